//! Values of RON as a tree: fields, items, words. Read from text, changed by who shows them, written back.

use std::fmt;

/// A value.
#[derive(Clone, Debug, PartialEq)]
pub enum Node {
    /// Named fields, of a struct or of a variant, whose name stands before them.
    Fields(Option<String>, Vec<(String, Self)>),
    /// Values in a row, of a tuple or of a variant, whose name stands before them.
    Items(Option<String>, Vec<Self>),
    /// A number, a truth value, a variant that holds nothing, or a string with its quotes: as it is written.
    Word(String),
}

/// A text that is no tree.
#[derive(Clone, PartialEq, Eq, thiserror::Error)]
#[error("the settings cannot be read at letter {at}: {why}")]
pub struct TreeError {
    /// Where, in bytes.
    pub at: usize,
    /// What was expected.
    pub why: &'static str,
}

impl fmt::Debug for TreeError {
    /// The sentence, since that is what an `unwrap` shows.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl Node {
    /// The field of that name.
    pub fn field(&self, name: &str) -> Option<&Self> {
        match self {
            Self::Fields(_, fields) => fields.iter().find(|(own, _)| own == name).map(|(_, value)| value),
            _ => None,
        }
    }

    /// The value at a path of names and numbers, `settings.shadows.splits.0`; the whole for an empty path.
    pub fn at(&self, path: &str) -> Option<&Self> {
        path.split('.').filter(|part| !part.is_empty()).try_fold(self, |node, part| match node {
            Self::Items(_, items) => items.get(part.parse::<usize>().ok()?),
            _ => node.field(part),
        })
    }

    /// The same, to be changed.
    pub fn at_mut(&mut self, path: &str) -> Option<&mut Self> {
        path.split('.').filter(|part| !part.is_empty()).try_fold(self, |node, part| match node {
            Self::Items(_, items) => items.get_mut(part.parse::<usize>().ok()?),
            Self::Fields(_, fields) => fields.iter_mut().find(|(own, _)| own == part).map(|(_, value)| value),
            Self::Word(_) => None,
        })
    }

    /// The name of a variant; of a word, the word.
    pub fn variant(&self) -> Option<&str> {
        match self {
            Self::Fields(name, _) | Self::Items(name, _) => name.as_deref(),
            Self::Word(word) => Some(word),
        }
    }

    /// What it holds, each with the name or number that follows its own path.
    pub fn children(&self) -> Vec<(String, &Self)> {
        match self {
            Self::Fields(_, fields) => fields.iter().map(|(name, value)| (name.clone(), value)).collect(),
            Self::Items(_, items) => items.iter().enumerate().map(|(i, value)| (i.to_string(), value)).collect(),
            Self::Word(_) => Vec::new(),
        }
    }
}

impl fmt::Display for Node {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = |name: &Option<String>| name.clone().unwrap_or_default();
        match self {
            Self::Word(word) => f.write_str(word),
            Self::Fields(variant, fields) => {
                let fields: Vec<String> = fields.iter().map(|(name, value)| format!("{name}: {value}")).collect();
                write!(f, "{}({})", name(variant), fields.join(", "))
            }
            Self::Items(variant, items) => {
                let items: Vec<String> = items.iter().map(Self::to_string).collect();
                write!(f, "{}({})", name(variant), items.join(", "))
            }
        }
    }
}

/// Reads a value.
///
/// # Errors
/// Where the text is none.
pub fn parse(text: &str) -> Result<Node, TreeError> {
    let mut reader = Reader { text, at: 0 };
    let node = reader.value(0)?;
    reader.space();
    if reader.at < text.len() { Err(reader.wrong("nothing more is expected")) } else { Ok(node) }
}

/// Values deeper within one another than this are refused.
const DEEPEST: usize = 64;

struct Reader<'a> {
    text: &'a str,
    at: usize,
}

impl Reader<'_> {
    fn wrong(&self, why: &'static str) -> TreeError {
        TreeError { at: self.at, why }
    }

    fn rest(&self) -> &str {
        &self.text[self.at..]
    }

    fn space(&mut self) {
        self.at += self.rest().len() - self.rest().trim_start().len();
    }

    fn take(&mut self, letter: char) -> bool {
        self.space();
        let found = self.rest().starts_with(letter);
        self.at += if found { letter.len_utf8() } else { 0 };
        found
    }

    fn word(&mut self) -> String {
        self.space();
        let ends = |c: char| c.is_whitespace() || matches!(c, '(' | ')' | ',' | ':' | '"');
        let length = self.rest().find(ends).unwrap_or(self.rest().len());
        // `r#None` is a variant of that name, which is read without the mark too.
        let word = self.rest()[..length].trim_start_matches("r#").to_owned();
        self.at += length;
        word
    }

    fn value(&mut self, depth: usize) -> Result<Node, TreeError> {
        if depth > DEEPEST {
            return Err(self.wrong("the values lie too deep within one another"));
        }
        if self.take('"') {
            let end = self.rest().find('"').ok_or_else(|| self.wrong("the string does not end"))?;
            let word = format!("\"{}\"", &self.rest()[..end]);
            self.at += end + 1;
            return Ok(Node::Word(word));
        }
        let name = self.word();
        if !self.take('(') {
            return if name.is_empty() { Err(self.wrong("a value is expected")) } else { Ok(Node::Word(name)) };
        }
        let name = (!name.is_empty()).then_some(name);
        let (mut fields, mut items) = (Vec::new(), Vec::new());
        while !self.take(')') {
            let before = self.at;
            let field = self.word();
            if !field.is_empty() && self.take(':') {
                fields.push((field, self.value(depth + 1)?));
            } else {
                self.at = before;
                items.push(self.value(depth + 1)?);
            }
            if !self.take(',')
                && !{
                    self.space();
                    self.rest().starts_with(')')
                }
            {
                return Err(self.wrong("a comma or a closing bracket is expected"));
            }
        }
        match (fields.is_empty(), items.is_empty()) {
            (false, false) => Err(self.wrong("fields and plain values do not go together")),
            (false, true) => Ok(Node::Fields(name, fields)),
            (true, _) => Ok(Node::Items(name, items)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read_again() -> Result<(), TreeError> {
        let text =
            "(a: 1.5, b: Some(x: -2, y: inf), c: (1, 2, (q: true)), d: None, e: \"no, (word)\", f: At((0.1, 0.2)))";
        let node = parse(text)?;
        assert_eq!(node.to_string(), text);
        assert_eq!(node.at("b.x"), Some(&Node::Word("-2".into())));
        assert_eq!(node.at("c.2.q").and_then(Node::variant), Some("true"));
        assert_eq!(node.at("f.0.1").and_then(Node::variant), Some("0.2"));
        assert_eq!((node.at("b").and_then(Node::variant), node.at("c.7")), (Some("Some"), None));
        assert_eq!(parse("(\n  a: (\n  ),\n)")?.to_string(), "(a: ())");
        Ok(())
    }

    #[test]
    fn what_is_no_tree_is_refused_where_it_ends_to_be_one() {
        for (text, at) in
            [("", 0), ("(a: 1", 5), ("(a: 1, 2)", 9), ("(a: \"b)", 5), ("(a: 1) b", 7), ("(a: , b: 2)", 4)]
        {
            assert_eq!(parse(text).map_err(|error| error.at), Err(at), "{text}");
        }
        assert!(parse(&"(".repeat(100_000)).is_err());
    }
}
