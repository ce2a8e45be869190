//! Guards of the library, found in shader text: code that limits a value before arithmetic breaks.
//!
//! A guard is a `max`, `min`, `clamp` or `saturate` with a constant limit, a `select`, or an `if` that returns early.
//! Removing it keeps the value that it limits: `max(x, 1e-4)` becomes `(x)`, `select(a, b, c)` becomes `(a)`, and the
//! condition of an `if` becomes false.

use std::ops::Range;

/// A guard in the text of a shader.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Guard {
    /// Source text of the guard.
    pub text: String,
    /// Replacement text without the guard.
    pub without: String,
    /// Byte range in the shader's text.
    pub at: Range<usize>,
}

impl Guard {
    /// Returns the shader's text without the guard.
    pub fn removed_from(&self, wgsl: &str) -> String {
        format!("{}{}{}", &wgsl[..self.at.start], self.without, &wgsl[self.at.end..])
    }
}

/// Returns the byte range of a function's body.
pub(super) fn body(wgsl: &str, function: &str) -> Option<Range<usize>> {
    let head = wgsl.find(&format!("fn {function}("))?;
    let open = head + wgsl[head..].find('{')?;
    Some(open..open + closing(&wgsl[open..])?)
}

/// Returns the position of the bracket that closes the first one.
pub(super) fn closing(text: &str) -> Option<usize> {
    let mut depth = 0;
    for (at, c) in text.char_indices() {
        match c {
            '(' | '{' | '[' => depth += 1,
            ')' | '}' | ']' => {
                depth -= 1;
                if depth == 0 {
                    return Some(at);
                }
            }
            _ => {}
        }
    }
    None
}

/// Splits the arguments of a call, given without its brackets.
pub(super) fn arguments(list: &str) -> Vec<&str> {
    let (mut depth, mut from, mut found) = (0_i32, 0, Vec::new());
    for (at, c) in list.char_indices() {
        match c {
            '(' | '[' => depth += 1,
            ')' | ']' => depth -= 1,
            // A template list has a single type here, and a comparison no comma.
            ',' if depth == 0 => {
                found.push(list[from..at].trim());
                from = at + 1;
            }
            _ => {}
        }
    }
    let last = list[from..].trim();
    if !last.is_empty() {
        found.push(last);
    }
    found
}

/// Returns true if an expression consists of numbers and constants.
pub(super) fn is_constant(expression: &str) -> bool {
    let words = expression.split(|c: char| !(c.is_alphanumeric() || c == '_' || c == '.'));
    let known = |word: &str| {
        word.is_empty()
            || word.starts_with(|c: char| c.is_ascii_digit() || c == '.')
            || word.chars().all(|c| c.is_ascii_uppercase() || c.is_ascii_digit() || c == '_')
            || ["vec2", "vec3", "vec4", "f32", "f16", "real", "real2", "real3", "u32", "scale2"].contains(&word)
    };
    words.into_iter().all(known)
}

/// Returns the argument of a call without its limit; `None` if the call is not a guard.
fn unheld(name: &str, arguments: &[&str]) -> Option<String> {
    let held = match (name, arguments) {
        ("saturate", [x]) => Some(*x),
        ("clamp", [x, ..]) => Some(*x),
        ("select", [x, ..]) => Some(*x),
        ("max" | "min", [x, limit]) if is_constant(limit) && !is_constant(x) => Some(*x),
        ("max" | "min", [limit, x]) if is_constant(limit) && !is_constant(x) => Some(*x),
        _ => None,
    };
    held.map(|x| format!("({x})"))
}

/// Returns the guards of a function in order.
pub fn guards(wgsl: &str, function: &str) -> Vec<Guard> {
    let Some(body) = body(wgsl, function) else { return Vec::new() };
    let mut found = Vec::new();
    for name in ["max", "min", "clamp", "saturate", "select", "if"] {
        let mut from = body.start;
        while let Some(offset) = wgsl[from..body.end].find(name) {
            let start = from + offset;
            from = start + name.len();
            let joined = wgsl[..start].ends_with(|c: char| c.is_alphanumeric() || c == '_' || c == '.');
            let rest = &wgsl[from..body.end];
            if joined {
                continue;
            }
            if name == "if" {
                let Some(brace) = rest.strip_prefix(' ').and_then(|rest| rest.find('{')) else { continue };
                let at = from + 1..from + 1 + brace;
                let inside = &wgsl[at.end..body.end];
                let returns = closing(inside).is_some_and(|end| inside[..end].contains("return"));
                if returns {
                    found.push(Guard {
                        text: format!("if {}", wgsl[at.clone()].trim()),
                        without: "false ".to_owned(),
                        at,
                    });
                }
            } else if rest.starts_with('(')
                && let Some(end) = closing(rest)
                && let Some(without) = unheld(name, &arguments(&rest[1..end]))
            {
                let at = start..from + end + 1;
                found.push(Guard { text: words(&wgsl[at.clone()]), without, at });
            }
        }
    }
    found.sort_by_key(|guard| guard.at.start);
    found
}

/// Joins the text into one line.
fn words(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "fn other(x: f32) -> f32 { return max(x, 1.0); }\n\
        fn f(x: f32) -> f32 {\n    if x < 0.0 {\n        return 0.0;\n    }\n    \
        let y = sqrt(max(1.0 - x * x, FLOOR)) + maximum(x, 1.0);\n    \
        return select(clamp(y, 0.0, 1.0), max(x, y), x > 1.0);\n}\n";

    #[test]
    fn limits_are_guards_and_the_larger_of_two_is_not() {
        let found = guards(TEXT, "f");
        let texts: Vec<&str> = found.iter().map(|guard| guard.text.as_str()).collect();
        let whole = "select(clamp(y, 0.0, 1.0), max(x, y), x > 1.0)";
        assert_eq!(texts, ["if x < 0.0", "max(1.0 - x * x, FLOOR)", whole, "clamp(y, 0.0, 1.0)"]);
        assert!(found[0].removed_from(TEXT).contains("if false {"));
        assert!(found[1].removed_from(TEXT).contains("sqrt((1.0 - x * x)) + maximum"));
        assert!(found[2].removed_from(TEXT).contains("return (clamp(y, 0.0, 1.0));"));
        assert!(guards(TEXT, "g").is_empty());
    }
}
