//! Tests that render with Bevy, without a window, on the adapter of the environment.

#[path = "../examples/support/mod.rs"]
mod support;

use framegraph::file::GraphFile;
use framegraph::{Caps, ClearValue, Intent, Options, Plan, Scratch, compile};
use framegraph_bevy::{Chains, Device, GraphPost, Report, ReportPlugin};
use framegraph_wgpu::RecordError;
use std::error::Error;
use std::path::{Path, PathBuf};
use support::Scene;
use support::chain::Effects;
use support::pictures::Difference;

const SMALL: Effects = Effects { size: [64, 48], samples: 1, bloom: false, fxaa: false };
/// Index of the reported frame.
const FRAME: u32 = 4;

/// Returns a report of the small scene, and the folder of its trace.
fn report(name: &str, effects: Effects) -> Result<(Report, PathBuf), Box<dyn Error>> {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let device = Device::open(Some(&folder))?;
    let mut scene = Scene::new(&device, &effects.of_bevy(), |app| {
        app.add_plugins(ReportPlugin);
    });
    scene.frames(&device, FRAME + 3);
    Ok((Report::of_trace(&folder, FRAME, &device.gpu().caps())?, folder))
}

/// The report lists the stores of samples and depth that nothing reads, and its file compiles to the plan of the report.
#[test]
fn a_report_lists_unneeded_stores_of_bevy() -> Result<(), Box<dyn Error>> {
    let (report, folder) = report("report", Effects { samples: 4, bloom: true, fxaa: true, ..SMALL })?;
    let names: Vec<&str> = report.frame.passes.iter().map(|pass| pass.name.as_str()).collect();
    for name in ["main_opaque_pass_3d", "tonemapping", "fxaa", "upscaling"] {
        assert!(names.contains(&name), "`{name}` is missing in {names:?}");
    }
    assert_eq!(report.frame.frame_size(), SMALL.size);
    assert!(report.declared.left_out.is_empty(), "{:?}", report.declared.left_out);
    let tiler = &report.plans[1];
    let stores: Vec<&str> = tiler.unneeded.iter().map(|own| own.texture.as_str()).collect();
    assert_eq!(stores, ["main_texture_sampled", "view_depth_texture"], "{:?}", tiler.unneeded);
    assert_eq!(tiler.plan.counts().memoryless, 2);
    // 4 samples of 8 bytes, and of 4 bytes.
    let saved: u64 = 64 * 48 * 4 * (8 + 4);
    assert_eq!(report.recorded.stored_bytes - tiler.plan.traffic(SMALL.size).stored_bytes, saved);
    assert_eq!(report.recorded.loads, tiler.plan.counts().unresolves, "bloom blends into its levels");
    assert!(report.plans[2].plan.counts().render_passes < tiler.plan.counts().render_passes);
    assert!(report.markdown().contains("memoryless: `view_depth_texture`"));

    let text = report.ron("bevy");
    let graph = GraphFile::parse("frame.ron", &text)?.graph(&[])?;
    let mut plan = Plan::new();
    let options = Options { frame: SMALL.size, ..*tiler.plan.options() };
    compile(&graph, &Caps::tiler(), &options, &mut Scratch::new(), &mut plan)?;
    assert_eq!(plan.counts(), tiler.plan.counts());

    let missing = Report::of_trace(&folder, FRAME + 3, &Caps::wgpu()).map(drop).unwrap_err();
    assert!(missing.to_string().starts_with("frame 7 is not in the trace"), "{missing}");
    Ok(())
}

/// Control: without multisampling there are no samples to store.
#[test]
fn a_frame_without_multisampling_has_no_samples_to_store() -> Result<(), Box<dyn Error>> {
    let (report, _) = report("one_sample", SMALL)?;
    let stores: Vec<&str> = report.plans[1].unneeded.iter().map(|own| own.texture.as_str()).collect();
    assert_eq!(stores, ["view_depth_texture"]);
    Ok(())
}

