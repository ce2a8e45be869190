//! The bilateral blur of ambient occlusion.

use super::settings::Blur;
use crate::gpu_scene::view::{ViewId, Views};
use crate::program::full_screen::FullScreen;
use crate::program::{Interface, ProgramDesc, Programs};
use framegraph::{DeclareError, Intent, Pass, PassBuilder, Texture, TextureDesc, View};
use framegraph_shaders::layout::BilateralUniforms;
use framegraph_shaders::{Module, library};
use framegraph_wgpu::{Cx, Record, RecordError};
use glam::{IVec2, Vec4};

static SHADER: Module<'static> = library::pass("pass/bilateral.wgsl").unwrap();

static INTERFACE: Interface =
    Interface { groups: &[&["bilateral", "occlusion_in", "structure"]], constants: &["REACH", "ALL_CHANNELS"] };

/// Direction of the blur.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// Horizontal.
    Across,
    /// Vertical.
    Down,
}

/// Blurs ambient occlusion along one axis without crossing surfaces. Uses [`Programs`] and the camera of the view of
/// the world.
#[derive(Clone, Copy, Debug)]
pub struct OcclusionBlur {
    /// View of the structure.
    pub view: ViewId,
    /// Reversed depth; its first level is read.
    pub structure: Texture,
    /// Visibility in red, of the size of that level.
    pub occlusion: Texture,
    /// Settings.
    pub blur: Blur,
    /// Axis of the blur.
    pub axis: Axis,
    /// Blurs the bent normal in the other channels too.
    pub bent_normals: bool,
}

/// Handles of the pass.
#[derive(Clone, Copy, Debug)]
pub struct OcclusionBlurIo {
    structure: View,
    occlusion: View,
    /// Visibility in red.
    pub blurred: Texture,
}

impl Pass for OcclusionBlur {
    type Io = OcclusionBlurIo;

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<OcclusionBlurIo, DeclareError> {
        let TextureDesc { extent, format, .. } = pass.desc(self.occlusion)?;
        let structure = pass.sampled(self.structure.mip(0))?;
        let occlusion = pass.sampled(self.occlusion)?;
        let blurred = pass.texture("occlusion_blurred", TextureDesc::new(extent, format));
        Ok(OcclusionBlurIo { structure, occlusion, blurred: pass.color(blurred, Intent::Overwrite)? })
    }
}

impl<W: AsRef<Programs> + AsRef<Views> + ?Sized> Record<W> for OcclusionBlur {
    fn record(&self, io: &OcclusionBlurIo, world: &W, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        let views: &Views = world.as_ref();
        let Blur { reach, stride, threshold_m, .. } = self.blur;
        let stride = stride as i32;
        let settings = BilateralUniforms {
            depth: views.get(self.view)?.view.stand().projection().depth,
            axis: match self.axis {
                Axis::Across => IVec2::new(stride, 0),
                Axis::Down => IVec2::new(0, stride),
            },
            threshold_m,
            _pad: 0.0,
            weights: weights(&self.blur),
        };
        let provided = [cx.uniform(&settings), cx.view(io.occlusion)?.into(), cx.view(io.structure)?.into()];
        let program = ProgramDesc::new(&SHADER, &INTERFACE);
        let constants = [f64::from(reach), f64::from(self.bent_normals)];
        FullScreen { constants: &constants, ..FullScreen::new(program, &[&provided.map(Some)]) }
            .draw(world.as_ref(), cx)
    }
}

/// Returns the normal distribution up to a factor; the shader normalizes the weights.
fn weights(blur: &Blur) -> [Vec4; 4] {
    let weight = |i: usize| (-0.5 * (i as f32 / blur.sigma).powi(2)).exp();
    std::array::from_fn(|row| Vec4::from_array(std::array::from_fn(|column| weight(4 * row + column))))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_fall_from_the_middle_as_a_normal_distribution() {
        let rows = weights(&Blur::high(4.0));
        assert_eq!(rows[0].x, 1.0);
        // At one and two standard deviations.
        assert!((rows[1].x - (-0.5_f32).exp()).abs() < 1e-6 && (rows[2].x - (-2.0_f32).exp()).abs() < 1e-6);
    }
}
