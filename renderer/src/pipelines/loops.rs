//! Whether the loops of a shader end, proved on naga's representation of it.
//!
//! wgpu counts the turns of every loop in the shaders that it hands to drivers, since an endless loop is undefined behavior
//! there. Where each loop is one that counts, that is not needed: a local variable that nothing else stores to goes up by one at
//! the end of each turn, and the loop ends unless it is less than some bound. It never wraps around, because what is less than
//! a number is less than the greatest one; so the loop ends, whatever the bound is and even if it changes meanwhile. With another
//! step, or with "less or equal", the bound must be a number that is not too near to the greatest.

use super::bounds::is_emitted;
use wgpu::naga::{
    BinaryOperator, Block, Expression, Function, Handle, Literal, LocalVariable, Module, Statement, front::wgsl,
};

/// Why the loops of a shader are counted while it runs: the name of the first function with a loop that is not seen to end; none
/// where all are, and for a text that does not compile.
///
/// ```
/// use framegraph_wgpu::endless_loop;
///
/// let counts = |step: &str| format!("fn sum(n: u32) -> u32 {{ var s = 0u; for (var i = 0u; i < n; {step}) {{ s += i; }} return s; }}");
/// assert_eq!(endless_loop(&counts("i++")), None);
/// assert_eq!(endless_loop(&counts("i += 2")).as_deref(), Some("sum")); // From the greatest number it goes on from 0 or 1.
/// ```
#[must_use]
pub fn endless_loop(text: &str) -> Option<String> {
    wgsl::parse_str(text).ok().and_then(|module| first_endless(&module))
}

/// The name of the first function with a loop that is not seen to end.
pub(crate) fn first_endless(module: &Module) -> Option<String> {
    let functions = module.functions.iter().map(|(_, function)| function);
    let entries = module.entry_points.iter().map(|entry| (&entry.function, entry.name.clone()));
    let named = functions.map(|function| (function, function.name.clone().unwrap_or_default()));
    let ends = |function: &Function| Proof { module, function }.ends(&function.body);
    named.chain(entries).find(|(function, _)| !ends(function)).map(|(_, name)| name)
}

struct Proof<'m> {
    module: &'m Module,
    function: &'m Function,
}

