//! The decision log indexed by subject.

use crate::decision::{Decision, Reason, Subject};
use crate::plan::Plan;

/// The log of a plan, sorted by subject. Decisions about one subject keep their order.
#[derive(Debug)]
pub(crate) struct Reasons {
    rows: Vec<(Key, Reason)>,
}

type Key = (u8, usize, usize);

fn key(subject: Subject) -> Key {
    match subject {
        Subject::Pass(pass) => (0, pass.index(), 0),
        Subject::Load(step, resource) => (1, step.index(), resource.index()),
        Subject::Store(step, resource) => (2, step.index(), resource.index()),
        Subject::Resource(resource) => (3, resource.index(), 0),
    }
}

impl Reasons {
    pub(crate) fn new(plan: &Plan) -> Self {
        let row = |d: &Decision| (key(d.subject), d.reason);
        let mut rows: Vec<_> = plan.decisions().iter().map(row).collect();
        rows.sort_by_key(|(key, _)| *key);
        Self { rows }
    }

    /// The reasons for one subject, in the order of the log.
    pub(crate) fn of(&self, subject: Subject) -> impl Iterator<Item = Reason> + '_ {
        let key = key(subject);
        let first = self.rows.partition_point(|(k, _)| *k < key);
        let rows = self.rows[first..].iter();
        rows.take_while(move |(k, _)| *k == key).map(|(_, r)| *r)
    }

    /// Returns the sentence of the first reason for a subject; empty if there is none.
    pub(crate) fn sentence(&self, plan: &Plan, subject: Subject) -> String {
        let reason = self.of(subject).next();
        reason.map(|r| r.sentence(plan.graph())).unwrap_or_default()
    }
}
