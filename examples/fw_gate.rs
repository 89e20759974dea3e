//! The gate: every public operation of the crate once or more, its results folded into a checksum per module.
//!
//! `tests/firmware_gate.rs` compares the lines of all four targets with the host's, bit for bit, reads the image's
//! symbols (no panic, no soft float, no allocator), and measures code, stack and memory against `tests/budgets.txt`.
//! A public function that no module of `gate` calls fails that test by its name.
#![cfg_attr(target_os = "none", no_std, no_main)]

mod gate;
#[path = "board/run.rs"]
mod run;

/// Writes a line per module; the same on all targets.
pub(crate) fn report(out: &mut impl core::fmt::Write) -> core::fmt::Result {
    for (module, call) in gate::MODULES {
        let mut sum = gate::Sum::default();
        call(&mut sum);
        writeln!(out, "{module}: {} results, checksum {:08x}", sum.results, sum.value)?;
    }
    Ok(())
}

#[cfg(not(target_os = "none"))]
fn main() {
    run::on_host();
}
