//! Schedule of a plan on a device with several queues.

use crate::args::{Format, QueuesArgs};
use framegraph::Plan;
use framegraph_queues::{QueueLayout, estimate_us, replan, schedule, share_memory, svg, text};

/// Memory bandwidth for estimated costs, in bytes per microsecond: 100 GB/s, typical of mobile devices and small
/// cards.
const BYTES_PER_US: f64 = 100_000.0;

/// Returns the schedule of a frame as text or SVG; `heap` is the plan for one queue.
///
/// # Errors
/// One line that names the file of costs and the mistake in it.
pub fn shown(args: &QueuesArgs, format: Format, heap: &Plan) -> Result<String, String> {
    let plan = &replan(heap).map_err(|error| error.to_string())?;
    let costs_us = match &args.costs {
        Some(file) => costs(&file.display().to_string(), &crate::run::read(file)?, plan)?,
        None => estimate_us(plan, BYTES_PER_US),
    };
    let layout = args.layout.clone().unwrap_or_else(|| QueueLayout::of_device(plan.caps()));
    let found = schedule(plan, &layout, &costs_us).map_err(|error| error.to_string())?;
    if format == Format::Svg {
        return Ok(svg(plan, &found));
    }
    let memory = share_memory(plan, &found, plan.caps().texture_alignment_bytes.max(1));
    let alone = heap.memory();
    let by = if args.costs.is_some() { "from --costs" } else { "estimated from bytes, at 100 GB/s" };
    // Devices without placed resources share memory only between textures of equal description.
    let pool = if heap.slots().is_empty() { "" } else { " in a pool" };
    Ok(format!(
        "costs: {by}\n{}\nmemory: {} B by this schedule, {} B on one queue{pool}, {} B unaliased\n",
        text(plan, &found),
        memory.bytes(),
        alone.bytes,
        memory.unaliased_bytes
    ))
}

/// Returns the cost of each step in microseconds, summed over its passes, from lines `PASS,MICROSECONDS`.
fn costs(file: &str, text: &str, plan: &Plan) -> Result<Vec<f64>, String> {
    let mut of_passes = vec![None; plan.graph().passes().len()];
    for (number, line) in (1..).zip(text.lines()).filter(|(_, line)| !line.trim().is_empty() && !line.starts_with('#'))
    {
        let wrong = |what: String| format!("{file}:{number}: {what}; expected `PASS,MICROSECONDS`");
        let (pass, us) = line.rsplit_once(',').ok_or_else(|| wrong("missing comma".into()))?;
        let us: f64 = us.trim().parse().map_err(|_| wrong(format!("`{}` is not a number", us.trim())))?;
        if !(0.0..1e12).contains(&us) {
            return Err(wrong(format!("{us} is out of range (0 to 1e12)")));
        }
        let pass = pass.trim();
        let known = plan.graph().find_pass(pass).ok_or_else(|| wrong(format!("unknown pass `{pass}`")))?;
        of_passes[known.index()] = Some(us);
    }
    let of_step = |step| {
        let own = plan.passes_of(step).iter().map(|member| {
            let name = plan.graph().pass_name(member.pass);
            of_passes[member.pass.index()]
                .ok_or_else(|| format!("{file}: missing cost of pass `{name}`; add a line `{name},MICROSECONDS`"))
        });
        own.sum::<Result<f64, String>>()
    };
    plan.step_ids().map(of_step).collect()
}

/// Returns the queue layout of a name; `None` for `device`, the layout of the device itself.
///
/// # Errors
/// One line that lists the valid names.
pub fn layout(name: &str) -> Result<Option<QueueLayout>, String> {
    let found = QueueLayout::named(name).map(Some).or_else(|| (name == "device").then_some(None));
    found.ok_or_else(|| format!("--queues: invalid value `{name}`; expected device, {}", QueueLayout::NAMES.join(", ")))
}