/// A graph's tone mapping equals Bevy's. A pass of the user changes its own texels only, and costs no render pass.
#[test]
fn a_graph_replaces_bevys_tone_mapping() -> Result<(), Box<dyn Error>> {
    let device = Device::open(None)?;
    let mut bevy = Scene::new(&device, &SMALL.of_bevy(), |_| {});
    bevy.frames(&device, 3);
    let expected = bevy.picture(&device);
    let mut graph = SMALL.executed(&device, false);
    graph.frames(&device, 3);
    let plan = graph.plan()?;
    assert_eq!(plan.counts().render_passes, 1);
    let picture = graph.picture(&device);
    assert!(expected.chunks(4).any(|texel| texel[0] > 100), "the scene is lit");
    let difference = Difference::new(&expected, &picture);
    assert!(difference.max <= 1, "{difference:?}");

    let mut bars = SMALL.executed(&device, true);
    bars.frames(&device, 3);
    let counts = bars.plan()?.counts();
    assert_eq!((counts.render_passes, counts.passes, counts.unresolves), (1, 2, 0));
    let barred = bars.picture(&device);
    // 6 rows of 64 texels on each side.
    let (bar, end) = (6 * 64 * 4, barred.len() - 6 * 64 * 4);
    assert!(barred[..bar].chunks(4).chain(barred[end..].chunks(4)).all(|texel| texel[..3] == [0, 0, 0]));
    assert_eq!(barred[bar..end], picture[bar..end]);
    // Control: the comparison sees the bars.
    assert!(Difference::new(&expected, &barred).max > 50);
    Ok(())
}

/// Bloom and FXAA change the picture, and the chain loads nothing.
#[test]
fn a_chain_of_bloom_grading_and_fxaa_loads_nothing() -> Result<(), Box<dyn Error>> {
    let device = Device::open(None)?;
    let mut plain = SMALL.executed(&device, false);
    plain.frames(&device, 3);
    let mut full = Effects { bloom: true, fxaa: true, ..SMALL }.executed(&device, false);
    full.frames(&device, 3);
    let counts = full.plan()?.counts();
    assert_eq!((counts.unresolves, counts.culled), (0, 0));
    assert!(counts.render_passes > 4);
    assert!(Difference::new(&plain.picture(&device), &full.picture(&device)).mean > 0.1);
    Ok(())
}

/// A chain that writes nothing is an error, and a later chain works.
#[test]
fn an_empty_chain_is_an_error() -> Result<(), Box<dyn Error>> {
    let device = Device::open(None)?;
    let mut scene = SMALL.executed(&device, false);
    let camera = scene.camera();
    let works = scene.world().get::<GraphPost>(camera).cloned().ok_or("no chain")?;
    scene.world().entity_mut(camera).insert(GraphPost::new(|_, _| Ok(())));
    scene.frames(&device, 3);
    let error = scene.render().resource::<Chains>().error();
    assert!(error.as_deref().is_some_and(|error| error.contains("draws nothing")), "{error:?}");
    scene.world().entity_mut(camera).insert(works);
    scene.frames(&device, 2);
    assert_eq!(scene.render().resource::<Chains>().error(), None);
    Ok(())
}

/// A chain that fails while it is recorded changes no texel, and Bevy's commands of the frame are submitted.
#[test]
fn a_chain_that_fails_is_not_submitted() -> Result<(), Box<dyn Error>> {
    let device = Device::open(None)?;
    let mut scene = SMALL.executed(&device, false);
    scene.frames(&device, 3);
    let before = scene.picture(&device);
    let camera = scene.camera();
    for fails in [true, false] {
        scene.world().entity_mut(camera).insert(GraphPost::new(move |frame, camera| {
            let clear = Intent::Clear(ClearValue::BLACK);
            let black = frame.add_fn("black", |pass| pass.color(camera.output, clear), |_, _, _| Ok(()))?;
            let record = move |_: &_, _: &_, _: &mut framegraph_wgpu::Cx<'_>| match fails {
                true => Err(RecordError::custom(std::io::Error::other("expected by the test"))),
                false => Ok(()),
            };
            frame.add_fn("fails", |pass| pass.color(black, Intent::Modify), record)?;
            Ok(())
        }));
        scene.frames(&device, 3);
        let error = scene.render().resource::<Chains>().error();
        assert_eq!(error.is_some_and(|error| error.contains("expected by the test")), fails);
        // Control: the same chain without the error draws.
        assert_eq!(scene.picture(&device) == before, fails);
    }
    Ok(())
}
