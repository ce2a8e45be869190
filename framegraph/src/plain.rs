//! Names as outputs show them: on one line, without control characters, and short.

use std::borrow::Cow;
use std::fmt::Write;

/// Text on one line, whatever is in a name: control characters are written as Rust would (`\n`, `\u{1b}`).
pub(crate) fn plain(text: &str) -> Cow<'_, str> {
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

/// Characters of a name that an error shows at most.
const MOST_OF_A_NAME: usize = 120;

/// Characters of an error at most.
const MOST_OF_A_LINE: usize = 4000;

/// The line of an error: [`plain`], each name in backticks shortened, and the whole too.
pub(crate) fn line(text: &str) -> String {
    let mut out = String::new();
    for (index, piece) in text.split('`').enumerate() {
        if index != 0 {
            out.push('`');
        }
        shorten(piece, MOST_OF_A_NAME, &mut out, index % 2 == 1);
    }
    let mut whole = String::new();
    shorten(&out, MOST_OF_A_LINE, &mut whole, true);
    plain(&whole).into_owned()
}

/// Appends `text`, or if it has more than `most` characters, so many of them and how many there are.
fn shorten(text: &str, most: usize, out: &mut String, name: bool) {
    match text.char_indices().nth(most) {
        Some((end, _)) if name => {
            out.push_str(&text[..end]);
            // Writing to a string cannot fail.
            let _ = write!(out, "… ({} characters)", text.chars().count());
        }
        _ => out.push_str(text),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn control_characters_are_written_out() {
        assert_eq!(plain("a\0b\u{1b}[31m\n\u{9b}\u{7f}ü"), "a\\u{0}b\\u{1b}[31m\\n\\u{9b}\\u{7f}ü");
        assert!(matches!(plain("plain"), Cow::Borrowed("plain")));
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
