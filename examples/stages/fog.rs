//! Custom fog pass that reads depth. It requires programs and views of its world, nothing else.

use framegraph::{DeclareError, Format, Intent, Pass, PassBuilder, Texture, TextureDesc, View};
use framegraph_passes::ViewId;
use framegraph_passes::gpu_scene::view::Views;
use framegraph_passes::program::full_screen::FullScreen;
use framegraph_passes::program::{Interface, ProgramDesc, Programs};
use framegraph_shaders::Module;
use framegraph_wgpu::{Cx, Record, RecordError};

/// Names of the variables in `fog.wgsl` that the pass binds, in order.
static INTERFACE: Interface = Interface { groups: &[&["frame", "hdr", "depth", "fog"]], constants: &[] };

static SHADER: Module<'static> = Module::new("fog.wgsl", include_str!("fog.wgsl"));

/// Fades radiance with distance.
#[derive(Clone, Copy, Debug)]
pub struct Fog {
    /// View whose camera rendered the depth.
    pub view: ViewId,
    /// Radiance, single-sampled.
    pub hdr: Texture,
    /// Reversed depth, single-sampled.
    pub depth: Texture,
    /// Radiance of dense fog, linear Rec.709, relative to white on the display.
    pub color: [f32; 3],
    /// Extinction coefficient in 1/m.
    pub density: f32,
}

/// Resources of the pass.
#[derive(Clone, Copy, Debug)]
pub struct FogIo {
    hdr: View,
    depth: View,
    /// Radiance with fog.
    pub foggy: Texture,
}

impl Pass for Fog {
    type Io = FogIo;

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<FogIo, DeclareError> {
        let extent = pass.desc(self.hdr)?.extent;
        let (hdr, depth) = (pass.sampled(self.hdr)?, pass.sampled(self.depth)?);
        let foggy = pass.texture("foggy", TextureDesc::new(extent, Format::Rgba16Float));
        Ok(FogIo { hdr, depth, foggy: pass.color(foggy, Intent::Overwrite)? })
    }
}

impl<W: AsRef<Programs> + AsRef<Views> + ?Sized> Record<W> for Fog {
    fn record(&self, io: &FogIo, world: &W, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        let views: &Views = world.as_ref();
        let frame = cx.uniform(&views.get(self.view)?.view.frame);
        let [r, g, b] = self.color;
        let (hdr, depth, fog) = (cx.view(io.hdr)?, cx.view(io.depth)?, cx.uniform(&[r, g, b, self.density]));
        let provided = [frame, hdr.into(), depth.into(), fog].map(Some);
        FullScreen::new(ProgramDesc::new(&SHADER, &INTERFACE), &[&provided]).draw(world.as_ref(), cx)
    }
}
