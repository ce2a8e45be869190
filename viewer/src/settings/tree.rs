//! RON values as a tree of fields, items and words, which can be parsed, edited and written.

use std::fmt;

/// RON value.
#[derive(Clone, Debug, PartialEq)]
pub enum Node {
    /// Named fields of a struct or variant, with the variant's name.
    Fields(Option<String>, Vec<(String, Self)>),
    /// Items of a tuple or variant, with the variant's name.
    Items(Option<String>, Vec<Self>),
    /// Number, boolean, unit variant, or string with its quotes, as written.
    Word(String),
}

/// Syntax error in RON.
#[derive(Clone, PartialEq, Eq, thiserror::Error)]
#[error("settings: syntax error at byte {at}: {why}")]
pub struct TreeError {
    /// Byte offset.
    pub at: usize,
    /// Reason.
    pub why: &'static str,
}

impl fmt::Debug for TreeError {
    /// Prints the sentence, which `unwrap` shows.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl Node {
    /// Returns the field with a name.
    pub fn field(&self, name: &str) -> Option<&Self> {
        match self {
            Self::Fields(_, fields) => fields.iter().find(|(own, _)| own == name).map(|(_, value)| value),
            _ => None,
        }
    }

    /// Returns the value at a path of names and indices such as `settings.shadows.splits.0`; the whole tree for an empty
    /// path.
    pub fn at(&self, path: &str) -> Option<&Self> {
        path.split('.').filter(|part| !part.is_empty()).try_fold(self, |node, part| match node {
            Self::Items(_, items) => items.get(part.parse::<usize>().ok()?),
            _ => node.field(part),
        })
    }

    /// Returns the value at a path for editing; see [`Self::at`].
    pub fn at_mut(&mut self, path: &str) -> Option<&mut Self> {
        path.split('.').filter(|part| !part.is_empty()).try_fold(self, |node, part| match node {
            Self::Items(_, items) => items.get_mut(part.parse::<usize>().ok()?),
            Self::Fields(_, fields) => fields.iter_mut().find(|(own, _)| own == part).map(|(_, value)| value),
            Self::Word(_) => None,
        })
    }

    /// Returns the name of a variant, or the word itself.
    pub fn variant(&self) -> Option<&str> {
        match self {
            Self::Fields(name, _) | Self::Items(name, _) => name.as_deref(),
            Self::Word(word) => Some(word),
        }
    }

    /// Returns the children with the last part of their paths.
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

/// Parses a value.
///
/// # Errors
/// The position of the first syntax error.
pub fn parse(text: &str) -> Result<Node, TreeError> {
    let mut reader = Reader { text, at: 0 };
    let node = reader.value(0)?;
    reader.space();
    if reader.at < text.len() { Err(reader.wrong("expected the end")) } else { Ok(node) }
}

/// Maximum nesting depth.
const MAX_DEPTH: usize = 64;

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
        // `r#None` is a variant of that name, parsed without the raw prefix.
        let word = self.rest()[..length].trim_start_matches("r#").to_owned();
        self.at += length;
        word
    }

    fn value(&mut self, depth: usize) -> Result<Node, TreeError> {
        if depth > MAX_DEPTH {
            return Err(self.wrong("values are nested too deeply"));
        }
        if self.take('"') {
            let end = self.rest().find('"').ok_or_else(|| self.wrong("unterminated string"))?;
            let word = format!("\"{}\"", &self.rest()[..end]);
            self.at += end + 1;
            return Ok(Node::Word(word));
        }
        let name = self.word();
        if !self.take('(') {
            return if name.is_empty() { Err(self.wrong("expected a value")) } else { Ok(Node::Word(name)) };
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
                return Err(self.wrong("expected a comma or a closing parenthesis"));
            }
        }
        match (fields.is_empty(), items.is_empty()) {
            (false, false) => Err(self.wrong("fields and plain values cannot be mixed")),
            (false, true) => Ok(Node::Fields(name, fields)),
            (true, _) => Ok(Node::Items(name, items)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn written_values_are_parsed_again() -> Result<(), TreeError> {
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
    fn syntax_errors_have_positions() {
        for (text, at) in
            [("", 0), ("(a: 1", 5), ("(a: 1, 2)", 9), ("(a: \"b)", 5), ("(a: 1) b", 7), ("(a: , b: 2)", 4)]
        {
            assert_eq!(parse(text).map_err(|error| error.at), Err(at), "{text}");
        }
        assert!(parse(&"(".repeat(100_000)).is_err());
    }
}
