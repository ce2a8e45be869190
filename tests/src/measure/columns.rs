//! Ambient occlusion in the scene of columns, compared with a path tracer.

use crate::reference::asset::Sources;
use crate::reference::document::Document;
use crate::reference::picture::Picture;
use crate::reference::studio;
use framegraph_passes::effects::occlusion::OcclusionSettings;
use framegraph_wgpu::Gpu;
use std::error::Error;
use std::path::Path;

/// The scene with its reference, path traced with rays of 0.3 m.
#[derive(Debug)]
pub struct Columns {
    document: Document,
    sources: Sources,
    truth: VisibilityMap,
    /// True for pixels that show a lit surface.
    covered: Vec<bool>,
}

/// A picture of visibility in one channel, rows from the top.
#[derive(Clone, Debug)]
struct VisibilityMap {
    /// Width and height, in pixels.
    size_px: [u32; 2],
    /// Visibility, 0 to 1.
    visibility: Vec<f32>,
}

impl VisibilityMap {
    /// Reads an OpenEXR picture; fails if it has more than one channel.
    fn read(path: &Path) -> Result<Self, exr::error::Error> {
        let image = exr::prelude::read_first_flat_layer_from_file(path)?;
        let layer = image.layer_data;
        let [channel] = layer.channel_data.list.as_slice() else {
            return Err(exr::error::Error::NotSupported("more than one channel".into()));
        };
        let size_px = [layer.size.width() as u32, layer.size.height() as u32];
        Ok(Self { size_px, visibility: channel.sample_data.values_as_f32().collect() })
    }
}

/// Error of visibility.
#[derive(Clone, Copy, Debug)]
pub struct Off {
    /// Root mean square.
    pub rms: f64,
    /// Mean of the signed error.
    pub bias: f64,
}

impl Columns {
    /// Reads the scene and its reference from `tests/references/filament_frame`.
    ///
    /// # Errors
    /// A file is missing or invalid.
    pub fn open(folder: &Path) -> Result<Self, Box<dyn Error>> {
        let lit = Picture::read(&folder.join("05a_columns_ibl_ao_off.exr"))?;
        Ok(Self {
            document: Document::read(&folder.join("05a_columns_ibl_ao_off.json"))?,
            sources: Sources { model: folder.join("assets/columns.glb"), light: None },
            truth: VisibilityMap::read(&folder.join("mi_columns_ao_r0.3.exr"))?,
            covered: lit.linear.iter().map(|rgb| rgb[0] > 0.0).collect(),
        })
    }

    /// Returns the error of the frame's ambient occlusion at full resolution.
    ///
    /// # Errors
    /// The device fails.
    pub fn off(&self, gpu: &Gpu, settings: OcclusionSettings) -> Result<Off, Box<dyn Error>> {
        let made = studio::visibility(gpu, &self.document, &self.sources, settings)?;
        if made.texels != self.truth.size_px {
            return Err("ambient occlusion and reference differ in size".into());
        }
        let visibility = made.rgba().into_iter().map(|[visibility, ..]| visibility);
        Ok(self.compare(visibility))
    }

    /// Returns the error of ambient occlusion as surfaces are shaded: radiance with it divided by radiance without it.
    /// Under uniform light, this is visibility, apart from the 4 % reflection. Works at any resolution.
    ///
    /// # Errors
    /// The device fails.
    pub fn off_as_shaded(&self, gpu: &Gpu, settings: OcclusionSettings) -> Result<Off, Box<dyn Error>> {
        let [without, with] =
            [None, Some(settings)].map(|settings| studio::radiance(gpu, &self.document, &self.sources, settings));
        let (without, with) = (without?, with?);
        let pairs = without.linear.iter().zip(&with.linear);
        Ok(self.compare(pairs.map(|(without, with)| with[1] / without[1].max(1e-6))))
    }

    fn compare(&self, visibility: impl Iterator<Item = f32>) -> Off {
        let pairs = visibility.zip(&self.truth.visibility).zip(&self.covered).filter(|(_, covered)| **covered);
        let errors: Vec<f64> = pairs.map(|((ours, truth), _)| f64::from(ours - truth)).collect();
        let count = errors.len().max(1) as f64;
        let square = errors.iter().map(|e| e * e).sum::<f64>();
        Off { rms: (square / count).sqrt(), bias: errors.iter().sum::<f64>() / count }
    }
}
