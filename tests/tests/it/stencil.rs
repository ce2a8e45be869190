//! Stencil states of materials: marks of one object cut another, and frames without stencil are unchanged.

use crate::stage::{declared, gpu, lighting};
use framegraph::{Caps, Counts, Format, Options, Plan, Scratch, compile};
use framegraph_passes::gpu_scene::view::{Background, ViewSettings};
use framegraph_passes::{CameraView, LightSearch, Settings, Transparency, World};
use framegraph_scene::material::{Stencil, StencilCompare, StencilFace, StencilOp};
use framegraph_scene::{AlphaMode, Camera, DrawOptions, Environment, Material, Projection, Scene, geometry, progress};
use framegraph_wgpu::{Gpu, Imports, read_texture};
use glam::{DMat4, DVec3, Vec2, Vec3, Vec4};
use std::error::Error;
use tests::executors;

type TestResult = Result<(), Box<dyn Error>>;

const SIZE_PX: [u32; 2] = [64, 48];
const GREEN: usize = 0;
const RED: usize = 1;

/// Returns a green window behind the middle of a red wall, both unlit, with the given stencil states.
fn scene(alpha: AlphaMode, stencil: [Option<Stencil>; 2]) -> Scene {
    let mut scene = Scene::default();
    let colors = [Vec3::Y, Vec3::X].map(|color| color.extend(1.0));
    let wall = scene.add_mesh(geometry::plane(Vec2::splat(4.0), 1, Vec2::ONE));
    let window = scene.add_mesh(geometry::plane(Vec2::new(0.8, 0.8), 1, Vec2::ONE));
    let of = |color: Vec4, alpha, stencil: Option<Stencil>| Material {
        base_color: color,
        unlit: true,
        alpha,
        stencil: stencil.map(Box::new),
        ..Material::default()
    };
    let green = scene.add_material(of(colors[GREEN], AlphaMode::Opaque, stencil[GREEN]));
    let red = scene.add_material(of(colors[RED], alpha, stencil[RED]));
    // The camera looks down.
    scene.add_instance("window", window, green, DMat4::from_translation(DVec3::new(0.0, -0.5, 0.0)));
    scene.add_instance("wall", wall, red, DMat4::IDENTITY);
    scene.instances[GREEN].draw = DrawOptions { priority: 0, ..DrawOptions::default() };
    scene
}

/// Returns the numbers of green, red and black texels, and the counts of the plan.
fn shoot(gpu: &Gpu, scene: &Scene, settings: Settings) -> Result<([usize; 3], Counts), Box<dyn Error>> {
    let settings = Settings { shadows: None, fxaa: false, ..settings };
    let lighting = lighting(gpu, &Environment::uniform(DVec3::splat(1.0))?, &settings.shading)?;
    let view = ViewSettings {
        camera: Camera::look_at(DVec3::Y * 3.0, DVec3::ZERO, DVec3::Z, Projection::perspective(0.9, 0.1))?,
        size_px: SIZE_PX,
        ev100: 0.0,
        shadows: None,
        lights: LightSearch::All,
        ..ViewSettings::default()
    };
    let view = CameraView::new(scene, &lighting.image, &Background::None, &view);
    let world = World::new(gpu, scene, lighting, [view], &mut progress::silent)?;
    let (frame, io) = declared(&settings.for_scene(scene, SIZE_PX));
    let (mut plan, mut executor) = (Plan::new(), executors::lend(gpu));
    let options = Options::for_frame(SIZE_PX[0], SIZE_PX[1]);
    executor.compile(frame.graph(), &options, &mut Scratch::new(), &mut plan)?;
    executor.execute(&plan, &frame, &world, &Imports::new())?;
    assert_eq!(executor.executed(), plan.counts());
    let texels = read_texture(gpu, executor.texture(&plan, io.output).ok_or("no picture")?)?.rgba8();
    let is = |texel: &[u8]| [texel[1] > 100 && texel[0] < 100, texel[0] > 100, texel[0] < 9 && texel[1] < 9];
    let mut counts = [0; 3];
    for texel in texels.chunks(4) {
        counts.iter_mut().zip(is(texel)).for_each(|(count, is)| *count += usize::from(is));
    }
    Ok((counts, plan.counts()))
}

