//! Drawings of the views.

use crate::{planned, plans, trace_of};
use framegraph::Caps;
use viewer::drawing::{Align, Drawing, Item, LINE, Shape, Theme, svg, text_width};
use viewer::standard_frame::StandardFrame;
use viewer::trace_data::{quartiles, read};
use viewer::view::{View, ViewContext, bandwidth, drawing, graph, inspector};
use viewer::what_if::{Planner, WhatIf};

/// Returns the bounds of each horizontal text.
fn texts(drawing: &Drawing) -> Vec<([f32; 4], &str)> {
    let text = |shape| match shape {
        &Shape::Text { at: [x, y], size, align, turned: 0.0, ref text, .. } => {
            let width = text_width(text, size);
            let left = match align {
                Align::Left => x,
                Align::Center => x - width / 2.0,
                Align::Right => x - width,
            };
            // Glyphs are lower than their lines.
            let half = size * LINE * 0.36;
            Some(([left, y - half, left + width, y + half], text.as_str()))
        }
        _ => None,
    };
    drawing.shapes.iter().filter_map(text).collect()
}

/// Returns the first overlapping or clipped text.
fn clash(drawing: &Drawing) -> Option<String> {
    let texts = texts(drawing);
    for (index, (a, first)) in texts.iter().enumerate() {
        if a[0] < -0.5 || a[1] < -1.0 || a[2] > drawing.size[0] + 1.0 || a[3] > drawing.size[1] + 1.0 {
            return Some(format!("`{first}` at {a:?} is outside of {:?}", drawing.size));
        }
        let over = |b: &[f32; 4]| a[0] < b[2] - 0.5 && b[0] < a[2] - 0.5 && a[1] < b[3] && b[1] < a[3];
        if let Some((b, second)) = texts[..index].iter().find(|(b, _)| over(b)) {
            return Some(format!("`{first}` at {a:?} lies over `{second}` at {b:?}"));
        }
    }
    None
}

#[test]
fn no_words_lie_over_others_in_any_view_of_any_plan() {
    let plans = plans();
    for (name, plan) in &plans {
        for view in View::ALL {
            let beside = ViewContext { against: Some(&plans[0].1), ..ViewContext::default() };
            let drawing = drawing(view, plan, beside, 60);
            if let Some(clash) = clash(&drawing) {
                panic!("{name}, {view:?}: {clash}");
            }
            let text = svg(&drawing, Theme::Dark);
            assert!(text.starts_with("<svg ") && text.ends_with("</svg>\n"));
        }
    }
    // Negative control: overlapping text is detected.
    let mut bad = Drawing::default();
    bad.text([0.0, 10.0], 12.0, viewer::drawing::Ink::Text, "one");
    bad.text([10.0, 12.0], 12.0, viewer::drawing::Ink::Text, "two");
    assert!(clash(&bad).is_some());
}

#[test]
fn the_graph_has_every_pass_and_lights_the_way_of_a_resource() {
    for (name, plan) in &plans() {
        let drawing = graph::drawing(plan, None);
        for (index, pass) in plan.form.passes.iter().enumerate() {
            assert!(drawing.hits.iter().any(|hit| hit.item == Some(Item::Pass(index))), "{name}: {}", pass.name);
        }
    }
    let plan = planned("filament", &Caps::tiler(), &["shadows"]);
    let shadow = plan.resource("shadow").expect("a resource");
    let lit = graph::lit(&plan, Item::Resource(shadow));
    let passes = ["shadow/0", "shadow/1", "shadow/2", "shadow/3", "color"];
    for name in passes {
        assert!(lit.contains(&Item::Pass(plan.pass(name).expect("a pass"))), "{name}");
    }
    assert_eq!(lit.len(), 1 + passes.len());
    let drawing = graph::drawing(&plan, None);
    let marked = drawing.marks.iter().filter(|(_, item)| *item == Item::Resource(shadow)).count();
    assert_eq!(marked, 4, "a line from each shadow pass to the color pass");
}

