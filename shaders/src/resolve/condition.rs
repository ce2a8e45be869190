//! Conditional translation: evaluates `@if`, `@elif` and `@else`.
//!
//! The attributes precede all other attributes of a declaration, import, parameter, struct member or statement. `@elif`
//! and `@else` belong to the item directly before them.

use super::code::Code;
use super::fault::Fault;
use super::token::Token;

/// Returns the state of a feature, or `None` for an unknown feature.
pub(super) type IsOn<'a> = dyn Fn(&str) -> Option<bool> + 'a;

/// Returns the tokens of active items.
///
/// # Errors
///
/// If a condition is invalid, names an unknown feature, or appears where conditions are not allowed.
pub(super) fn translate<'a>(code: &Code<'a>, features: &IsOn<'_>) -> Result<Code<'a>, Fault> {
    let mut kept = Vec::with_capacity(code.tokens.len());
    let translation = Translation { code, features };
    translation.items(0, code.tokens.len(), false, &mut kept)?;
    Code::of(code.text, kept)
}

struct Translation<'a, 'b> {
    code: &'b Code<'a>,
    features: &'b IsOn<'b>,
}

impl Translation<'_, '_> {
    /// Keeps the items from `start` to `end`: members and parameters, or declarations and statements.
    fn items(&self, start: usize, end: usize, members: bool, kept: &mut Vec<Token>) -> Result<(), Fault> {
        let code = self.code;
        // State of the condition that an `@else` may follow.
        let mut taken: Option<bool> = None;
        let mut at = start;
        while at < end {
            let attribute = self.attribute(at);
            let (on, first) = match attribute {
                None => (true, at),
                Some("else") => (!taken.ok_or_else(|| self.alone(at))?, at + 2),
                Some(name) => {
                    let before = if name == "if" { false } else { taken.ok_or_else(|| self.alone(at))? };
                    let (value, next) = self.condition(at + 2)?;
                    taken = Some(before || value);
                    (value && !before, next)
                }
            };
            if !matches!(attribute, Some("if" | "elif")) {
                taken = None;
            }
            let next = if members { code.member_end(first, end) } else { code.statement_end(first, end) };
            if on {
                self.item(first, next, kept)?;
            }
            at = next;
        }
        Ok(())
    }

    /// Keeps one item, without inactive items inside it.
    fn item(&self, start: usize, end: usize, kept: &mut Vec<Token>) -> Result<(), Fault> {
        let code = self.code;
        let keyword = code.after_attributes(start);
        let is_struct = code.word(keyword) == "struct";
        let mut at = start;
        while at < end {
            if self.attribute(at).is_some() {
                return Err(Fault::new(code.line(at), "`@if`, `@elif` and `@else` come before other attributes"));
            }
            kept.push(code.tokens[at]);
            let parameters = code.is(at, '(') && at == keyword + 2 && code.word(keyword) == "fn";
            if parameters || code.is(at, '{') {
                let close = code.close(at);
                self.items(at + 1, close, parameters || is_struct, kept)?;
                at = close;
            } else {
                at += 1;
            }
        }
        Ok(())
    }

    /// Returns the name of the condition that begins at a token.
    fn attribute(&self, at: usize) -> Option<&str> {
        let name = self.code.word(at + 1);
        (self.code.is(at, '@') && matches!(name, "if" | "elif" | "else")).then_some(name)
    }

    fn alone(&self, at: usize) -> Fault {
        Fault::new(self.code.line(at), format!("`@{}` follows no `@if`", self.code.word(at + 1)))
    }

    /// Returns the value of the condition whose bracket opens at `open`, and the index after it.
    fn condition(&self, open: usize) -> Result<(bool, usize), Fault> {
        if !self.code.is(open, '(') {
            return Err(Fault::new(self.code.line(open), "a condition in brackets is missing"));
        }
        let close = self.code.close(open);
        let (value, next) = self.any(open + 1)?;
        if next != close {
            let message = format!("`{}` is not expected in a condition", self.code.word(next));
            return Err(Fault::new(self.code.line(next), message));
        }
        Ok((value, close + 1))
    }

    /// Evaluates `a || b || …`.
    fn any(&self, at: usize) -> Result<(bool, usize), Fault> {
        let (mut value, mut next) = self.all(at)?;
        while self.code.is(next, '|') && self.code.is(next + 1, '|') {
            let (right, after) = self.all(next + 2)?;
            (value, next) = (value || right, after);
        }
        Ok((value, next))
    }

