//! What can be wrong, said once: enumerations of faults, and how the errors that hold them are shown.
//!
//! Macros, since no function can make the variants of an enumeration or implement a trait.

use crate::plain::line;
use std::fmt;
use std::panic::Location;

/// Makes an enumeration of rows `Variant { field: Type, … } "sentence", "hint", more = …;`. Sentence and hint name in braces
/// what the row holds, or what it works out from that behind them; the sentence is the variant's documentation too. A row
/// whose words are those of what it holds has `=> words` in their place.
macro_rules! faults {
    ($(#[$meta:meta])* $name:ident { $(
        $(#[$doc:meta])*
        $variant:ident $({ $($(#[$of_field:meta])* $field:ident: $type:ty),+ })? $(($inner:ident: $of:ty))?
        $($sentence:literal, $hint:literal $(, $more:pat = $value:expr)*)? $(=> $words:expr)?;
    )+ }) => {
        $(#[$meta])*
        #[derive(Clone, PartialEq, Eq)]
        #[non_exhaustive]
        #[allow(missing_docs, reason = "the sentence says what the fields are")]
        pub enum $name {
            $($(#[$doc])* $(#[doc = $sentence])? $variant $({ $($(#[$of_field])* $field: $type),+ })? $(($of))?,)+
        }

        impl $name {
            /// What is wrong, without names of pass and resource, and what to do about it: empty when the sentence says that.
            #[allow(unused_variables, clippy::useless_format, reason = "not every sentence names every field")]
            pub(crate) fn words(&self) -> (String, String) {
                match self {
                    $(Self::$variant $({ $($field),+ })? $(($inner))? => {
                        $($(let $more = $value;)* (format!($sentence), format!($hint)))? $($words)?
                    })+
                }
            }

            /// What is wrong, without names of pass and resource.
            pub fn sentence(&self) -> String {
                self.words().0
            }

            /// What to do about it; empty when the sentence says so already.
            pub fn hint(&self) -> String {
                self.words().1
            }
        }

        impl std::fmt::Display for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                $crate::faults::show(f, "", (None, None), self.words(), None)
            }
        }

        $crate::faults::errors!($name);
    };
}

/// Makes types with a `Display` errors, whose `Debug` is the sentence too, since that is what an `unwrap` shows.
macro_rules! errors {
    ($($error:ident),+) => { $(
        impl std::fmt::Debug for $error {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                std::fmt::Display::fmt(self, f)
            }
        }

        impl std::error::Error for $error {}
    )+ };
}

pub(crate) use {errors, faults};

/// Writes an error as one line: where in a file, whom it is about, what is wrong, where in code, and what to do.
pub(crate) fn show(
    f: &mut fmt::Formatter<'_>,
    start: &str,
    (pass, resource): (Option<&str>, Option<&str>),
    (sentence, hint): (String, String),
    location: Option<&Location<'_>>,
) -> fmt::Result {
    let pass = pass.map(|pass| format!("pass `{pass}`: ")).unwrap_or_default();
    let resource = resource.map(|resource| format!("resource `{resource}`: ")).unwrap_or_default();
    let place = location.map(|l| format!(" (at {}:{})", l.file(), l.line())).unwrap_or_default();
    let hint = if hint.is_empty() { hint } else { format!("; {hint}") };
    f.write_str(&line(&format!("{start}{pass}{resource}{sentence}{place}{hint}")))
}
