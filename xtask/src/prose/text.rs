//! Paragraphs and sentences of prose in Rust, WGSL and Markdown.

use crate::source::literals::{Literal, literals};

/// A paragraph without comment markers; its lines are joined by spaces.
#[derive(Debug, PartialEq, Eq)]
pub struct Paragraph {
    /// Line on which it starts, from 1.
    pub line: usize,
    /// The text.
    pub text: String,
}

/// Returns the paragraphs of a Markdown file, or of the comments and string literals of a source file.
pub fn paragraphs(text: &str, markdown: bool) -> Vec<Paragraph> {
    let mut found = Vec::new();
    if markdown {
        let indented = |line: &str| line.starts_with("    ");
        prose(text.lines().enumerate().map(|(at, line)| (at + 1, if indented(line) { "" } else { line })), &mut found);
        return found;
    }
    let (mut line, mut counted) = (1, 0);
    let mut block: Vec<(usize, &str)> = Vec::new();
    for (kind, range) in literals(text) {
        line += text[counted..range.start].matches('\n').count();
        counted = range.start;
        let (start, inside) = (range.start, &text[range]);
        match kind {
            Literal::Line => {
                // Comments on consecutive lines are one text, except trailing comments.
                let beside_code = text[..start].rsplit('\n').next().is_some_and(|before| !before.trim().is_empty());
                if beside_code || block.last().is_some_and(|(last, _)| last + 1 != line) {
                    prose(block.drain(..), &mut found);
                }
                block.push((line, inside.trim_start_matches(['/', '!'])));
            }
            Literal::String | Literal::Raw => found.extend(message(line, inside)),
            Literal::Block | Literal::Character => {}
        }
    }
    prose(block.into_iter(), &mut found);
    found.sort_by_key(|paragraph| paragraph.line);
    found
}

/// Splits lines of Markdown into paragraphs; leaves out code, tables, headings, quotes and HTML.
fn prose<'a>(lines: impl Iterator<Item = (usize, &'a str)>, found: &mut Vec<Paragraph>) {
    let mut fenced = false;
    let mut open = false;
    for (number, line) in lines {
        let line = line.trim();
        if line.starts_with("```") {
            (fenced, open) = (!fenced, false);
            continue;
        }
        // Columns of a table in plain text have several blanks in between.
        let skipped = line.starts_with(['|', '#', '<', '!', '>', '$']) || line.starts_with("SAFETY");
        if fenced || line.is_empty() || skipped || line.contains("   ") {
            open = false;
            continue;
        }
        let digits = line.trim_start_matches(|c: char| c.is_ascii_digit());
        let numbered = digits.strip_prefix(". ").filter(|_| digits.len() < line.len());
        let item = line.strip_prefix("- ").or_else(|| line.strip_prefix("* ")).or(numbered);
        match found.last_mut().filter(|_| open && item.is_none()) {
            Some(paragraph) => {
                paragraph.text.push(' ');
                paragraph.text += line;
            }
            None => found.push(Paragraph { line: number, text: item.unwrap_or(line).to_owned() }),
        }
        open = true;
    }
}

/// Returns the paragraphs of a string literal that reads like a message. Indented lines are lists of options.
fn message(line: usize, literal: &str) -> Vec<Paragraph> {
    let inside = literal.trim_matches(|c| "rbc#\"".contains(c));
    let joined: Vec<String> = inside.split("\\\n").map(|part| part.trim_start_matches(' ').to_owned()).collect();
    let text = joined.concat().replace("\\n", "\n").replace("\\\"", "\"");
    let mut found = Vec::new();
    for block in text.split("\n\n") {
        let lines = block.lines().filter(|line| !line.starts_with("  "));
        let text = lines.collect::<Vec<_>>().join(" ").replace(['{', '}'], "`").trim().to_owned();
        if is_message(&text) {
            found.push(Paragraph { line, text });
        }
    }
    found
}

/// Returns true if a text starts with a capital letter, ends with a full stop, and has at least four words.
fn is_message(text: &str) -> bool {
    let words = text.split_whitespace().filter(|word| word.chars().all(|c| c.is_alphabetic() || ",.;:'".contains(c)));
    text.starts_with(|c: char| c.is_ascii_uppercase()) && text.ends_with('.') && words.count() >= 4
}

/// Returns the sentences of a paragraph. Code is replaced by `X`, quoted text by `Q`, and links by their titles.
pub fn sentences(paragraph: &str) -> Vec<String> {
    let text = links(&between(&between(paragraph, '`', "X"), '"', "Q"));
    let mut found = Vec::new();
    let mut rest = text.trim();
    while let Some(end) = end_of_sentence(rest) {
        found.push(rest[..end].trim().to_owned());
        rest = rest[end..].trim_start();
    }
    found.push(rest.to_owned());
    found.retain(|sentence| sentence.chars().count() > 3);
    found
}

/// Returns the end of the first sentence if another one follows: punctuation, white space, a capital letter.
fn end_of_sentence(text: &str) -> Option<usize> {
    text.match_indices(['.', '!', '?']).map(|(at, _)| at + 1).find(|end| {
        let next = text[*end..].trim_start();
        let is_apart = next.len() < text.len() - end;
        is_apart && next.trim_start_matches(['*', '_']).starts_with(|c: char| c.is_ascii_uppercase())
    })
}

/// Replaces every pair of marks and the text between them.
fn between(text: &str, mark: char, with: &str) -> String {
    let parts: Vec<&str> = text.split(mark).collect();
    let inside = |at: usize| at % 2 == 1 && at + 1 < parts.len();
    parts.iter().enumerate().map(|(at, part)| if inside(at) { with } else { part }).collect()
}

/// Replaces `[title](target)` and `[title]` by `title`.
fn links(text: &str) -> String {
    let mut found = String::new();
    let mut rest = text;
    while let Some((before, after)) = rest.split_once('[') {
        let Some((title, after)) = after.split_once(']') else { break };
        found = found + before + title;
        rest = after.strip_prefix('(').and_then(|target| target.split_once(')')).map_or(after, |(_, after)| after);
    }
    found + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_and_messages_are_read_and_code_is_not() {
        let text = "\
//! One sentence
//! on two lines.
//! ```
//! What is code.
//! ```
//! - An item.
fn f() { // A comment. Another of [`f`](x), \"quoted\".
    let s = \"A message of {n} words: \\
             none of two.\";
    let t = \"one two three four\";
}
";
        let found = paragraphs(text, false);
        let found: Vec<(usize, &str)> = found.iter().map(|found| (found.line, &*found.text)).collect();
        let last = "A message of `n` words: none of two.";
        let comment = "A comment. Another of [`f`](x), \"quoted\".";
        assert_eq!(found, [(1, "One sentence on two lines."), (6, "An item."), (7, comment), (8, last)]);
        assert_eq!(sentences(comment), ["A comment.", "Another of X, Q."]);
    }

    #[test]
    fn tables_headings_and_code_of_markdown_are_left_out() {
        let text = "# What is a heading\n\nA text\nof two lines.\n\n| What |\n> Who\n\n    What is code.\n1. First.\n2. Second.\n";
        let found: Vec<String> = paragraphs(text, true).into_iter().map(|paragraph| paragraph.text).collect();
        assert_eq!(found, ["A text of two lines.", "First.", "Second."]);
    }
}