    /// Evaluates `a && b && …`.
    fn all(&self, at: usize) -> Result<(bool, usize), Fault> {
        let (mut value, mut next) = self.single(at)?;
        while self.code.is(next, '&') && self.code.is(next + 1, '&') {
            let (right, after) = self.single(next + 2)?;
            (value, next) = (value && right, after);
        }
        Ok((value, next))
    }

    /// Evaluates `a`, `!a` or `(…)`.
    fn single(&self, at: usize) -> Result<(bool, usize), Fault> {
        let code = self.code;
        if code.is(at, '!') {
            return self.single(at + 1).map(|(value, next)| (!value, next));
        }
        if code.is(at, '(') {
            return self.condition(at);
        }
        let name = code.word(at);
        let value = match name {
            "true" => Some(true),
            "false" => Some(false),
            _ if code.is_word(at) => (self.features)(name),
            _ => return Err(Fault::new(code.line(at), format!("a feature is expected, found `{name}`"))),
        };
        let unknown = || Fault::new(code.line(at), format!("`{name}` is not a known feature"));
        Ok((value.ok_or_else(unknown)?, at + 1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn kept(text: &str, on: &[&str]) -> Result<String, Fault> {
        let code = Code::new(text)?;
        let known = |name: &str| ["A", "B"].contains(&name).then(|| on.contains(&name));
        let left = translate(&code, &known)?;
        Ok((0..left.tokens.len()).map(|at| left.word(at)).collect::<Vec<_>>().join(" "))
    }

    #[test]
    fn conditions_decide_on_the_item_that_follows() {
        let text = "@if(A) const a = 1; @elif(B) const a = 2; @else const a = 3; const b = 4;";
        assert_eq!(kept(text, &["A", "B"]).unwrap(), "const a = 1 ; const b = 4 ;");
        assert_eq!(kept(text, &["B"]).unwrap(), "const a = 2 ; const b = 4 ;");
        assert_eq!(kept(text, &[]).unwrap(), "const a = 3 ; const b = 4 ;");
        let members = "struct S { a: array<vec2<f32>, 4>, @if(A) @size(8) b: map<f32, u32>, c: f32 }";
        assert_eq!(kept(members, &[]).unwrap(), "struct S { a : array < vec2 < f32 > , 4 > , c : f32 }");
        let body = "fn f(@if(A) a: f32, b: f32) -> S { @if(B) if a { x(); } else if b { y(); } else { z(); } @if(A) { w(); } v(); }";
        assert_eq!(kept(body, &[]).unwrap(), "fn f ( b : f32 ) - > S { v ( ) ; }");
        assert_eq!(kept(body, &["A"]).unwrap(), "fn f ( a : f32 , b : f32 ) - > S { { w ( ) ; } v ( ) ; }");
        assert!(kept(body, &["B"]).unwrap().contains("{ z ( ) ; } v"));
    }

    #[test]
    fn operators_have_their_usual_order() {
        for (condition, on, expected) in [
            ("A || B && !A", &["A"][..], true),
            ("(A || B) && !A", &["A"], false),
            ("!(A && B) || false", &["A", "B"], false),
            ("!!B", &["B"], true),
        ] {
            assert_eq!(!kept(&format!("@if({condition}) x;"), on).unwrap().is_empty(), expected, "{condition}");
        }
    }

    #[test]
    fn faults_are_told_with_their_line() {
        for (text, line, part) in [
            ("a;\n@if(C) b;", 2, "`C` is not a known feature"),
            ("\n@else b;", 2, "follows no `@if`"),
            ("@if(A) a; b;\n@elif(B) c;", 2, "follows no `@if`"),
            ("@if a;", 1, "brackets"),
            ("@if(A B) a;", 1, "`B` is not expected"),
            ("@if(A &&) a;", 1, "a feature is expected"),
            ("@id(1)\n@if(A) override a: f32;", 2, "before other attributes"),
            ("fn f() { x[1; }", 1, "expected `]`"),
            ("fn f() {\n", 1, "missing"),
            ("}", 1, "closes no bracket"),
        ] {
            let fault = kept(text, &["A"]).unwrap_err();
            assert!(fault.line == line && fault.message.contains(part), "{text}: {fault:?}");
        }
    }
}
