//! WGSL text as tokens: words, numbers and marks, without white space and comments.

use super::fault::Fault;

/// Kind of a token.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// A keyword or an identifier.
    Word,
    /// A numeric literal.
    Number,
    /// Any other single character: `->` is two marks.
    Mark(char),
}

/// Token and its position.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Token {
    pub kind: Kind,
    /// Start byte in the text.
    pub start: usize,
    /// End byte in the text, exclusive.
    pub end: usize,
    /// Line number, starting at 1.
    pub line: usize,
}

/// Returns true for the line breaks of WGSL (section 3.1), all of which end a `//` comment.
const fn is_line_break(c: char) -> bool {
    matches!(c, '\n' | '\u{b}' | '\u{c}' | '\r' | '\u{85}' | '\u{2028}' | '\u{2029}')
}

fn is_word(c: char) -> bool {
    c == '_' || c.is_alphanumeric()
}

/// Splits a text into tokens.
///
/// # Errors
///
/// If a block comment is not closed.
pub(super) fn tokens(text: &str) -> Result<Vec<Token>, Fault> {
    let mut list = Vec::with_capacity(text.len() / 4);
    let (mut at, mut line) = (0, 1);
    while let Some(first) = text[at..].chars().next() {
        let rest = &text[at..];
        let (kind, length) = if first.is_whitespace() {
            (None, first.len_utf8())
        } else if rest.starts_with("//") {
            (None, rest.find(is_line_break).unwrap_or(rest.len()))
        } else if rest.starts_with("/*") {
            let length = block_comment(rest).ok_or_else(|| Fault::new(line, "this comment is not closed"))?;
            (None, length)
        } else if first.is_ascii_digit() || first == '.' && rest[1..].starts_with(|c: char| c.is_ascii_digit()) {
            (Some(Kind::Number), number(rest))
        } else if is_word(first) {
            (Some(Kind::Word), rest.find(|c| !is_word(c)).unwrap_or(rest.len()))
        } else {
            (Some(Kind::Mark(first)), first.len_utf8())
        };
        let end = at + length;
        if let Some(kind) = kind {
            list.push(Token { kind, start: at, end, line });
        }
        line += rest[..length].matches('\n').count();
        at = end;
    }
    Ok(list)
}

/// Returns the length of the block comment at the start of a text; block comments nest.
fn block_comment(text: &str) -> Option<usize> {
    let (mut depth, mut at) = (0_usize, 0);
    loop {
        let found = at + text[at..].find(['/', '*'])?;
        at = found + 1;
        if text[found..].starts_with("/*") {
            (depth, at) = (depth + 1, found + 2);
        } else if text[found..].starts_with("*/") {
            (depth, at) = (depth - 1, found + 2);
            if depth == 0 {
                return Some(at);
            }
        }
    }
}

/// Returns the length of the number at the start of a text: digits, letters, points, and the sign of an exponent.
fn number(text: &str) -> usize {
    let hexadecimal = text.starts_with("0x") || text.starts_with("0X");
    let exponents: &[char] = if hexadecimal { &['p', 'P'] } else { &['e', 'E'] };
    let mut before = '0';
    let end = text.find(|c: char| {
        let inside = c == '.' || c.is_ascii_alphanumeric() || matches!(c, '+' | '-') && exponents.contains(&before);
        before = c;
        !inside
    });
    end.unwrap_or(text.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(text: &str) -> Vec<&str> {
        tokens(text).unwrap().iter().map(|t| &text[t.start..t.end]).collect()
    }

    #[test]
    fn texts_become_words_numbers_and_marks() {
        assert_eq!(words("let x=1.5e-3+a.b;"), ["let", "x", "=", "1.5e-3", "+", "a", ".", "b", ";"]);
        assert_eq!(words("0x1p-2-0xe-1 .5f 1u"), ["0x1p-2", "-", "0xe", "-", "1", ".5f", "1u"]);
        assert_eq!(
            words("@if(A)\nfn größe_2() -> b"),
            ["@", "if", "(", "A", ")", "fn", "größe_2", "(", ")", "-", ">", "b"]
        );
    }

    #[test]
    fn comments_are_left_out_and_lines_counted() {
        let text = "a // b\n/* c /* d */ \n */ e\n// f";
        assert_eq!(words(text), ["a", "e"]);
        assert_eq!(tokens(text).unwrap()[1].line, 3);
        assert_eq!(tokens("a\n/* b /* */").unwrap_err().line, 2);
    }
}
