//! Creates mutants with a single change.

use framegraph::internals::{PlanArrays, arrays};
use framegraph::plan::Plan;

/// A plan with a single change.
#[derive(Debug)]
pub struct Mutant {
    /// The changed field.
    pub field: &'static str,
    /// The row of the field's array.
    pub row: usize,
    /// The changed plan.
    pub plan: Plan,
}

/// A change of one row, with the name of the field.
pub(super) type Edit<T> = (&'static str, fn(&mut T));

/// Creates the mutants of one plan.
pub(super) struct Mutator<'a> {
    pub(super) plan: &'a Plan,
    pub(super) visit: &'a mut dyn FnMut(Mutant),
}

impl Mutator<'_> {
    /// Visits the plan with one change.
    pub(super) fn with(&mut self, field: &'static str, row: usize, edit: impl FnOnce(&mut PlanArrays<'_>)) {
        let mut plan = self.plan.clone();
        edit(&mut arrays(&mut plan));
        (self.visit)(Mutant { field, row, plan });
    }
}
