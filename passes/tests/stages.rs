//! Tests of the standard frame as a value: stages are inserted and replaced by name, and errors are explained.

use framegraph::{Extent, Format, Graph, Intent, Target, Texture, TextureDesc};
use framegraph_passes::effects::depth::resolve::{DepthOf, single_sample_depth};
use framegraph_passes::stages::{Handles, SlotFault, Stages};
use framegraph_passes::{Settings, Slot, Stage, StageError, ViewId, World, stages};
use framegraph_wgpu::Frame;

type Frames = Frame<World>;

const FOUR: Settings = Settings { samples: 4, ..Settings::DEFAULT };

/// Returns the names of the passes, in order.
fn passes(graph: &Graph) -> Vec<&str> {
    graph.pass_ids().map(|pass| graph.pass_name(pass)).collect()
}

/// Declares `stages` in a new frame.
fn declare(stages: &Stages<World>) -> Result<(Frames, Handles), StageError> {
    let mut frame = Frames::new();
    let output = frame.graph_mut().texture("output", TextureDesc::new(Extent::FRAME, Format::Rgba8UnormSrgb));
    let handles = stages.declare(&mut frame, Handles::default(), Target::from(output))?;
    Ok((frame, handles))
}

/// Adds a pass that reads `from` and writes `target`, or a new texture with `desc`.
fn filter(
    frame: &mut Frames,
    name: &str,
    from: Texture,
    target: Target,
    desc: TextureDesc,
) -> Result<Texture, StageError> {
    let declare = |pass: &mut framegraph::PassBuilder<'_>| {
        pass.sampled(from)?;
        let into = pass.target(target, name, desc);
        if desc.format.has_depth() { pass.depth(into, Intent::Overwrite) } else { pass.color(into, Intent::Overwrite) }
    };
    Ok(frame.add_fn(name, declare, |_, _, _| Ok(()))?)
}

/// Returns a stage that filters the radiance into a new texture.
fn radiance(name: &'static str, desc: TextureDesc) -> Stage<World> {
    Stage::new(name, move |frame, handles| {
        let filtered = filter(frame, name, handles.get(Slot::HDR)?, Target::New, desc)?;
        handles.set(Slot::HDR, filtered);
        Ok(())
    })
}

/// Returns a stage that filters the picture into its target.
fn picture(name: &'static str) -> Stage<World> {
    Stage::picture(name, move |frame, handles| {
        let desc = TextureDesc::new(handles.extent(), Format::Rgba8Unorm);
        let filtered = filter(frame, name, handles.get(Slot::PICTURE)?, handles.target(), desc)?;
        handles.set(Slot::PICTURE, filtered);
        Ok(())
    })
}

const HDR: TextureDesc = TextureDesc::new(Extent::FRAME, Format::Rgba16Float);

/// Returns the stages in the table of the module's documentation.
fn documented() -> Vec<&'static str> {
    let rows = include_str!("../src/frame.rs").lines().filter_map(|line| line.strip_prefix("//! | `"));
    rows.filter_map(|row| row.split_once('`')).map(|(name, _)| name).collect()
}

#[test]
fn names_are_the_same_whatever_the_settings_are() -> Result<(), StageError> {
    let names = documented();
    let bare = Settings { shadows: None, fxaa: false, ..Settings::DEFAULT };
    for settings in [Settings::DEFAULT, FOUR, bare, Settings { scene_levels: 3, ..bare }] {
        assert!(names.len() > 10 && stages::<World>(&settings).names().eq(names.iter().copied()));
    }
    let (frame, _) = declare(&stages(&bare))?;
    assert_eq!(passes(frame.graph()), ["prepass", "color", "post"]);
    let (frame, _) = declare(&stages(&Settings { scene_levels: 2, ..Settings::DEFAULT }))?;
    let expected = ["shadow", "prepass", "color", "scene/copy", "scene/level", "transparent", "post", "fxaa"];
    assert_eq!(passes(frame.graph()), expected);
    Ok(())
}

