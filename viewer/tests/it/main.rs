//! Tests of the viewer: files, drawings, panels and the window.

mod attach;
mod changes;
mod editing;
mod grids;
mod live;
mod live_pictures;
mod panels;
mod pictures;
mod program;
mod saved;
mod sizes;
mod textures;
mod views;
mod window;

use framegraph::Caps;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;
use viewer::app::{Role, Session};
use viewer::graph_source::GraphSource;
use viewer::plan_data::PlanData;
use viewer::view::bandwidth;
use viewer::what_if::{Planner, WhatIf};

/// Graph files of the workspace.
const CASES: [&str; 7] = ["deferred", "diamond", "filament", "forward", "granite_on_tile", "mip_pyramid", "two_views"];

fn case(name: &str) -> PathBuf {
    // Tests run in the folder of their package; pictures show the path.
    Path::new("../tests/cases").join(format!("{name}.ron"))
}

/// Compiles a graph file for a device, with some features enabled.
fn planned(name: &str, caps: &Caps, on: &[&str]) -> PlanData {
    let source = GraphSource::open(&case(name)).expect("the case is sound");
    let features = on.iter().map(|feature| ((*feature).to_owned(), true)).collect();
    source.plan(&WhatIf { features, ..WhatIf::on(caps.clone()) }).expect("the case can be planned")
}

/// Opens a file in a session and waits for its plan.
fn session(path: &Path) -> Session {
    session_of(path, &[])
}

/// Opens a file in a session with some features enabled.
fn session_of(path: &Path, on: &[&str]) -> Session {
    let features = on.iter().map(|feature| ((*feature).to_owned(), true)).collect();
    let mut session = Session::new(WhatIf { features, ..WhatIf::on(Caps::tiler()) }, || {});
    session.open(path, Role::Shown);
    assert!(session.settle(Duration::from_secs(60)), "reading {} takes a minute", path.display());
    session
}

/// Returns a trace in the format of the library: a warm-up frame, and one frame that stutters.
///
/// Times are synthetic: a millisecond for every ten mebibytes that a step moves, with small variations.
fn trace_of(plan: &PlanData, frames: u64, stutter: u64) -> String {
    let named = |what: &str, pid: u32, tid: u32, name: &str| {
        format!(r#"{{"name":"{what}","ph":"M","pid":{pid},"tid":{tid},"args":{{"name":"{name}"}}}}"#)
    };
    let mut events = vec![named("process_name", 1, 0, "CPU"), named("process_name", 2, 0, "GPU")];
    events.extend([1, 2].map(|pid| named("thread_name", pid, 1, "frames")));
    let mut event = |name: &str, [pid, tid]: [u32; 2], us: f64, args: &str| {
        events.push(format!(
            r#"{{"name":"{name}","ph":"X","pid":{pid},"tid":{tid},"ts":0,"dur":{us},"args":{{{args}}}}}"#
        ));
    };
    for frame in 1..=frames {
        let slow = if frame == stutter { 3.0 } else { 1.0 + (frame * 7 % 5) as f64 / 50.0 };
        let mut sum_us = 0.0;
        for step in &plan.form.steps {
            let moved = bandwidth::of_step(plan, step).total() as f64 / f64::from(1 << 20);
            let (us, args) = ((moved * 100.0 + 10.0) * slow, format!(r#""frame":{frame}"#));
            sum_us += us;
            event(&step.passes.join(" + "), [1, 2], 10.0 * slow, &args);
            event(&step.passes.join(" + "), [2, 2], us, &args);
        }
        let warm_up = format!(r#""warm_up":{}"#, frame == 1);
        event(&format!("frame {frame}"), [1, 1], 200.0 * slow, &warm_up);
        event(&format!("frame {frame}"), [2, 1], sum_us, &warm_up);
    }
    format!("{{\"displayTimeUnit\":\"ms\",\"traceEvents\":[{}]}}", events.join(","))
}

/// Creates an empty folder for a test.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("viewer").join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).expect("a folder");
    folder
}

/// Compiles every graph file for every device.
fn plans() -> Vec<(String, Arc<PlanData>)> {
    let mut plans = Vec::new();
    for name in CASES {
        let source = GraphSource::open(&case(name)).expect("the case is sound");
        for caps in Caps::PRESETS.iter().filter_map(|name| Caps::preset(name)) {
            for on in [false, true] {
                let features = source.features().into_iter().map(|(feature, is)| (feature, is || on)).collect();
                let plan = source.plan(&WhatIf { features, ..WhatIf::on(caps.clone()) });
                // Some features of a graph exclude each other.
                plans.extend(plan.ok().map(|plan| (format!("{name} for {}, all on: {on}", caps.name), Arc::new(plan))));
            }
        }
    }
    assert!(plans.len() > 20, "only {} plans", plans.len());
    plans
}
