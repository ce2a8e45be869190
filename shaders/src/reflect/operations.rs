//! Counts of the operations in a function, taken from naga's module: a deterministic measure of cost that needs no
//! device.

use naga::{Expression, Function, Handle, MathFunction, Module, Statement};
use std::collections::BTreeMap;

/// Operations of a function and all its callees, as written: loop bodies count once, and both sides of a branch count.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Operations {
    /// Sums, products, comparisons, clamps and similar operations on scalars or vectors.
    pub arithmetic: u32,
    /// Roots, powers, logarithms and trigonometric functions.
    pub transcendental: u32,
    /// Texture loads and samples.
    pub texture: u32,
    /// Conversions between number types.
    pub conversion: u32,
}

impl Operations {
    /// Returns the sum of all counts.
    pub fn total(self) -> u32 {
        self.arithmetic + self.transcendental + self.texture + self.conversion
    }

    fn add(&mut self, other: Self) {
        self.arithmetic += other.arithmetic;
        self.transcendental += other.transcendental;
        self.texture += other.texture;
        self.conversion += other.conversion;
    }

    /// Counts the operations of a function in plain WGSL. Returns `None` if the text is invalid or lacks a function of
    /// this name.
    pub fn of(wgsl: &str, function: &str) -> Option<Self> {
        let module = naga::front::wgsl::parse_str(wgsl).ok()?;
        let (handle, _) = module.functions.iter().find(|(_, f)| f.name.as_deref() == Some(function))?;
        Some(counted(&module, handle, &mut BTreeMap::new()))
    }
}

fn counted(module: &Module, handle: Handle<Function>, known: &mut BTreeMap<usize, Operations>) -> Operations {
    if let Some(found) = known.get(&handle.index()) {
        return *found;
    }
    let function = &module.functions[handle];
    let mut sum = Operations::default();
    for (_, expression) in function.expressions.iter() {
        match expression {
            Expression::Math { fun, .. } if is_transcendental(*fun) => sum.transcendental += 1,
            Expression::Binary { .. }
            | Expression::Unary { .. }
            | Expression::Math { .. }
            | Expression::Select { .. } => {
                sum.arithmetic += 1;
            }
            Expression::ImageSample { .. } | Expression::ImageLoad { .. } => sum.texture += 1,
            Expression::As { .. } => sum.conversion += 1,
            _ => {}
        }
    }
    let mut calls = Vec::new();
    called(&function.body, &mut calls);
    for callee in calls {
        let inner = counted(module, callee, known);
        sum.add(inner);
    }
    known.insert(handle.index(), sum);
    sum
}

fn called(block: &naga::Block, calls: &mut Vec<Handle<Function>>) {
    for statement in block.iter() {
        match statement {
            Statement::Call { function, .. } => calls.push(*function),
            Statement::Block(inner) => called(inner, calls),
            Statement::If { accept, reject, .. } => [accept, reject].into_iter().for_each(|b| called(b, calls)),
            Statement::Switch { cases, .. } => cases.iter().for_each(|case| called(&case.body, calls)),
            Statement::Loop { body, continuing, .. } => [body, continuing].into_iter().for_each(|b| called(b, calls)),
            _ => {}
        }
    }
}

fn is_transcendental(fun: MathFunction) -> bool {
    use MathFunction::{
        Acos, Acosh, Asin, Asinh, Atan, Atan2, Atanh, Cos, Cosh, Exp, Exp2, InverseSqrt, Length, Log, Log2, Normalize,
        Pow, Sin, Sinh, Sqrt, Tan, Tanh,
    };
    matches!(
        fun,
        Acos | Acosh
            | Asin
            | Asinh
            | Atan
            | Atan2
            | Atanh
            | Cos
            | Cosh
            | Exp
            | Exp2
            | InverseSqrt
            | Length
            | Log
            | Log2
            | Normalize
            | Pow
            | Sin
            | Sinh
            | Sqrt
            | Tan
            | Tanh
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_called_counts_as_often_as_it_is() {
        let text = "fn g(x: f32) -> f32 { return sqrt(x * x); }\n\
            fn f(x: f32) -> f32 { if x > 0.0 { return g(x) + g(x + 1.0); } return f32(u32(x)); }";
        let g = Operations { arithmetic: 1, transcendental: 1, ..Operations::default() };
        assert_eq!(Operations::of(text, "g"), Some(g));
        let f = Operations { arithmetic: 5, transcendental: 2, texture: 0, conversion: 2 };
        assert_eq!(Operations::of(text, "f"), Some(f));
        assert_eq!(Operations::of(text, "h"), None);
    }
}
