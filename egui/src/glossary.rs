//! Terms of the glossary (`docs/reference/glossary.md`) for tooltips.

/// Text of the document at build time.
const TEXT: &str = include_str!("glossary.md");

/// Returns the definition of a term as plain text: the second column of the row with the term in bold.
pub fn meaning(word: &str) -> Option<String> {
    let row = TEXT.lines().filter_map(|line| {
        let mut cells = line.strip_prefix("| ")?.split(" | ");
        let (terms, meaning) = (cells.next()?, cells.next()?);
        let mut bold = terms.split("**").skip(1).step_by(2);
        bold.any(|term| term.split(", ").any(|term| term.eq_ignore_ascii_case(word))).then_some(meaning)
    });
    row.map(plain).next().or_else(|| sentence(word))
}

/// Returns the sentence of running text that has the term in bold.
fn sentence(word: &str) -> Option<String> {
    let bold = format!("**{word}**");
    let paragraphs = TEXT.split("\n\n").map(|paragraph| paragraph.replace('\n', " "));
    let mut bold_in = paragraphs.filter(|p| !p.starts_with('|')).filter_map(move |paragraph| {
        let lower = paragraph.to_lowercase();
        let at = lower.find(&bold.to_lowercase())?;
        let from = lower[..at].rfind(". ").map_or(0, |dot| dot + 2);
        let to = lower[at..].find(". ").map_or(lower.len(), |dot| at + dot + 1);
        paragraph.get(from..to).map(plain)
    });
    bold_in.next()
}

/// Removes Markdown markup.
fn plain(text: &str) -> String {
    text.replace("**", "").replace(['`', '*'], "")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_words_of_the_panels_are_explained() {
        for word in super::super::panel::TERMS {
            let meaning = meaning(word).unwrap_or_else(|| panic!("`{word}` is not in docs/reference/glossary.md"));
            assert!(meaning.len() > 20 && !meaning.contains("**"), "{word}: {meaning}");
        }
        assert_eq!(meaning("toaster"), None);
    }
}
