//! A function's text as a driver may read it that takes every liberty WGSL leaves: what is no number goes through every
//! limit, and a logarithm or a power of nothing and of less is no number.
//!
//! Mesa's software driver makes a number of what is none in `max` and `clamp`, and has finite logarithms of zero; others do
//! not. A guard whose absence that hides is missed here.

use super::guard::{arguments, body, closing, is_constant};

/// Calls that are read strictly.
const CALLS: [&str; 7] = ["max", "min", "clamp", "saturate", "log2", "log", "pow"];

/// The shader's text with one function's body read strictly.
pub fn strict(wgsl: &str, function: &str) -> String {
    let Some(body) = body(wgsl, function) else { return wgsl.to_owned() };
    format!("{}{}{}", &wgsl[..body.start], read(&wgsl[body.clone()]), &wgsl[body.end..])
}

/// Every call in a text, from the inner ones out.
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

/// The first of the calls from a place on.
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
    // Numbers are what they are.
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
