//! Macros that define error enumerations together with their messages and hints.
//!
//! Macros are needed because a function cannot define the variants of an enumeration.

use crate::sanitize::line;
use std::fmt;
use std::panic::Location;

/// Defines an error enumeration from rows of the form `Variant { field: Type, … } "message", "hint", more = …;`.
///
/// Messages and hints can use the fields and the values bound behind them in braces. The message is also the
/// documentation of the variant. A row that wraps another error uses `=> expression` instead of the two strings.
macro_rules! error_enum {
    ($(#[$meta:meta])* $name:ident { $(
        $(#[$doc:meta])*
        $variant:ident $({ $($(#[$of_field:meta])* $field:ident: $type:ty),+ })? $(($inner:ident: $of:ty))?
        $($sentence:literal, $hint:literal $(, $more:pat = $value:expr)*)? $(=> $words:expr)?;
    )+ }) => {
        $(#[$meta])*
        #[derive(Clone, PartialEq, Eq)]
        #[non_exhaustive]
        #[allow(missing_docs, reason = "the message describes the fields")]
        pub enum $name {
            $($(#[$doc])* $(#[doc = $sentence])? $variant $({ $($(#[$of_field])* $field: $type),+ })? $(($of))?,)+
        }

        impl $name {
            /// Returns message and hint, without the names of pass and resource. The hint may be empty.
            #[allow(unused_variables, clippy::useless_format, reason = "not every message uses every field")]
            pub(crate) fn words(&self) -> (String, String) {
                match self {
                    $(Self::$variant $({ $($field),+ })? $(($inner))? => {
                        $($(let $more = $value;)* (format!($sentence), format!($hint)))? $($words)?
                    })+
                }
            }

            /// Returns the message, without the names of pass and resource.
            pub fn sentence(&self) -> String {
                self.words().0
            }

            /// Returns the hint: how to fix the error. Empty if the message says so already.
            pub fn hint(&self) -> String {
                self.words().1
            }
        }

        impl std::fmt::Display for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                $crate::error_macros::show(f, "", (None, None), self.words(), None)
            }
        }

        $crate::error_macros::impl_error!($name);
    };
}

/// Implements `Error` for types with `Display`, and `Debug` by the same text, because `unwrap` prints that.
macro_rules! impl_error {
    ($($error:ident),+) => { $(
        impl std::fmt::Debug for $error {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                std::fmt::Display::fmt(self, f)
            }
        }

        impl std::error::Error for $error {}
    )+ };
}

pub(crate) use {error_enum, impl_error};

/// Formats an error as one line: position in a file, pass, resource, message, position in code, hint.
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