impl Proof<'_> {
    /// Whether all loops in a block end.
    fn ends(&self, block: &Block) -> bool {
        block.iter().all(|statement| match statement {
            Statement::Block(inner) => self.ends(inner),
            Statement::If { accept, reject, .. } => self.ends(accept) && self.ends(reject),
            Statement::Switch { cases, .. } => cases.iter().all(|case| self.ends(&case.body)),
            Statement::Loop { body, continuing, .. } => {
                self.counts(body, continuing) && self.ends(body) && self.ends(continuing)
            }
            _ => true,
        })
    }

    /// Whether a loop counts up to a bound.
    fn counts(&self, body: &Block, continuing: &Block) -> bool {
        let tested = body.iter().find(|statement| !matches!(statement, Statement::Emit(_)));
        let Some(Statement::If { condition, accept, reject }) = tested else { return false };
        if !accept.is_empty() || !matches!(reject.iter().next(), Some(Statement::Break)) {
            return false;
        }
        let Expression::Binary { op, left, right } = self.function.expressions[*condition] else { return false };
        let (counter, bound, equal) = match op {
            BinaryOperator::Less => (left, right, false),
            BinaryOperator::LessEqual => (left, right, true),
            BinaryOperator::Greater => (right, left, false),
            BinaryOperator::GreaterEqual => (right, left, true),
            _ => return false,
        };
        // As it is in this turn, not as it was once.
        let Some(counter) = self.loaded(counter).filter(|_| is_emitted(body, counter)) else { return false };
        let Some(step) = self.step(counter, continuing) else { return false };
        // One store at the end of a turn, and none elsewhere.
        if self.changes(body, counter) > 0 || self.changes(continuing, counter) != 1 {
            return false;
        }
        match (step, self.number(bound)) {
            (1, _) if !equal => true,
            (step, Some(Literal::U32(bound))) => u32::try_from(step).is_ok_and(|step| bound <= u32::MAX - step),
            (step, Some(Literal::I32(bound))) => i32::try_from(step).is_ok_and(|step| bound <= i32::MAX - step),
            _ => false,
        }
    }

    /// The local variable whose value an expression is.
    fn loaded(&self, value: Handle<Expression>) -> Option<Handle<LocalVariable>> {
        let Expression::Load { pointer } = self.function.expressions[value] else { return None };
        match self.function.expressions[pointer] {
            Expression::LocalVariable(variable) => Some(variable),
            _ => None,
        }
    }

    /// By how much a whole number goes up at the end of each turn, from 1.
    fn step(&self, counter: Handle<LocalVariable>, continuing: &Block) -> Option<i64> {
        continuing.iter().find_map(|statement| {
            let Statement::Store { pointer, value } = statement else { return None };
            if self.root(*pointer) != Some(counter) {
                return None;
            }
            let Expression::Binary { op: BinaryOperator::Add, left, right } = self.function.expressions[*value] else {
                return None;
            };
            let step = match self.number(right)? {
                Literal::U32(step) => i64::from(step),
                Literal::I32(step) => i64::from(step),
                _ => return None,
            };
            (self.loaded(left) == Some(counter) && is_emitted(continuing, left) && step > 0).then_some(step)
        })
    }

    /// A number that is written in the text.
    fn number(&self, value: Handle<Expression>) -> Option<Literal> {
        match self.function.expressions[value] {
            Expression::Literal(literal) => Some(literal),
            Expression::Constant(constant) => {
                match self.module.global_expressions[self.module.constants[constant].init] {
                    Expression::Literal(literal) => Some(literal),
                    _ => None,
                }
            }
            _ => None,
        }
    }

    /// The local variable into which a pointer points.
    fn root(&self, pointer: Handle<Expression>) -> Option<Handle<LocalVariable>> {
        match self.function.expressions[pointer] {
            Expression::LocalVariable(variable) => Some(variable),
            Expression::Access { base, .. } | Expression::AccessIndex { base, .. } => self.root(base),
            _ => None,
        }
    }

    /// How many statements may change a variable.
    fn changes(&self, block: &Block, variable: Handle<LocalVariable>) -> usize {
        let is_it = |pointer: Handle<Expression>| usize::from(self.root(pointer) == Some(variable));
        let of = |statement: &Statement| match statement {
            Statement::Store { pointer, .. } => is_it(*pointer),
            Statement::Call { arguments, .. } => arguments.iter().map(|argument| is_it(*argument)).sum(),
            Statement::Block(inner) => self.changes(inner, variable),
            Statement::If { accept, reject, .. } => self.changes(accept, variable) + self.changes(reject, variable),
            Statement::Switch { cases, .. } => cases.iter().map(|case| self.changes(&case.body, variable)).sum(),
            Statement::Loop { body, continuing, .. } => {
                self.changes(body, variable) + self.changes(continuing, variable)
            }
            _ => 0,
        };
        block.iter().map(of).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn counted(head: &str, body: &str) -> bool {
        let text = format!(
            "const MOST = 9; override END: i32 = 7; struct S {{ i: i32 }}
             fn up(p: ptr<function, i32>) {{ *p = 0; }}
             fn f(n: i32, m: u32, x: f32) -> i32 {{ var s = 0; var t: S; for ({head}) {{ {body} }} return s + t.i; }}"
        );
        assert!(wgsl::parse_str(&text).is_ok(), "{text}");
        endless_loop(&text).is_none()
    }

    #[test]
    fn loops_that_count_end() {
        for head in [
            "var i = 0; i < n; i++",
            "var i = n; i < END; i += 1",
            "var i = 0u; i < m; i++",
            "var i = 0; n > i; i++",
            "var i = -1; i <= 1; i += 2",
            "var i = 0; i <= MOST; i++",
            "var i = 0u; i < 4000000000u; i += 3u",
        ] {
            assert!(counted(head, "s += i32(i); if s > 4 { continue; } if s > 9 { break; }"), "{head}");
            assert!(counted(head, "for (var k = 0; k < 4; k++) { s += k; }"), "{head}");
        }
    }

    /// Each is nearly one of those, and may never end.
    #[test]
    fn what_is_not_seen_to_end_is_told() {
        for (head, body) in [
            ("var i = 0; i < n; i += 2", ""),
            ("var i = 0; i <= n; i++", ""),
            ("var i = 0u; i <= 4294967295u; i++", ""),
            ("var i = 0; i <= 2147483646; i += 2", ""),
            ("var i = 0; i < n; i--", ""),
            ("var i = 0; i > n; i++", ""),
            ("var i = 0; i != n; i++", ""),
            ("var i = 0; i < n; i += n", ""),
            ("var i = 0; i < n; s++", ""),
            ("var i = 0; i < n; i++", "i = 0;"),
            ("var i = 0; i < n; i++", "if s > 3 { i -= 1; }"),
            ("var i = 0; i < n; i++", "up(&i);"),
            ("var i = 0; i < n; i++", "for (var k = 0; k < 3; i--) { k++; }"),
            ("var i = 0; i < n; i++", "loop { if s > 7 { break; } }"),
            ("var i = 0.0; i < x; i += 1.0", ""),
            ("var i = 0; ; i++", "if i > 3 { break; }"),
            ("; t.i < n; t.i++", ""),
        ] {
            assert!(!counted(head, body), "{head}: {body}");
        }
    }

    #[test]
    fn the_function_is_named() {
        let text = "fn a() { for (var i = 0; i < 3; i++) {} } @compute @workgroup_size(1) fn main() { a(); loop {} }";
        assert_eq!(endless_loop(text).as_deref(), Some("main"));
        assert_eq!(endless_loop("no shader"), None);
        // What was read of the counter before the loop stays what it was.
        let stale = "fn f(n: i32) { var i = 0; let x = i; for (; x < n; i++) {} }";
        assert_eq!(endless_loop(stale).as_deref(), Some("f"));
        let stale = "fn f(n: i32) { var i = 0; let x = i; for (; i < n; i = x + 1) {} }";
        assert_eq!(endless_loop(stale).as_deref(), Some("f"));
    }
}