/// A window behind a wall marks its texels before the wall is drawn. The wall skips marked texels, so the window is visible
/// through it: with a prepass, without one, and if the wall blends. A mark that is not written cuts nothing.
#[test]
fn what_one_object_marks_cuts_another() -> TestResult {
    let Some(gpu) = gpu("what_one_object_marks_cuts_another") else { return Ok(()) };
    let mark = StencilFace { pass: StencilOp::Replace, ..StencilFace::default() };
    let mark = Stencil { write: true, reference: 1, ..Stencil::both(mark) };
    let unmarked = StencilFace { compare: StencilCompare::NotEqual, ..StencilFace::default() };
    let unmarked = Stencil { reference: 1, ..Stencil::both(unmarked) };
    let all = (SIZE_PX[0] * SIZE_PX[1]) as usize;
    let prepass = |prepass| Settings { prepass, ..Settings::DEFAULT };
    let (plain, without) = shoot(&gpu, &scene(AlphaMode::Opaque, [None; 2]), prepass(true))?;
    assert_eq!(plain, [0, all, 0]);
    let (unwritten, with) = shoot(
        &gpu,
        &scene(AlphaMode::Opaque, [Some(Stencil { write: false, ..mark }), Some(unmarked)]),
        prepass(true),
    )?;
    assert_eq!(unwritten, [0, all, 0]);
    // Blended surfaces may write stencil, so the color pass attaches depth as writable, in the same step.
    assert_eq!((with.passes, with.steps), (without.passes, without.steps));
    // Order-independent techniques fall back to sorting, since the marks of other objects come first.
    let unordered = |transparency| Settings { transparency, ..Settings::DEFAULT };
    for (alpha, settings) in [
        (AlphaMode::Opaque, prepass(true)),
        (AlphaMode::Opaque, prepass(false)),
        (AlphaMode::Blend, prepass(true)),
        (AlphaMode::Blend, unordered(Transparency::Weighted)),
        (AlphaMode::Blend, unordered(Transparency::Peeled { layers: 2 })),
    ] {
        let ([green, red, black], _) = shoot(&gpu, &scene(alpha, [Some(mark), Some(unmarked)]), settings)?;
        let case = format!("{alpha:?}, prepass {}, {}", settings.prepass, settings.transparency.name());
        assert!(green > 100 && green < all / 2, "{case}: {green} texels");
        assert_eq!((green + red, black), (all, 0), "{case}");
    }
    Ok(())
}

/// The depth texture has a stencil plane only if a material of the scene uses stencil. The plane is cleared and discarded.
#[test]
fn only_scenes_with_stencil_have_a_stencil_plane() {
    let depth = |stencil| {
        let settings = Settings { shadows: None, ..Settings::DEFAULT }
            .for_scene(&scene(AlphaMode::Opaque, [stencil, None]), SIZE_PX);
        let mut plan = Plan::new();
        let (frame, _) = declared(&settings);
        let options = Options::for_frame(SIZE_PX[0], SIZE_PX[1]);
        compile(frame.graph(), &Caps::desktop(), &options, &mut Scratch::new(), &mut plan).expect("it compiles");
        let formats = frame.graph().resources().iter().filter_map(|own| own.desc.texture()).map(|desc| desc.format);
        let formats: Vec<Format> = formats.filter(|format| format.has_depth()).collect();
        (formats.first().copied(), framegraph::dump::text(&plan))
    };
    let (format, text) = depth(None);
    assert!(format == Some(Format::Depth32Float) && !text.contains("stencil"), "{format:?}");
    let (format, text) = depth(Some(Stencil::default()));
    assert!(format == Some(Format::Depth32FloatStencil8) && text.contains("stencil"), "{format:?}\n{text}");
}
