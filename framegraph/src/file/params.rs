//! Template arguments, and plugin parameters that can contain them.

use super::error::FileError;
use super::spanned::{Raw, Source, Spanned, text_or};
use ron::value::RawValue;
use serde::de::{Deserialize, DeserializeOwned, Deserializer};
use std::ops::Range;

/// The meaning of a template parameter.
#[derive(Clone, Debug)]
pub(super) enum Word {
    /// A quoted text.
    Text(Spanned<String>),
    /// Any other RON value as text: `6`, `High`, `(0.5, 2)`.
    Value(String),
}

impl Word {
    /// The word as part of a text.
    pub(super) fn text(&self) -> &str {
        match self {
            Self::Text(text) => &text.value,
            Self::Value(value) => value,
        }
    }

    /// The word as a RON value.
    fn ron(&self) -> String {
        match self {
            Self::Text(text) => format!("{:?}", text.value),
            Self::Value(value) => value.clone(),
        }
    }
}

impl<'de> Deserialize<'de> for Word {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Ok(match text_or::<Box<RawValue>, D>(deserializer)? {
            Ok(text) => Self::Text(text),
            Err(value) => Self::Value(value.get_ron().trim().into()),
        })
    }
}

/// Plugin parameters of an entry. Only the plugin can parse them.
#[derive(Clone, Debug)]
pub(super) struct Params {
    raw: Raw,
    /// The text with template parameters replaced, if it contains any.
    filled: Option<Filled>,
}

#[derive(Clone, Debug, Default)]
struct Filled {
    text: String,
    /// Byte range of each inserted word in `text`, and of the braces it replaces in the file.
    words: Vec<(Range<usize>, Range<usize>)>,
}

impl<'de> Deserialize<'de> for Params {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Ok(Self { raw: Raw::deserialize(deserializer)?, filled: None })
    }
}

impl Params {
    /// Replaces the names in braces that `meaning` knows. A text that consists of a single name becomes the value
    /// itself: `"{levels}"` becomes 6. Other braces belong to the plugin.
    pub(super) fn fill(&mut self, source: Source<'_>, meaning: impl Fn(&str) -> Option<Word>) {
        let text = source.text_of(&self.raw);
        let (mut filled, mut copied) = (Filled::default(), 0);
        for (open, _) in text.match_indices('{') {
            let Some((inside, behind)) = text[open + 1..].split_once('}') else { break };
            let Some(word) = meaning(inside) else { continue };
            let before = &text[copied..open];
            let alone = behind.starts_with('"') && before.ends_with('"') && !before.ends_with("r\"");
            let quote = usize::from(alone);
            filled.text += &before[..before.len() - quote];
            let start = filled.text.len();
            filled.text += &if alone { word.ron() } else { word.text().escape_debug().to_string() };
            copied = open + 1 + inside.len() + 1 + quote;
            filled.words.push((start..filled.text.len(), open - quote..copied));
        }
        filled.text += &text[copied..];
        self.filled = (!filled.words.is_empty()).then_some(filled);
    }

    /// Parses the parameters.
    ///
    /// # Errors
    /// Returns an error with its position in the file. For an error in an inserted word, that is the position of the
    /// braces.
    pub(super) fn parse<T: DeserializeOwned>(&self, source: Source<'_>) -> Result<T, FileError> {
        match &self.filled {
            None => source.parse(&self.raw),
            Some(Filled { text, words }) => source.parse_for(&self.raw, text, |byte| {
                match words.iter().rev().find(|(word, _)| word.start <= byte) {
                    None => byte,
                    Some((word, braces)) if byte <= word.end => braces.start,
                    Some((word, braces)) => braces.end + (byte - word.end),
                }
            }),
        }
    }
}
