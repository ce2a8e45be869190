//! Attaching to an engine: both programs, and the panels.

use crate::{case, folder, planned, trace_of};
use framegraph::{ClearValue, DeclareError, Extent, Format, Intent, Order, TextureDesc};
use framegraph_wgpu::remote::Server;
use framegraph_wgpu::{FrameLoop, Gpu};
use std::io::{BufRead, BufReader, Write};
use std::net::TcpListener;
use std::process::{Command, Output, Stdio};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::time::{Duration, Instant};
use viewer::app::{Pane, Role, Session, Viewer};
use viewer::attached::Attached;
use viewer::drawing::Item;
use viewer::what_if::WhatIf;

/// Set for the process that is the engine.
const ENGINE: &str = "VIEWER_TEST_ENGINE";

/// Draws frames until `ends` is set; `passes` is read before each.
fn engine(server: &mut Server, passes: &AtomicU32, ends: &AtomicBool) -> Result<(), Box<dyn std::error::Error>> {
    let mut frames = FrameLoop::<()>::new(&Gpu::noop()?);
    while !ends.load(Ordering::Relaxed) {
        let passes = passes.load(Ordering::Relaxed);
        frames.run([64, 32], &(), |frame, _| {
            let desc = TextureDesc::new(Extent::FRAME, Format::Rgba16Float);
            let sky = frame.graph_mut().texture("sky", desc);
            let clear = Intent::Clear(ClearValue::BLACK);
            let mut image = frame.add_fn("clear sky", |pass| pass.color(sky, clear), |_, _, _| Ok(()))?;
            for pass in 0..passes {
                let next = frame.graph_mut().texture(&format!("image {pass}"), desc);
                let declare = |builder: &mut framegraph::PassBuilder<'_>| {
                    builder.sampled(image)?;
                    builder.color(next, clear)
                };
                image = frame.add_fn(&format!("filter {pass}"), declare, |_, _, _| Ok(()))?;
            }
            frame.graph_mut().readback(image)?;
            Ok::<_, DeclareError>(())
        })?;
        server.after_frame(&mut frames, &());
        std::thread::sleep(Duration::from_millis(5));
    }
    Ok(())
}

/// The engine's process. As a test without the variable, it does nothing.
#[test]
fn engine_process() {
    if std::env::var_os(ENGINE).is_none() {
        return;
    }
    let mut server = Server::start("127.0.0.1:0", "engine of a test").expect("a port");
    // The harness prints the name of the test into the first line.
    println!("\nlisten {}", server.address());
    std::io::stdout().flush().expect("a pipe");
    engine(&mut server, &AtomicU32::new(2), &AtomicBool::new(false)).expect("frames");
}

fn run(args: &[&str]) -> (Option<i32>, String) {
    let Output { status, stderr, .. } =
        Command::new(env!("CARGO_BIN_EXE_viewer")).args(args).output().expect("the program starts");
    (status.code(), String::from_utf8_lossy(&stderr).into_owned())
}

#[test]
fn the_program_shows_the_frame_of_another_program() {
    let mut child = Command::new(std::env::current_exe().expect("a program"))
        .args(["--exact", "attach::engine_process", "--nocapture"])
        .env(ENGINE, "1")
        .stdout(Stdio::piped())
        .spawn()
        .expect("the program starts");
    let lines = BufReader::new(child.stdout.take().expect("a pipe")).lines().map_while(Result::ok);
    let address = lines.filter_map(|line| line.strip_prefix("listen ").map(str::to_owned)).next().expect("an address");
    let folder = folder("attach");
    for (view, expected) in [("graph", "filter 1"), ("timeline", "ms")] {
        let out = folder.join(format!("{view}.svg"));
        let path = out.to_str().expect("a name");
        let (code, message) = run(&["--headless", "--attach", &address, "--view", view, "--out", path]);
        assert_eq!(code, Some(0), "{message}");
        let text = std::fs::read_to_string(&out).expect("the file is there");
        assert!(text.contains("clear sky") && text.contains(expected), "{view}: {text}");
    }
    let _ = child.kill();
    let _ = child.wait();
}

#[test]
fn engines_that_are_none_give_one_line() {
    let foreign = TcpListener::bind("127.0.0.1:0").expect("a port");
    let address = foreign.local_addr().expect("an address").to_string();
    let serve = std::thread::spawn(move || {
        let (mut peer, _) = foreign.accept().expect("a viewer");
        let _ = peer.write_all(b"HTTP/1.1 400 Bad Request\r\n\r\n");
        drop(foreign);
    });
    let (foreign, gone) = (run(&["--headless", "--attach", &address, "--out", "out.svg"]), serve.join());
    assert!(gone.is_ok() && foreign.0 == Some(2) && foreign.1.contains("does not speak this protocol"), "{foreign:?}");
    let nobody = run(&["--headless", "--attach", &address, "--out", "out.svg"]);
    assert!(nobody.0 == Some(2) && nobody.1.contains(&address) && nobody.1.lines().count() == 1, "{nobody:?}");
}