#[test]
fn stages_are_inserted_and_replaced_where_they_are_named() -> Result<(), StageError> {
    let mut stages = stages(&Settings::DEFAULT);
    stages.insert_after("color", radiance("glow", HDR))?.insert_before("glow", radiance("fog", HDR))?;
    stages.replace(Stage::picture("fxaa", |frame, handles| {
        let desc = TextureDesc::new(handles.extent(), Format::Rgba8Unorm);
        let sharp = filter(frame, "smaa", handles.get(Slot::PICTURE)?, handles.target(), desc)?;
        handles.set(Slot::PICTURE, sharp);
        Ok(())
    }))?;
    let (frame, handles) = declare(&stages)?;
    assert_eq!(passes(frame.graph()), ["shadow", "prepass", "color", "fog", "glow", "post", "smaa"]);
    let name = |slot| frame.graph().resource_of(handles.get(slot).ok()?).map(|r| frame.graph().resource_name(r));
    assert_eq!((name(Slot::HDR), name(Slot::PICTURE)), (Some("glow"), Some("output")));
    // Declaring the same stages again gives the same passes.
    assert_eq!(passes(declare(&stages)?.0.graph()), passes(frame.graph()));
    Ok(())
}

/// The last stage that writes the picture renders to the frame's target; earlier ones render to their own textures.
#[test]
fn the_last_picture_goes_into_the_target() -> Result<(), StageError> {
    let mut stages = stages(&Settings { fxaa: false, ..Settings::DEFAULT });
    stages.push(picture("grain"))?;
    let (frame, handles) = declare(&stages)?;
    let graph = frame.graph();
    assert_eq!(passes(graph), ["shadow", "prepass", "color", "post", "grain"]);
    assert!(graph.find_resource("ldr").is_some());
    assert_eq!(graph.resource_of(handles.get(Slot::PICTURE)?), graph.find_resource("output"));
    Ok(())
}

#[test]
fn names_that_are_wrong_are_said_with_those_that_are_right() {
    let mut stages = stages(&Settings::DEFAULT);
    let told = stages.insert_after("colour", radiance("glow", HDR)).map(drop).map_err(|e| e.to_string());
    assert_eq!(told, Err(format!("unknown stage `colour`; use one of {}", documented().join(", "))));
    let told = stages.replace(radiance("glow", HDR)).map(drop).map_err(|e| e.to_string());
    assert!(told.is_err_and(|told| told.contains("unknown stage `glow`")));
    let told = stages.insert_before("post", radiance("color", HDR)).map(drop);
    assert_eq!(told, Err(StageError::Twice { name: "color" }));
}

#[test]
fn what_a_stage_hands_on_wrongly_is_named() -> Result<(), StageError> {
    let after_color = |stage: Stage<World>| -> Result<StageError, StageError> {
        let mut stages = stages(&FOUR);
        stages.insert_after("color", stage)?;
        Ok(declare(&stages).err().unwrap_or_else(|| panic!("it was taken")))
    };
    // The error names the code of this file that set the texture.
    let wrong = |told: &StageError, expected: &SlotFault| match told {
        StageError::Wrong { stage: "glow", slot: "hdr", texture, fault, at } => {
            texture == "glow" && fault == expected && at.file() == file!()
        }
        _ => false,
    };
    let depth = TextureDesc::new(Extent::FRAME, Format::Depth32Float);
    let fault = SlotFault::Format { format: Format::Depth32Float, depth: false };
    let told = after_color(radiance("glow", depth))?;
    assert!(wrong(&told, &fault), "{told}");
    let told = after_color(radiance("glow", HDR.samples(4)))?;
    assert!(wrong(&told, &SlotFault::Samples { samples: 4 }), "{told}");

    let mut other = Frames::new();
    let foreign = other.graph_mut().texture("foreign", HDR);
    let told = after_color(Stage::new("glow", move |_, handles| {
        handles.set(Slot::HDR, foreign);
        Ok(())
    }))?;
    assert!(matches!(told, StageError::Foreign { stage: "glow", slot: "hdr", at } if at.file() == file!()), "{told}");
    Ok(())
}

#[test]
fn what_a_stage_does_not_hand_on_is_named_by_the_stage_that_needs_it() -> Result<(), StageError> {
    let mut silent = stages(&Settings::DEFAULT);
    silent.replace(Stage::picture("post", |_, _| Ok(())))?;
    assert_eq!(declare(&silent).err(), Some(StageError::Missing { stage: "fxaa", slot: "picture" }));

    // A stale handle: the filter has written a newer version.
    let mut stale = stages(&Settings::DEFAULT);
    stale.insert_after(
        "color",
        Stage::new("ui", |frame: &mut Frames, handles| {
            let hdr = handles.get(Slot::HDR)?;
            frame.add_fn("ui", |pass| pass.color(hdr, Intent::Modify), |_, _, _| Ok(()))?;
            Ok(())
        }),
    )?;
    let told = declare(&stale).err().map(|e| e.to_string()).unwrap_or_default();
    assert!(told.contains("pass `post`") && told.contains("use the handle that `ui` returned"), "{told}");
    Ok(())
}

