//! Reads a texture as numbers, with their range and histogram.

use crate::live::frame::Running;
use framegraph::Numeric;
use framegraph_wgpu::inspect::{InspectTarget, Inspector, Texels};

/// Number of histogram bins.
pub const BINS: usize = 128;

/// Inspected texture.
pub struct Found {
    /// Description.
    pub title: String,
    /// Texels.
    pub texels: Texels,
    /// Texels as numbers.
    pub numbers: Vec<[f32; 4]>,
    /// Minimum and maximum finite values of the existing channels; 0 if none is finite.
    pub span: [f32; 2],
    /// Number of texels with NaN or infinity.
    pub non_finite: usize,
    /// Histogram of each channel over `span`.
    pub histogram: Vec<[u32; BINS]>,
    /// Distance of the near plane in meters, for depth; 0 if unknown.
    pub near_m: f32,
}

/// Reads a subresource. Blocks until the device is finished.
///
/// # Errors
/// The reason that inspection failed.
pub fn read(running: &Running, inspector: &mut Inspector, target: InspectTarget) -> Result<Found, String> {
    let frames = running.frames();
    let (executor, plan, world) = (frames.executor(), frames.plan(), &running.loaded.world);
    let found = inspector.inspect_target(executor, plan, frames.frame(), world, frames.imports(), target);
    let found = found.map_err(|e| e.to_string())?;
    let near_m = running.rig.camera(None).projection.near_m() as f32;
    Ok(Found::new(found.title(), found.texels, near_m))
}

impl Found {
    /// Computes range and histogram of texels. `near_m` is the distance of the near plane in meters.
    pub fn new(title: String, texels: Texels, near_m: f32) -> Self {
        let (numbers, channels) = (texels.numbers(), texels.channels());
        let span = span(&numbers, channels);
        let (non_finite, histogram) = (texels.non_finite(channels), histogram(&numbers, channels, span));
        Self { title, non_finite, histogram, texels, numbers, span, near_m }
    }

    /// Returns the values of a texel; `None` outside the picture.
    pub fn texel(&self, [x, y]: [u32; 2]) -> Option<[f32; 4]> {
        let [width, height] = self.texels.size;
        (x < width && y < height).then(|| self.numbers[(y * width + x) as usize])
    }

    /// Returns the number of channels of the format.
    pub fn channels(&self) -> usize {
        self.texels.channels().min(4)
    }

    /// Returns whether the texels are reversed depth.
    pub fn is_depth(&self) -> bool {
        self.texels.numeric() == Numeric::Depth
    }
}

/// Returns the minimum and maximum finite values of the first `channels` channels; 0 if none is finite.
fn span(numbers: &[[f32; 4]], channels: usize) -> [f32; 2] {
    let finite = numbers.iter().flat_map(|texel| &texel[..channels]).copied().filter(|x| x.is_finite());
    let [low, high] = finite.fold([f32::INFINITY, f32::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)]);
    if low <= high { [low, high] } else { [0.0; 2] }
}

/// Counts the values of each channel per bin of a range; NaN and infinity are ignored.
pub fn histogram(numbers: &[[f32; 4]], channels: usize, [low, high]: [f32; 2]) -> Vec<[u32; BINS]> {
    let mut all = vec![[0; BINS]; channels];
    let per_bin = (high - low) / BINS as f32;
    for texel in numbers {
        for (boxes, number) in all.iter_mut().zip(texel).filter(|(_, number)| number.is_finite()) {
            let at = if per_bin > 0.0 { ((number - low) / per_bin) as usize } else { 0 };
            boxes[at.min(BINS - 1)] += 1;
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_finite_value_is_in_one_bin() {
        let numbers = [[0.0, 1.0, f32::NAN, 1.0], [0.5, -1.0, 2.0, 1.0], [1.0, f32::INFINITY, 0.0, 1.0]];
        let found = histogram(&numbers, 3, [-1.0, 2.0]);
        let sums: Vec<u32> = found.iter().map(|boxes| boxes.iter().sum()).collect();
        assert_eq!(sums, [3, 2, 2]);
        assert_eq!((found[1][0], found[2][BINS - 1]), (1, 1));
        assert_eq!(histogram(&[[5.0; 4]], 1, [5.0, 5.0])[0][0], 1);
    }
}
