//! One change at a time.

use crate::plan::Plan;

/// One broken plan.
#[derive(Debug)]
pub struct Mutant {
    /// Which field was changed.
    pub field: &'static str,
    /// The row of the field's array.
    pub row: usize,
    /// The plan with that one change.
    pub plan: Plan,
}

/// A change of one row, with the field's name.
pub(super) type Edit<T> = (&'static str, fn(&mut T));

/// Makes the mutants of one plan.
pub(super) struct Mutator<'a> {
    pub(super) plan: &'a Plan,
    pub(super) visit: &'a mut dyn FnMut(Mutant),
}

impl Mutator<'_> {
    /// The plan with one change.
    pub(super) fn with(&mut self, field: &'static str, row: usize, edit: impl FnOnce(&mut Plan)) {
        let mut plan = self.plan.clone();
        plan.number();
        edit(&mut plan);
        (self.visit)(Mutant { field, row, plan });
    }
}
