//! Values with their position in the text, for errors found after parsing.
//!
//! RON returns the text of a value as a slice of the whole text ([`RawValue`]). The difference of the addresses is the
//! position.

use super::error::{FileError, FileReason};
use super::syntax;
use super::value::ValueReason;
use ron::value::RawValue;
use serde::de::{Deserialize, DeserializeOwned, Deserializer, Error};

/// A value and the address of its first byte.
#[derive(Clone, Debug)]
pub(super) struct Spanned<T> {
    /// The parsed value.
    pub(super) value: T,
    /// Address of the first byte, inside of the parsed text.
    address: usize,
}

/// Delimits the address of an invalid value in an error message that passes through serde.
const MARK: char = '\u{1}';

impl<'de, T: DeserializeOwned> Deserialize<'de> for Spanned<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        spanned(<&RawValue>::deserialize(deserializer)?)
    }
}

fn spanned<T: DeserializeOwned, E: Error>(raw: &RawValue) -> Result<Spanned<T>, E> {
    let raw = raw.get_ron();
    let text = &raw[trivia(raw)..];
    let address = text.as_ptr().addr();
    match syntax::options().from_str(text) {
        Ok(value) => Ok(Spanned { value, address }),
        // A nested value has already added its position.
        Err(ron::error::SpannedError { code: ron::Error::Message(inner), .. }) if inner.starts_with(MARK) => {
            Err(E::custom(inner))
        }
        Err(error) => {
            let inside = offset_of(text, error.span.start);
            let (message, hint) = syntax::explained(&error.code);
            Err(E::custom(marked(address + inside, &message, &hint)))
        }
    }
}

/// A value kept as text, to be parsed later.
#[derive(Clone, Copy, Debug)]
pub(super) struct Raw {
    address: usize,
    bytes: usize,
}

/// Reads a quoted text with its position, or else a `T`.
pub(super) fn text_or<'de, T: DeserializeOwned, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<Result<Spanned<String>, T>, D::Error> {
    let raw = <&RawValue>::deserialize(deserializer)?;
    let quoted = raw.get_ron()[trivia(raw.get_ron())..].starts_with(['"', 'r']);
    Ok(if quoted { Ok(spanned(raw)?) } else { Err(spanned::<T, D::Error>(raw)?.value) })
}

impl<'de> Deserialize<'de> for Raw {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let raw = <&RawValue>::deserialize(deserializer)?.get_ron();
        let text = &raw[trivia(raw)..];
        Ok(Self { address: text.as_ptr().addr(), bytes: text.len() })
    }
}

/// Returns a message that carries a position through serde.
fn marked(address: usize, message: &str, hint: &str) -> String {
    format!("{MARK}{address}{MARK}{message}{MARK}{hint}")
}

impl<T> Spanned<T> {
    /// Creates an error about this value, during deserialization.
    pub(super) fn refuse<E: Error>(&self, message: &str, hint: &str) -> E {
        E::custom(marked(self.address, message, hint))
    }
}

/// The text and path of a file.
#[derive(Clone, Copy, Debug)]
pub(super) struct Source<'t> {
    pub(super) path: &'t str,
    pub(super) text: &'t str,
    /// Included files, as path and text.
    pub(super) included: &'t [(String, String)],
}

impl<'t> Source<'t> {
    /// Returns a source for errors that are only counted: it skips the search for positions.
    pub(super) fn unless(self, counted_only: bool) -> Self {
        if counted_only { Self { text: "", included: &[], ..self } } else { self }
    }

    /// Returns `true` if errors are only counted.
    pub(super) fn is_brief(self) -> bool {
        self.text.is_empty()
    }

    /// Returns line and column of a value, both from 1; columns count characters.
    pub(super) fn place<T>(&self, at: &Spanned<T>) -> (usize, usize) {
        self.place_at(at.address)
    }

    /// Returns path and text of the file that contains an address.
    fn holding(&self, address: usize) -> (&'t str, &'t str) {
        let holds = |text: &str| (text.as_ptr().addr()..text.as_ptr().addr() + text.len()).contains(&address);
        let found = self.included.iter().find(|(_, text)| holds(text));
        found.map_or((self.path, self.text), |(path, text)| (path, text))
    }

    fn place_at(&self, address: usize) -> (usize, usize) {
        let (_, text) = self.holding(address);
        let offset = address.saturating_sub(text.as_ptr().addr()).min(text.len());
        let before = (0..=offset).rev().find_map(|end| text.get(..end)).unwrap_or_default();
        let line = 1 + before.matches('\n').count();
        let column = 1 + before.chars().rev().take_while(|c| *c != '\n').count();
        (line, column)
    }

    /// Creates an error at a value.
    pub(super) fn error<T>(&self, at: &Spanned<T>, reason: FileReason) -> FileError {
        let (path, _) = self.holding(at.address);
        FileError { path: path.into(), ..self.error_at(self.place(at), reason) }
    }