#[test]
fn a_culled_pass_says_why() {
    let text = r#"(version: 1, name: "small", resources: [
        Texture(name: "screen", format: Rgba8Unorm, kind: Import(entry: Undefined, exit: Keep)),
        Texture(name: "hdr", format: Rgba16Float), Texture(name: "idle_out", format: R8Unorm),
    ], passes: [
        Raster(name: "scene", accesses: [Color(to: "hdr", intent: ClearColor(0, 0, 0, 1))]),
        Raster(name: "idle", accesses: [Sampled(of: "hdr"), Color(to: "idle_out", intent: Overwrite)]),
        Raster(name: "tonemap", accesses: [Sampled(of: "hdr"), Color(to: "screen", intent: Overwrite)]),
    ])"#;
    let path = crate::folder("culled").join("small.ron");
    std::fs::write(&path, text).expect("a file");
    let session = crate::session(&path);
    let plan = session.plan.as_ref().expect("a plan");
    let idle = Item::Pass(plan.pass("idle").expect("a pass"));
    let words = inspector::text(&inspector::sections(plan, Some(idle)));
    assert!(words.contains("culled because no pass reads `idle_out`") && words.contains("small.ron:6"), "{words}");
    let frame = inspector::text(&inspector::sections(plan, None));
    assert!(frame.contains("culled passes\n  idle: culled"), "{frame}");
    let timeline = drawing(View::Timeline, plan, ViewContext::default(), 80).words();
    assert!(timeline.contains("culled") || timeline.contains('-'), "{timeline}");
}

#[test]
fn bytes_by_step_are_those_of_the_plan() {
    for (name, plan) in &plans() {
        let (frame, totals) = (bandwidth::of_frame(plan), plan.form.totals);
        assert_eq!(frame.loaded, totals.unresolve_bytes, "{name}");
        assert_eq!(frame.stored + frame.resolved, totals.resolve_bytes, "{name}");
        assert_eq!(frame.resolved, totals.multisample_resolve_bytes, "{name}");
    }
    // A full-screen pass reads a picture of 16 bits per channel: eight bytes per texel.
    let plan = planned("filament", &Caps::desktop(), &[]);
    let grade = &plan.form.passes[plan.pass("grade").expect("a pass")];
    let step = &plan.form.steps[grade.step.expect("it runs")];
    assert_eq!(bandwidth::of_step(&plan, step).fetched, 1920 * 1080 * 8);
    // A downsampling pass reads one level, not the whole chain.
    let pyramid = planned("mip_pyramid", &Caps::desktop(), &[]);
    let (pass, access) = pyramid
        .form
        .passes
        .iter()
        .find_map(|pass| {
            Some((pass, pass.accesses.iter().find(|a| a.mode == "read" && a.part.as_deref() == Some("mip 1"))?))
        })
        .expect("a pass reads level 1");
    let resource = &pyramid.form.resources[pyramid.resource(&access.resource).expect("a resource")];
    let fetched = bandwidth::of_step(&pyramid, &pyramid.form.steps[pass.step.expect("it runs")]).fetched;
    assert!(fetched > 0 && 4 * fetched < resource.bytes, "{fetched} of {}", resource.bytes);
    // The following filter samples 8 bits per channel.
    let fxaa = &plan.form.passes[plan.pass("fxaa").expect("a pass")];
    let step = &plan.form.steps[fxaa.step.expect("it runs")];
    assert_eq!(bandwidth::of_step(&plan, step).fetched, 1920 * 1080 * 4);
}

#[test]
fn the_heap_map_shows_each_resource_where_it_lies() {
    let plan = planned("filament", &Caps::tiler(), &["shadows", "sao"]);
    let drawing = drawing(View::Memory, &plan, ViewContext::default(), 80);
    let bounds = |name: &str| {
        let item = Some(Item::Resource(plan.resource(name).expect("a resource")));
        drawing.hits.iter().find(|hit| hit.item == item).unwrap_or_else(|| panic!("{name}")).bounds
    };
    let row = |name: &str| &plan.form.resources[plan.resource(name).expect("a resource")];
    for pair in [("shadow", "structure"), ("ao", "ao_h"), ("ao_h", "ao_v")] {
        let (a, b) = (bounds(pair.0), bounds(pair.1));
        let higher = row(pair.0).offset < row(pair.1).offset;
        assert_eq!(b[1] < a[1], higher, "{pair:?}: larger offsets are higher");
        assert_eq!(a[0] < b[0], row(pair.0).held_steps < row(pair.1).held_steps, "{pair:?}: later is to the right");
    }
    let peak = plan.form.peak.as_ref().expect("memory is shared");
    assert!(drawing.words().contains(&format!("peak at step {}: {}", peak.step, peak.resources.join(", "))));
}

