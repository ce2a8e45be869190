//! Proof that the indices of a shader are in bounds, on naga's representation of the shader.
//!
//! Out-of-bounds accesses are undefined behavior in drivers, so wgpu clamps or checks every index at run time. These
//! checks can be omitted if every index is proven to be in bounds.
//!
//! Each function is analyzed statement by statement with intervals of integers. Intervals are known for constants and
//! loop counters, and for sums, products, masks, clamps and remainders of known intervals.

use super::counting_loop::{CountingLoop, changed, number, root, whole};
use std::collections::HashMap;
use std::ops::RangeInclusive;
use wgpu::naga::valid::{Capabilities, FunctionInfo, ValidationFlags, Validator};
use wgpu::naga::{
    ArraySize, BinaryOperator, Block, Expression, Function, Handle, LocalVariable, MathFunction, Module, ScalarKind,
    Statement, TypeInner, front::wgsl, proc::TypeResolution,
};

/// Returns the name of the first function with an index that is not proven to be in bounds. The shader then keeps wgpu's
/// run-time checks.
///
/// Texel coordinates of loads and stores always count as unproven. Returns `None` if all indices are proven, or if the
/// source does not compile.
///
/// ```
/// use framegraph_wgpu::unproved_index;
///
/// let sum = |bound: &str| format!("fn sum(a: array<f32, 4>, n: u32) -> f32 {{
///     var all = a; var s = 0.0; for (var i = 0u; i < {bound}; i++) {{ s += all[i]; }} return s; }}");
/// assert_eq!(unproved_index(&sum("4u")), None);
/// assert_eq!(unproved_index(&sum("min(n, 4u)")), None);
/// assert_eq!(unproved_index(&sum("n")).as_deref(), Some("sum"));
/// ```
#[must_use]
pub fn unproved_index(text: &str) -> Option<String> {
    first_unproved(&wgsl::parse_str(text).ok()?)
}

/// Returns the name of the first function with an unproven index; `None` also for an invalid module.
pub(crate) fn first_unproved(module: &Module) -> Option<String> {
    let info = Validator::new(ValidationFlags::empty(), Capabilities::all()).validate(module).ok()?;
    let own = module.functions.iter().map(|(handle, function)| (function, &info[handle], function.name.as_deref()));
    let entries = module.entry_points.iter().enumerate();
    let entries = entries.map(|(at, entry)| (&entry.function, info.get_entry_point(at), Some(entry.name.as_str())));
    let proved = |function, types| {
        let mut proof = Proof { module, function, types, values: HashMap::new(), variables: HashMap::new() };
        let first = |(variable, own): (_, &LocalVariable)| Some((variable, proof.span(own.init?)?));
        proof.variables = function.local_variables.iter().filter_map(first).collect();
        proof.block(&function.body)
    };
    own.chain(entries)
        .find(|(function, types, _)| !proved(*function, types))
        .map(|(.., name)| name.unwrap_or_default().to_owned())
}

/// Interval of an integer.
type Span = RangeInclusive<i64>;

struct Proof<'m> {
    module: &'m Module,
    function: &'m Function,
    types: &'m FunctionInfo,
    /// Intervals of expressions at the point where they were evaluated.
    values: HashMap<Handle<Expression>, Span>,
    /// Current intervals of local variables.
    variables: HashMap<Handle<LocalVariable>, Span>,
}

