//! Positions of the comments and literals in a text of Rust or WGSL.

use std::ops::Range;

/// Kind of a comment or literal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Literal {
    /// `// …`, `/// …`, `//! …`, up to the end of the line.
    Line,
    /// `/* … */`, which may be nested.
    Block,
    /// `"…"`, in which a backslash escapes the next character.
    String,
    /// `r"…"`, `r#"…"#` and so on, without escapes.
    Raw,
    /// `'…'`.
    Character,
}

/// Comments and literals in order, with their delimiters; byte ranges of `text`.
pub fn literals(text: &str) -> Vec<(Literal, Range<usize>)> {
    let bytes = text.as_bytes();
    let mut found = Vec::new();
    let mut at = 0;
    while at < bytes.len() {
        let rest = &bytes[at..];
        let in_word = at > 0 && (bytes[at - 1].is_ascii_alphanumeric() || bytes[at - 1] == b'_');
        let (kind, length) = if rest.starts_with(b"//") {
            (Literal::Line, rest.iter().position(|byte| *byte == b'\n').unwrap_or(rest.len()))
        } else if rest.starts_with(b"/*") {
            (Literal::Block, block_comment(rest))
        } else if let Some(length) = raw_string(rest).filter(|_| !in_word) {
            (Literal::Raw, length)
        } else if rest[0] == b'"' {
            (Literal::String, quoted(rest))
        } else if rest[0] == b'\'' {
            (Literal::Character, character(rest))
        } else {
            at += 1;
            continue;
        };
        if length > 1 {
            found.push((kind, at..at + length));
        }
        at += length;
    }
    found
}

fn block_comment(rest: &[u8]) -> usize {
    let (mut depth, mut at) = (0, 0);
    while at < rest.len() {
        match &rest[at..] {
            [b'/', b'*', ..] => (depth, at) = (depth + 1, at + 2),
            [b'*', b'/', ..] => (depth, at) = (depth - 1, at + 2),
            _ => at += 1,
        }
        if depth == 0 {
            break;
        }
    }
    at
}

/// Returns the length of the raw string that starts here, if there is one.
fn raw_string(rest: &[u8]) -> Option<usize> {
    let prefix =
        rest.iter().position(|byte| *byte == b'r').filter(|at| *at == 0 || (*at == 1 && b"bc".contains(&rest[0])))?;
    let hashes = rest[prefix + 1..].iter().take_while(|byte| **byte == b'#').count();
    let start = prefix + 1 + hashes;
    if rest.get(start) != Some(&b'"') {
        return None;
    }
    let end: Vec<u8> = std::iter::once(b'"').chain(std::iter::repeat_n(b'#', hashes)).collect();
    let inside = &rest[start + 1..];
    let length = inside.windows(end.len()).position(|window| window == end).map_or(inside.len(), |at| at + end.len());
    Some(start + 1 + length)
}

fn quoted(rest: &[u8]) -> usize {
    let mut at = 1;
    while at < rest.len() {
        match rest[at] {
            b'\\' => at += 2,
            b'"' => return at + 1,
            _ => at += 1,
        }
    }
    rest.len()
}

/// Returns the length of a character literal; 1 if the quote starts a lifetime.
fn character(rest: &[u8]) -> usize {
    match rest {
        [_, b'\\', _, after @ ..] => after.iter().position(|byte| *byte == b'\'').map_or(1, |at| at + 4),
        [_, b'\'', ..] => 1,
        [_, first, ..] => {
            let width = match first {
                0..0x80 => 1,
                0x80..0xe0 => 2,
                0xe0..0xf0 => 3,
                0xf0.. => 4,
            };
            if rest.get(1 + width) == Some(&b'\'') { width + 2 } else { 1 }
        }
        _ => 1,
    }
}
