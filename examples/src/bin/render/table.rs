//! Main table of a run: each step with its passes, memory traffic and times.

use framegraph::{Alias, Join, Plan, StepId};
use framegraph_passes::feature_culling::{Cost, Decision, Facts, Saved};
use framegraph_wgpu::{Executor, Summary, Times, Timing};

/// Formats one line per step, then the totals. Times are medians in milliseconds.
pub fn table(plan: &Plan, timing: &Timing) -> String {
    let mut rows =
        vec![["step", "passes", "loads", "stores", "loaded", "stored", "CPU ms", "GPU ms"].map(String::from)];
    rows.extend(plan.step_ids().map(|step| row(plan, step, timing.step(step))));
    let (counts, traffic) = (plan.counts(), plan.traffic(plan.frame()));
    let Times { cpu, gpu } = timing.frame();
    rows.push([
        "total".into(),
        format!("{} passes, {} culled, {} memoryless", counts.passes, counts.culled, counts.memoryless),
        counts.unresolves.to_string(),
        counts.resolves.to_string(),
        mebibytes(traffic.loaded_bytes),
        mebibytes(traffic.stored_bytes),
        milliseconds(cpu),
        milliseconds(gpu),
    ]);
    aligned(&rows, 2)
}

/// Formats the memory that the driver allocated for textures and buffers with `--alias heap`.
pub fn memory(plan: &Plan, executor: &Executor) -> String {
    if plan.options().alias != Alias::Heap {
        return String::new();
    }
    let allocated = executor.allocated();
    let block = match executor.not_placed() {
        Some(why) => format!("--alias heap: {why}; textures of equal description share memory instead"),
        None => format!(
            "in one block: {} allocated, {} without placement",
            mebibytes(allocated.placed),
            mebibytes(allocated.unshared)
        ),
    };
    format!("{block}; wgpu allocated {}\n", mebibytes(allocated.by_wgpu))
}

fn row(plan: &Plan, step: StepId, times: Times) -> [String; 8] {
    let names = plan.passes_of(step).iter().map(|member| {
        let name = plan.graph().pass_name(member.pass);
        match member.join {
            Join::Inlined => format!("({name})"),
            Join::Resolve => format!("{name} (resolve)"),
            _ => name.to_owned(),
        }
    });
    let (counts, traffic) = (plan.step_counts(step), plan.step_traffic(step, plan.frame()));
    [
        step.index().to_string(),
        names.collect::<Vec<_>>().join(" + "),
        counts.unresolves.to_string(),
        counts.resolves.to_string(),
        mebibytes(traffic.loaded_bytes),
        mebibytes(traffic.stored_bytes),
        milliseconds(times.cpu),
        milliseconds(times.gpu),
    ]
}

/// Formats the dropped effects, one line each: effect, class of the proof, reason and savings.
pub fn facts_table(facts: &Facts, saved: &[Saved]) -> String {
    let mut rows = vec![["dropped", "class", "why", "passes", "moved", "memory"].map(String::from)];
    for row in facts.rows.iter().filter(|row| row.decision == Decision::Dropped) {
        let own = saved.iter().find(|saved| saved.effect == row.effect);
        let less = |of: fn(&Cost) -> u64| own.map_or(0, |s| of(&s.with).saturating_sub(of(&s.without)));
        rows.push([
            row.effect.name().into(),
            row.proof.class().into(),
            row.reason.clone(),
            less(|cost| cost.passes.into()).to_string(),
            mebibytes(less(|cost| cost.moved_bytes)),
            mebibytes(less(|cost| cost.memory_bytes)),
        ]);
    }
    for (proof, reason) in &facts.always {
        rows.push(["-".into(), proof.class().into(), reason.clone(), "0".into(), mebibytes(0), mebibytes(0)]);
    }
    if rows.len() == 1 { String::new() } else { format!("\n{}", aligned(&rows, 3)) }
}

/// Formats bytes in MiB.
pub fn mebibytes(bytes: u64) -> String {
    format!("{:.2} MiB", bytes as f64 / f64::from(1 << 20))
}

/// Formats the median; a dash without measurements.
pub fn milliseconds(times: Option<Summary>) -> String {
    times.map_or("-".into(), |t| format!("{:.2}", t.median_ms))
}

/// Formats aligned columns under a header row. The first `words` columns are left-aligned, the others right-aligned.
pub fn aligned<const N: usize>(rows: &[[String; N]], words: usize) -> String {
    let width = |column: usize| rows.iter().map(|r| r[column].chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..N).map(width).collect();
    let mut out = String::new();
    for (index, row) in rows.iter().enumerate() {
        let cell = |(column, text): (usize, &String)| match column {
            c if c < words => format!("{text:<0$}", widths[column]),
            _ => format!("{text:>0$}", widths[column]),
        };
        let line: Vec<String> = row.iter().enumerate().map(cell).collect();
        out += &format!("| {} |\n", line.join(" | "));
        if index == 0 {
            let rule = |w: &usize| "-".repeat(*w);
            out += &format!("| {} |\n", widths.iter().map(rule).collect::<Vec<_>>().join(" | "));
        }
    }
    out
}
