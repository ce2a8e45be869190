//! Blur effect: a function from a texture handle to a texture handle, implemented by three compute passes.
//!
//! `halve` downsamples to half size, `across` and `down` blur along one axis each. The three intermediate textures have
//! equal descriptions. `down` writes after the last read of `halve`'s result, so the plan assigns both to one texture.

use framegraph::{DeclareError, Extent, Format, Intent, Pass, PassBuilder, Texture, TextureDesc, View};
use framegraph_wgpu::{Compute, Constants, Cx, RecordError, Shader};
use framegraph_wgpu::{Frame, Record};

/// Radius of the blur in texels at half resolution.
pub const RADIUS: usize = 12;
/// Texels of a line written by one workgroup.
const STRETCH: u32 = 64;

const SHADER: Shader<'static> = Shader::new("custom_pass/blur", include_str!("blur.wgsl"));

/// Blurs `image` (linear light) with a Gaussian filter. The result has half the size, rounded up, and the same total light.
///
/// The effect works in any frame, because it reads nothing from the world.
///
/// # Errors
/// Fails if `image` is stale, belongs to another graph, or cannot be sampled.
pub fn blur<W: ?Sized>(frame: &mut Frame<W>, image: Texture) -> Result<Texture, DeclareError> {
    // Scopes nest names: the passes are called `blur/halve`, `blur/across` and `blur/down`.
    frame.scope("blur", |frame| {
        let (_, half) = frame.add("halve", Halve { image })?;
        let (_, across) = frame.add("across", Sweep { image: half, down: false })?;
        let (_, down) = frame.add("down", Sweep { image: across, down: true })?;
        Ok(down)
    })
}

/// Weights of the center and of the texels on one side.
///
/// The standard deviation is a third of the radius. The center plus twice the others sum to 1.
pub fn weights() -> [f32; 16] {
    let mut weights = [0.0; 16];
    let deviation = RADIUS as f32 / 3.0;
    for (distance, weight) in weights.iter_mut().enumerate().take(RADIUS + 1) {
        *weight = (-0.5 * (distance as f32 / deviation).powi(2)).exp();
    }
    let total = 2.0 * weights.iter().sum::<f32>() - weights[0];
    weights.map(|weight| weight / total)
}

/// Description of the intermediate textures: half the frame size, in a format for storage writes.
fn half_size() -> TextureDesc {
    TextureDesc::new(Extent::fraction(2), Format::Rgba16Float)
}

/// Downsamples a picture to half its size.
struct Halve {
    image: Texture,
}

impl Pass for Halve {
    // Data for the recorder: the token of the read, and the handle of the written texture.
    type Io = (View, Texture);

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<Self::Io, DeclareError> {
        let image = pass.sampled(self.image)?;
        let half = pass.texture("half", half_size());
        // Every texel is overwritten, so the previous contents are irrelevant. Loads and stores are derived, never
        // declared.
        Ok((image, pass.storage_write(half, Intent::Overwrite)?))
    }
}

impl<W: ?Sized> Record<W> for Halve {
    fn record(&self, (image, half): &Self::Io, _: &W, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        let pipeline = cx.compute_pipeline(&Compute { entry: "halve", ..Compute::new(SHADER) })?;
        let (image, half) = (cx.view(*image)?, cx.view_of(*half)?);
        let size = half.texture().size();
        let group = cx.bind_group(pipeline.group(0), &[(0, image.into()), (1, half.into())]);
        let pass = cx.compute_pass()?;
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.dispatch_workgroups(size.width.div_ceil(8), size.height.div_ceil(8), 1);
        Ok(())
    }
}

/// Blurs along one axis.
struct Sweep {
    image: Texture,
    down: bool,
}

impl Pass for Sweep {
    type Io = (View, Texture);

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<Self::Io, DeclareError> {
        let image = pass.sampled(self.image)?;
        let swept = pass.texture(if self.down { "blurred" } else { "swept" }, half_size());
        Ok((image, pass.storage_write(swept, Intent::Overwrite)?))
    }
}

impl<W: ?Sized> Record<W> for Sweep {
    fn record(&self, (image, swept): &Self::Io, _: &W, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        let constants = [("DOWN", f64::from(self.down))];
        let pipeline =
            cx.compute_pipeline(&Compute { entry: "sweep", constants: Constants(&constants), ..Compute::new(SHADER) })?;
        let (image, swept) = (cx.view(*image)?, cx.view_of(*swept)?);
        let size = swept.texture().size();
        let (length, lines) = if self.down { (size.height, size.width) } else { (size.width, size.height) };
        let weights = cx.uniform(&weights());
        let group = cx.bind_group(pipeline.group(0), &[(0, image.into()), (1, swept.into()), (2, weights)]);
        let pass = cx.compute_pass()?;
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.dispatch_workgroups(length.div_ceil(STRETCH), lines, 1);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_sum_up_to_one() {
        let weights = weights();
        let total: f64 = weights.iter().map(|w| 2.0 * f64::from(*w)).sum::<f64>() - f64::from(weights[0]);
        // Thirteen roundings of numbers below 1.
        assert!((total - 1.0).abs() < 13.0 * f64::from(f32::EPSILON), "{total}");
        assert!(weights.windows(2).all(|w| w[0] >= w[1]) && weights[RADIUS] > 0.0 && weights[RADIUS + 1] == 0.0);
    }
}
