//! Sanitizes names for output: one line, no control characters, limited length.

use std::borrow::Cow;

/// Escapes control characters as Rust does (`\n`, `\u{1b}`), so that the text fits on one line.
pub fn escape_controls(text: &str) -> Cow<'_, str> {
    if !text.contains(char::is_control) {
        return Cow::Borrowed(text);
    }
    let mut out = String::with_capacity(text.len() + 8);
    for c in text.chars() {
        if c.is_control() {
            out.extend(c.escape_default());
        } else {
            out.push(c);
        }
    }
    Cow::Owned(out)
}

/// Maximum number of characters of a name in an error.
const MAX_NAME_CHARS: usize = 120;

/// Maximum number of characters of an error.
const MAX_LINE_CHARS: usize = 4000;

/// Formats an error as one line: escapes control characters, and shortens long names in backticks and the whole line.
pub fn line(text: &str) -> String {
    let pieces = text.split('`').enumerate();
    let pieces = pieces.map(|(i, piece)| if i % 2 == 1 { short(piece, MAX_NAME_CHARS) } else { piece.into() });
    escape_controls(&short(&pieces.collect::<Vec<_>>().join("`"), MAX_LINE_CHARS)).into_owned()
}

/// Formats a name for an error: escapes control characters and shortens it.
pub fn name(text: &str) -> String {
    escape_controls(&short(text, MAX_NAME_CHARS)).into_owned()
}

/// Shortens `text` to `most` characters and appends its length if it is longer.
fn short(text: &str, most: usize) -> Cow<'_, str> {
    match text.char_indices().nth(most) {
        Some((end, _)) => format!("{}… ({} characters)", &text[..end], text.chars().count()).into(),
        None => text.into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn control_characters_are_written_out() {
        assert_eq!(escape_controls("a\0b\u{1b}[31m\n\u{9b}\u{7f}ü"), "a\\u{0}b\\u{1b}[31m\\n\\u{9b}\\u{7f}ü");
        assert!(matches!(escape_controls("plain"), Cow::Borrowed("plain")));
    }

    #[test]
    fn long_names_are_cut_and_short_lines_are_not() {
        let long = "x".repeat(5_000_000);
        let cut = line(&format!("there is no pass `{long}`; did you mean `y`?"));
        assert!(cut.len() < 300 && cut.ends_with("(5000000 characters)`; did you mean `y`?"), "{cut}");
        let sentence = "word ".repeat(100);
        assert_eq!(line(&sentence), sentence);
        assert!(line(&"`a` ".repeat(100_000)).len() < 5000);
    }
}
