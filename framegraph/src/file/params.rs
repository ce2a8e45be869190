//! Words that uses give to templates, and parameters of plugins, in which they can stand.

use super::error::FileError;
use super::spanned::{Raw, Source, Spanned, text_or};
use ron::value::RawValue;
use serde::de::{Deserialize, DeserializeOwned, Deserializer};
use std::ops::Range;

/// What a name in braces stands for.
#[derive(Clone, Debug)]
pub(super) enum Word {
    /// A text, which stands in quotes in the file.
    Text(Spanned<String>),
    /// Any other value of RON, as it stands there: `6`, `High`, `(0.5, 2)`.
    Value(String),
}

impl Word {
    /// As part of a text.
    pub(super) fn text(&self) -> &str {
        match self {
            Self::Text(text) => &text.value,
            Self::Value(value) => value,
        }
    }

    /// As a value of RON.
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

/// The parameters of one entry, which only its plugin can parse.
#[derive(Clone, Debug)]
pub(super) struct Params {
    raw: Raw,
    /// The text with words in the places of names in braces, once there are any.
    filled: Option<Filled>,
}

#[derive(Clone, Debug, Default)]
struct Filled {
    text: String,
    /// Where each word stands in `text`, and where in the file's the braces stand that it is for, in bytes.
    words: Vec<(Range<usize>, Range<usize>)>,
}

impl<'de> Deserialize<'de> for Params {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Ok(Self { raw: Raw::deserialize(deserializer)?, filled: None })
    }
}

impl Params {
    /// Puts words in the places of the names in braces that `meaning` knows: in a text part of it, and for a text that is a
    /// name in braces and nothing else the value itself, `"{levels}"` for 6. All other braces are the plugin's own.
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

    /// Parses them.
    ///
    /// # Errors
    /// With the place in the file; what is wrong in a word stands at its braces.
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
