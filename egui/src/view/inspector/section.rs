//! Text lines under headings.

use crate::drawing::Item;
use crate::plan_data::Decision;

/// Line of a section.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Line {
    /// Plain sentence.
    Plain(String),
    /// Hint about the change that would alter a decision.
    Hint(String),
    /// Source location as `PATH:LINE`.
    Source(String),
    /// Link to an item.
    Link(Item, String),
}

/// Lines under a heading.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Section {
    /// Heading.
    pub title: String,
    /// Lines.
    pub lines: Vec<Line>,
}

impl Section {
    pub(super) fn new(title: impl Into<String>) -> Self {
        Self { title: title.into(), lines: Vec::new() }
    }

    pub(super) fn say(&mut self, line: impl Into<String>) {
        self.lines.push(Line::Plain(line.into()));
    }

    pub(super) fn link(&mut self, item: Item, line: impl Into<String>) {
        self.lines.push(Line::Link(item, line.into()));
    }

    /// Adds a decision with its hint.
    pub(super) fn decide(&mut self, decision: &Decision) {
        let refused = decision.refusal.as_ref().map(|why| format!(" [{why}]")).unwrap_or_default();
        self.say(format!("{}{refused}", decision.sentence));
        self.lines.extend(decision.hint.clone().map(Line::Hint));
    }
}