#[test]
fn a_picture_beside_the_target_is_named() -> Result<(), StageError> {
    let mut stages = stages(&Settings::DEFAULT);
    stages.push(Stage::picture("grain", |frame, handles| {
        let desc = TextureDesc::new(handles.extent(), Format::Rgba8Unorm);
        let grain = filter(frame, "grain", handles.get(Slot::PICTURE)?, Target::New, desc)?;
        handles.set(Slot::PICTURE, grain);
        Ok(())
    }))?;
    assert_eq!(declare(&stages).err(), Some(StageError::OtherTarget { stage: "grain", texture: "grain".into() }));
    Ok(())
}

/// Refractive surfaces render to the multisampled texture. Resolving it would undo a stage that changed only the
/// resolved one.
#[test]
fn a_stage_whose_result_would_be_lost_is_named() -> Result<(), StageError> {
    for (samples, after, sound) in [(1, "color", true), (4, "color", false), (4, "transparent", true)] {
        let mut stages = stages(&Settings { samples, scene_levels: 2, ..Settings::DEFAULT });
        stages.insert_after(after, radiance("glow", HDR))?;
        let told = declare(&stages).err();
        let lost = StageError::Lost { stage: "transparent", slot: "hdr", samples: "hdr_samples", by: "glow" };
        assert_eq!(told, (!sound).then_some(lost), "{samples} samples, after {after}");
    }
    Ok(())
}

/// A single-sample depth is resolved when the first stage requests it, and shared by equal requests. Without MSAA it
/// costs nothing.
#[test]
fn one_depth_a_texel_is_made_on_request() -> Result<(), StageError> {
    let ask = |name, which| {
        Stage::new(name, move |frame: &mut Frames, handles: &mut Handles| {
            single_sample_depth(frame, handles, which).map(drop)
        })
    };
    let resolves = |settings: &Settings, stages: &[(&str, &'static str, DepthOf)]| -> Result<usize, StageError> {
        let mut all = framegraph_passes::stages(settings);
        for (after, name, which) in stages {
            all.insert_after(after, ask(*name, *which))?;
        }
        let (frame, _) = declare(&all)?;
        Ok(passes(frame.graph()).iter().filter(|name| **name == "depth_resolve").count())
    };
    let (ao, fog) = (("prepass", "ao", DepthOf::Nearest), ("color", "fog", DepthOf::Nearest));
    assert_eq!(resolves(&FOUR, &[])?, 0, "nobody asks");
    assert_eq!(resolves(&FOUR, &[ao, fog])?, 1, "two ask alike");
    assert_eq!(resolves(&FOUR, &[ao, ("color", "fog", DepthOf::Farthest)])?, 2, "two ask for different ones");
    assert_eq!(resolves(&Settings::DEFAULT, &[ao, fog])?, 0, "one sample is enough");
    // Refractive surfaces change the depth.
    let transmits = Settings { scene_levels: 2, ..FOUR };
    assert_eq!(resolves(&transmits, &[ao, ("transparent", "fog", DepthOf::Nearest)])?, 2);
    Ok(())
}

#[test]
fn views_have_names_and_sizes_of_their_own_and_share_a_shadow_map() -> Result<(), StageError> {
    let mut frame = Frames::new();
    let half = Extent::Relative { num: 1, den: 2, align: 1 };
    let stages = stages(&Settings::DEFAULT);
    let left = frame.scope("left", |frame| stages.declare(frame, Handles::for_view(ViewId(0), half), Target::New))?;
    let right = Handles::for_view(ViewId(1), half).sharing_shadows(&left);
    let right = frame.scope("right", |frame| stages.declare(frame, right, Target::New))?;
    let graph = frame.graph();
    let expected = [
        "left/shadow",
        "left/prepass",
        "left/color",
        "left/post",
        "left/fxaa",
        "right/prepass",
        "right/color",
        "right/post",
        "right/fxaa",
    ];
    assert_eq!(passes(graph), expected);
    for handles in [left, right] {
        for slot in [Slot::DEPTH, Slot::HDR, Slot::PICTURE] {
            let resource = graph.resource_of(handles.get(slot)?).expect("it is of this frame");
            assert_eq!(graph.resources()[resource.index()].desc.texture().map(|t| t.extent), Some(half), "{slot:?}");
        }
    }
    Ok(())
}
