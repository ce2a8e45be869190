//! JSON values (RFC 8259) and their text, as far as the dumps need them.

use std::fmt::Write;

/// A JSON value. Objects keep the order of their fields.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Json {
    Null,
    Bool(bool),
    Number(u64),
    Text(String),
    List(Vec<Json>),
    Object(Vec<(&'static str, Json)>),
}

/// Creates an object.
pub(crate) fn object<const N: usize>(fields: [(&'static str, Json); N]) -> Json {
    Json::Object(fields.into())
}

/// Creates a field of an object.
pub(crate) fn field(name: &'static str, value: impl Into<Json>) -> (&'static str, Json) {
    (name, value.into())
}

impl Json {
    /// Creates a list.
    pub(crate) fn list<T: Into<Self>>(values: impl IntoIterator<Item = T>) -> Self {
        Self::List(values.into_iter().map(T::into).collect())
    }

    /// Returns the text with one value or field per line, indented by two spaces per level, ending in a line feed.
    pub(crate) fn text(&self) -> String {
        let mut out = String::new();
        self.write(&mut out, 0);
        out.push('\n');
        out
    }

    fn write(&self, out: &mut String, depth: usize) {
        match self {
            Self::Null => out.push_str("null"),
            Self::Bool(value) => *out += if *value { "true" } else { "false" },
            // Writing to a string cannot fail; also below.
            Self::Number(value) => _ = write!(out, "{value}"),
            Self::Text(text) => quote(text, out),
            Self::List(values) => lines(out, depth, ['[', ']'], values, |value, out| value.write(out, depth + 1)),
            Self::Object(fields) => lines(out, depth, ['{', '}'], fields, |(name, value), out| {
                quote(name, out);
                out.push_str(": ");
                value.write(out, depth + 1);
            }),
        }
    }
}

/// Writes rows between brackets, one per line; empty brackets stay on one line.
fn lines<T>(out: &mut String, depth: usize, [open, close]: [char; 2], rows: &[T], row: impl Fn(&T, &mut String)) {
    out.push(open);
    for (index, value) in rows.iter().enumerate() {
        out.push_str(if index == 0 { "\n" } else { ",\n" });
        out.extend(std::iter::repeat_n("  ", depth + 1));
        row(value, out);
    }
    if !rows.is_empty() {
        out.push('\n');
        out.extend(std::iter::repeat_n("  ", depth));
    }
    out.push(close);
}

/// Writes a quoted string, with quotes, backslashes and control characters escaped.
fn quote(text: &str, out: &mut String) {
    out.push('"');
    for c in text.chars() {
        match c {
            '"' => out.push_str("\\\""),
            '\\' => out.push_str("\\\\"),
            '\n' => out.push_str("\\n"),
            '\r' => out.push_str("\\r"),
            '\t' => out.push_str("\\t"),
            '\u{8}' => out.push_str("\\b"),
            '\u{c}' => out.push_str("\\f"),
            c if c.is_control() => _ = write!(out, "\\u{:04x}", u32::from(c)),
            c => out.push(c),
        }
    }
    out.push('"');
}

impl From<bool> for Json {
    fn from(value: bool) -> Self {
        Self::Bool(value)
    }
}

impl From<u32> for Json {
    fn from(value: u32) -> Self {
        Self::Number(value.into())
    }
}

impl From<u64> for Json {
    fn from(value: u64) -> Self {
        Self::Number(value)
    }
}

impl From<usize> for Json {
    fn from(value: usize) -> Self {
        Self::Number(value as u64)
    }
}

impl From<String> for Json {
    fn from(text: String) -> Self {
        Self::Text(text)
    }
}

impl From<&str> for Json {
    fn from(text: &str) -> Self {
        Self::Text(text.into())
    }
}

impl<T: Into<Self>> From<Option<T>> for Json {
    fn from(value: Option<T>) -> Self {
        value.map_or(Self::Null, T::into)
    }
}

impl<T: Into<Self>> From<Vec<T>> for Json {
    fn from(values: Vec<T>) -> Self {
        Self::list(values)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_text_is_that_of_the_standard_library_of_json() {
        let text: String = (0..0x180u32).filter_map(char::from_u32).collect();
        let empty = || Json::List(Vec::new());
        let value = object([
            field("a", vec![0u64, u64::MAX]),
            field("b", None::<u64>),
            field("c", object([field("d", text.as_str()), field("e", empty()), field("f", object([]))])),
            field("g", Json::list([empty(), Json::Bool(true)])),
        ]);
        let expected = serde_json::json!({
            "a": [0, u64::MAX], "b": null, "c": { "d": text, "e": [], "f": {} }, "g": [[], true],
        });
        // serde_json does not escape DEL and C1 control characters; the dumps do, because a terminal may show them.
        let library = serde_json::to_string_pretty(&expected).unwrap() + "\n";
        let escaped = |c: char| match c {
            '\u{7f}'..='\u{9f}' => format!("\\u{:04x}", u32::from(c)),
            c => c.to_string(),
        };
        assert_eq!(value.text(), library.chars().map(escaped).collect::<String>());
    }
}