#[test]
fn lanes_are_those_of_the_schedule() {
    let plan = planned("deferred", &Caps::desktop(), &[]);
    let words = |beside: ViewContext<'_>| drawing(View::Queues, &plan, beside, 80).words();
    let own = framegraph_queues::replan(plan.plan.as_ref().expect("it was planned here")).expect("a plan");
    let costs_us = framegraph_queues::estimate_us(&own, 100_000.0);
    let layout = framegraph_queues::QueueLayout::async_compute();
    let found = framegraph_queues::schedule(&own, &layout, &costs_us).expect("a schedule");
    let head = format!("graphics + compute: {:.0} µs, {:.0} µs on one queue", found.total_us, found.alone_us);
    assert!(found.total_us < found.alone_us && words(ViewContext::default()).contains(&head), "{head}");
    // Each step has one box in each of two layouts; boxes of the second queue are lower.
    let drawn = drawing(View::Queues, &plan, ViewContext::default(), 80);
    let boxes = |step: usize| drawn.hits.iter().filter(move |hit| hit.item == Some(Item::Step(step)));
    assert!((0..own.steps().len()).all(|step| boxes(step).count() == 2));
    let top = |step: usize| boxes(step).next().expect("a box").bounds[1];
    for (step, lane) in found.lanes.iter().enumerate() {
        assert_eq!(top(step) > top(0), lane.index() > 0, "step {step}");
    }
    // With a trace of the frame, times are its medians.
    let trace = read(trace_of(&plan, 12, 6).as_bytes()).expect("a trace");
    let traced = words(ViewContext { trace: Some(&trace), ..ViewContext::default() });
    assert!(traced.contains("medians of the trace") && !traced.contains(&head), "{traced}");
    // A saved plan has no graph.
    let mut saved = plan.clone();
    saved.plan = None;
    assert!(
        drawing(View::Queues, &saved, ViewContext::default(), 80).words().contains("A saved plan contains no graph")
    );
}

#[test]
fn a_trace_gives_quartiles_and_stutters() {
    let plan = planned("filament", &Caps::tiler(), &[]);
    let trace = read(trace_of(&plan, 12, 6).as_bytes()).expect("a trace");
    assert_eq!(trace.frames.len(), 12);
    assert_eq!(trace.stutters().iter().map(|frame| frame.number).collect::<Vec<_>>(), [6]);
    let step = trace.steps_of(&plan)[0].expect("the step");
    assert_eq!((step.cpu_ms.len(), step.gpu_ms.len()), (11, 11), "the frame that warms up does not count");
    let [low, median, high] = quartiles(&step.cpu_ms).expect("there are times");
    assert!(0.0100 <= low && low < median && median < high && high <= 0.0108, "{low} {median} {high}");
    assert_eq!(quartiles(&[1.0, 2.0, 3.0, 4.0, 5.0]), Some([2.0, 3.0, 4.0]));
    assert_eq!(quartiles(&[]), None);
    let beside = ViewContext { trace: Some(&trace), ..ViewContext::default() };
    assert!(drawing(View::Timeline, &plan, beside, 80).words().contains("0.01"), "the median of the step");
    assert!(drawing(View::Trace, &plan, beside, 80).words().contains("1 stutters"));
}

