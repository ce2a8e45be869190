//! Generation of mutants from lines of WGSL.
//!
//! Sources are formatted, so a binary operator has a space on either side and a generic bracket has none. Mutants that
//! do not compile are discarded later.

/// Kind of a mutant.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// `+` and `-`, `*` and `/`, `min` and `max` are exchanged.
    Operator,
    /// A comparison or logical operator is inverted.
    Comparison,
    /// A number is increased by a tenth, an integer by 1.
    Constant,
    /// A vector component is replaced, or components are reordered.
    Channel,
    /// A statement is removed.
    Statement,
}

impl Kind {
    /// All kinds.
    pub const ALL: [Self; 5] = [Self::Operator, Self::Comparison, Self::Constant, Self::Channel, Self::Statement];

    /// Returns the name of the kind.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Operator => "operator",
            Self::Comparison => "comparison",
            Self::Constant => "constant",
            Self::Channel => "channel",
            Self::Statement => "dropped statement",
        }
    }
}

/// One fault in one file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mutant {
    /// Path of the file, from the workspace's root.
    pub file: String,
    /// Line number, from 1.
    pub line: usize,
    pub kind: Kind,
    /// The line before and after the change, trimmed.
    pub before: String,
    pub after: String,
}

impl Mutant {
    /// Returns the file's text with the mutant in it.
    pub fn planted(&self, text: &str) -> String {
        let line = |(i, line): (usize, &str)| {
            if i + 1 == self.line { line.replace(&self.before, &self.after) } else { line.to_owned() }
        };
        text.lines().enumerate().map(line).fold(String::new(), |text, line| text + &line + "\n")
    }

    /// Rank by which samples are drawn. It depends only on the mutant, so that inserted lines do not change it.
    pub fn rank(&self) -> u64 {
        let words = [&self.file, &self.before, &self.after];
        // FNV-1a of 64 bits, with a final multiplication to spread the bits.
        let bytes = words.into_iter().flat_map(|word| word.bytes().chain([0]));
        let hash =
            bytes.fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3));
        (hash ^ (hash >> 32)).wrapping_mul(0x9e37_79b9_7f4a_7c15)
    }
}

const OPERATORS: [(&str, &str); 12] = [
    (" + ", " - "),
    (" - ", " + "),
    (" * ", " / "),
    (" / ", " * "),
    (" += ", " -= "),
    (" -= ", " += "),
    (" *= ", " /= "),
    ("min(", "max("),
    ("max(", "min("),
    ("(-", "("),
    ("= -", "= "),
    ("return -", "return "),
];

const COMPARISONS: [(&str, &str); 8] = [
    (" < ", " > "),
    (" > ", " < "),
    (" <= ", " > "),
    (" >= ", " < "),
    (" == ", " != "),
    (" != ", " == "),
    (" && ", " || "),
    (" || ", " && "),
];

/// Returns every possible mutant of a text.
pub fn mutants(file: &str, text: &str) -> Vec<Mutant> {
    let mut found = Vec::new();
    for (index, line) in text.lines().enumerate() {
        let code = code_of(line);
        if !is_code(code) {
            continue;
        }
        let mut add = |kind, after: String| {
            let before = code.trim().to_owned();
            found.push(Mutant { file: file.into(), line: index + 1, kind, before, after: after.trim().to_owned() });
        };
        for (kind, pairs) in [(Kind::Operator, &OPERATORS[..]), (Kind::Comparison, &COMPARISONS[..])] {
            for (from, to) in pairs {
                for at in occurrences(code, from) {
                    add(kind, replaced(code, at, from.len(), to));
                }
            }
        }
        for (at, length, to) in numbers(code) {
            add(Kind::Constant, replaced(code, at, length, &to));
        }
        for (at, length, to) in channels(code) {
            add(Kind::Channel, replaced(code, at, length, &to));
        }
        if is_statement(code) {
            add(Kind::Statement, String::new());
        }
    }
    found
}

/// Returns a line without its trailing comment.
fn code_of(line: &str) -> &str {
    line.split("//").next().unwrap_or_default().trim_end()
}

/// Returns true for lines that compute something, unlike attributes, imports and declarations of types and bindings.
fn is_code(code: &str) -> bool {
    let code = code.trim();
    let never = ["import", "@group", "@if", "@else", "struct", "}"];
    !code.is_empty() && !never.iter().any(|start| code.starts_with(start))
}

/// Returns true for an assignment or call on a single line.
fn is_statement(code: &str) -> bool {
    let code = code.trim();
    let declares = ["let ", "var ", "const ", "return", "override ", "static ", "break", "continue"];
    code.ends_with(';')
        && !declares.iter().any(|start| code.starts_with(start))
        && (code == "discard;" || code.contains("= ") || code.contains('('))
        // The last line of a multi-line statement closes more brackets than it opens.
        && code.matches(['(', '[', '{']).count() == code.matches([')', ']', '}']).count()
        && code.starts_with(|c: char| c.is_ascii_alphabetic() || c == '*')
}

