//! The public functions and methods of the crate, and the calls in the gate, by their tokens.

use super::firmware::ROOT;
use proc_macro2::{Delimiter, Group, TokenStream, TokenTree};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// How often a name occurs: `Type::method`, `Trait::method` or `function`.
pub(crate) type Names = BTreeMap<String, usize>;

/// Type aliases: `CubicCurve` is a `Curve`.
pub(crate) type Aliases = BTreeMap<String, String>;

pub(crate) fn rust_files(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for path in std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
        if path.is_dir() {
            files.extend(rust_files(&path));
        } else if path.extension().is_some_and(|e| e == "rs") {
            files.push(path);
        }
    }
    files
}

/// The public names of each module of the crate, `reference` and tests left out.
pub(crate) fn defined() -> BTreeMap<String, Names> {
    let folder = Path::new(ROOT).join("src");
    let mut sources = Vec::new();
    let mut aliases = Aliases::new();
    for path in rust_files(&folder) {
        let relative = path.strip_prefix(&folder).unwrap().with_extension("");
        let module = relative.iter().next().unwrap().to_str().unwrap().to_owned();
        if module == "reference" || relative.ends_with("tests") {
            continue;
        }
        let tokens: Vec<_> =
            std::fs::read_to_string(&path).unwrap().parse::<TokenStream>().unwrap().into_iter().collect();
        aliases_in(&tokens, &mut aliases);
        sources.push((module, tokens));
    }
    let mut out = BTreeMap::new();
    for (module, tokens) in sources {
        definitions(&tokens, &aliases, out.entry(module).or_default());
    }
    out
}

pub(crate) fn aliases_in(tokens: &[TokenTree], aliases: &mut Aliases) {
    for window in tokens.windows(5) {
        let [public, kind, name, equals, target] = window else { continue };
        if [public, kind, equals].map(ToString::to_string) == ["pub", "type", "="] {
            aliases.insert(name.to_string(), target.to_string());
        }
    }
}

/// Adds the public functions of a list of items.
pub(crate) fn definitions(tokens: &[TokenTree], aliases: &Aliases, out: &mut Names) {
    let mut at = 0;
    let mut skipped = false;
    while let Some(token) = tokens.get(at) {
        match token.to_string().as_str() {
            "#" => {
                let attribute = tokens.get(at + 1).map_or(String::new(), ToString::to_string).replace(' ', "");
                let not_in_firmware = attribute.starts_with("[cfg(test") || attribute.starts_with("[cfg(all(test");
                skipped |= not_in_firmware || attribute == "[cfg(feature=\"std\")]";
                at += 2;
                continue;
            }
            "pub" if is_public(tokens, at) => {
                let words: Vec<_> = tokens[at + 1..].iter().take(3).map(ToString::to_string).collect();
                let kind = words.iter().position(|word| word == "fn" || word == "trait");
                match kind {
                    Some(k) if words[k] == "fn" => add(out, &tokens[at + k + 2].to_string(), skipped),
                    Some(k) if !skipped => {
                        let body = body_after(tokens, at);
                        methods(&body, &tokens[at + k + 2].to_string(), false, out);
                    }
                    _ => {}
                }
            }
            "impl" if !skipped => {
                let header = tokens[at + 1..].iter().take_while(|t| !is_braces(t));
                if let Some(name) = inherent(&header.cloned().collect::<Vec<_>>()) {
                    let name = aliases.get(&name).cloned().unwrap_or(name);
                    methods(&body_after(tokens, at), &name, true, out);
                }
            }
            "macro_rules" if !skipped => generated(tokens, at, out),
            _ => {}
        }
        // On to the end of the item.
        while tokens.get(at).is_some_and(|t| !is_braces(t) && t.to_string() != ";") {
            at += 1;
        }
        at += 1;
        skipped = false;
    }
}

fn add(out: &mut Names, name: &str, skipped: bool) {
    if !skipped {
        *out.entry(name.to_owned()).or_default() += 1;
    }
}

fn is_public(tokens: &[TokenTree], at: usize) -> bool {
    tokens[at].to_string() == "pub" && !matches!(tokens.get(at + 1), Some(TokenTree::Group(_)))
}

fn is_braces(token: &TokenTree) -> bool {
    matches!(token, TokenTree::Group(g) if g.delimiter() == Delimiter::Brace)
}

fn body_after(tokens: &[TokenTree], at: usize) -> Vec<TokenTree> {
    let body = tokens[at..].iter().find(|token| is_braces(token));
    body.map_or(Vec::new(), |token| inside(token).into_iter().collect())
}