/// Steps of equal names have times of their own, and a trace of another frame is reported.
#[test]
fn times_are_those_of_a_step_and_not_of_a_name() {
    let plan = planned("filament", &Caps::tiler(), &["shadows"]);
    let text = trace_of(&plan, 4, 9).replace("shadow/0", "cascade").replace("shadow/1", "cascade");
    let trace = read(text.as_bytes()).expect("a trace");
    assert_eq!(trace.steps.iter().filter(|step| step.name == "cascade").count(), 2);
    let said = trace.mismatch(&plan).expect("two steps have other names");
    assert!(said.contains("2 of ") && said.contains("`shadow/0`"), "{said}");
    let words = |trace| {
        let beside = ViewContext { trace: Some(trace), ..ViewContext::default() };
        [View::Timeline, View::Trace].map(|view| drawing(view, &plan, beside, 80).words())
    };
    assert!(words(&trace).iter().all(|words| words.contains("of another frame")), "{:?}", words(&trace));
    let own = read(trace_of(&plan, 4, 9).as_bytes()).expect("a trace");
    assert_eq!(own.mismatch(&plan), None);
    assert!(words(&own).iter().all(|words| !words.contains("of another frame")));
    // Three cascades of one name.
    let plan = StandardFrame::open("ultra").and_then(|frame| frame.plan(&WhatIf::on(Caps::tiler()))).expect("a plan");
    let names: Vec<_> = plan.form.steps.iter().map(|step| step.passes.join(" + ")).collect();
    let twice = names.iter().position(|name| name.ends_with("#2")).expect("a second step of one name");
    let first = names.iter().position(|name| *name == names[twice].replace("#2", "")).expect("the first");
    let event = |name: &str, us: u32| {
        format!(r#"{{"name":"{name}","ph":"X","pid":1,"tid":2,"ts":0,"dur":{us},"args":{{"frame":1}}}}"#)
    };
    let mut events = vec![r#"{"name":"thread_name","ph":"M","pid":1,"tid":1,"args":{"name":"frames"}}"#.to_owned()];
    events.push(r#"{"name":"frame 1","ph":"X","pid":1,"tid":1,"ts":0,"dur":9,"args":{}}"#.to_owned());
    let plain = names[twice].replace("#2", "");
    events.extend([event(&plain, 1000), event(&plain, 3000)]);
    let trace = read(format!("{{\"traceEvents\":[{}]}}", events.join(",")).as_bytes()).expect("a trace");
    let times = trace.steps_of(&plan);
    let ms = |step: usize| times[step].map(|step| step.cpu_ms.clone());
    assert_eq!((ms(first), ms(twice)), (Some(vec![1.0]), Some(vec![3.0])));
}

/// A shadow map cannot be read at the same pixel: it has another size than the frame.
#[test]
fn hints_that_cannot_apply_are_not_shown() {
    let plan = StandardFrame::open("high").and_then(|frame| frame.plan(&WhatIf::on(Caps::tiler()))).expect("a plan");
    let stored = |name: &str| {
        let stored = plan.form.decisions.iter().filter(|d| d.reason == "store_read_by");
        let of = stored.filter(|d| d.resource.as_deref().is_some_and(|resource| resource.ends_with(name)));
        of.map(|d| d.hint.clone()).collect::<Vec<_>>()
    };
    let maps = stored("shadow_map");
    assert!(!maps.is_empty() && maps.iter().all(Option::is_none), "{maps:?}");
    let all: Vec<_> = plan.form.decisions.iter().filter(|d| d.reason == "store_read_by" && d.hint.is_some()).collect();
    assert!(!all.is_empty(), "hints that can apply are shown");
}

#[test]
fn two_thousand_passes_are_laid_out() {
    let plan = viewer::synthetic::large(2000).expect("a plan");
    let started = std::time::Instant::now();
    let drawing = graph::drawing(&plan, None);
    println!("{} passes are laid out in {:?}", plan.form.passes.len(), started.elapsed());
    assert!(plan.form.passes.len() >= 2000 && drawing.hits.len() > 2000);
}

#[test]
fn accuracy_is_plotted_for_every_technique() {
    let text = std::fs::read("tests/it/accuracy.json").expect("the sample");
    let data = viewer::accuracy_data::read(&text).expect("it is sound");
    assert!(data.techniques.len() > 3);
    let drawn = |budget_ms: f64| viewer::accuracy_view::drawing(Some(&data), budget_ms);
    let (strict, free) = (drawn(0.0), drawn(1e9));
    // A larger time budget gives a smaller error; the slider covers the whole range.
    let [fastest, finest] = data.span_ms().expect("frames were measured");
    let (fast, fine) = (data.within(fastest).expect("a frame"), data.within(finest).expect("a frame"));
    assert!(fast.ms < fine.ms && fast.error > 1.0 && fine.error == 0.0, "{fast:?} {fine:?}");
    for [group, option] in &fine.options {
        assert!(free.words().contains(&format!("{group}: {option}")), "{group}");
    }
    let middle = data.within(0.5 * (fastest + finest)).expect("a frame");
    assert!(middle.ms <= 0.5 * (fastest + finest) && middle.error < fast.error && middle.error > 0.0, "{middle:?}");
    for technique in &data.techniques {
        assert!(strict.words().contains(&technique.name));
        let front = technique.front();
        let best = technique.choices.iter().map(|choice| choice.error).fold(f64::INFINITY, f64::min);
        let is_best = |index: usize| technique.choices[index].error == best;
        assert!((0..front.len()).any(|index| front[index] && is_best(index)), "the most accurate is beaten by none");
    }
    assert_ne!(strict.shapes, free.shapes);
    let is_timed = |technique: &&viewer::accuracy_data::Technique| technique.choices.iter().all(|c| c.ms.is_some());
    let timed = data.techniques.iter().filter(is_timed).count();
    assert!(timed > 1 && timed < data.techniques.len(), "some are timed, some are counted: {timed}");
    for (text, named) in [("{}", "invalid accuracy record"), ("[", "invalid accuracy record")] {
        assert!(viewer::accuracy_data::read(text.as_bytes()).is_err_and(|error| error.contains(named)), "{text}");
    }
    let text = String::from_utf8_lossy(&text);
    for (own, other) in [
        ("framegraph-accuracy", "framegraph-other"),
        ("\"version\": 2", "\"version\": 3"),
        ("\"name\": \"edges\"", "\"name\": \"hems\""),
    ] {
        let error = viewer::accuracy_data::read(text.replace(own, other).as_bytes()).expect_err("it is another");
        let word = other.rsplit(['"', ' ']).find(|word| !word.is_empty()).unwrap_or(other);
        assert!(error.contains(word), "{error}");
    }
}
