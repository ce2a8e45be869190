//! Motion vectors: previous positions of moving surfaces, for passes that read the previous frame.
//!
//! Positions of static surfaces follow from their depth and both cameras, so they are not drawn. A frame without
//! motion does not declare the pass ([`Settings::moving`](crate::Settings::moving)). It shares the step of prepass
//! and color pass. Its cost is one cleared and stored attachment, and the draws of moving instances.

use crate::gpu_scene::draw::SurfaceDraw;
use crate::gpu_scene::upload::{GpuScene, MATERIAL_BINDINGS};
use crate::gpu_scene::view::{ViewId, Views};
use crate::program::{Interface, ProgramDesc, Programs};
use framegraph::{ClearValue, DeclareError, Format, Intent, Pass, PassBuilder, Texture, TextureDesc};
use framegraph_scene::Batch;
use framegraph_shaders::{Module, library};
use framegraph_wgpu::{Cx, Depth, Record, RecordError};

/// Format of motion vectors: half floats keep eleven significant bits.
const VELOCITY_FORMAT: Format = Format::Rgba16Float;

/// Color slot of the motion vectors; the color pass of the same step uses slot 0.
const SLOT: u8 = 1;

static SHADER: Module<'static> = library::pass("pass/velocity.wgsl").unwrap();

static INTERFACE: Interface = Interface {
    groups: &[&["frame", "motions"], &MATERIAL_BINDINGS, &["objects", "origins"]],
    constants: &[SurfaceDraw::TRAITS],
};

/// Draws motion vectors of opaque and masked surfaces that moved since the previous frame
/// ([`CameraView::after`](crate::CameraView::after)).
#[derive(Clone, Copy, Debug)]
pub struct Velocity {
    /// The view.
    pub view: ViewId,
    /// Reversed depth of the visible surfaces, with any number of samples.
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
