//! What a linked image weighs: sections, code per module of the crate, stack per function.

use object::{Object, ObjectSection, ObjectSymbol, SymbolKind};
use std::collections::BTreeMap;

/// Smaller frames are not listed.
const LISTED_STACK: u64 = 512;
/// What the gate's own code counts as.
const GATE: &str = "the gate";

/// Name and number of everything that has a budget; frames where wanted.
pub(crate) fn weigh(elf: &[u8], with_stacks: bool) -> Vec<(String, u64)> {
    let file = object::File::parse(elf).unwrap();
    let size = |names: &[&str]| -> u64 {
        file.sections().filter(|s| s.name().is_ok_and(|name| names.contains(&name))).map(|s| s.size()).sum()
    };
    let mut out = vec![
        ("bytes of code".to_owned(), size(&[".text", ".text.dummy", ".vector_table", ".init"])),
        ("bytes of constants".to_owned(), size(&[".rodata", ".srodata"])),
        ("bytes of static memory".to_owned(), size(&[".data", ".sdata", ".bss", ".sbss", ".uninit"])),
    ];
    let mut code = BTreeMap::<String, u64>::new();
    for symbol in file.symbols().filter(|symbol| symbol.kind() == SymbolKind::Text) {
        *code.entry(module(&readable(symbol.name().unwrap_or("")))).or_default() += symbol.size();
    }
    out.extend(code.into_iter().map(|(module, size)| (format!("bytes of code in {module}"), size)));
    if with_stacks {
        out.extend(stacks(&file).into_iter().map(|(name, size)| (format!("bytes of stack in {name}"), size)));
    }
    out
}

/// The frames of functions outside the gate itself, largest first; of instances with the same name the largest.
fn stacks(file: &object::File<'_>) -> Vec<(String, u64)> {
    let symbols = file.symbols().filter(|symbol| symbol.kind() == SymbolKind::Text);
    let names: BTreeMap<u64, String> = symbols.map(|s| (s.address() & !1, readable(s.name().unwrap_or("")))).collect();
    let section = file.section_by_name(".stack_sizes").expect("-Z emit-stack-sizes");
    let mut frames = BTreeMap::<String, u64>::new();
    for (address, size) in stack_sizes(section.data().unwrap()) {
        let name = names.get(&(address & !1)).cloned().unwrap_or_else(|| format!("{address:#x}"));
        if module(&name) != GATE {
            let frame = frames.entry(short(&name)).or_default();
            *frame = size.max(*frame);
        }
    }
    let mut frames: Vec<_> = frames.into_iter().filter(|(_, size)| *size >= LISTED_STACK).collect();
    frames.sort_by_key(|(name, size)| (u64::MAX - size, name.clone()));
    frames
}

/// Entries of `.stack_sizes` of a 32-bit target: an address and a size in LEB128.
pub(crate) fn stack_sizes(mut bytes: &[u8]) -> Vec<(u64, u64)> {
    let mut out = Vec::new();
    while let Some((address, rest)) = bytes.split_first_chunk::<4>() {
        let length = rest.iter().position(|byte| byte & 0x80 == 0).expect("the end of a number") + 1;
        let size = rest[..length].iter().rev().fold(0, |sum, byte| sum << 7 | u64::from(byte & 0x7f));
        out.push((u32::from_le_bytes(*address).into(), size));
        bytes = &rest[length..];
    }
    out
}

/// Demangled, without hashes, and with short names for the number types.
pub(crate) fn readable(symbol: &str) -> String {
    let name = symbol.split(".llvm.").next().unwrap_or(symbol);
    let mut name = format!("{:#}", rustc_demangle::demangle(name));
    for (prefix, short) in [("fixed::FixedI32<", "I16F16"), ("fixed::FixedI64<", "I32F32")] {
        while let Some(start) = name.find(prefix) {
            let mut depth = 0;
            let end = name[start..].find(|c| {
                depth += i32::from(c == '<') - i32::from(c == '>');
                c == '>' && depth == 0
            });
            name.replace_range(start..=start + end.expect("balanced"), short);
        }
    }
    name
}

/// Every path in a name by its last two parts.
pub(crate) fn short(name: &str) -> String {
    let is_word = |c: char| c.is_alphanumeric() || c == '_' || c == ':';
    let mut out = String::new();
    let mut rest = name;
    while let Some(c) = rest.chars().next() {
        let end = rest.find(|c| is_word(c) != is_word(rest.chars().next().unwrap_or(c))).unwrap_or(rest.len());
        let (token, after) = rest.split_at(end);
        let parts: Vec<_> = token.split("::").collect();
        match parts.len() {
            3.. if is_word(c) && !token.starts_with("::") => out.push_str(&parts[parts.len() - 2..].join("::")),
            _ => out.push_str(token),
        }
        rest = after;
    }
    out
}

/// The module of the crate that a name speaks of first; the gate's own code, or the rest.
pub(crate) fn module(name: &str) -> String {
    let after =
        |prefix: &str| name.split(prefix).nth(1).and_then(|rest| rest.split(|c: char| !c.is_alphanumeric()).next());
    match after("embedded_surfaces::") {
        Some(module) => module.to_owned(),
        None if name.contains("fw_gate::") => GATE.to_owned(),
        None => "core and run-time".to_owned(),
    }
}
