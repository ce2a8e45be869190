//! Contact sheets: thumbnails of all files with their names below, as pages of PNG.

use crate::font::{CELL_PX, pixels};
use crate::record::{Record, Report};
use crate::verdict::Verdict;
use std::fs::File;
use std::io::{BufReader, BufWriter};
use std::path::{Path, PathBuf};

/// Thumbnails in a row, and rows on a page.
const GRID: [usize; 2] = [10, 12];
/// Pixels between tiles.
const GAP_PX: usize = 4;
/// Lines of text below a thumbnail.
const LINES: usize = 2;
const BACKGROUND: [u8; 3] = [32, 32, 32];
const TEXT: [u8; 3] = [220, 220, 220];

/// An RGB picture of eight bits per channel, rows from the top.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Width and height in pixels.
    pub size_px: [usize; 2],
    /// Three bytes per pixel.
    pub rgb8: Vec<u8>,
}

impl Picture {
    fn new([width, height]: [usize; 2], color: [u8; 3]) -> Self {
        Self { size_px: [width, height], rgb8: color.repeat(width * height) }
    }

    fn at(&self, [x, y]: [usize; 2]) -> [u8; 3] {
        let from = (y * self.size_px[0] + x) * 3;
        [self.rgb8[from], self.rgb8[from + 1], self.rgb8[from + 2]]
    }

    fn set(&mut self, [x, y]: [usize; 2], color: [u8; 3]) {
        if x < self.size_px[0] && y < self.size_px[1] {
            let from = (y * self.size_px[0] + x) * 3;
            self.rgb8[from..from + 3].copy_from_slice(&color);
        }
    }
}

/// Writes the pages beside the pictures, `sheet-1.png` and so on, and returns their paths.
///
/// # Errors
/// One line that names a file that cannot be read or written.
pub fn write(out: &Path, report: &Report) -> Result<Vec<PathBuf>, String> {
    let mut written = Vec::new();
    for (index, records) in report.files.chunks(GRID[0] * GRID[1]).enumerate() {
        let file = out.join(format!("sheet-{}.png", index + 1));
        let read = |record: &Record| {
            let picture = record.picture.as_ref().map(|picture| out.join(picture));
            picture
                .map(|picture| decode(&picture).map_err(|error| format!("{}: {error}", picture.display())))
                .transpose()
        };
        let pictures = records.iter().map(read).collect::<Result<Vec<_>, _>>()?;
        let sheet = page(records, &pictures, report.with.size_px.map(|side| side as usize));
        encode(&file, &sheet).map_err(|error| format!("{}: {error}", file.display()))?;
        written.push(file);
    }
    Ok(written)
}

/// Lays out one page. A file without a picture has a tile of one color: its verdict's.
#[must_use]
pub fn page(records: &[Record], pictures: &[Option<Picture>], tile_px: [usize; 2]) -> Picture {
    let cell = [tile_px[0] + GAP_PX, tile_px[1] + LINES * CELL_PX[1] + GAP_PX + 2];
    let columns = GRID[0].min(records.len().max(1));
    let rows = records.len().div_ceil(columns).max(1);
    let mut sheet = Picture::new([columns * cell[0] + GAP_PX, rows * cell[1] + GAP_PX], BACKGROUND);
    for (index, (record, picture)) in records.iter().zip(pictures).enumerate() {
        let corner = [index % columns * cell[0] + GAP_PX, index / columns * cell[1] + GAP_PX];
        for y in 0..tile_px[1] {
            for x in 0..tile_px[0] {
                let color = picture.as_ref().map_or(color(record.verdict), |picture| sampled(picture, [x, y], tile_px));
                sheet.set([corner[0] + x, corner[1] + y], color);
            }
        }
        let letters = tile_px[0] / CELL_PX[0];
        let (folder, name) = record.file.rsplit_once('/').unwrap_or(("", &record.file));
        let below = if record.verdict == Verdict::Ok { folder } else { record.verdict.word() };
        for (line, text) in [name, below].into_iter().enumerate() {
            let top = corner[1] + tile_px[1] + 2 + line * CELL_PX[1];
            let color = if line == 1 && record.verdict != Verdict::Ok { color(record.verdict) } else { TEXT };
            pixels(end_of(text, letters)).for_each(|[x, y]| sheet.set([corner[0] + x, top + y], color));
        }
    }
    sheet
}

