//! The background: a full-screen triangle on the far plane, drawn where no surface is.

use crate::effects::color::surface::{SKY, SKY_SHADER, SurfaceBindings, SurfaceWorld};
use crate::gpu_scene::view::BackgroundUniforms;
use crate::program::ProgramDesc;
use crate::program::full_screen::FullScreen;
use framegraph_shaders::Feature;
use framegraph_wgpu::{Cx, Depth, RecordError};

/// Draws the background of the world's view.
///
/// A black background needs no triangle, since it is the clear value. With fog or inlined grading it is drawn as well:
/// the result may depend on the pixel, and must match the shader bit for bit.
pub(crate) fn draw_background(
    world: &SurfaceWorld<'_>,
    bindings: &SurfaceBindings,
    cx: &mut Cx<'_>,
) -> Result<(), RecordError> {
    let SurfaceBindings { frame, epilogue, .. } = bindings;
    let view = &world.view.view;
    let features = bindings.background_features();
    let (fragment, sky) = match &view.background {
        BackgroundUniforms::Environment => ("fs_environment", None),
        BackgroundUniforms::ClearSky(sky) => ("fs_procedural", Some(*sky)),
        BackgroundUniforms::Constant(radiance) => ("fs_constant", Some(*radiance)),
        BackgroundUniforms::None if epilogue.effects.is_empty() && features.is_empty() => return Ok(()),
        BackgroundUniforms::None => ("fs_black", None),
    };
    let halo = view.sun_halo.filter(|_| !matches!(view.background, BackgroundUniforms::None));
    let sky = match halo {
        None => sky,
        Some((radius_rad, halo)) => Some(sky.unwrap_or_default().with_halo(radius_rad, halo.size, halo.falloff)),
    };
    let features = &features.with_if(Feature::SUN_HALO, halo.is_some());
    let uniforms = sky.map(|sky| cx.uniform(&sky));
    let program = ProgramDesc { fragment: Some(fragment), features, epilogue, ..ProgramDesc::new(&SKY_SHADER, &SKY) };
    let constants = bindings.background_constants();
    let groups: [&[_]; 2] = [frame, &[uniforms]];
    let depth = Depth { write: false, ..Depth::NEARER };
    FullScreen { constants: &constants, depth, ..FullScreen::new(program, &groups) }.draw(world.programs, cx)
}
