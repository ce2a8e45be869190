//! The numbers in `docs/render.md` match the program's output.

use crate::stage::plan;
use framegraph::{Caps, Join, Options, StepId};
use framegraph_passes::grading::Look;
use framegraph_passes::{PostSettings, Settings};
use framegraph_shaders::layout::Grading;

const README: &str = include_str!("../../../docs/render.md");

/// Returns the cells of the rows of a command's table, without the head.
fn rows(command: &str) -> Vec<Vec<&'static str>> {
    let mark = format!("<!-- table: {command} -->");
    let (_, after) = README.split_once(&mark).expect("docs/render.md has the table");
    let (table, _) = after.split_once("<!-- end -->").expect("the table ends");
    let lines = table.lines().filter(|line| line.starts_with('|'));
    let cells = |line: &'static str| line.trim_matches('|').split('|').map(str::trim).collect();
    lines.skip(2).map(cells).collect()
}

fn mebibytes(bytes: u64) -> String {
    format!("{:.2} MiB", bytes as f64 / f64::from(1 << 20))
}

#[test]
fn the_table_is_what_the_program_prints() {
    // The built-in scene under the clear sky has a sun and no blending; `render` uses four samples.
    let settings = Settings { samples: 4, ..Settings::default() };
    let plan = plan(&settings, &Caps::wgpu(), &Options::for_frame(1280, 720));
    let rows = rows("render spheres --force-effects");
    assert_eq!(rows.len(), plan.steps().len() + 1, "{rows:?}");
    for (index, row) in rows[..plan.steps().len()].iter().enumerate() {
        let step = StepId::new(index).expect("few steps");
        let names = plan.passes_of(step).iter().map(|m| {
            let name = plan.graph().pass_name(m.pass);
            if m.join == Join::Inlined { format!("({name})") } else { name.to_owned() }
        });
        let names: Vec<_> = names.collect();
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

#[test]
fn the_ways_of_post_processing_cost_what_the_program_prints() {
    let grading = Grading { contrast: 1.1, ..Grading::NEUTRAL };
    let look = Look { grading, ..Look::default() };
    let post = PostSettings { vignette_ev: 0.5, look, ..PostSettings::DEFAULT };
    let every_effect = Settings { post, ..Settings::default() };
    let (effects, hdr_bytes) = (5, 1920 * 1080 * 8);
    // Name, inlined, one pass per effect, and the number of times that a half-float picture is read.
    let ways = [
        ("inlined", true, false, 0),
        ("fused: one full-screen pass", false, false, 1),
        ("unfused: one pass per effect", false, true, effects),
    ];
    let rows = rows("render --compare-post");
    assert_eq!(rows.len(), 2 * ways.len(), "{rows:?}");
    let ways = [1, 4].into_iter().flat_map(|samples| ways.map(|way| (samples, way)));
    for (row, (samples, (name, inline, split_post, fetches))) in rows.iter().zip(ways) {
        let settings = Settings { samples, split_post, ..every_effect };
        let plan = plan(&settings, &Caps::wgpu(), &Options { inline, ..Options::for_frame(1920, 1080) });
        let (counts, traffic) = (plan.counts(), plan.traffic(plan.frame()));
        let expected = [
            name.to_owned(),
            samples.to_string(),
            counts.steps.to_string(),
            counts.unresolves.to_string(),
            counts.resolves.to_string(),
            mebibytes(traffic.loaded_bytes),
            mebibytes(traffic.stored_bytes),
            mebibytes(fetches * hdr_bytes),
        ];
        assert_eq!(row[..8], expected);
    }
}
