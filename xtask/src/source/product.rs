//! Product code of a Rust file: code without comments, literals and tests.

use std::ops::Range;

use super::literals::literals;

/// Code of a file. It has the length of the text; removed parts are blank, and line breaks remain.
#[derive(Debug)]
pub struct Product {
    /// Code with comments, contents of literals, and tests replaced by blanks.
    pub code: String,
    /// Number of lines with documentation and comments, without tests.
    pub lines: usize,
}

impl Product {
    /// Reads a file's text.
    pub fn of(text: &str) -> Self {
        let mut code = without_literals(text);
        let tests = test_items(&code, text);
        let test_lines: usize = tests.iter().map(|range| text[range.clone()].lines().count()).sum();
        tests.into_iter().for_each(|range| blank(&mut code[range]));
        let code = String::from_utf8(code).expect("only whole literals and items were blanked");
        Self { code, lines: text.lines().count() - test_lines }
    }
}

/// Returns true if a `cfg` condition holds only in tests or with the feature `testing`.
fn is_test(condition: &str) -> bool {
    let plain: String = condition.split_whitespace().collect();
    !plain.contains("not(")
        && (plain.contains("feature=\"testing\"")
            || plain.split(|c: char| !c.is_alphanumeric()).any(|word| matches!(word, "test" | "doctest")))
}

fn blank(bytes: &mut [u8]) {
    bytes.iter_mut().filter(|byte| **byte != b'\n').for_each(|byte| *byte = b' ');
}

/// Replaces comments and literals with blanks.
fn without_literals(text: &str) -> Vec<u8> {
    let mut code = text.as_bytes().to_vec();
    literals(text).into_iter().for_each(|(_, range)| blank(&mut code[range]));
    code
}

/// Returns the ranges of items that only tests compile, with their attributes.
fn test_items(code: &[u8], text: &str) -> Vec<Range<usize>> {
    let mut found: Vec<Range<usize>> = Vec::new();
    let starts = code.windows(2).enumerate().filter(|(_, pair)| *pair == b"#[" || *pair == b"#!").map(|(at, _)| at);
    for start in starts {
        if found.last().is_some_and(|last| last.contains(&start)) {
            continue;
        }
        let Some(open) = code[start..].iter().position(|byte| *byte == b'[').map(|at| start + at) else { continue };
        let end = closing(code, open);
        if !code[open + 1..].starts_with(b"cfg(") || !is_test(&text[open..end]) {
            continue;
        }
        let whole_file = code[start + 1] == b'!';
        found.push(start..if whole_file { code.len() } else { item_end(code, end) });
    }
    found
}

/// Returns the position after the bracket that closes the one at `open`.
fn closing(code: &[u8], open: usize) -> usize {
    let mut depth = 0_usize;
    for (at, byte) in code.iter().enumerate().skip(open) {
        match byte {
            b'(' | b'[' | b'{' => depth += 1,
            b')' | b']' | b'}' => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return at + 1;
        }
    }
    code.len()
}

/// Returns the position after the item, field, variant or statement that follows an attribute ending at `from`.
fn item_end(code: &[u8], from: usize) -> usize {
    let blanks = |at: usize| at + code[at..].iter().take_while(|byte| byte.is_ascii_whitespace()).count();
    let mut at = blanks(from);
    while code[at..].starts_with(b"#[") {
        at = blanks(closing(code, at + 1));
    }
    let first: Vec<u8> =
        code[at..].iter().copied().take_while(|byte| byte.is_ascii_alphanumeric() || *byte == b'_').collect();
    let item =
        [&b"pub"[..], b"fn", b"mod", b"use", b"struct", b"enum", b"impl", b"trait", b"const", b"static", b"type"];
    let item =
        item.contains(&&first[..]) || [&b"unsafe"[..], b"async", b"extern", b"macro_rules"].contains(&&first[..]);
    // `use a::{b};` and `const A: B = B { … };` end at their semicolon.
    let head = &code[at..code.len().min(at + 24)];
    let at_semicolon = [&b"use "[..], b"const ", b"static ", b"let "].iter().any(|word| {
        head.windows(word.len())
            .position(|window| window == *word)
            .is_some_and(|at| at == 0 || head.starts_with(b"pub"))
    }) && !head.windows(9).any(|window| window == b"const fn ");
    while at < code.len() {
        match code[at] {
            b';' => return at + 1,
            b',' if !item => return at + 1,
            b')' | b']' | b'}' => return at,
            b'{' if !at_semicolon => return closing(code, at),
            b'{' | b'(' | b'[' => at = closing(code, at),
            _ => at += 1,
        }
    }
    at
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_and_literals_are_blank() {
        let text =
            "a(\"x \\\" y\", 'q', '\\'', 'ä', r#\"b \" c\"#); // no\n/* n /* o */ p */ fn f<'a>(v: &'a str) {}\n";
        let product = Product::of(text);
        assert_eq!(product.code.len(), text.len());
        let words: Vec<&str> = product.code.split_whitespace().collect();
        assert_eq!(words.join(" "), "a( , , , , ); fn f<'a>(v: &'a str) {}");
    }

    #[test]
    fn what_only_tests_compile_is_gone_and_not_counted() {
        let text = "\
mod a;
#[cfg(test)]
mod tests;
#[cfg(any(test, feature = \"testing\"))]
#[derive(Debug)]
pub struct Fake<T, U> {
    a: T,
}
#[cfg(test)]
use a::{b, c};
struct Kept {
    #[cfg(test)]
    field: u8,
    other: u8,
}
#[cfg(not(test))]
const KEPT: u8 = 1;
#[cfg(feature = \"files\")]
mod files;
#[cfg(test)]
mod tests2 {
    fn inner() {}
}
";
        let product = Product::of(text);
        let words: Vec<&str> = product.code.split_whitespace().collect();
        let kept =
            "mod a; struct Kept { other: u8, } #[cfg(not(test))] const KEPT: u8 = 1; #[cfg(feature = )] mod files;";
        assert_eq!(words.join(" "), kept);
        assert_eq!(product.lines, 8);
        assert_eq!(Product::of("//! A test.\n#![cfg(test)]\nfn f() {}\n").lines, 1);
    }
}