/// Returns the color of the nearest pixel of a picture that is stretched over a tile.
fn sampled(picture: &Picture, at: [usize; 2], tile_px: [usize; 2]) -> [u8; 3] {
    picture.at([0, 1].map(|axis| (2 * at[axis] + 1) * picture.size_px[axis] / (2 * tile_px[axis])))
}

/// Returns at most the last `count` characters: the ends of paths tell files apart.
fn end_of(text: &str, count: usize) -> &str {
    let skipped = text.chars().count().saturating_sub(count);
    text.char_indices().nth(skipped).map_or("", |(at, _)| &text[at..])
}

fn color(verdict: Verdict) -> [u8; 3] {
    match verdict {
        Verdict::Ok => TEXT,
        Verdict::Refused => [110, 110, 150],
        Verdict::NonFinite => [255, 0, 255],
        Verdict::Failed | Verdict::Crashed => [220, 60, 40],
        Verdict::Hung | Verdict::Memory => [220, 150, 30],
    }
}

/// Reads a PNG as `render` writes it: RGBA of eight bits per channel.
///
/// # Errors
/// When the file cannot be read, or has another format.
pub fn decode(file: &Path) -> Result<Picture, String> {
    let open = File::open(file).map_err(|error| error.to_string())?;
    let mut reader = png::Decoder::new(BufReader::new(open)).read_info().map_err(|error| error.to_string())?;
    let size = reader.output_buffer_size().ok_or("the picture is too large")?;
    let mut rgba = vec![0; size];
    let info = reader.next_frame(&mut rgba).map_err(|error| error.to_string())?;
    if (info.color_type, info.bit_depth) != (png::ColorType::Rgba, png::BitDepth::Eight) {
        return Err("the picture is not RGBA of eight bits".to_owned());
    }
    let rgb8 = rgba.chunks_exact(4).flat_map(|texel| [texel[0], texel[1], texel[2]]).collect();
    Ok(Picture { size_px: [info.width as usize, info.height as usize], rgb8 })
}

fn encode(file: &Path, picture: &Picture) -> Result<(), png::EncodingError> {
    let [width, height] = picture.size_px.map(|side| side as u32);
    let mut encoder = png::Encoder::new(BufWriter::new(File::create(file)?), width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&picture.rgb8)?;
    writer.finish()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::Stamp;

    fn record(file: &str, verdict: Verdict) -> Record {
        Record {
            file: file.to_owned(),
            stamp: Stamp { bytes: 1, changed_ms: 1 },
            verdict,
            message: String::new(),
            warnings: Vec::new(),
            seconds: 0.1,
            peak_bytes: 0,
            picture: None,
        }
    }

    #[test]
    fn tiles_stand_in_rows_with_their_names_below() {
        let records: Vec<_> = (0..11).map(|n| record(&format!("folder/{n}l"), Verdict::Refused)).collect();
        let mut pictures = vec![None; 11];
        // Half as large as a tile: each of its pixels is four.
        let checker = Picture { size_px: [2, 1], rgb8: vec![255, 0, 0, 0, 255, 0] };
        pictures[10] = Some(checker);
        let sheet = page(&records, &pictures, [16, 16]);
        let cell = [16 + 4, 16 + 2 * 6 + 4 + 2];
        assert_eq!(sheet.size_px, [10 * cell[0] + 4, 2 * cell[1] + 4]);
        assert_eq!(sheet.at([4, 4]), color(Verdict::Refused));
        assert_eq!(sheet.at([3, 4]), BACKGROUND);
        let second = 4 + cell[1];
        assert_eq!((sheet.at([4, second]), sheet.at([12, second])), ([255, 0, 0], [0, 255, 0]));
        // The last row of the third letter of `10L` is full, and its first has one pixel.
        let (left, top) = (4 + 2 * 4, second + 16 + 2);
        let row = |y: usize| [0, 1, 2].map(|x| sheet.at([left + x, top + y]) == TEXT);
        assert_eq!((row(0), row(4)), ([true, false, false], [true; 3]));
    }

    #[test]
    fn long_names_keep_their_end() {
        assert_eq!((end_of("abcdef", 3), end_of("ab", 3), end_of("", 3), end_of("äöü", 2)), ("def", "ab", "", "öü"));
    }
}
