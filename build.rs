//! Tells the crate which of its assembly forms the target runs; only with the feature `asm`.

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rustc-check-cfg=cfg(forward_asm, values(none(), \"v6m\", \"v7m\", \"rv32\"))");
    let wanted = std::env::var_os("CARGO_FEATURE_ASM").is_some();
    let target = std::env::var("TARGET").unwrap_or_default();
    // ARMv8-M baseline runs what v6-M runs, main line what v7-M runs.
    let forms = [
        ("thumbv6m-", "v6m"),
        ("thumbv8m.base-", "v6m"),
        ("thumbv7m-", "v7m"),
        ("thumbv7em-", "v7m"),
        ("thumbv8m.main-", "v7m"),
        ("riscv32", "rv32"),
    ];
    // The RISC-V form uses more registers than the E extension has.
    let form = forms.into_iter().find(|(prefix, _)| target.starts_with(prefix) && !target.starts_with("riscv32e"));
    if let Some((_, form)) = form.filter(|_| wanted) {
        println!("cargo::rustc-cfg=forward_asm");
        println!("cargo::rustc-cfg=forward_asm=\"{form}\"");
    }
}
