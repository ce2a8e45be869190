//! Loads and stores of the standard frame, derived by hand in the comments.

use crate::stage::plan;
use framegraph::{Caps, Counts, LoadOp, Options, StoreOp, dump};
use framegraph_passes::effects::depth::structure::Resolution;
use framegraph_passes::effects::occlusion::OcclusionSettings;
use framegraph_passes::effects::reflection::ReflectionSettings;
use framegraph_passes::gpu_scene::shadow_views::{ContactShadows, MomentSettings, ShadowFilter, ShadowSettings};
use framegraph_passes::{Preset, Settings};

const FRAME: [u32; 2] = [1280, 720];

fn counts(settings: Settings) -> Counts {
    plan(&settings, &Caps::wgpu(), &Options::for_frame(FRAME[0], FRAME[1])).counts()
}

/// Returns the counts with a separate post-processing pass.
fn counts_apart(settings: Settings) -> Counts {
    plan(&settings, &Caps::wgpu(), &Options { inline: false, ..Options::for_frame(FRAME[0], FRAME[1]) }).counts()
}

const ONE: Settings = Settings::DEFAULT;
const FOUR: Settings = Settings { samples: 4, ..ONE };

/// step             attachment    load       store
/// shadow           shadow_map    clear      STORE   (color samples it)
/// prepass + color  ldr           clear      STORE   (fxaa samples it; post is inlined, and hdr is nowhere)
///   (+ post)       depth         clear      discard (nobody reads it): memoryless
/// fxaa             output        don't care STORE   (read back)
#[test]
fn one_sample() {
    let expected = Counts {
        unresolves: 0,
        resolves: 3,
        clears: 3,
        discards: 1,
        multisample_resolves: 0,
        memoryless: 1,
        inlined: 1,
        steps: 3,
        render_passes: 3,
        passes: 5,
        culled: 0,
    };
    assert_eq!(counts(ONE), expected);
}

/// As with one sample, but hdr_samples is cleared and discarded (memoryless, in the format of ldr), and ldr is its
/// resolve target, one of the three stores.
#[test]
fn four_samples() {
    let one = counts(ONE);
    let expected = Counts { discards: 2, multisample_resolves: 1, memoryless: 2, ..one };
    assert_eq!(counts(FOUR), expected);
}

/// With a separate post-processing pass, hdr is stored for it (one of four stores), and ldr is its attachment.
///
/// prepass + color  hdr           clear      STORE   (post reads it)
///                  depth         clear      discard: memoryless
/// post             ldr           don't care STORE   (fxaa samples it)
#[test]
fn without_inlining() {
    for settings in [ONE, FOUR] {
        let inlined = counts(settings);
        let expected = Counts {
            resolves: inlined.resolves + 1,
            inlined: 0,
            steps: inlined.steps + 1,
            render_passes: inlined.render_passes + 1,
            ..inlined
        };
        assert_eq!(counts_apart(settings), expected);
    }
}

/// Each effect in its own pass: with inlining, they form a chain in the color pass. Without inlining, exposure and tone
/// curve each store a picture that the next pass reads.
#[test]
fn split_into_passes() {
    for settings in [ONE, FOUR] {
        let split = Settings { split_post: true, ..settings };
        let (whole, whole_apart) = (counts(settings), counts_apart(settings));
        assert_eq!(counts(split), Counts { inlined: 3, passes: whole.passes + 2, ..whole });
        let expected = Counts {
            resolves: whole_apart.resolves + 2,
            steps: whole_apart.steps + 2,
            render_passes: whole_apart.render_passes + 2,
            passes: whole_apart.passes + 2,
            ..whole_apart
        };
        assert_eq!(counts_apart(split), expected);
    }
}

/// Blending must happen before grading, so post-processing is not inlined.
#[test]
fn blending_keeps_post_apart() {
    for settings in [ONE, FOUR] {
        assert_eq!(counts(Settings { blended: true, ..settings }), counts_apart(settings));
    }
}

/// Without FXAA, the output replaces ldr. Without inlining, post-processing writes the output. Both have one step,
/// store and pass less.
#[test]
fn without_fxaa() {
    for (settings, counts) in [ONE, FOUR].into_iter().flat_map(|s| [counts, counts_apart].map(|c| (s, c))) {
        let with = counts(settings);
        let without = counts(Settings { fxaa: false, ..settings });
        let expected = Counts {
            resolves: with.resolves - 1,
            steps: with.steps - 1,
            render_passes: with.render_passes - 1,
            passes: with.passes - 1,
            ..with
        };
        assert_eq!(without, expected);
    }
}

