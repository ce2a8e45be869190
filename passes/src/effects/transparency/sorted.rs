//! Blended surfaces sorted by object, with two passes for materials or frames that request them.

use super::settings::Transparency;
use crate::effects::color::surface::{SurfaceBindings, SurfaceWorld};
use crate::effects::depth::prepass::draw_depth_of;
use crate::gpu_scene::draw::{Faces, SurfaceDraw};
use crate::gpu_scene::indirect::DrawList;
use crate::light::shading::AlphaUse;
use framegraph_scene::{Batch, TransparencyMode};
use framegraph_wgpu::{Cx, Depth, Output, RecordError};
use wgpu::BlendState;

/// Draws the blended surfaces of the world's view from back to front, over the current radiance.
pub(crate) fn draw_sorted(
    world: &SurfaceWorld<'_>,
    bindings: &SurfaceBindings,
    transparency: Transparency,
    cx: &mut Cx<'_>,
) -> Result<(), RecordError> {
    let draws = &world.view.view.draws;
    let mode = |batch: &Batch| {
        let material = world.scene.instances[batch.instance as usize].material;
        match world.scene.transparency(material) {
            TransparencyMode::Default if transparency == Transparency::TwoPasses => {
                let both = world.scene.is_double_sided(material);
                if both { TransparencyMode::TwoPassesTwoSides } else { TransparencyMode::Default }
            }
            own => own,
        }
    };
    let draw = |list: &DrawList, faces: Faces, depth: Depth, cx: &mut Cx<'_>| {
        let blended = SurfaceDraw {
            program: &|variant| bindings.program(world.programs, variant),
            frame: &bindings.frame,
            constants: &bindings.constants(AlphaUse::Blend),
            depth,
            colors: &[Output { blend: Some(BlendState::PREMULTIPLIED_ALPHA_BLENDING), ..Output::REPLACE }],
        };
        blended.draw_faces(list, faces, world.instances().with_stencil(bindings.stencil), cx)
    };
    let tested = || Depth { write: false, ..Depth::NEARER };
    let is_default = |batch: &Batch| mode(batch) == TransparencyMode::Default;
    if draws.blend.iter().all(is_default) {
        return draw(&draws.blend, Faces::OfMaterial, tested(), cx);
    }
    let mut rest = &draws.blend[..];
    while let Some(first) = rest.first() {
        let run = rest.iter().take_while(|batch| is_default(batch)).count();
        let (own, behind) = rest.split_at(run.max(1));
        rest = behind;
        if run > 0 {
            draw(&own.to_vec().into(), Faces::OfMaterial, tested(), cx)?;
            continue;
        }
        // Finishes an instance before the next one, which may be in front of it.
        for at in first.range() {
            let alone = Batch { instance: draws.numbers[at as usize], first: at, count: 1, ..*first };
            let alone = DrawList::from(vec![alone]);
            if mode(first) == TransparencyMode::TwoPassesOneSide {
                draw_depth_of(&alone, world.view, bindings.stencil, world.scene, world.programs, cx)?;
                draw(&alone, Faces::OfMaterial, Depth::EQUAL, cx)?;
            } else {
                draw(&alone, Faces::Back, tested(), cx)?;
                draw(&alone, Faces::Front, tested(), cx)?;
            }
        }
    }
    Ok(())
}