fn inside(token: &TokenTree) -> TokenStream {
    if let TokenTree::Group(group) = token { Group::stream(group) } else { TokenStream::new() }
}

/// Adds the functions of an `impl` or trait.
fn methods(body: &[TokenTree], name: &str, only_public: bool, out: &mut Names) {
    let (mut public, mut skipped) = (false, false);
    for (at, token) in body.iter().enumerate() {
        match token.to_string().replace(' ', "").as_str() {
            "pub" => public = is_public(body, at),
            ";" => (public, skipped) = (false, false),
            attribute if attribute.starts_with("[cfg(test") || attribute == "[cfg(feature=\"std\")]" => skipped = true,
            "fn" => {
                if public || !only_public {
                    add(out, &format!("{name}::{}", body[at + 1]), skipped);
                }
                (public, skipped) = (false, false);
            }
            _ => {}
        }
    }
}

/// The type of an inherent `impl`, from what stands before its braces; `None` for an `impl` of a trait.
fn inherent(header: &[TokenTree]) -> Option<String> {
    let words: Vec<_> = header.iter().map(ToString::to_string).collect();
    let mut at = skip_generics(&words, 0);
    let mut name = None;
    while let Some(word) = words.get(at) {
        match word.as_str() {
            "for" => return None,
            "where" => break,
            "<" => at = skip_generics(&words, at) - 1,
            "$" => name = words.get(at + 1).map(|word| format!("${word}")),
            word if word.starts_with(|c: char| c.is_alphabetic())
                && !name.as_ref().is_some_and(|n| n.starts_with('$')) =>
            {
                name = Some(word.to_owned());
            }
            _ => {}
        }
        at += 1;
    }
    name
}

/// The place behind `<…>`, if there are any at `at`.
fn skip_generics(words: &[String], at: usize) -> usize {
    if words.get(at).map(String::as_str) != Some("<") {
        return at;
    }
    let (mut depth, mut end) = (0, at);
    while let Some(word) = words.get(end) {
        let arrow = end > 0 && words[end - 1] == "-";
        depth += i32::from(word == "<") - i32::from(word == ">" && !arrow);
        end += 1;
        if depth == 0 {
            break;
        }
    }
    end
}

/// Adds what a macro makes: `impl $name` for the first name of each of its invocations in the file.
fn generated(tokens: &[TokenTree], at: usize, out: &mut Names) {
    let name = tokens[at + 2].to_string();
    let rules: Vec<_> = body_after(tokens, at);
    let bodies: Vec<Vec<TokenTree>> =
        rules.iter().filter(|t| is_braces(t)).map(|t| inside(t).into_iter().collect()).collect();
    let calls = tokens.windows(3).filter(|w| w[0].to_string() == name && w[1].to_string() == "!");
    for call in calls {
        let mut arguments = inside(&call[2]).into_iter().filter(|token| matches!(token, TokenTree::Ident(_)));
        let Some(first) = arguments.next() else { continue };
        for body in &bodies {
            for (place, token) in body.iter().enumerate() {
                let header: Vec<_> = body[place..].iter().skip(1).take_while(|t| !is_braces(t)).cloned().collect();
                if token.to_string() == "impl" && inherent(&header).is_some_and(|name| name.starts_with('$')) {
                    methods(&body_after(body, place), &first.to_string(), true, out);
                }
            }
        }
    }
}

/// The calls in a file: `Type::method` with or without generics between, and plain names.
pub(crate) fn calls(tokens: TokenStream, aliases: &Aliases, out: &mut Names) {
    let tokens: Vec<_> = tokens.into_iter().collect();
    let words: Vec<_> =
        tokens.iter().map(|t| if let TokenTree::Group(_) = t { String::new() } else { t.to_string() }).collect();
    let mut at = 0;
    while at < tokens.len() {
        if let TokenTree::Group(group) = &tokens[at] {
            calls(group.stream(), aliases, out);
        } else if words[at] == "use" {
            at += words[at..].iter().position(|word| word == ";").unwrap_or(0);
        } else if matches!(tokens[at], TokenTree::Ident(_)) {
            add(out, &words[at], at > 0 && words[at - 1] == ".");
            let colons = |at: usize| words.get(at..at + 2).is_some_and(|w| w == [":", ":"]);
            let mut next = at + 1;
            if colons(next) && words.get(next + 2).is_some_and(|w| w == "<") {
                next = skip_generics(&words, next + 2);
            }
            if colons(next) && matches!(tokens.get(next + 2), Some(TokenTree::Ident(_))) {
                let name = aliases.get(&words[at]).unwrap_or(&words[at]);
                add(out, &format!("{name}::{}", words[next + 2]), false);
            }
        }
        at += 1;
    }
}