/// Four cascades, as in Filament's table (four shadow layers: four stores, no load), add three clears and stores to a
/// single map. A point light adds six maps. Moments are stored once per map, and blurred twice.
///
/// shadow/cascade   shadow_map layer  clear      STORE
/// shadow/cascade   moments layer     clear      STORE, its depth clear -> discard (memoryless)
/// shadow/blur      across            don't care STORE
/// shadow/blur      moments layer     don't care STORE
#[test]
fn cascades_and_their_filters() {
    let one = counts(ONE);
    let with = |shadows: ShadowSettings| counts(Settings { shadows: Some(shadows), ..ONE });
    let more = |maps: u32| Counts {
        resolves: one.resolves + maps,
        clears: one.clears + maps,
        steps: one.steps + maps,
        render_passes: one.render_passes + maps,
        passes: one.passes + maps,
        ..one
    };
    let four = ShadowSettings { cascades: 4, ..ShadowSettings::DEFAULT };
    assert_eq!(with(four), more(3));
    assert_eq!(with(ShadowSettings { filter: ShadowFilter::Pcss, ..four }), more(3));
    assert_eq!(with(ShadowSettings { local_maps: 6, ..four }), more(9));
    // Six maps in one layer add one clear and store, and take a sixth of the memory.
    let [apart, shared] = [6, 1].map(|local_layers| ShadowSettings { local_maps: 6, local_layers, ..four });
    assert_eq!(with(shared), more(4));
    let bytes = |shadows| {
        let plan = plan(&Settings { shadows: Some(shadows), ..ONE }, &Caps::wgpu(), &Options::for_frame(64, 64));
        let map = plan.graph().find_resource("shadow/shadow_map").expect("the maps");
        plan.resources()[map.index()].bytes
    };
    let layer = 4 * 2048 * 2048;
    assert_eq!([bytes(four), bytes(apart), bytes(shared)], [4 * layer, 10 * layer, 5 * layer]);
    let moments = ShadowSettings { filter: ShadowFilter::Vsm, ..four };
    let drawn =
        Counts { clears: more(3).clears + 4, discards: one.discards + 4, memoryless: one.memoryless + 4, ..more(3) };
    assert_eq!(with(moments), drawn);
    let blurred = ShadowSettings { moments: MomentSettings { blur_texels: 5.0, ..four.moments }, ..moments };
    // Contact shadows read a copy of the prepass's depth, for any number of cascades: depth and copy are stored, and
    // the color pass loads the depth.
    let contact = with(ShadowSettings { contact: Some(ContactShadows::FILAMENT), ..four });
    let expected =
        Counts { unresolves: 1, resolves: more(5).resolves, clears: more(3).clears, memoryless: 0, ..more(4) };
    assert_eq!(contact, Counts { steps: expected.steps + 1, render_passes: expected.render_passes + 1, ..expected });
    let expected = Counts {
        resolves: drawn.resolves + 8,
        steps: drawn.steps + 8,
        render_passes: drawn.render_passes + 8,
        passes: drawn.passes + 8,
        ..drawn
    };
    assert_eq!(with(blurred), expected);
}

/// Presets below ultra inline post-processing into the color pass, and draw the scene twice without shadow maps.
#[test]
fn presets_inline_post_processing() {
    for preset in Preset::ALL {
        let settings = preset.frame().settings;
        let inlined = u32::from(preset != Preset::Ultra);
        assert_eq!(counts(settings).inlined, inlined, "{preset:?}");
        assert!(geometry_passes(settings).len() as u32 + inlined <= 3, "{preset:?}");
    }
}

/// Returns the passes of a frame that draw the scene's surfaces, without shadow maps.
fn geometry_passes(settings: Settings) -> Vec<String> {
    let plan = plan(&settings, &Caps::wgpu(), &Options::for_frame(FRAME[0], FRAME[1]));
    let graph = plan.graph();
    let passes = graph.pass_ids().filter(|pass| match graph.pass_name(*pass) {
        "prepass" | "reflection_depth" | "reflection" | "velocity" | "color" => true,
        // A copy reads depth, and the drawn structure reads nothing.
        "structure" => graph.accesses_of(*pass).len() == 1,
        _ => false,
    });
    passes.map(|pass| graph.pass_name(pass).to_owned()).collect()
}

/// Effects that read the depth of the scene share that of the prepass, or draw it once with one sample per texel. The
/// scene is thus drawn twice. Reflections draw it once more, for normals and roughness.
#[test]
fn geometry_is_drawn_twice() {
    let half = OcclusionSettings { resolution: Resolution::Half, ..OcclusionSettings::SAO };
    let contact = ShadowSettings { contact: Some(ContactShadows::FILAMENT), ..ShadowSettings::DEFAULT };
    for occlusion in [None, Some(OcclusionSettings::SAO), Some(half)] {
        for shadows in [ShadowSettings::DEFAULT, contact] {
            for settings in [ONE, FOUR, Settings { prepass: false, ..ONE }] {
                let own = Settings { occlusion, shadows: Some(shadows), ..settings };
                let passes = geometry_passes(own);
                assert!(passes.len() <= 2, "{passes:?} of {own:?}");
                let reflected = Settings { reflections: Some(ReflectionSettings::DEFAULT), ..own };
                let passes = geometry_passes(reflected);
                assert!(passes.len() <= 3, "{passes:?} of {reflected:?}");
            }
        }
    }
}