    /// Creates an error at a line and column.
    pub(super) fn error_at(&self, (line, column): (usize, usize), reason: FileReason) -> FileError {
        FileError { path: self.path.into(), line, column, pass: None, resource: None, reason: Box::new(reason) }
    }

    /// Creates an error about an invalid value.
    pub(super) fn value<T>(&self, at: &Spanned<T>, fault: ValueReason) -> FileError {
        self.error(at, FileReason::Value(fault))
    }

    /// Converts an error of RON, at the marked value or else at the parser's position.
    pub(super) fn refused(&self, error: &ron::error::SpannedError) -> FileError {
        if let ron::Error::Message(message) = &error.code
            && let [_, address, message, hint] = message.splitn(4, MARK).collect::<Vec<_>>().as_slice()
            && let Ok(address) = address.parse()
        {
            let (message, hint) = ((*message).to_owned(), (*hint).to_owned());
            return self.error_at(self.place_at(address), FileReason::Syntax { message, hint });
        }
        let (message, hint) = syntax::explained(&error.code);
        let place = (error.span.start.line, error.span.start.col);
        self.error_at(place, FileReason::Syntax { message, hint })
    }

    /// Returns the text of an unparsed value.
    pub(super) fn text_of(&self, raw: &Raw) -> &'t str {
        let (_, text) = self.holding(raw.address);
        let offset = raw.address.saturating_sub(text.as_ptr().addr());
        text.get(offset..offset + raw.bytes).unwrap_or_default()
    }

    /// Parses a value kept as text.
    pub(super) fn parse<T: Deserialize<'t>>(&self, raw: &Raw) -> Result<T, FileError> {
        self.parse_for(raw, self.text_of(raw), |byte| byte)
    }

    /// Parses `text` in place of the value `raw`. For errors, `in_value` maps byte offsets in `text` to offsets in `raw`.
    pub(super) fn parse_for<'a, T: Deserialize<'a>>(
        &self,
        raw: &Raw,
        text: &'a str,
        in_value: impl Fn(usize) -> usize,
    ) -> Result<T, FileError> {
        syntax::options().from_str(text).map_err(|error| {
            let (message, hint) = syntax::explained(&error.code);
            let place = self.place_at(raw.address + in_value(offset_of(text, error.span.start)));
            let (path, _) = self.holding(raw.address);
            FileError { path: path.into(), ..self.error_at(place, FileReason::Syntax { message, hint }) }
        })
    }
}

/// Returns the number of bytes before a line and column of `text`.
fn offset_of(text: &str, at: ron::error::Position) -> usize {
    let start: usize = text.split_inclusive('\n').take(at.line.saturating_sub(1)).map(str::len).sum();
    let rest = &text[start..];
    let column = at.col.saturating_sub(1);
    start + rest.char_indices().nth(column).map_or(rest.len(), |(byte, _)| byte)
}

/// Returns the number of bytes of white space and comments at the start.
fn trivia(text: &str) -> usize {
    let mut rest = text;
    loop {
        let trimmed = rest.trim_start();
        rest = if trimmed.starts_with("//") {
            trimmed.find('\n').map_or("", |end| &trimmed[end..])
        } else if trimmed.starts_with("/*") {
            after_block(trimmed)
        } else {
            return text.len() - trimmed.len();
        };
    }
}

/// Returns the text after a block comment; comments nest.
fn after_block(text: &str) -> &str {
    let mut depth = 0;
    let mut at = 0;
    while at < text.len() {
        let rest = &text.as_bytes()[at..];
        if rest.starts_with(b"/*") {
            (depth, at) = (depth + 1, at + 2);
        } else if rest.starts_with(b"*/") {
            (depth, at) = (depth - 1, at + 2);
            if depth == 0 {
                return &text[at..];
            }
        } else {
            at += 1;
        }
    }
    ""
}

#[cfg(test)]
mod tests {
    use super::*;

    fn place(text: &str) -> (usize, usize) {
        #[derive(serde::Deserialize)]
        struct Form {
            a: Spanned<String>,
        }
        let form: Form = syntax::options().from_str(text).expect("the text is valid");
        Source { path: "", text, included: &[] }.place(&form.a)
    }

    #[test]
    fn a_value_knows_its_line_and_column() {
        assert_eq!(place(r#"(a: "x")"#), (1, 5));
        assert_eq!(place("(\n  a: /* one /* two */ */ // three\n    \"x\",\n)"), (3, 5));
        assert_eq!(place("(/* ü */ a: \"x\")"), (1, 13));
    }

    #[test]
    fn a_refused_value_is_pointed_at() {
        #[derive(serde::Deserialize)]
        struct Form {
            #[expect(dead_code, reason = "never parsed")]
            a: Spanned<u8>,
        }
        let text = "(\n  a:   300)";
        let source = Source { path: "p", text, included: &[] };
        let error = syntax::options().from_str::<Form>(text).map(drop).expect_err("300 is no u8");
        let error = source.refused(&error);
        assert_eq!((error.line, error.column), (2, 8));
        assert!(error.to_string().starts_with("p:2:8: "), "{error}");
    }
}
