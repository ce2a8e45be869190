//! Undo and redo of one value.

/// Maximum number of undo steps.
const KEPT: usize = 200;

/// Value with its undo and redo states.
#[derive(Clone, Debug, Default)]
pub struct History<T> {
    now: T,
    before: Vec<T>,
    after: Vec<T>,
    /// State before an unfinished change, such as a slider being dragged.
    held: Option<T>,
}

impl<T: Clone + PartialEq> History<T> {
    /// Creates a history without undo steps.
    pub fn new(now: T) -> Self {
        Self { now, before: Vec::new(), after: Vec::new(), held: None }
    }

    /// Returns the current value.
    pub fn now(&self) -> &T {
        &self.now
    }

    /// Changes the value. While `going_on` is set, further changes belong to the same undo step.
    pub fn set(&mut self, value: T, going_on: bool) {
        if value != self.now {
            let before = std::mem::replace(&mut self.now, value);
            self.held.get_or_insert(before);
        }
        if !going_on {
            self.finish();
        }
    }

    /// Completes an unfinished change.
    pub fn finish(&mut self) {
        if let Some(before) = self.held.take().filter(|before| *before != self.now) {
            self.before.push(before);
            self.after.clear();
            let more = self.before.len().saturating_sub(KEPT);
            self.before.drain(..more);
        }
    }

    /// Undoes the last step; returns false if none exists.
    pub fn undo(&mut self) -> bool {
        self.finish();
        let Some(value) = self.before.pop() else { return false };
        self.after.push(std::mem::replace(&mut self.now, value));
        true
    }

    /// Redoes the last undone step; returns false if none exists.
    pub fn redo(&mut self) -> bool {
        self.finish();
        let Some(value) = self.after.pop() else { return false };
        self.before.push(std::mem::replace(&mut self.now, value));
        true
    }

    /// Returns the number of steps that can be undone and redone.
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
        // A drag that returns to its start is no step.
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