/// Shows frames of the viewer until a condition holds, at most a minute.
fn until(ctx: &egui::Context, viewer: &mut Viewer, mut holds: impl FnMut(&Viewer) -> bool) {
    let end = Instant::now() + Duration::from_secs(60);
    while !holds(viewer) {
        assert!(Instant::now() < end, "the condition does not hold: {:?}", viewer.session.messages);
        let screen_rect = Some(egui::Rect::from_min_size(egui::Pos2::ZERO, egui::vec2(1280.0, 720.0)));
        let mut output = ctx.run_ui(egui::RawInput { screen_rect, ..Default::default() }, |ui| viewer.show(ui));
        output.textures_delta.clear();
        std::thread::sleep(Duration::from_millis(2));
    }
}

#[test]
fn panels_show_plan_times_textures_and_what_if_of_an_engine() {
    let (passes, ends) = (Arc::new(AtomicU32::new(1)), Arc::new(AtomicBool::new(false)));
    let mut server = Server::start("127.0.0.1:0", "engine of a test").expect("a port");
    let address = server.address().to_string();
    let (count, stop) = (passes.clone(), ends.clone());
    let draws = std::thread::spawn(move || engine(&mut server, &count, &stop).map_err(|error| error.to_string()));

    let ctx = egui::Context::default();
    let mut viewer = Viewer::new(Session::new(WhatIf::on(framegraph::Caps::wgpu()), || {}));
    viewer.attach(&address, || {});
    let names = |viewer: &Viewer| -> Vec<String> {
        let plan = viewer.session.plan.as_ref();
        plan.map_or_else(Vec::new, |plan| plan.form.passes.iter().map(|pass| pass.name.clone()).collect())
    };
    until(&ctx, &mut viewer, |viewer| viewer.attached.as_ref().is_some_and(Attached::is_complete));
    assert_eq!(names(&viewer), ["clear sky", "filter 0"]);
    let plan = viewer.session.plan.clone().expect("a plan");
    assert!(plan.plan.is_some() && plan.declared_at[0].contains("attach.rs"), "{:?}", plan.declared_at);
    until(&ctx, &mut viewer, |viewer| {
        viewer.session.trace.as_ref().is_some_and(|trace| trace.steps[0].cpu_ms.len() > 1)
    });
    let trace = viewer.session.trace.clone().expect("times");
    assert_eq!((trace.mismatch(&plan), trace.steps.len()), (None, 2));
    assert!(trace.steps.iter().all(|step| step.cpu_ms.len() > 1), "{trace:?}");

    // The frame changes.
    passes.store(3, Ordering::Relaxed);
    until(&ctx, &mut viewer, |viewer| names(viewer).len() == 4);
    assert!(viewer.session.against().is_some_and(|before| before.form.passes.len() == 2), "shown as the difference");

    // Another connection does not compare with plans of the previous one.
    viewer.attach(&address, || {});
    until(&ctx, &mut viewer, |viewer| viewer.attached.as_ref().is_some_and(Attached::is_complete));
    assert!(names(&viewer).len() == 4 && viewer.session.against().is_none());

    // A texture on demand.
    viewer.turn_to(Pane::Preview);
    let image = viewer.session.plan.as_ref().and_then(|plan| plan.resource("image 1")).map(Item::Resource);
    viewer.select(image);
    let found = |viewer: &Viewer| viewer.attached.as_ref().and_then(|attached| attached.preview.found.clone());
    until(&ctx, &mut viewer, |viewer| found(viewer).is_some());
    let first = found(&viewer).expect("texels");
    assert_eq!((first.title.as_str(), first.texels.size), ("image 1@filter 1", [64, 32]));

    // Live, it is read again and again.
    let mut last = first;
    viewer.attached.as_mut().expect("an engine").preview.follow = true;
    for _ in 0..3 {
        until(&ctx, &mut viewer, |viewer| found(viewer).is_some_and(|found| !Arc::ptr_eq(&found, &last)));
        last = found(&viewer).expect("texels");
    }
    viewer.attached.as_mut().expect("an engine").preview.follow = false;

    // A trace does not end the connection, and a graph does.
    let path = folder("attach_trace").join("trace.json");
    std::fs::write(&path, trace_of(&planned("diamond", &framegraph::Caps::wgpu(), &[]), 3, 0)).expect("a file");
    viewer.open(&path, Role::Shown);
    until(&ctx, &mut viewer, |viewer| viewer.session.doing().is_none());
    assert_eq!((viewer.attached.is_some(), &viewer.session.messages), (true, &Vec::new()));
    viewer.open(&case("diamond"), Role::Shown);
    until(&ctx, &mut viewer, |viewer| viewer.attached.is_none());
    assert!(viewer.session.settle(Duration::from_secs(60)) && names(&viewer).contains(&"combine".into()));
    viewer.attach(&address, || {});
    until(&ctx, &mut viewer, |viewer| viewer.attached.as_ref().is_some_and(Attached::is_complete));
    assert_eq!(names(&viewer).len(), 4, "files that were opened before do not end the connection");

    // A question about the declared graph.
    let questions = viewer.session.questions.as_mut().expect("a graph");
    (questions.asked.frame, questions.asked.order) = (Some([3840, 2160]), Order::Optimized);
    viewer.session.ask();
    until(&ctx, &mut viewer, |viewer| viewer.session.plan.as_ref().is_some_and(|plan| plan.form.frame == [3840, 2160]));

    ends.store(true, Ordering::Relaxed);
    assert_eq!(draws.join().expect("the engine ends"), Ok(()));
    until(&ctx, &mut viewer, |viewer| viewer.attached.as_ref().is_some_and(Attached::is_ended));
    assert!(viewer.session.plan.is_some(), "the last plan stays");
}
