//! Resources over passes or steps as a sparse table, for the timeline and the memory table.

use super::heads::{self, Column};
use crate::drawing::Drawing;
use crate::plan_data::{Attachment, PlanData};
use std::collections::BTreeMap;
use std::ops::Range;

/// Content of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Kind {
    /// Accesses of each pass.
    Timeline,
    /// Memory held from step to step.
    Memory,
}

/// Use of a resource in a column.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Cell {
    /// Reads, modifies, writes.
    pub accesses: [bool; 3],
    /// Load operation, in the first column of a step.
    pub load: Option<&'static str>,
    /// Store operation, in the last column of a step.
    pub store: Option<&'static str>,
    /// True if an attachment of the step uses the resource.
    pub attached: bool,
}

/// Sparse table.
#[derive(Clone, Debug)]
pub struct Table {
    /// Content.
    pub kind: Kind,
    /// Columns: passes by step, then culled passes; or steps.
    pub(super) columns: Vec<Column>,
    /// First and last column of the lifetime of each resource.
    pub spans: Vec<Option<[usize; 2]>>,
    /// Uses of each resource by column.
    pub cells: Vec<BTreeMap<usize, Cell>>,
}

impl Table {
    /// Creates the table of a plan.
    pub fn new(plan: &PlanData, kind: Kind) -> Self {
        let columns = match kind {
            Kind::Timeline => heads::columns(plan),
            Kind::Memory => heads::steps(plan),
        };
        let mut of_step = vec![[usize::MAX, 0]; plan.form.steps.len()];
        for (index, column) in columns.iter().enumerate() {
            if let Some([first, last]) = column.step.map(|step| &mut of_step[step]) {
                (*first, *last) = ((*first).min(index), index);
            }
        }
        let span = |steps: Option<[usize; 2]>| {
            let [first, last] = steps?;
            Some([of_step.get(first)?[0], of_step.get(last)?[1]]).filter(|[first, last]| first <= last)
        };
        let spans = plan.form.resources.iter().map(|resource| match kind {
            Kind::Timeline => span(resource.first_step.zip(resource.last_step).map(<[usize; 2]>::from)),
            Kind::Memory => span(resource.held_steps),
        });
        let spans = spans.collect();
        let mut cells = vec![BTreeMap::new(); plan.form.resources.len()];
        if kind == Kind::Timeline {
            accesses(plan, &columns, &mut cells);
            attachments(plan, &of_step, &mut cells);
        }
        Self { kind, columns, spans, cells }
    }

    /// Returns the number of columns.
    pub fn len(&self) -> usize {
        self.columns.len()
    }

    /// Returns whether the table has no columns.
    pub fn is_empty(&self) -> bool {
        self.columns.is_empty()
    }

    /// Returns the pass of a column.
    pub fn pass(&self, column: usize) -> Option<usize> {
        self.columns.get(column).map(|column| column.pass)
    }

    /// Returns the step of a column; `None` for a culled pass.
    pub fn step(&self, column: usize) -> Option<usize> {
        self.columns.get(column).and_then(|column| column.step)
    }

    /// Returns the height of the names and step brackets of the columns.
    pub fn heads_height(&self, plan: &PlanData) -> f32 {
        heads::height(plan, &self.columns)
    }

    /// Draws names and step brackets of some columns of a width, with the first column at `x`, ending at `bottom`.
    pub fn heads(&self, plan: &PlanData, range: Range<usize>, drawing: &mut Drawing, at: [f32; 2], width: f32) {
        heads::draw(plan, &self.columns, range, drawing, at, width);
    }

    /// Returns the table with some of its columns, in the given order.
    #[must_use]
    pub fn with_columns(&self, kept: &[usize]) -> Self {
        let columns: Vec<Column> = kept.iter().map(|column| self.columns[*column].clone()).collect();
        let new: BTreeMap<usize, usize> = kept.iter().enumerate().map(|(new, old)| (*old, new)).collect();
        let span = |span: &Option<[usize; 2]>| {
            let [first, last] = (*span)?;
            let within = || new.range(first..=last).map(|(_, new)| *new);
            Some([within().min()?, within().max()?])
        };
        let cells = |cells: &BTreeMap<usize, Cell>| {
            cells.iter().filter_map(|(old, cell)| Some((*new.get(old)?, cell.clone()))).collect()
        };
        Self {
            kind: self.kind,
            columns,
            spans: self.spans.iter().map(span).collect(),
            cells: self.cells.iter().map(cells).collect(),
        }
    }
}

fn accesses(plan: &PlanData, columns: &[Column], cells: &mut [BTreeMap<usize, Cell>]) {
    for (index, column) in columns.iter().enumerate().filter(|(_, column)| !column.resolve) {
        for access in &plan.form.passes[column.pass].accesses {
            let Some(resource) = plan.resource(&access.resource) else { continue };
            let [read, modify, write] = &mut cells[resource].entry(index).or_default().accesses;
            match access.mode.as_str() {
                "read" => *read = true,
                "modify" => *modify = true,
                _ => *write = true,
            }
        }
    }
}

fn attachments(plan: &PlanData, of_step: &[[usize; 2]], cells: &mut [BTreeMap<usize, Cell>]) {
    for (step, [first, last]) in plan.form.steps.iter().zip(of_step).filter(|(_, [first, last])| first <= last) {
        let mut of: BTreeMap<usize, Vec<&Attachment>> = BTreeMap::new();
        for attachment in &step.attachments {
            of.entry(plan.resource(&attachment.resource).unwrap_or(usize::MAX)).or_default().push(attachment);
        }
        for (resource, attached) in of {
            let Some(cells) = cells.get_mut(resource) else { continue };
            for column in *first..=*last {
                cells.entry(column).or_default().attached = true;
            }
            // The most expensive operation of several levels or layers is shown.
            let load = attached.iter().max_by_key(|a| ["clear", "load"].iter().position(|op| *op == a.load));
            if let Some(load) = load.filter(|a| !a.role.starts_with("resolve")) {
                let load = match load.load.as_str() {
                    "load" => "load",
                    "clear" => "clear",
                    _ => "dont_care",
                };
                cells.entry(*first).or_default().load = Some(load);
            }
            let store = attached.iter().max_by_key(|a| ["discard", "store"].iter().position(|op| *op == a.store));
            if let Some(store) = store {
                let store = match store.store.as_str() {
                    "store" if store.role.starts_with("resolve") => "multisample",
                    "store" => "store",
                    "discard" => "discard",
                    _ => "none",
                };
                cells.entry(*last).or_default().store = Some(store);
            }
        }
    }
}
