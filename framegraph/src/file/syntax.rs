//! RON syntax options, and readable messages for RON errors.

use crate::suggest::nearest;
use ron::Options;
use ron::extensions::Extensions;

/// Options for every file: no `Some` around optional fields, no second parentheses around newtype variants.
pub(super) fn options() -> Options {
    Options::default()
        .with_default_extension(
            Extensions::UNWRAP_NEWTYPES | Extensions::IMPLICIT_SOME | Extensions::UNWRAP_VARIANT_NEWTYPES,
        )
        .with_recursion_limit(DEPTH)
}

/// Maximum nesting depth. The format itself needs 8; plugin parameters can use the rest.
const DEPTH: usize = 64;

/// Returns message and hint for an error of RON.
pub(super) fn explained(error: &ron::Error) -> (String, String) {
    use ron::Error as E;
    let hint = match error {
        E::NoSuchStructField { expected, found, .. } | E::NoSuchEnumVariant { expected, found, .. } => {
            match nearest(found, expected.iter().copied()) {
                Some(near) => format!("did you mean `{near}`?"),
                None => format!("known are {}", listed(expected, 20)),
            }
        }
        E::MissingStructField { field, .. } => format!("add `{field}: …`"),
        E::DuplicateStructField { .. } => "remove one of them".into(),
        E::Eof
        | E::ExpectedArrayEnd
        | E::ExpectedMapEnd
        | E::ExpectedOptionEnd
        | E::ExpectedStructLikeEnd
        | E::ExpectedStringEnd
        | E::ExpectedComma
        | E::UnclosedBlockComment => "add the missing bracket, quote or comma".into(),
        E::ExceededRecursionLimit => format!("nest at most {DEPTH} brackets"),
        E::IntegerOutOfBounds | E::InvalidValueForType { .. } => {
            "docs/reference/graph-format.md lists the range of each field".into()
        }
        E::TrailingCharacters => "remove the text after the first value".into(),
        _ => "docs/reference/graph-format.md documents the fields".into(),
    };
    let message = match error {
        E::NoSuchStructField { found, outer, .. } => match outer {
            Some(outer) => format!("`{outer}` has no field `{found}`"),
            None => format!("unknown field `{found}`"),
        },
        E::NoSuchEnumVariant { found, outer, .. } => match outer {
            Some(outer) => format!("`{found}` is not a variant of {outer}"),
            None => format!("unknown variant `{found}`"),
        },
        E::MissingStructField { field, outer } => match outer {
            Some(outer) => format!("`{outer}` requires the field `{field}`"),
            None => format!("missing field `{field}`"),
        },
        E::DuplicateStructField { field, .. } => format!("duplicate field `{field}`"),
        E::ExceededRecursionLimit => "brackets are nested too deeply".into(),
        other => lowercase(&other.to_string()),
    };
    (message, hint)
}

fn lowercase(text: &str) -> String {
    let mut chars = text.chars();
    chars.next().map(|c| c.to_lowercase().chain(chars).collect()).unwrap_or_default()
}

/// Lists up to `most` names: `a`, `b` and `c`.
pub(super) fn listed(names: &[impl AsRef<str>], most: usize) -> String {
    let mut names: Vec<_> = names.iter().take(most + 1).map(|n| format!("`{}`", n.as_ref())).collect();
    if names.len() > most {
        names[most] = "others".into();
    }
    match names.split_last() {
        None => "none".into(),
        Some((only, [])) => only.clone(),
        Some((last, rest)) => format!("{} and {last}", rest.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_read_well() {
        assert_eq!(listed(&[""; 0], 8), "none");
        assert_eq!(listed(&["a"], 8), "`a`");
        assert_eq!(listed(&["a", "b", "c"], 8), "`a`, `b` and `c`");
        let many: Vec<_> = (0..20).map(|i| i.to_string()).collect();
        assert!(listed(&many, 8).ends_with("`7` and others"));
    }

    #[test]
    fn refusals_carry_a_hint() {
        #[derive(Debug, serde::Deserialize)]
        #[serde(deny_unknown_fields)]
        struct Form {
            #[expect(dead_code, reason = "never parsed")]
            samples: u8,
        }
        let refused = |text: &str| {
            let error = options().from_str::<Form>(text).expect_err("the text is invalid");
            explained(&error.code)
        };
        assert_eq!(refused("(sample: 1)").1, "did you mean `samples`?");
        assert_eq!(refused("()").1, "add `samples: …`");
        let deep = format!("(samples: {}", "(".repeat(500));
        assert!(!refused(&deep).0.is_empty());
    }
}