fn occurrences(code: &str, part: &str) -> Vec<usize> {
    let starts = code.match_indices(part).map(|(at, _)| at);
    // `min(` is not the end of `argmin(`, nor is `(-` followed by `>`.
    let whole = |at: &usize| {
        let named = part.starts_with(|c: char| c.is_ascii_alphabetic());
        !(named && code[..*at].ends_with(|c: char| c.is_ascii_alphanumeric() || c == '_'))
    };
    starts.filter(whole).collect()
}

fn replaced(code: &str, at: usize, length: usize, by: &str) -> String {
    format!("{}{by}{}", &code[..at], &code[at + length..])
}

/// Returns the numbers of a line with their replacements. Constants below 0.001, which guard divisions, are left alone:
/// changing them has no visible effect.
fn numbers(code: &str) -> Vec<(usize, usize, String)> {
    let bytes = code.as_bytes();
    let mut found = Vec::new();
    let mut at = 0;
    while at < bytes.len() {
        let word = |c: u8| c.is_ascii_alphanumeric() || c == b'_' || c == b'.';
        if !bytes[at].is_ascii_digit() || at > 0 && word(bytes[at - 1]) {
            at += 1;
            continue;
        }
        let length = bytes[at..].iter().take_while(|c| word(**c)).count();
        let text = &code[at..at + length];
        if let Some(to) = other_number(text) {
            found.push((at, length, to));
        }
        at += length;
    }
    found
}

fn other_number(text: &str) -> Option<String> {
    if let Some(whole) = text.strip_suffix('u') {
        return whole.parse::<u32>().ok().map(|n| format!("{}u", n + 1));
    }
    let value: f64 = text.parse().ok().filter(|_| text.contains('.'))?;
    match value {
        0.0 => Some("0.1".to_owned()),
        v if v >= 1e-3 => Some(format!("{:?}", v * 1.1)),
        _ => None,
    }
}

/// Returns vector components with their replacements: the next one for a single component, the reverse order for
/// several.
fn channels(code: &str) -> Vec<(usize, usize, String)> {
    let mut found = Vec::new();
    for (dot, _) in code.match_indices('.') {
        let rest = &code[dot + 1..];
        let length = rest.bytes().take_while(|c| c.is_ascii_alphanumeric() || *c == b'_').count();
        let name = &rest[..length];
        let of = |set: &str| (1..=4).contains(&length) && name.chars().all(|c| set.contains(c));
        let called = rest[length..].starts_with('(');
        let sets = ["xyzw", "rgba"];
        let Some(set) = sets.into_iter().find(|set| of(set) && !called) else { continue };
        let to = match set.find(name) {
            Some(place) if length == 1 => set[if place == 0 { 1..2 } else { place - 1..place }].to_owned(),
            _ => name.chars().rev().collect(),
        };
        if to != name {
            found.push((dot + 1, length, to));
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    fn after(line: &str, kind: Kind) -> Vec<String> {
        let mutants = mutants("a.wgsl", line);
        mutants.into_iter().filter(|m| m.kind == kind).map(|m| m.after).collect()
    }

    #[test]
    fn each_kind_is_planted_where_it_can_be() {
        assert_eq!(
            after("    let a = b - c * max(d, 0.0); // a - b", Kind::Operator),
            ["let a = b + c * max(d, 0.0);", "let a = b - c / max(d, 0.0);", "let a = b - c * min(d, 0.0);",]
        );
        assert_eq!(after("if a.x >= 1u && b {", Kind::Comparison), ["if a.x < 1u && b {", "if a.x >= 1u || b {"]);
        assert_eq!(
            after("let a = 2.0 * f16x2 + 1e-6 + 3u + 0.0;", Kind::Constant),
            [
                "let a = 2.2 * f16x2 + 1e-6 + 3u + 0.0;",
                "let a = 2.0 * f16x2 + 1e-6 + 4u + 0.0;",
                "let a = 2.0 * f16x2 + 1e-6 + 3u + 0.1;",
            ]
        );
        assert_eq!(
            after("let a = b.xyz + c.r - d.max(e).field.zz;", Kind::Channel),
            ["let a = b.zyx + c.r - d.max(e).field.zz;", "let a = b.xyz + c.g - d.max(e).field.zz;",]
        );
        assert_eq!(after("    color *= texel;", Kind::Statement), [""]);
        for whole in ["let a = b;", "    1.0);", "return a(b);", "import package::a;", "@group(0) var a: b;"] {
            assert!(after(whole, Kind::Statement).is_empty(), "{whole}");
        }
    }

    #[test]
    fn a_fault_is_planted_in_its_line_alone() {
        let text = "a = b + c;\na = b + c;\n";
        let all = mutants("a.wgsl", text);
        let second = all.iter().find(|m| m.line == 2 && m.kind == Kind::Operator).expect("there is one");
        assert_eq!(second.planted(text), "a = b + c;\na = b - c;\n");
        assert_eq!(second.rank(), all[0].rank(), "the same fault, wherever it stands");
    }
}
