//! Rows and columns of a grid: filters, groups and order.

use crate::plan_data::{PlanData, Resource};
use crate::view::table::{Kind, Table};
use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet};

/// Order of the rows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Sort {
    /// Order of declaration.
    #[default]
    Declared,
    /// Name.
    Name,
    /// Size, largest first.
    Size,
    /// First use.
    FirstUse,
    /// Kind of memory, then offset.
    Placement,
}

impl Sort {
    /// All orders.
    pub const ALL: [Self; 5] = [Self::Declared, Self::Name, Self::Size, Self::FirstUse, Self::Placement];

    /// Returns the name.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Declared => "declared",
            Self::Name => "name",
            Self::Size => "size",
            Self::FirstUse => "first use",
            Self::Placement => "placement",
        }
    }
}

/// Filters, groups and order of a grid.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Options {
    /// Order of the rows.
    pub sort: Sort,
    /// Reverses the order.
    pub reversed: bool,
    /// Groups resources by the part of their names before the first `/`.
    pub grouped: bool,
    /// Closed groups.
    pub closed: BTreeSet<String>,
    /// Shows only the resources of the selected pass.
    pub of_pass: bool,
    /// Shows only raster passes and their resources.
    pub raster: bool,
    /// Shows only culled passes and their resources.
    pub culled: bool,
}

/// Row of a grid.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Row {
    /// Group of resources: name, number of resources, and whether it is open.
    Group(String, usize, bool),
    /// Resource by index.
    Resource(usize),
}

/// Returns the columns that the filters keep, by index.
pub(super) fn columns(plan: &PlanData, table: &Table, options: &Options) -> Vec<usize> {
    let kept = |column: &usize| {
        let pass = table.pass(*column).map(|pass| &plan.form.passes[pass]);
        let raster = pass.is_some_and(|pass| pass.kind == "raster");
        (!options.raster || raster) && (!options.culled || table.step(*column).is_none())
    };
    (0..table.len()).filter(kept).collect()
}

/// Returns the rows of a table whose columns are filtered. `pass` is the selected pass.
pub(super) fn rows(plan: &PlanData, table: &Table, options: &Options, pass: Option<usize>) -> Vec<Row> {
    let of_pass: Option<BTreeSet<usize>> = pass.filter(|_| options.of_pass).map(|pass| {
        let accesses = plan.form.passes[pass].accesses.iter();
        accesses.filter_map(|access| plan.resource(&access.resource)).collect()
    });
    let filtered = options.raster || options.culled;
    let used = |index: usize| match table.kind {
        Kind::Timeline => !filtered || !table.cells[index].is_empty(),
        Kind::Memory => table.spans[index].is_some(),
    };
    let mut found: Vec<usize> = (0..plan.form.resources.len())
        .filter(|index| used(*index) && of_pass.as_ref().is_none_or(|own| own.contains(index)))
        .collect();
    let row = |index: &usize| -> &Resource { &plan.form.resources[*index] };
    match options.sort {
        Sort::Declared => {}
        Sort::Name => found.sort_by(|a, b| row(a).name.cmp(&row(b).name)),
        Sort::Size => found.sort_by_key(|index| Reverse(row(index).bytes)),
        Sort::FirstUse => found.sort_by_key(|index| row(index).first_step.unwrap_or(usize::MAX)),
        Sort::Placement => found.sort_by_key(|index| (row(index).placement.clone(), row(index).offset)),
    }
    if options.reversed {
        found.reverse();
    }
    if !options.grouped {
        return found.into_iter().map(Row::Resource).collect();
    }
    // A group stands where its first resource would.
    let group_of = |index: &usize| row(index).name.split_once('/').map(|(group, _)| group.to_owned());
    let mut members: BTreeMap<String, Vec<usize>> = BTreeMap::new();
    for index in &found {
        if let Some(group) = group_of(index) {
            members.entry(group).or_default().push(*index);
        }
    }
    let mut rows = Vec::new();
    for index in found {
        match group_of(&index) {
            None => rows.push(Row::Resource(index)),
            Some(group) => {
                if let Some(members) = members.remove(&group) {
                    let open = !options.closed.contains(&group);
                    rows.push(Row::Group(group, members.len(), open));
                    rows.extend(members.into_iter().filter(|_| open).map(Row::Resource));
                }
            }
        }
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan_data::{Access, Form, Pass, Step};

    fn plan() -> PlanData {
        let resource = |name: &str, bytes, first_step| Resource {
            name: name.into(),
            bytes,
            first_step,
            last_step: first_step,
            ..Resource::default()
        };
        let pass = |name: &str, kind: &str, step, resource: &str| Pass {
            name: name.into(),
            kind: kind.into(),
            step,
            culled: step.is_none(),
            accesses: vec![Access { resource: resource.into(), mode: "write".into(), ..Access::default() }],
            ..Pass::default()
        };
        let step = |index, pass: &str| Step { index, passes: vec![pass.into()], ..Step::default() };
        let form = Form {
            passes: vec![
                pass("draw", "raster", Some(0), "b/x"),
                pass("sum", "compute", Some(1), "a"),
                pass("idle", "raster", None, "b/y"),
            ],
            steps: vec![step(0, "draw"), step(1, "sum")],
            resources: vec![resource("b/x", 1, Some(0)), resource("a", 3, Some(1)), resource("b/y", 2, None)],
            ..Form::default()
        };
        PlanData::new(form, Vec::new())
    }

    #[test]
    fn rows_are_filtered_grouped_and_sorted() {
        let plan = plan();
        let table = Table::new(&plan, Kind::Timeline);
        let of = |options: Options, pass| {
            let shown = table.with_columns(&columns(&plan, &table, &options));
            let rows = rows(&plan, &shown, &options, pass);
            let text = |row: &Row| match row {
                Row::Group(name, count, open) => format!("{name}:{count}{}", if *open { "" } else { " closed" }),
                Row::Resource(index) => plan.form.resources[*index].name.clone(),
            };
            (shown.len(), rows.iter().map(text).collect::<Vec<_>>().join(" "))
        };
        let options = Options::default;
        assert_eq!(of(options(), None), (3, "b/x a b/y".into()));
        assert_eq!(of(Options { sort: Sort::Name, ..options() }, None).1, "a b/x b/y");
        assert_eq!(of(Options { sort: Sort::Size, reversed: true, ..options() }, None).1, "b/x b/y a");
        assert_eq!(of(Options { grouped: true, ..options() }, None).1, "b:2 b/x b/y a");
        let closed = BTreeSet::from(["b".to_owned()]);
        assert_eq!(of(Options { grouped: true, closed, ..options() }, None).1, "b:2 closed a");
        assert_eq!(of(Options { raster: true, ..options() }, None), (2, "b/x b/y".into()));
        assert_eq!(of(Options { culled: true, ..options() }, None), (1, "b/y".into()));
        assert_eq!(of(Options { of_pass: true, ..options() }, Some(1)).1, "a");
        assert_eq!(of(Options { of_pass: true, ..options() }, None).1, "b/x a b/y", "no pass is selected");
    }
}
