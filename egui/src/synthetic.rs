//! A plan of any number of passes, for tests and measurements of panels.

use crate::plan_data::PlanData;
use framegraph::{Caps, Entry, Exit, Extent, Format, Graph, Intent, Options, Plan, Scratch, TextureDesc, compile};

/// Returns the plan of a graph with `passes` + 40 passes that read earlier ones.
///
/// # Errors
/// An error of the compiler; none is known.
pub fn large(passes: usize) -> Result<PlanData, String> {
    let mut graph = Graph::new();
    let desc = |format| TextureDesc::new(Extent::FRAME, format);
    let mut screen = graph.import_texture("screen", desc(Format::Rgba8Unorm), Entry::Defined, Exit::Keep);
    let mut made = Vec::new();
    for pass in 0..passes {
        let written = graph.texture(&format!("texture {pass}"), desc(Format::R8Unorm));
        // Each pass reads its predecessor, an older pass, and every hundredth one the first pass.
        let read = [pass.checked_sub(1), pass.checked_sub(37), (pass % 100 == 99).then_some(0)];
        let read: Vec<_> = read.into_iter().flatten().filter_map(|before| made.get(before).copied()).collect();
        let declared = graph.add_fn(&format!("pass {pass}"), |builder| {
            read.into_iter().try_for_each(|texture| builder.sampled(texture).map(drop))?;
            builder.color(written, Intent::Overwrite)
        });
        made.push(declared.map_err(|e| e.to_string())?);
    }
    for last in made.iter().rev().take(40).copied().collect::<Vec<_>>() {
        let name = format!("show {}", graph.passes().len());
        let shown = graph.add_fn(&name, |builder| {
            builder.sampled(last)?;
            builder.color(screen, Intent::Modify)
        });
        screen = shown.map_err(|e| e.to_string())?;
    }
    let mut plan = Plan::new();
    compile(&graph, &Caps::desktop(), &Options::for_frame(64, 64), &mut Scratch::new(), &mut plan)
        .map_err(|e| e.to_string())?;
    PlanData::of(&plan, "large").map_err(|e| e.to_string())
}
