//! Velocity: where surfaces of what moves were in the frame before, for passes that read that frame's picture.
//!
//! What stands still is found by its depth and both cameras, so nothing of it is drawn, and a frame in which nothing moves does not
//! declare the pass ([`Settings::moving`](crate::Settings::moving)). Between prepass and color pass it shares their step: it
//! costs one attachment, cleared and stored, and the draws of what moves.

use crate::draw::SurfaceDraw;
use crate::program::{Interface, ProgramDesc, Programs};
use crate::upload::{GpuScene, MATERIAL_BINDINGS};
use crate::view::{ViewId, Views};
use framegraph::{ClearValue, DeclareError, Format, Intent, Pass, PassBuilder, Texture, TextureDesc};
use framegraph_scene::Batch;
use framegraph_shaders::{Module, library};
use framegraph_wgpu::{Cx, Depth, Record, RecordError};

/// Format of velocity: a half float has eleven bits of the way, whatever that is.
const VELOCITY_FORMAT: Format = Format::Rgba16Float;

/// The slot that it is drawn in; the color pass of the same step draws in slot 0.
const SLOT: u8 = 1;

static SHADER: Module<'static> = library::pass("pass/velocity.wgsl").unwrap();

static INTERFACE: Interface = Interface {
    groups: &[&["frame", "motions"], &MATERIAL_BINDINGS, &["objects", "origins"]],
    constants: &[SurfaceDraw::TRAITS],
};

/// Draws velocity of opaque and masked surfaces that moved since the frame before ([`CameraView::after`](crate::CameraView::after)).
#[derive(Clone, Copy, Debug)]
pub struct Velocity {
    /// The view that is drawn.
    pub view: ViewId,
    /// Reversed depth of the visible surfaces, of one sample per texel or more.
    pub depth: Texture,
}

impl Pass for Velocity {
    type Io = Texture;

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<Texture, DeclareError> {
        let TextureDesc { extent, samples, .. } = pass.desc(self.depth)?;
        pass.depth_read_only(self.depth)?;
        let desc = TextureDesc::new(extent, VELOCITY_FORMAT);
        let still = Intent::Clear(ClearValue::TRANSPARENT);
        let velocity = pass.texture("velocity", desc);
        if samples == 1 {
            return pass.color_at(SLOT, velocity, still);
        }
        let each = pass.texture("velocity_samples", desc.samples(samples));
        let each = pass.color_at(SLOT, each, still)?;
        pass.resolve(each, velocity)
    }
}

impl<W: AsRef<Programs> + AsRef<GpuScene> + AsRef<Views> + ?Sized> Record<W> for Velocity {
    fn record(&self, _: &Texture, world: &W, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        let (views, programs): (&Views, &Programs) = (world.as_ref(), world.as_ref());
        let seen = views.get(self.view)?;
        let frame = [Some(cx.uniform(&seen.view.frame)), Some(seen.motions.clone().into())];
        let of_moved = |batches: &[Batch]| seen.view.draws.only(batches, |instance| seen.view.moves(instance as usize));
        for (batches, fragment) in seen.view.draws.depth.iter().zip(["fs_opaque", "fs_mask"]) {
            let surfaces = SurfaceDraw {
                program: &|variant| {
                    let (fragment, features) = (Some(fragment), &variant.vertex_features());
                    programs.get(&ProgramDesc { fragment, features, ..ProgramDesc::new(&SHADER, &INTERFACE) })
                },
                frame: &frame,
                constants: &[],
                depth: Depth::EQUAL,
                colors: &[],
            };
            surfaces.draw(&of_moved(batches), seen.instances(world.as_ref()), cx)?;
        }
        Ok(())
    }
}
