//! Passes that measure: full-screen steps of one shader.

use crate::program::full_screen::FullScreen;
use crate::program::{Interface, ProgramDesc, Programs};
use framegraph::{DeclareError, Extent, Format, Intent, Pass, PassBuilder, Texture, TextureDesc, View};
use framegraph_shaders::{Module, library};
use framegraph_wgpu::{Cx, Record, RecordError};

static SHADER: Module<'static> = library::pass("pass/measure.wgsl").unwrap();

static INTERFACE: Interface = Interface { groups: &[&["hdr", "scene_depth", "measured"]], constants: &[] };

/// Side of the block that one texel summarizes, in texels, as in the shader.
const SIDE: u16 = 8;

/// Format of maximum and minimum. Half floats hold light as radiance does, and reversed depth to 1/2048 of the
/// distance.
const FORMAT: Format = Format::Rg16Float;

/// A step with its inputs.
#[derive(Clone, Copy, Debug)]
pub enum MeasureStep {
    /// Finds the maximum and minimum light.
    Light {
        /// Pre-exposed radiance, single-sampled.
        hdr: Texture,
    },
    /// Finds the nearest and the farthest depth.
    Depth {
        /// Reversed depth, single-sampled.
        depth: Texture,
    },
    /// Reduces an earlier result.
    Smaller {
        /// Result of an earlier step.
        measured: Texture,
    },
}

impl MeasureStep {
    /// Returns the name of the pass.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Light { .. } => "light",
            Self::Depth { .. } => "depth",
            Self::Smaller { .. } => "smaller",
        }
    }

    const fn fragment(self) -> &'static str {
        match self {
            Self::Light { .. } => "fs_light",
            Self::Depth { .. } => "fs_depth",
            Self::Smaller { .. } => "fs_smaller",
        }
    }
}

/// A step of measuring. Uses [`Programs`] of the world.
#[derive(Clone, Copy, Debug)]
pub struct MeasurePass {
    /// The step.
    pub step: MeasureStep,
    /// Size of the picture.
    pub extent: Extent,
    /// Number of reductions to an eighth so far, including this step: 1 or 2.
    pub eighths: u8,
}

/// Handles of the pass.
#[derive(Clone, Copy, Debug)]
pub struct MeasureIo {
    /// Inputs in the order of the shader's bindings.
    read: [Option<View>; 3],
    /// Maximum and minimum.
    pub result: Texture,
}

impl Pass for MeasurePass {
    type Io = MeasureIo;

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<MeasureIo, DeclareError> {
        let mut read = [None; 3];
        match self.step {
            MeasureStep::Light { hdr } => read[0] = Some(pass.sampled(hdr)?),
            MeasureStep::Depth { depth } => read[1] = Some(pass.sampled(depth)?),
            MeasureStep::Smaller { measured } => read[2] = Some(pass.sampled(measured)?),
        }
        let side = SIDE.pow(self.eighths.into());
        let extent = match self.extent {
            Extent::Relative { num, den, align } => Extent::Relative { num, den: den * side, align },
            Extent::Absolute { width, height } => {
                Extent::absolute(width.div_ceil(side.into()), height.div_ceil(side.into()))
            }
        };
        let result = pass.texture("measured", TextureDesc::new(extent, FORMAT));
        Ok(MeasureIo { read, result: pass.color(result, Intent::Overwrite)? })
    }
}

impl<W: AsRef<Programs> + ?Sized> Record<W> for MeasurePass {
    fn record(&self, io: &MeasureIo, world: &W, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        let mut provided = [const { None }; 3];
        for (slot, view) in provided.iter_mut().zip(io.read) {
            *slot = view.map(|view| cx.view(view)).transpose()?.map(Into::into);
        }
        let program = ProgramDesc { fragment: Some(self.step.fragment()), ..ProgramDesc::new(&SHADER, &INTERFACE) };
        FullScreen::new(program, &[&provided]).draw(world.as_ref(), cx)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use framegraph::{Caps, Desc, Options, Plan, Scratch, compile};

    /// Partial blocks at the edge have a texel of their own, for relative and absolute sizes.
    #[test]
    fn no_texel_of_the_edge_is_left_out() -> Result<(), Box<dyn std::error::Error>> {
        for extent in [Extent::FRAME, Extent::absolute(75, 41)] {
            for (eighths, expected) in [(1, [10, 6]), (2, [2, 1])] {
                let mut frame = framegraph_wgpu::Frame::<Programs>::new();
                let hdr = frame.graph_mut().import_texture(
                    "hdr",
                    TextureDesc::new(extent, Format::Rgba16Float),
                    framegraph::Entry::Defined,
                    framegraph::Exit::Keep,
                );
                let step = MeasureStep::Light { hdr };
                let result = frame.add(step.name(), MeasurePass { step, extent, eighths })?.result;
                frame.graph_mut().readback(result)?;
                let mut plan = Plan::new();
                let options = Options::for_frame(75, 41);
                compile(frame.graph(), &Caps::wgpu(), &options, &mut Scratch::new(), &mut plan)?;
                let graph = plan.graph();
                let made = graph.resource_ids().find(|id| graph.resource_name(*id).ends_with("measured"));
                let made = made.ok_or("it is declared")?;
                let Desc::Texture(desc) = graph.resources()[made.index()].desc else { return Err("a buffer".into()) };
                assert_eq!(desc.extent.texels([75, 41]), expected, "{extent:?}");
            }
        }
        Ok(())
    }
}
