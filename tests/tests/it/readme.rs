//! The numbers in the README are those that the program prints.

use crate::stage::plan;
use framegraph::{Caps, Options, StepId};
use passes::Settings;

const README: &str = include_str!("../../../README.md");

/// The cells of the table's rows, without the head.
fn rows() -> Vec<Vec<&'static str>> {
    let (_, after) = README.split_once("<!-- table: render spheres -->").expect("the README has the table");
    let (table, _) = after.split_once("<!-- end -->").expect("the table ends");
    let lines = table.lines().filter(|line| line.starts_with('|'));
    let cells = |line: &'static str| line.trim_matches('|').split('|').map(str::trim).collect();
    lines.skip(2).map(cells).collect()
}

#[test]
fn the_table_is_what_the_program_prints() {
    // The built-in scene under the clear sky has a sun and nothing that blends; `render` takes four samples.
    let settings = Settings { samples: 4, ..Settings::default() };
    let plan = plan(&settings, &Caps::wgpu(), &Options::for_frame(1280, 720));
    let mebibytes = |bytes: u64| format!("{:.2} MiB", bytes as f64 / f64::from(1 << 20));
    let rows = rows();
    assert_eq!(rows.len(), plan.steps().len() + 1, "{rows:?}");
    for (index, row) in rows[..plan.steps().len()].iter().enumerate() {
        let step = StepId::new(index).expect("few steps");
        let names: Vec<_> = plan.passes_of(step).iter().map(|m| plan.graph().pass_name(m.pass)).collect();
        let (counts, traffic) = (plan.step_counts(step), plan.step_traffic(step, plan.frame()));
        let expected = [
            index.to_string(),
            names.join(" + "),
            counts.unresolves.to_string(),
            counts.resolves.to_string(),
            mebibytes(traffic.loaded_bytes),
            mebibytes(traffic.stored_bytes),
        ];
        assert_eq!(row[..6], expected, "row {index}");
    }
    let (counts, traffic) = (plan.counts(), plan.traffic(plan.frame()));
    let total = rows.last().expect("there is a last row");
    let expected = [
        "total".to_owned(),
        format!("{} passes, {} culled, {} memoryless", counts.passes, counts.culled, counts.memoryless),
        counts.unresolves.to_string(),
        counts.resolves.to_string(),
        mebibytes(traffic.loaded_bytes),
        mebibytes(traffic.stored_bytes),
    ];
    assert_eq!(total[..6], expected);
}