/// The plan states the reason for each effect with several passes, and nothing for absent ones.
#[test]
fn effects_say_why_they_are_there() {
    let told = |settings: &Settings| {
        let plan = plan(settings, &Caps::wgpu(), &Options::for_frame(64, 64));
        plan.graph().notes().map(|(about, text)| format!("{about}: {text}")).collect::<Vec<_>>()
    };
    let all = Settings {
        occlusion: Some(OcclusionSettings::SAO),
        reflections: Some(ReflectionSettings::DEFAULT),
        scene_levels: 3,
        ..ONE
    };
    let expected = [
        "shadow: the settings ask for it: a layer for each of 1 cascades, 0 for maps of other lights, 2048 texels across, read \
         by `pcf`",
        "occlusion: the settings ask for it: SAO within 0.3 m",
        "reflection: the settings ask for it: rays of 3 m read the radiance of the previous frame, which is kept for them",
        "scene: surfaces of the scene transmit: what is behind them is copied, in 3 levels",
    ];
    assert_eq!(told(&all), expected);
    assert!(told(&Settings { shadows: None, ..ONE }).is_empty());
}

/// Without shadows, the shadow map's clear and store are gone with its step.
#[test]
fn without_shadows() {
    for settings in [ONE, FOUR] {
        let with = counts(settings);
        let without = counts(Settings { shadows: None, ..settings });
        let expected = Counts {
            resolves: with.resolves - 1,
            clears: with.clears - 1,
            steps: with.steps - 1,
            render_passes: with.render_passes - 1,
            passes: with.passes - 1,
            ..with
        };
        assert_eq!(without, expected);
    }
}

/// Without merging, the prepass stores depth and the color pass loads it: one more load and store, and depth takes
/// memory. The color pass reads it last and discards it.
#[test]
fn without_merging() {
    let options = Options { merge: false, ..Options::for_frame(FRAME[0], FRAME[1]) };
    let plan = plan(&ONE, &Caps::wgpu(), &options);
    let merged = counts(ONE);
    let expected = Counts { unresolves: 1, resolves: 4, memoryless: 0, steps: 4, render_passes: 4, ..merged };
    assert_eq!(plan.counts(), expected);
    let depth = plan.graph().find_resource("depth").expect("the prepass makes it");
    let ops: Vec<_> = plan.attachments().iter().filter(|a| a.resource == depth).map(|a| (a.load, a.store)).collect();
    assert_eq!(ops, [(LoadOp::Clear, StoreOp::Store), (LoadOp::Load, StoreOp::Discard)]);
}

/// If only the linear picture is used, post-processing and FXAA are culled.
#[test]
fn unused_passes_are_culled() {
    let mut frame = framegraph_wgpu::Frame::<framegraph_passes::World>::new();
    let io = framegraph_passes::standard(&mut frame, &ONE, framegraph::Target::New).expect("a sound frame");
    frame.graph_mut().readback(io.hdr).unwrap();
    let mut plan = framegraph::Plan::new();
    let options = Options::for_frame(64, 64);
    framegraph::compile(frame.graph(), &Caps::wgpu(), &options, &mut framegraph::Scratch::new(), &mut plan)
        .expect("it compiles");
    let counts = plan.counts();
    assert_eq!((counts.culled, counts.passes, counts.resolves), (2, 3, 2));
}

/// Two runs give the same plan, byte for byte, as the committed file from another process.
#[test]
fn the_plan_is_reproducible() {
    let make = || {
        let plan = plan(&FOUR, &Caps::wgpu(), &Options::for_frame(FRAME[0], FRAME[1]));
        dump::text(&plan) + &dump::dot(&plan)
    };
    let (first, second) = (make(), make());
    assert_eq!(first, second);
    let golden = concat!(env!("CARGO_MANIFEST_DIR"), "/references/standard_frame.txt");
    if std::env::var_os("FRAMEGRAPH_WRITE_REFERENCES").is_some() {
        std::fs::write(golden, &first).expect("the reference can be written");
    }
    let committed = std::fs::read_to_string(golden).expect("tests/references/standard_frame.txt is committed");
    let compared = framegraph_check::golden::compare(golden, &committed, &first);
    compared.expect("set FRAMEGRAPH_WRITE_REFERENCES=1 to write it anew");
}
