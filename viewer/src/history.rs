//! Undo and redo of one value.

/// States that are kept; older ones make way.
const KEPT: usize = 200;

/// A value with the states before it and, after an undo, those after it.
#[derive(Clone, Debug, Default)]
pub struct History<T> {
    now: T,
    before: Vec<T>,
    after: Vec<T>,
    /// The state before a change that is not finished, as while a slider is dragged.
    held: Option<T>,
}

impl<T: Clone + PartialEq> History<T> {
    /// A value that nothing was done to.
    pub fn new(now: T) -> Self {
        Self { now, before: Vec::new(), after: Vec::new(), held: None }
    }

    /// The value.
    pub fn now(&self) -> &T {
        &self.now
    }

    /// Changes the value. As long as `going_on`, further changes are part of the same step.
    pub fn set(&mut self, value: T, going_on: bool) {
        if value != self.now {
            let before = std::mem::replace(&mut self.now, value);
            self.held.get_or_insert(before);
        }
        if !going_on {
            self.finish();
        }
    }

    /// Ends a change that went on.
    pub fn finish(&mut self) {
        if let Some(before) = self.held.take().filter(|before| *before != self.now) {
            self.before.push(before);
            self.after.clear();
            let more = self.before.len().saturating_sub(KEPT);
            self.before.drain(..more);
        }
    }

    /// Takes the last step back; false where there is none.
    pub fn undo(&mut self) -> bool {
        self.finish();
        let Some(value) = self.before.pop() else { return false };
        self.after.push(std::mem::replace(&mut self.now, value));
        true
    }

    /// Does again what was taken back; false where nothing was.
    pub fn redo(&mut self) -> bool {
        self.finish();
        let Some(value) = self.after.pop() else { return false };
        self.before.push(std::mem::replace(&mut self.now, value));
        true
    }

    /// How many steps can be taken back, and done again.
    pub fn steps(&self) -> [usize; 2] {
        [self.before.len() + usize::from(self.held.is_some()), self.after.len()]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_drag_is_one_step_and_a_change_forgets_what_was_undone() {
        let mut history = History::new(0);
        for value in 1..=5 {
            history.set(value, true);
        }
        history.set(5, false);
        history.set(9, false);
        assert_eq!((*history.now(), history.steps()), (9, [2, 0]));
        assert!(history.undo() && *history.now() == 5 && history.undo() && *history.now() == 0 && !history.undo());
        assert!(history.redo() && *history.now() == 5);
        history.set(5, false);
        assert_eq!(history.steps(), [1, 1], "nothing was changed");
        history.set(7, false);
        assert_eq!((history.redo(), *history.now(), history.steps()), (false, 7, [2, 0]));
        // A drag that ends where it began is none.
        history.set(8, true);
        history.set(7, false);
        assert_eq!(history.steps(), [2, 0]);
    }

    #[test]
    fn old_steps_make_way() {
        let mut history = History::new(0);
        (1..=3 * KEPT).for_each(|value| history.set(value, false));
        assert_eq!(history.steps(), [KEPT, 0]);
    }
}
