//! Proof that the loops of a shader terminate, on naga's representation of the shader.
//!
//! Endless loops are undefined behavior in drivers, so wgpu adds an iteration counter to every loop. It can be omitted
//! if all loops are counting loops that are proven to terminate.
//!
//! A counting loop increments a local variable that nothing else writes, and runs while it is less than a bound. With
//! step 1 it terminates for any bound, even one that changes. A value less than another is not the maximum, so the
//! increment cannot overflow. Other steps, and "less or equal", require a constant bound below the maximum.

use super::counting_loop::{CountingLoop, number};
use wgpu::naga::{Block, Function, Literal, Module, Statement, front::wgsl};

/// Returns the name of the first function with a loop that is not proven to terminate. The shader then keeps wgpu's
/// iteration counters.
///
/// Returns `None` if all loops are proven to terminate, or if the source does not compile.
///
/// ```
/// use framegraph_wgpu::endless_loop;
///
/// let counts = |step: &str| format!("fn sum(n: u32) -> u32 {{ var s = 0u; for (var i = 0u; i < n; {step}) {{ s += i; }} return s; }}");
/// assert_eq!(endless_loop(&counts("i++")), None);
/// assert_eq!(endless_loop(&counts("i += 2")).as_deref(), Some("sum")); // May overflow and start again at 0 or 1.
/// ```
#[must_use]
pub fn endless_loop(text: &str) -> Option<String> {
    wgsl::parse_str(text).ok().and_then(|module| first_endless(&module))
}

/// Returns the name of the first function with a loop that is not proven to terminate.
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
    /// Returns whether all loops of a block are proven to terminate.
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

    /// Returns whether a loop counts up to a bound without overflow.
    fn counts(&self, body: &Block, continuing: &Block) -> bool {
        let Some(CountingLoop { bound, equal, step, .. }) =
            CountingLoop::find(self.module, self.function, body, continuing)
        else {
            return false;
        };
        match (step, number(self.module, self.function, bound)) {
            (1, _) if !equal => true,
            (step, Some(Literal::U32(bound))) => u32::try_from(step).is_ok_and(|step| bound <= u32::MAX - step),
            (step, Some(Literal::I32(bound))) => i32::try_from(step).is_ok_and(|step| bound <= i32::MAX - step),
            _ => false,
        }
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

    /// Variations of the cases above that may not terminate.
    #[test]
    fn unbounded_loops_are_reported() {
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
        // A value of the counter that was loaded before the loop does not change.
        let stale = "fn f(n: i32) { var i = 0; let x = i; for (; x < n; i++) {} }";
        assert_eq!(endless_loop(stale).as_deref(), Some("f"));
        let stale = "fn f(n: i32) { var i = 0; let x = i; for (; i < n; i = x + 1) {} }";
        assert_eq!(endless_loop(stale).as_deref(), Some("f"));
    }
}
