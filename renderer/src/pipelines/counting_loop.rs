//! Detection of counting loops, and analysis of the statements of a block.

use wgpu::naga::{
    BinaryOperator, Block, Expression, Function, Handle, Literal, LocalVariable, Module, Range, Statement,
};

/// A loop that runs while a local variable is below a bound. Each iteration adds a constant to the variable at its end,
/// and nothing else stores to it.
#[derive(Clone, Copy, Debug)]
pub(super) struct CountingLoop {
    pub(super) bound: Handle<Expression>,
    /// True if the loop also runs when the counter equals the bound.
    pub(super) equal: bool,
    /// Increment per iteration, at least 1.
    pub(super) step: i64,
}

impl CountingLoop {
    /// Returns the counting loop with this body and continuing block, or `None` if it is another kind of loop.
    pub(super) fn find(module: &Module, function: &Function, body: &Block, continuing: &Block) -> Option<Self> {
        let tested = body.iter().find(|statement| !matches!(statement, Statement::Emit(_)))?;
        let Statement::If { condition, accept, reject } = tested else { return None };
        if !accept.is_empty() || !matches!(reject.iter().next(), Some(Statement::Break)) {
            return None;
        }
        let Expression::Binary { op, left, right } = function.expressions[*condition] else { return None };
        let (read, bound, equal) = match op {
            BinaryOperator::Less => (left, right, false),
            BinaryOperator::LessEqual => (left, right, true),
            BinaryOperator::Greater => (right, left, false),
            BinaryOperator::GreaterEqual => (right, left, true),
            _ => return None,
        };
        // The counter must be loaded in this iteration, not before the loop.
        let counter = loaded(function, read).filter(|_| is_emitted(body, read))?;
        let step = continuing.iter().find_map(|statement| step(module, function, counter, statement, continuing))?;
        // The counter must be stored once in the continuing block, and nowhere else.
        let stores = |block| changed(function, block).into_iter().filter(|variable| *variable == counter).count();
        (stores(body) == 0 && stores(continuing) == 1).then_some(Self { bound, equal, step })
    }
}

/// Returns the positive constant that a statement adds to the counter.
fn step(
    module: &Module,
    function: &Function,
    counter: Handle<LocalVariable>,
    statement: &Statement,
    continuing: &Block,
) -> Option<i64> {
    let Statement::Store { pointer, value } = statement else { return None };
    let Expression::Binary { op: BinaryOperator::Add, left, right } = function.expressions[*value] else { return None };
    let step = whole(number(module, function, right)?)?;
    let from_itself = loaded(function, left) == Some(counter) && is_emitted(continuing, left);
    (root(function, *pointer) == Some(counter) && from_itself && step > 0).then_some(step)
}

/// Returns the local variable that an expression loads.
fn loaded(function: &Function, value: Handle<Expression>) -> Option<Handle<LocalVariable>> {
    let Expression::Load { pointer } = function.expressions[value] else { return None };
    match function.expressions[pointer] {
        Expression::LocalVariable(variable) => Some(variable),
        _ => None,
    }
}

/// Returns the value of a literal or constant.
pub(super) fn number(module: &Module, function: &Function, value: Handle<Expression>) -> Option<Literal> {
    match function.expressions[value] {
        Expression::Literal(literal) => Some(literal),
        Expression::Constant(constant) => match module.global_expressions[module.constants[constant].init] {
            Expression::Literal(literal) => Some(literal),
            _ => None,
        },
        _ => None,
    }
}

/// Returns the value of a 32-bit integer literal.
pub(super) fn whole(literal: Literal) -> Option<i64> {
    match literal {
        Literal::U32(number) => Some(number.into()),
        Literal::I32(number) => Some(number.into()),
        _ => None,
    }
}

/// Returns whether a block itself evaluates an expression.
fn is_emitted(block: &Block, value: Handle<Expression>) -> bool {
    let emits = |range: &Range<Expression>| range.clone().any(|own| own == value);
    block.iter().any(|statement| matches!(statement, Statement::Emit(range) if emits(range)))
}

/// Returns the local variable that a pointer refers to.
pub(super) fn root(function: &Function, pointer: Handle<Expression>) -> Option<Handle<LocalVariable>> {
    match function.expressions[pointer] {
        Expression::LocalVariable(variable) => Some(variable),
        Expression::Access { base, .. } | Expression::AccessIndex { base, .. } => root(function, base),
        _ => None,
    }
}

/// Returns the local variables that a block may change, once per statement.
pub(super) fn changed(function: &Function, block: &Block) -> Vec<Handle<LocalVariable>> {
    let of = |statement: &Statement| match statement {
        Statement::Store { pointer, .. } => root(function, *pointer).into_iter().collect(),
        Statement::Call { arguments, .. } => arguments.iter().filter_map(|a| root(function, *a)).collect(),
        Statement::Block(inner) => changed(function, inner),
        Statement::If { accept, reject, .. } => [accept, reject].map(|own| changed(function, own)).concat(),
        Statement::Switch { cases, .. } => cases.iter().flat_map(|case| changed(function, &case.body)).collect(),
        Statement::Loop { body, continuing, .. } => [body, continuing].map(|own| changed(function, own)).concat(),
        _ => Vec::new(),
    };
    block.iter().flat_map(of).collect()
}
