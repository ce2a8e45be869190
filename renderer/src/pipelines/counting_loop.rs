//! Loops that count, and what else is asked of statements: what a block changes, and what it works out itself.

use wgpu::naga::{BinaryOperator, Block, Expression, Function, Handle, Literal, LocalVariable, Module, Statement};

/// A loop that goes on while a local variable is less than a bound, to which each turn adds a number at its end and nothing else
/// stores.
#[derive(Clone, Copy, Debug)]
pub(super) struct CountingLoop {
    pub(super) counter: Handle<LocalVariable>,
    pub(super) bound: Handle<Expression>,
    /// It goes on where the counter is the bound, too.
    pub(super) equal: bool,
    /// What is added, from 1.
    pub(super) step: i64,
}

impl CountingLoop {
    /// That of a body and what continues it; none where it is no such loop.
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
        // As it is in this turn, not as it was once.
        let counter = loaded(function, read).filter(|_| is_emitted(body, read))?;
        let step = continuing.iter().find_map(|statement| step(module, function, counter, statement, continuing))?;
        // One store at the end of a turn, and none elsewhere.
        let stores = |block| changed(function, block).into_iter().filter(|variable| *variable == counter).count();
        (stores(body) == 0 && stores(continuing) == 1).then_some(Self { counter, bound, equal, step })
    }
}

/// By how much a statement makes a whole number go up, from 1.
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

/// The local variable whose value an expression is.
fn loaded(function: &Function, value: Handle<Expression>) -> Option<Handle<LocalVariable>> {
    let Expression::Load { pointer } = function.expressions[value] else { return None };
    match function.expressions[pointer] {
        Expression::LocalVariable(variable) => Some(variable),
        _ => None,
    }
}

/// A number that is written in the text.
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

/// A whole number of 32 bits.
pub(super) fn whole(literal: Literal) -> Option<i64> {
    match literal {
        Literal::U32(number) => Some(number.into()),
        Literal::I32(number) => Some(number.into()),
        _ => None,
    }
}

/// Whether a value is worked out in a block itself, each time it is run.
fn is_emitted(block: &Block, value: Handle<Expression>) -> bool {
    let emits = |range: &wgpu::naga::Range<Expression>| range.clone().any(|own| own == value);
    block.iter().any(|statement| matches!(statement, Statement::Emit(range) if emits(range)))
}

/// The local variable into which a pointer points.
pub(super) fn root(function: &Function, pointer: Handle<Expression>) -> Option<Handle<LocalVariable>> {
    match function.expressions[pointer] {
        Expression::LocalVariable(variable) => Some(variable),
        Expression::Access { base, .. } | Expression::AccessIndex { base, .. } => root(function, base),
        _ => None,
    }
}

/// The local variables that a block may change, once for each statement that may.
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
