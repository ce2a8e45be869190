//! Comparison of pictures, and PNG files.

use std::path::Path;

/// Difference of two pictures in 8-bit steps.
#[derive(Clone, Copy, Debug)]
pub struct Difference {
    /// Largest difference of a channel.
    pub max: u8,
    /// Mean difference of red, green and blue.
    pub mean: f64,
    /// Share of channels that differ by more than two steps.
    pub share: f64,
}

impl Difference {
    /// Compares red, green and blue of two pictures of equal size.
    pub fn new(a: &[u8], b: &[u8]) -> Self {
        assert_eq!(a.len(), b.len(), "pictures of equal size");
        let channels =
            || a.iter().zip(b).enumerate().filter(|(index, _)| index % 4 != 3).map(|(_, (a, b))| a.abs_diff(*b));
        let count = channels().count() as f64;
        Self {
            max: channels().max().unwrap_or(0),
            mean: channels().map(f64::from).sum::<f64>() / count,
            share: channels().filter(|step| *step > 2).count() as f64 / count,
        }
    }
}

/// Writes an 8-bit picture with red, green, blue and alpha.
pub fn write_png(path: &Path, [width, height]: [u32; 2], rgba: &[u8]) -> Result<(), Box<dyn std::error::Error>> {
    let mut encoder = png::Encoder::new(std::io::BufWriter::new(std::fs::File::create(path)?), width, height);
    encoder.set_color(png::ColorType::Rgba);
    encoder.write_header()?.write_image_data(rgba)?;
    Ok(())
}
