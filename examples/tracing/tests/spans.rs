//! Spans of compilations and frames, as a subscriber sees them.

use framegraph::{Alias, ClearValue, DeclareError, Extent, Format, Intent, Options, TextureDesc};
use framegraph_wgpu::{Frame, FrameLoop, Gpu};
use serde_json::Value;
use std::error::Error;
use tracing_example::ChromeTrace;

fn declare(frame: &mut Frame) -> Result<(), DeclareError> {
    let desc = TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm);
    let mut before = None;
    for name in ["first", "second", "third"] {
        let texture = frame.graph_mut().texture(name, desc);
        let accesses = |p: &mut framegraph::PassBuilder<'_>| {
            before.map(|before| p.sampled(before)).transpose()?;
            p.color(texture, Intent::Clear(ClearValue::BLACK))
        };
        before = Some(frame.add_fn(name, accesses, |_, _, _| Ok(()))?);
    }
    before.map_or(Ok(()), |last| frame.graph_mut().export(last))
}

/// Returns the events with a name.
fn named<'v>(trace: &'v Value, name: &str) -> Vec<&'v Value> {
    trace["traceEvents"].as_array().into_iter().flatten().filter(|event| event["name"] == name).collect()
}

/// Returns begin and end in microseconds.
fn interval(event: &Value) -> Option<(f64, f64)> {
    let begin = event["ts"].as_f64()?;
    Some((begin, begin + event["dur"].as_f64()?))
}

#[test]
fn spans_have_counts_and_bytes() -> Result<(), Box<dyn Error>> {
    let trace = ChromeTrace::default();
    let guard = tracing::subscriber::set_default(trace.clone());
    let mut frames =
        FrameLoop::<()>::with(&Gpu::noop()?, Options { alias: Alias::Pool, ..Options::default() }, Default::default());
    for _ in 0..2 {
        frames.run([64, 32], &(), |frame, _| declare(frame))?;
    }
    drop(guard);
    frames.run([64, 32], &(), |frame, _| declare(frame))?;
    let json = trace.json();

    let compiled = named(&json, "compile");
    assert_eq!(compiled.len(), 1, "the second frame is unchanged");
    let bytes = 64 * 32 * 4;
    let args = &compiled[0]["args"];
    assert_eq!(
        [&args["passes"], &args["resources"], &args["steps"], &args["stores"]].map(Value::as_u64),
        [3; 4].map(Some)
    );
    assert!(args["bytes"].as_u64() >= Some(2 * bytes), "{args}");
    for phase in ["measure", "validate", "cull", "merge", "lower", "lifetimes", "operations", "memoryless", "alias"] {
        let [event] = *named(&json, phase) else { return Err(format!("no phase {phase}").into()) };
        let (outer, inner) = (interval(compiled[0]).ok_or("no time")?, interval(event).ok_or("no time")?);
        assert!(outer.0 <= inner.0 && inner.1 <= outer.1, "{phase} is inside of the compilation");
    }

    let (executed, steps, passes) = (named(&json, "frame"), named(&json, "step"), named(&json, "pass"));
    assert_eq!([executed.len(), steps.len(), passes.len()], [2, 6, 6], "the third frame has no subscriber");
    assert_eq!([named(&json, "realize").len(), named(&json, "submit").len()], [2; 2]);
    assert_eq!(executed[0]["args"]["stored_bytes"], 3 * bytes);
    assert_eq!((&executed[0]["args"]["steps"], &executed[0]["args"]["loads"]), (&3.into(), &0.into()));
    let names: Vec<_> = passes.iter().map(|pass| pass["args"]["name"].as_str()).collect();
    assert_eq!(names, ["first", "second", "third", "first", "second", "third"].map(Some));
    assert!(steps.iter().all(|step| step["args"]["kind"] == "raster" && step["args"]["stored_bytes"] == bytes));
    Ok(())
}
