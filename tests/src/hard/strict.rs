//! Strict evaluation of a function: NaN passes through limits, and the logarithm or power of zero and negative numbers
//! is NaN. WGSL allows drivers to do so.
//!
//! Mesa's software driver turns NaN into a number in `max` and `clamp`, and gives finite logarithms of zero; other
//! drivers do not. Strict evaluation detects guards whose removal this would hide.

use super::guard::{arguments, body, closing, is_constant};

/// Calls that are evaluated strictly.
const CALLS: [&str; 7] = ["max", "min", "clamp", "saturate", "log2", "log", "pow"];

/// Returns the shader's text with strict evaluation in one function's body.
pub fn strict(wgsl: &str, function: &str) -> String {
    let Some(body) = body(wgsl, function) else { return wgsl.to_owned() };
    format!("{}{}{}", &wgsl[..body.start], read(&wgsl[body.clone()]), &wgsl[body.end..])
}

/// Rewrites every call in a text, innermost first.
fn read(text: &str) -> String {
    let mut out = String::new();
    let mut from = 0;
    while let Some((at, name)) = next_call(text, from) {
        let open = at + name.len();
        let Some(length) = closing(&text[open..]) else { break };
        out.push_str(&text[from..at]);
        let inner = &text[open + 1..open + length];
        let given: Vec<String> = arguments(inner).into_iter().map(read).collect();
        out.push_str(&call(name, &given));
        from = open + length + 1;
    }
    out.push_str(&text[from..]);
    out
}

/// Returns the first of the calls at or after a position.
fn next_call(text: &str, from: usize) -> Option<(usize, &'static str)> {
    let joined = |at: usize| text[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_' || c == '.');
    let first = |name: &'static str| {
        let call = format!("{name}(");
        let found = text[from..].match_indices(&call).map(|(at, _)| from + at).find(|at| !joined(*at));
        found.map(|at| (at, name))
    };
    CALLS.into_iter().filter_map(first).min()
}

fn call(name: &str, given: &[String]) -> String {
    let plain = format!("{name}({})", given.join(", "));
    // Constants need no check.
    if given.iter().all(|argument| is_constant(argument)) {
        return plain;
    }
    let numbers = |of: &[String]| of.iter().map(|x| format!("(({x}) == ({x}))")).collect::<Vec<_>>().join(" & ");
    match (name, given) {
        ("log2" | "log" | "pow", [x, ..]) => {
            format!("select((({x}) - ({x})) / (({x}) - ({x})), {plain}, -({x}) < ({x}))")
        }
        ("saturate", [x]) => format!("select(({x}), {plain}, ({x}) == ({x}))"),
        (_, [x, y, ..]) => format!("select(({x}) + ({y}), {plain}, {})", numbers(given)),
        _ => plain,
    }
}

#[cfg(test)]
mod tests {
    use super::strict;

    #[test]
    fn calls_of_one_function_are_read_strictly() {
        let text =
            "fn g(x: f32) -> f32 { return log2(x); }\nfn f(x: f32) -> f32 { return saturate(log2(max(x, 1.0))); }";
        let read = strict(text, "f");
        assert!(read.starts_with("fn g(x: f32) -> f32 { return log2(x); }\n"), "{read}");
        assert!(read.contains("select((x) + (1.0), max(x, 1.0), ((x) == (x)) & ((1.0) == (1.0)))"), "{read}");
        assert!(read.contains(" / ") && read.contains("select((select("), "{read}");
        assert_eq!(strict("fn f() { let a = log2(2.0); }", "f"), "fn f() { let a = log2(2.0); }");
        assert_eq!(strict(text, "h"), text);
    }
}
