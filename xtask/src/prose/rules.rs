//! Rules for one sentence.

/// Longest sentence that is not flagged, in words. Writers aim for 25.
const MAX_WORDS: usize = 30;

/// First words of clauses that stand in for nouns.
const CLAUSES: &str = "what who whoever whether which where how those that of beside such as";

/// First words that form a clause or an ellipsis only together.
const OPENINGS: [&str; 7] =
    ["so is", "so are", "so do", "none is", "any of them", "the same as", "nothing that is not"];

/// First words that are allowed, although [`CLAUSES`] has one of them.
const ALLOWED: [&str; 11] = [
    "that is,",
    "where possible",
    "where available",
    "of course",
    "as a ",
    "as an ",
    "as in ",
    "as with ",
    "as described",
    "as expected",
    "as of ",
];

/// Words that only this project uses in this sense, and literary words.
const PRIVATE: [&str; 24] = [
    "all the same:",
    "errs by",
    "goes in a circle",
    "in the place of",
    "in turns",
    "in which case of",
    "is told",
    "lamp",
    "lamps",
    "meanwhile",
    "no farther",
    "no more than there",
    "nobody",
    "not any more",
    "of one's own",
    "of which there",
    "so many",
    "stand beside",
    "stands beside",
    "there are not",
    "there is not",
    "what there is",
    "whoever",
    "with which",
];

/// Returns the reasons a sentence is flagged; empty for most good sentences.
pub fn reasons(sentence: &str) -> Vec<String> {
    let lower = sentence.to_lowercase();
    let words: Vec<&str> = lower.split_whitespace().collect();
    let mut found = Vec::new();
    if opens_with_clause(sentence, &lower) {
        found.push("opens with a clause used as a noun".to_owned());
    }
    if words.len() > MAX_WORDS {
        found.push(format!("{} words", words.len()));
    }
    if is_fragment(&words) {
        found.push("fragment that refers to something not named".to_owned());
    }
    found.extend(PRIVATE.iter().filter(|phrase| has(&lower, phrase)).map(|phrase| format!("`{phrase}`")));
    found
}

/// Returns true if the subject is a clause, as in "What is dropped …". Questions are allowed.
fn opens_with_clause(sentence: &str, lower: &str) -> bool {
    let first = lower.split(|c: char| !c.is_alphabetic()).next().unwrap_or_default();
    // Items of lists start with a lowercase letter; only these two words are flagged there.
    let capital = sentence.starts_with(char::is_uppercase) || ["what", "who"].contains(&first);
    let clause = CLAUSES.split(' ').any(|clause| clause == first) || OPENINGS.iter().any(|open| starts(lower, open));
    capital && clause && !lower.ends_with('?') && !ALLOWED.iter().any(|allowed| lower.starts_with(allowed))
}

/// Returns true for a pronoun with a complement, such as "The same of levels."
fn is_fragment(words: &[&str]) -> bool {
    let [first, second, rest @ ..] = words else { return false };
    let second = second.trim_end_matches(|c: char| !c.is_alphabetic());
    let length: usize = rest.iter().map(|word| word.chars().count() + 1).sum();
    ["the", "that", "those", "its", "their", "one", "any"].contains(first)
        && ["of", "same", "one"].contains(&second)
        && length <= 41
        && words.last().is_some_and(|last| last.ends_with('.'))
}

/// Returns true if `text` starts with these words.
fn starts(text: &str, words: &str) -> bool {
    text.strip_prefix(words).is_some_and(|rest| !rest.starts_with(char::is_alphanumeric))
}

/// Returns true if `phrase` occurs in `text` as whole words.
fn has(text: &str, phrase: &str) -> bool {
    text.match_indices(phrase)
        .any(|(at, _)| !text[..at].ends_with(char::is_alphanumeric) && starts(&text[at..], phrase))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Flagged sentences with their replacements.
    const REWRITTEN: &str = include_str!("before_and_after.txt");

    #[test]
    fn old_sentences_are_flagged_and_rewritten_ones_pass() {
        let lines = REWRITTEN.lines().filter(|line| !line.starts_with('#'));
        for (before, after) in lines.map(|line| line.split_once('\t').expect("a tab in every line")) {
            match before.strip_prefix("? ") {
                None => assert!(!reasons(before).is_empty(), "{before}"),
                Some(missed) => assert_eq!(reasons(missed), Vec::<String>::new(), "{missed}"),
            }
            assert_eq!(reasons(after), Vec::<String>::new(), "{after}");
        }
    }

    #[test]
    fn questions_and_conjunctions_pass() {
        for sentence in
            ["What is a pass?", "That is, none.", "Where possible, levels are shared.", "As in Filament, X."]
        {
            assert_eq!(reasons(sentence), Vec::<String>::new(), "{sentence}");
        }
    }

    #[test]
    fn every_reason_is_named() {
        assert_eq!(reasons("The same of levels."), ["fragment that refers to something not named"]);
        assert_eq!(reasons("So is the other."), ["opens with a clause used as a noun"]);
        assert_eq!(reasons("Shadow maps of lamps."), ["`lamps`"]);
        assert_eq!(reasons(&"word ".repeat(31)), ["31 words"]);
    }
}