impl Proof<'_> {
    /// Returns whether all indices of a block are proven.
    fn block(&mut self, block: &Block) -> bool {
        block.iter().all(|statement| self.statement(statement))
    }

    fn statement(&mut self, statement: &Statement) -> bool {
        match statement {
            Statement::Emit(range) => range.clone().all(|value| self.emit(value)),
            Statement::Block(inner) => self.block(inner),
            Statement::Store { pointer, value } => {
                if let Some(variable) = root(self.function, *pointer) {
                    let whole = matches!(self.function.expressions[*pointer], Expression::LocalVariable(_));
                    match self.span(*value).filter(|_| whole) {
                        Some(span) => self.variables.insert(variable, span),
                        None => self.variables.remove(&variable),
                    };
                }
                true
            }
            Statement::If { accept, reject, .. } => self.branches(&[accept, reject]),
            Statement::Switch { cases, .. } => self.branches(&cases.iter().map(|case| &case.body).collect::<Vec<_>>()),
            Statement::Loop { body, continuing, .. } => self.turns(body, continuing),
            Statement::Call { arguments, .. } => {
                for variable in arguments.iter().filter_map(|argument| root(self.function, *argument)) {
                    self.variables.remove(&variable);
                }
                true
            }
            Statement::Break | Statement::Continue | Statement::Return { .. } | Statement::Kill => true,
            // Statements that write through coordinates, and statements that are not analyzed.
            _ => false,
        }
    }

    /// Analyzes several alternative blocks from the current state. Afterwards, variables that any of them changes are
    /// unknown.
    fn branches(&mut self, blocks: &[&Block]) -> bool {
        let before = self.variables.clone();
        let proved = blocks.iter().all(|block| {
            self.variables.clone_from(&before);
            self.block(block)
        });
        self.variables = before;
        blocks.iter().for_each(|block| self.forget(block));
        proved
    }

    fn turns(&mut self, body: &Block, continuing: &Block) -> bool {
        let counted = self.counter(body, continuing);
        self.forget(body);
        self.forget(continuing);
        let before = self.variables.clone();
        // The counter is known to be below its bound only after the loop condition.
        let tested = body.iter().position(|statement| matches!(statement, Statement::If { .. })).unwrap_or(0);
        let all: Vec<&Statement> = body.iter().collect();
        let (head, rest) = all.split_at(tested);
        let mut proved = head.iter().all(|statement| self.statement(statement));
        if let Some((counter, span)) = counted {
            self.variables.insert(counter, span);
        }
        proved &= rest.iter().all(|statement| self.statement(statement)) && self.block(continuing);
        self.variables = before;
        proved
    }

    /// Returns the counter of a loop with constant step and known bounds, with its interval inside of the loop.
    fn counter(&mut self, body: &Block, continuing: &Block) -> Option<(Handle<LocalVariable>, Span)> {
        let CountingLoop { counter, bound, equal, step } =
            CountingLoop::find(self.module, self.function, body, continuing)?;
        let first = *self.variables.get(&counter)?.start();
        // The bound may be computed in each iteration from values that the loop does not change.
        let before = self.variables.clone();
        self.forget(body);
        self.forget(continuing);
        for statement in body.iter().take_while(|statement| matches!(statement, Statement::Emit(_))) {
            self.statement(statement);
        }
        let bound = self.span(bound).map(|span| *span.end());
        self.variables = before;
        let last = bound? - i64::from(!equal);
        // The loop ends before the counter can overflow.
        (last <= i64::from(i32::MAX) - step).then(|| (counter, first..=last.max(first)))
    }

    /// Removes the intervals of all variables that a block changes.
    fn forget(&mut self, block: &Block) {
        let changed = changed(self.function, block);
        self.variables.retain(|variable, _| !changed.contains(variable));
    }

    /// Computes the interval of an expression. Returns false if it is an index that is not proven to be in bounds.
    fn emit(&mut self, value: Handle<Expression>) -> bool {
        if let Some(span) = self.worked_out(value) {
            self.values.insert(value, span);
        } else {
            self.values.remove(&value);
        }
        match self.function.expressions[value] {
            Expression::Access { base, index } => {
                let count = self.elements(base);
                let span = self.span(index);
                count.zip(span).is_some_and(|(count, span)| *span.start() >= 0 && *span.end() < count)
            }
            Expression::ImageLoad { .. } => false,
            _ => true,
        }
    }

    /// Returns the number of elements of a value or pointer; `None` if it is not constant.
    fn elements(&self, base: Handle<Expression>) -> Option<i64> {
        let inner = |resolution: &TypeResolution| match resolution {
            TypeResolution::Handle(handle) => self.module.types[*handle].inner.clone(),
            TypeResolution::Value(inner) => inner.clone(),
        };
        let mut own = inner(&self.types[base].ty);
        if let TypeInner::Pointer { base, .. } = own {
            own = self.module.types[base].inner.clone();
        }
        match own {
            TypeInner::Vector { size, .. } | TypeInner::ValuePointer { size: Some(size), .. } => Some(size as i64),
            TypeInner::Matrix { columns, .. } => Some(columns as i64),
            TypeInner::Array { size: ArraySize::Constant(count), .. } => Some(i64::from(count.get())),
            _ => None,
        }
    }

    fn span(&self, value: Handle<Expression>) -> Option<Span> {
        let written = || number(self.module, self.function, value).and_then(whole);
        self.values.get(&value).cloned().or_else(|| written().map(|number| number..=number))
    }

    /// Computes the interval of an expression from its operands.
    fn worked_out(&self, value: Handle<Expression>) -> Option<Span> {
        let (min, max) = match self.types[value].ty.inner_with(&self.module.types) {
            TypeInner::Scalar(scalar) if scalar.kind == ScalarKind::Uint && scalar.width == 4 => {
                (0, i64::from(u32::MAX))
            }
            TypeInner::Scalar(scalar) if scalar.kind == ScalarKind::Sint && scalar.width == 4 => {
                (i64::from(i32::MIN), i64::from(i32::MAX))
            }
            _ => return None,
        };
        let any = || min..=max;
        let span = |value| self.span(value).unwrap_or(any());
        let found = match self.function.expressions[value] {
            Expression::Load { pointer } => match self.function.expressions[pointer] {
                Expression::LocalVariable(variable) => self.variables.get(&variable)?.clone(),
                _ => return None,
            },
            Expression::Binary { op, left, right } => {
                let ((a, b), (c, d)) = (span(left).into_inner(), span(right).into_inner());
                match op {
                    BinaryOperator::Add => a + c..=b + d,
                    BinaryOperator::Subtract => a - d..=b - c,
                    BinaryOperator::Multiply if a >= 0 && c >= 0 => a.checked_mul(c)?..=b.checked_mul(d)?,
                    BinaryOperator::Divide if a >= 0 && c > 0 => a / d..=b / c,
                    BinaryOperator::Modulo if a >= 0 && c > 0 => 0..=b.min(d - 1),
                    BinaryOperator::And if c >= 0 => 0..=d,
                    BinaryOperator::And if a >= 0 => 0..=b,
                    BinaryOperator::ShiftRight if a >= 0 && c == d => a >> c..=b >> c,
                    _ => return None,
                }
            }
            Expression::Math { fun: MathFunction::Min, arg, arg1: Some(other), .. } => {
                let ((a, b), (c, d)) = (span(arg).into_inner(), span(other).into_inner());
                a.min(c)..=b.min(d)
            }
            Expression::Math { fun: MathFunction::Max, arg, arg1: Some(other), .. } => {
                let ((a, b), (c, d)) = (span(arg).into_inner(), span(other).into_inner());
                a.max(c)..=b.max(d)
            }
            Expression::Math { fun: MathFunction::Clamp, arg1: Some(low), arg2: Some(high), .. } => {
                let ((a, _), (c, d)) = (span(low).into_inner(), span(high).into_inner());
                a.min(c)..=d
            }
            Expression::Select { accept, reject, .. } => {
                let ((a, b), (c, d)) = (span(accept).into_inner(), span(reject).into_inner());
                a.min(c)..=b.max(d)
            }
            Expression::As { expr, convert: Some(4), .. } => self.span(expr)?,
            _ => return None,
        };
        // Values outside of the type's range wrap around, so nothing is known.
        (*found.start() >= min && *found.end() <= max).then_some(found)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn proved(body: &str) -> bool {
        let text = format!(
            "const COUNT = 4u; var<private> far: u32;
             fn up(p: ptr<function, u32>) {{ *p += 9u; }}
             fn f(a: array<f32, 8>, n: u32, k: i32, v: vec4<f32>) -> f32 {{ var all = a; var s = 0.0; {body} return s; }}"
        );
        assert!(wgsl::parse_str(&text).is_ok(), "{text}");
        unproved_index(&text).is_none()
    }

    #[test]
    fn indices_in_bounds_are_proven() {
        for body in [
            "s = all[7] + v[3];",
            "s = all[n & 7u] + v[n % 4u];",
            "s = all[min(n, 7u)] + all[clamp(k, 0, 7)];",
            "s = all[2u * (n & 3u) + 1u];",
            "s = all[(n >> 29u)];",
            "s = all[select(0u, 7u, n > 3u)];",
            "for (var i = 0u; i < 8u; i++) { s += all[i]; }",
            "for (var i = 0; i < 7; i++) { s += all[i + 1]; all[i] = s; }",
            "for (var i = 0u; i < COUNT; i += 1u) { for (var j = 0u; j < 2u; j++) { s += all[2u * i + j]; } }",
            "for (var i = 0; i <= 6; i += 3) { s += all[i]; }",
            "let most = min(n, 8u); for (var i = 0u; i < most; i++) { if s > 3.0 { continue; } s += all[i]; }",
            "var i = 3u; if n > 2u { s = all[i]; } i = 7u; s += all[i];",
        ] {
            assert!(proved(body), "{body}");
        }
    }

    /// Variations of the cases above that may be out of bounds.
    #[test]
    fn unproven_indices_are_reported() {
        for body in [
            "s = all[n];",
            "s = v[n & 7u];",
            "s = all[n & 8u];",
            "s = all[k % 8];",
            "s = all[min(k, 7)];",
            "s = all[clamp(k, 0, 8)];",
            "s = all[max(n, 7u)];",
            "s = all[(n & 3u) - 1u];",
            "s = all[(n >> 28u)];",
            "s = all[far];",
            "for (var i = 0u; i < 9u; i++) { s += all[i]; }",
            "for (var i = 0u; i <= 8u; i++) { s += all[i]; }",
            "for (var i = 0u; i < n; i++) { s += all[i]; }",
            "for (var i = k; i < 8; i++) { s += all[i]; }",
            "for (var i = 0u; i < 8u; i++) { s += all[i + 1u]; }",
            "for (var i = 0u; i < 8u; i++) { i += 3u; s += all[i]; }",
            "for (var i = 0u; i < 8u; i++) { up(&i); s += all[i]; }",
            "for (var i = 7; i < 8; i--) { s += all[i]; }",
            "for (var i = 1u; i <= 7u; i += 4294967295u) { s += all[i]; }",
            "for (var i = 2u; i < 8u; i += 0u) { i -= 1u; s += all[i]; }",
            "for (var i = 0u; i <= 8u; i += 2u) { s += all[i]; }",
            "var i = 0u; let x = i; loop { if x < 8u { } else { break; } s += all[i]; continuing { i += 1u; } }",
            "var i = -9; let x = i; i = 0; loop { if i < 8 { } else { break; } s += all[i]; continuing { i = x + 1; } }",
            "var i = 3u; if n > 2u { i = n; } s = all[i];",
            "var i = 3u; up(&i); s = all[i];",
            "var i = 0u; loop { s += all[i]; i += 1u; if i > 7u { break; } }",
        ] {
            assert!(!proved(body), "{body}");
        }
    }

    #[test]
    fn texel_loads_and_runtime_arrays_are_unproven() {
        let load = "@group(0) @binding(0) var t: texture_2d<f32>; fn texel() -> vec4<f32> { return textureLoad(t, vec2(0), 0); }";
        assert_eq!(unproved_index(load).as_deref(), Some("texel"));
        let open = "@group(0) @binding(0) var<storage> b: array<f32>; fn item(n: u32) -> f32 { return b[n & 1u]; }";
        assert_eq!(unproved_index(open).as_deref(), Some("item"));
        assert_eq!(unproved_index("no shader"), None);
    }
}
