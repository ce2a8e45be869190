//! Color lookup tables (LUTs) from `.cube` files, as written by color grading software (Adobe, "Cube LUT Specification"
//! 1.0, 2013).
//!
//! DaVinci Resolve's extensions are supported: a 1D table before a 3D table, input ranges, and video range.

use crate::error::SceneError;
use crate::read::read_file;
use glam::DVec3;
use std::path::{Path, PathBuf};

/// Maximum number of entries along each axis of a 3D table, from the specification.
pub const MAX_CUBE_ENTRIES: usize = 256;
/// Maximum number of entries of a 1D table, from the specification.
pub const MAX_CURVE_ENTRIES: usize = 65536;

/// Error of loading a `.cube` file.
#[derive(thiserror::Error)]
#[non_exhaustive]
pub enum ColorTableError {
    /// The file cannot be read.
    #[error(transparent)]
    Read(#[from] SceneError),
    /// A line is invalid.
    #[error("{}: line {line}: {fault}", .file.display())]
    Line {
        /// Path of the file.
        file: PathBuf,
        /// Line number, counted from 1.
        line: usize,
        /// Problem with the line.
        fault: ColorTableFault,
    },
    /// The file is truncated or contains no table.
    #[error("{}: {fault}", .file.display())]
    Whole {
        /// Path of the file.
        file: PathBuf,
        /// Problem with the file.
        fault: ColorTableFault,
    },
}

impl std::fmt::Debug for ColorTableError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}

/// Problem with a `.cube` file.
#[derive(Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ColorTableFault {
    /// The file is not text.
    #[error("it is not UTF-8")]
    Text,
    /// A keyword is repeated or follows the first row of numbers.
    #[error("{0} comes a second time, or after the table has begun")]
    Late(&'static str),
    /// The values of a keyword are invalid.
    #[error("{keyword} takes {takes}")]
    Values {
        /// Name of the keyword.
        keyword: &'static str,
        /// Expected values.
        takes: &'static str,
    },
    /// A size is out of range.
    #[error("{keyword} is {value}; sizes go from 2 to {most}")]
    Size {
        /// Name of the keyword.
        keyword: &'static str,
        /// Size in the file.
        value: String,
        /// Maximum size.
        most: usize,
    },
    /// A row is not three finite numbers.
    #[error("a row of three finite numbers is needed, not `{0}`")]
    Row(String),
    /// A row of numbers precedes the size.
    #[error("the table begins before LUT_1D_SIZE or LUT_3D_SIZE says how large it is")]
    NoSize,
    /// The domain is empty.
    #[error(
        "a domain must begin below its end: DOMAIN_MIN below DOMAIN_MAX, and the first number of an input range below the second"
    )]
    Domain,
    /// The number of rows exceeds the size.
    #[error("there are more than the {0} rows that its size asks for")]
    TooManyRows(usize),
    /// The number of rows is below the size.
    #[error("there are {rows} rows, and its size asks for {needed}")]
    TooFewRows {
        /// Number of rows in the file.
        rows: usize,
        /// Number of rows that the size requires.
        needed: usize,
    },
}

impl std::fmt::Debug for ColorTableFault {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}

/// Color lookup table from a `.cube` file: a curve for each channel (1D), a 3D table, or a curve followed by a 3D
/// table.
#[derive(Clone, Debug, PartialEq)]
pub struct ColorTable {
    /// 1D table, applied first.
    curve: Option<Table>,
    /// 3D table, applied after the curve.
    cube: Option<Table>,
    /// True if the input is converted to video range before the tables (`LUT_IN_VIDEO_RANGE`).
    is_video_in: bool,
    /// True if the tables return video range, which is converted back (`LUT_OUT_VIDEO_RANGE`).
    is_video_out: bool,
    /// One warning for each ignored line, with the file name and the reason.
    pub warnings: Vec<String>,
}

impl ColorTable {
    /// Reads a `.cube` file.
    ///
    /// # Errors
    /// Returns a one-line error with the file, the line and the problem.
    pub fn load(file: &Path) -> Result<Self, ColorTableError> {
        Self::load_bytes(file, &read_file(file)?)
    }

    /// Parses the bytes of a `.cube` file; `file` is its name in errors. Memory use is bounded by the rows in the file,
    /// not by the sizes it states.
    ///
    /// # Errors
    /// Returns the errors of [`ColorTable::load`] except those of reading the file.
    pub fn load_bytes(file: &Path, bytes: &[u8]) -> Result<Self, ColorTableError> {
        let text = str::from_utf8(bytes)
            .map_err(|_| ColorTableError::Whole { file: file.into(), fault: ColorTableFault::Text })?;
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let mut read = Reading::default();
        for (index, line) in text.lines().enumerate() {
            let words = line.split('#').next().unwrap_or_default().trim();
            if !words.is_empty() {
                read.line(index + 1, words).map_err(|fault| ColorTableError::Line {
                    file: file.into(),
                    line: index + 1,
                    fault,
                })?;
            }
        }
        read.done(file).map_err(|fault| ColorTableError::Whole { file: file.into(), fault })
    }

    /// Maps `color` through the tables, interpolated linearly between entries. Colors beyond the domain of a table are
    /// clamped to it.
    pub fn sample(&self, color: DVec3) -> DVec3 {
        let [black, white] = VIDEO_RANGE;
        let input = if self.is_video_in { color * (white - black) + black } else { color };
        let tables = self.curve.iter().chain(&self.cube);
        let output = tables.fold(input, |color, table| table.sample(color));
        if self.is_video_out { (output - black) / (white - black) } else { output }
    }
}

/// Black and white in video range: 64 and 940 of 10 bits (Recommendation ITU-R BT.709-6, table 4.6).
const VIDEO_RANGE: [f64; 2] = [64.0 / 1023.0, 940.0 / 1023.0];

/// 1D or 3D table.
#[derive(Clone, Debug, PartialEq)]
struct Table {
    /// Number of entries along each axis, at least 2.
    entries: usize,
    /// True for a 3D table; false for a curve of each channel.
    cube: bool,
    /// Input colors of the first and the last entry of each axis.
    domain: [DVec3; 2],
    /// Output colors, red varying fastest.
    rows: Vec<[f32; 3]>,
}

impl Table {
    fn sample(&self, color: DVec3) -> DVec3 {
        let [low, high] = self.domain;
        let last = (self.entries - 1) as f64;
        let at = ((color - low) / (high - low)).clamp(DVec3::ZERO, DVec3::ONE) * last;
        let below = at.floor().min(DVec3::splat(last - 1.0));
        let (share, below) = ((at - below).to_array(), below.to_array().map(|x| x as usize));
        let row = |index: usize| DVec3::from_array(self.rows[index].map(f64::from));
        if !self.cube {
            let channel = |c: usize| row(below[c])[c] * (1.0 - share[c]) + row(below[c] + 1)[c] * share[c];
            return DVec3::new(channel(0), channel(1), channel(2));
        }
        let corner = |corner: usize| {
            let step = [corner & 1, corner >> 1 & 1, corner >> 2];
            let weight = |c: usize| if step[c] == 1 { share[c] } else { 1.0 - share[c] };
            let place = |c: usize| below[c] + step[c];
            row(place(0) + self.entries * (place(1) + self.entries * place(2))) * (weight(0) * weight(1) * weight(2))
        };
        (0..8).map(corner).sum()
    }
}

/// Maximum number of ignored lines that are listed individually; further ones are counted.
const MAX_WARNINGS: usize = 8;

/// State of reading a file.
#[derive(Debug, Default)]
struct Reading {
    /// Sizes of the 1D table and the 3D table.
    sizes: [Option<usize>; 2],
    /// `DOMAIN_MIN` and `DOMAIN_MAX`.
    domain: [Option<DVec3>; 2],
    /// `LUT_1D_INPUT_RANGE` and `LUT_3D_INPUT_RANGE`.
    ranges: [Option<[f64; 2]>; 2],
    is_video_in: bool,
    is_video_out: bool,
    rows: Vec<[f32; 3]>,
    /// Line and keyword of the first unknown keywords.
    unknown: Vec<(usize, String)>,
    unknown_count: usize,
}

impl Reading {
    fn line(&mut self, number: usize, line: &str) -> Result<(), ColorTableFault> {
        let (first, rest) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
        if !first.starts_with(|c: char| c.is_ascii_alphabetic()) || first.parse::<f32>().is_ok() {
            return self.row(line);
        }
        let keyword = match first {
            "TITLE" => return Ok(()),
            "LUT_1D_SIZE" => "LUT_1D_SIZE",
            "LUT_3D_SIZE" => "LUT_3D_SIZE",
            "DOMAIN_MIN" => "DOMAIN_MIN",
            "DOMAIN_MAX" => "DOMAIN_MAX",
            "LUT_1D_INPUT_RANGE" => "LUT_1D_INPUT_RANGE",
            "LUT_3D_INPUT_RANGE" => "LUT_3D_INPUT_RANGE",
            "LUT_IN_VIDEO_RANGE" => "LUT_IN_VIDEO_RANGE",
            "LUT_OUT_VIDEO_RANGE" => "LUT_OUT_VIDEO_RANGE",
            _ => {
                if self.unknown.len() < MAX_WARNINGS {
                    self.unknown.push((number, first.chars().take(40).collect()));
                }
                self.unknown_count += 1;
                return Ok(());
            }
        };
        let late = ColorTableFault::Late(keyword);
        if !self.rows.is_empty() {
            return Err(late);
        }
        let kind = usize::from(keyword.starts_with("LUT_3D"));
        let is_new = match keyword {
            "LUT_IN_VIDEO_RANGE" => !std::mem::replace(&mut self.is_video_in, true),
            "LUT_OUT_VIDEO_RANGE" => !std::mem::replace(&mut self.is_video_out, true),
            "DOMAIN_MIN" | "DOMAIN_MAX" => {
                let wrong = ColorTableFault::Values { keyword, takes: "three finite numbers" };
                let value = numbers::<3>(rest).map(DVec3::from_array).ok_or(wrong)?;
                self.domain[usize::from(keyword == "DOMAIN_MAX")].replace(value).is_none()
            }
            "LUT_1D_INPUT_RANGE" | "LUT_3D_INPUT_RANGE" => {
                let wrong = ColorTableFault::Values { keyword, takes: "two finite numbers" };
                self.ranges[kind].replace(numbers::<2>(rest).ok_or(wrong)?).is_none()
            }
            _ => {
                let most = [MAX_CURVE_ENTRIES, MAX_CUBE_ENTRIES][kind];
                let value = rest.trim();
                let size = value.parse().ok().filter(|size| (2..=most).contains(size));
                let wrong = || ColorTableFault::Size { keyword, value: value.chars().take(40).collect(), most };
                self.sizes[kind].replace(size.ok_or_else(wrong)?).is_none()
            }
        };
        if is_new { Ok(()) } else { Err(late) }
    }

    /// Returns the numbers of rows of the 1D table and the 3D table.
    fn needed(&self) -> Result<[usize; 2], ColorTableFault> {
        let [curve, cube] = self.sizes;
        if curve.is_none() && cube.is_none() {
            return Err(ColorTableFault::NoSize);
        }
        Ok([curve.unwrap_or(0), cube.unwrap_or(0).pow(3)])
    }

    fn row(&mut self, line: &str) -> Result<(), ColorTableFault> {
        let needed = self.needed()?.into_iter().sum();
        let row = numbers::<3>(line).filter(|row| row.iter().all(|x| x.abs() <= f64::from(f32::MAX)));
        let row = row.ok_or_else(|| ColorTableFault::Row(line.chars().take(40).collect()))?;
        if self.rows.len() >= needed {
            return Err(ColorTableFault::TooManyRows(needed));
        }
        self.rows.push(row.map(|x| x as f32));
        Ok(())
    }

    fn done(mut self, file: &Path) -> Result<ColorTable, ColorTableFault> {
        let [of_curve, of_cube] = self.needed()?;
        let (needed, rows) = (of_curve + of_cube, self.rows.len());
        if rows < needed {
            return Err(ColorTableFault::TooFewRows { rows, needed });
        }
        let warnings = self.warnings(file);
        let cube_rows = self.rows.split_off(of_curve);
        let [curve, cube] = self.sizes;
        // `DOMAIN_MIN` and `DOMAIN_MAX` describe the input of the file, hence of the table applied first.
        let curve_domain = self.domain_of(0, self.domain)?;
        let cube_domain = self.domain_of(1, if curve.is_some() { [None; 2] } else { self.domain })?;
        let table = |entries, cube, domain, rows| Table { entries, cube, domain, rows };
        Ok(ColorTable {
            curve: curve.map(|entries| table(entries, false, curve_domain, self.rows)),
            cube: cube.map(|entries| table(entries, true, cube_domain, cube_rows)),
            is_video_in: self.is_video_in,
            is_video_out: self.is_video_out,
            warnings,
        })
    }

    /// Returns the domain of a table: its input range if stated, otherwise `[low, high]`, otherwise 0 to 1.
    fn domain_of(&self, kind: usize, [low, high]: [Option<DVec3>; 2]) -> Result<[DVec3; 2], ColorTableFault> {
        if self.sizes[kind].is_none() {
            return Ok([DVec3::ZERO, DVec3::ONE]);
        }
        let domain = match self.ranges[kind] {
            Some(range) => range.map(DVec3::splat),
            None => [low.unwrap_or(DVec3::ZERO), high.unwrap_or(DVec3::ONE)],
        };
        // An infinite or NaN width would make coordinates NaN.
        let width = domain[1] - domain[0];
        if width.cmpgt(DVec3::ZERO).all() && width.is_finite() { Ok(domain) } else { Err(ColorTableFault::Domain) }
    }

    fn warnings(&self, file: &Path) -> Vec<String> {
        let file = file.display();
        let unknown =
            self.unknown.iter().map(|(line, word)| format!("{file}: line {line}: `{word}` is not known; ignored"));
        let mut warnings: Vec<String> = unknown.collect();
        if self.unknown_count > self.unknown.len() {
            warnings.push(format!("{file}: {} further lines are ignored", self.unknown_count - self.unknown.len()));
        }
        for (kind, name) in ["LUT_1D", "LUT_3D"].into_iter().enumerate() {
            if self.ranges[kind].is_some() && self.sizes[kind].is_none() {
                warnings.push(format!("{file}: {name}_INPUT_RANGE is ignored: there is no {name}_SIZE"));
            }
        }
        if self.domain.iter().any(Option::is_some) {
            let first = usize::from(self.sizes[0].is_none());
            if self.ranges[first].is_some() {
                warnings.push(format!("{file}: DOMAIN_MIN and DOMAIN_MAX are ignored: there is an input range"));
            }
        }
        warnings
    }
}

/// Parses exactly `N` finite numbers.
fn numbers<const N: usize>(text: &str) -> Option<[f64; N]> {
    let mut found = [0.0; N];
    let mut words = text.split_whitespace();
    for number in &mut found {
        *number = words.next()?.parse().ok().filter(|x: &f64| x.is_finite())?;
    }
    words.next().is_none().then_some(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<ColorTable, ColorTableError> {
        ColorTable::load_bytes(Path::new("looks/a.cube"), text.as_bytes())
    }

    /// Exchanges red and blue.
    const SWAPPED: &str =
        "TITLE \"swap\"\n# a comment\nLUT_3D_SIZE 2\n0 0 0\n0 0 1\n0 1 0\n0 1 1\n1 0 0\n1 0 1\n1 1 0\n1 1 1\n";

    #[test]
    fn tables_are_read_between_their_entries() -> Result<(), ColorTableError> {
        let swapped = read(SWAPPED)?;
        for color in [DVec3::new(0.1, 0.5, 0.9), DVec3::ZERO, DVec3::ONE] {
            assert!((swapped.sample(color) - DVec3::new(color.z, color.y, color.x)).length() < 1e-12, "{color}");
        }
        assert_eq!(swapped.sample(DVec3::new(-1.0, 2.0, 0.0)), DVec3::Y, "beyond the domain");
        let curves = read("LUT_1D_SIZE 3\nDOMAIN_MIN 0 0 0\nDOMAIN_MAX 2 2 2\n0 0 1\n0.5 0.1 0.5\n1 1 0\n")?;
        assert!((curves.sample(DVec3::new(0.5, 1.5, 1.0)) - DVec3::new(0.25, 0.55, 0.5)).length() < 1e-6);
        let ranged = read("LUT_1D_SIZE 2\nLUT_1D_INPUT_RANGE -1 1\n0 0 0\n1 1 1")?;
        assert!((ranged.sample(DVec3::ZERO) - 0.5).length() < 1e-12);
        Ok(())
    }

    /// A 1D table of three entries over −0.5 to 1.5, then a 3D table of two entries a side over 0 to 2.
    const SHAPED: &str = "TITLE \"shaper\"\nLUT_1D_SIZE 3\nLUT_1D_INPUT_RANGE -0.5 1.5\nLUT_3D_SIZE 2\n\
        LUT_3D_INPUT_RANGE 0.0 2.0\n0.0 0.1 0.2\n0.9 0.4 1.0\n2.0 1.6 1.2\n0.05 0.10 0.20\n0.80 0.15 0.10\n\
        0.10 0.90 0.25\n0.70 0.95 0.05\n0.00 0.20 1.00\n0.60 0.05 0.85\n0.15 0.65 0.75\n1.00 0.90 0.95\n";

    /// The expected colors are those of `colour.read_LUT(file).apply(color)` of colour-science 0.4.7 (PyPI).
    #[test]
    fn a_curve_before_a_table_is_applied_first() -> Result<(), ColorTableError> {
        let shaped = read(SHAPED)?;
        assert_eq!(shaped.warnings, [""; 0]);
        for (color, expected) in [
            ([0.0, 0.0, 0.0], [0.20278125, 0.218, 0.41010938]),
            ([1.0, 1.0, 1.0], [0.5843125, 0.495, 0.54353125]),
            ([0.25, 0.5, 0.9], [0.2740425, 0.271205, 0.57639]),
            ([1.4, -0.3, 0.6], [0.6731199, 0.1670024, 0.4909527]),
            ([0.1, 1.2, 0.4], [0.2760816, 0.5616416, 0.4981418]),
        ] {
            let (found, expected) = (shaped.sample(DVec3::from_array(color)), DVec3::from_array(expected));
            // Entries are f32, and the expected colors have seven digits.
            assert!((found - expected).abs().max_element() < 2e-7, "{color:?}: {found}, not {expected}");
        }
        // Without input ranges, DOMAIN_MIN and DOMAIN_MAX apply to the first table, the curve.
        let domain = "DOMAIN_MIN -0.5 -0.5 -0.5\nDOMAIN_MAX 1.5 1.5 1.5";
        let other = read(&SHAPED.replace("LUT_1D_INPUT_RANGE -0.5 1.5", domain))?;
        assert_eq!(other, shaped);
        let short = SHAPED.trim_end().rsplit_once('\n').map_or("", |(lines, _)| lines);
        assert!(read(short).is_err_and(|e| e.to_string().ends_with("there are 10 rows, and its size asks for 11")));
        assert!(read(&format!("{SHAPED}0 0 0")).is_err_and(|e| e.to_string().contains("more than the 11 rows")));
        Ok(())
    }

    #[test]
    fn video_range_is_converted_on_either_side() -> Result<(), ColorTableError> {
        let (input, output) = ("LUT_IN_VIDEO_RANGE\n", "LUT_OUT_VIDEO_RANGE\n");
        let identity = "LUT_1D_SIZE 2\n0 0 0\n1 1 1\n";
        let color = DVec3::new(0.0, 0.5, 1.0);
        // 64, 502 and 940 of 1023.
        let video = DVec3::new(0.06256109, 0.49071359, 0.91886608);
        let found = read(&format!("{input}{identity}"))?.sample(color);
        assert!((found - video).abs().max_element() < 1e-8, "{found}");
        let found = read(&format!("{output}{identity}"))?.sample(video);
        assert!((found - color).abs().max_element() < 1e-7, "{found}");
        let found = read(&format!("{input}{output}{identity}"))?.sample(color);
        assert!((found - color).abs().max_element() < 1e-12, "{found}");
        assert!(
            read(&format!("{input}{input}{identity}")).is_err_and(|e| e.to_string().contains("line 2: LUT_IN_VIDEO"))
        );
        Ok(())
    }

    #[test]
    fn unknown_words_and_unused_ranges_are_warned_of() -> Result<(), ColorTableError> {
        let marked = format!("\u{feff}{}", SWAPPED.replace("0 1 1", "GAMMA 2.4\n0 1 1"));
        let swapped = read(&marked)?;
        assert_eq!(swapped.warnings, ["looks/a.cube: line 7: `GAMMA` is not known; ignored"]);
        assert_eq!(swapped.sample(DVec3::X), DVec3::Z);
        let many = read(&format!("{}{SWAPPED}", "WORD\n".repeat(20)))?;
        assert_eq!((many.warnings.len(), many.warnings[8].as_str()), (9, "looks/a.cube: 12 further lines are ignored"));
        let other = read(&format!("LUT_1D_INPUT_RANGE 5 6\n{SWAPPED}"))?;
        assert_eq!(other.warnings, ["looks/a.cube: LUT_1D_INPUT_RANGE is ignored: there is no LUT_1D_SIZE"]);
        assert_eq!(other.sample(DVec3::X), DVec3::Z);
        let both = read(&format!("DOMAIN_MAX 5 5 5\nLUT_3D_INPUT_RANGE 0 2\n{SWAPPED}"))?;
        assert!(both.warnings[0].contains("DOMAIN_MIN and DOMAIN_MAX are ignored"), "{:?}", both.warnings);
        assert!((both.sample(DVec3::ONE) - 0.5).length() < 1e-12);
        Ok(())
    }

    #[test]
    fn what_is_wrong_is_named_with_its_line() {
        for (from, to, told) in [
            ("LUT_3D_SIZE 2", "LUT_3D_SIZE 1", "looks/a.cube: line 3: LUT_3D_SIZE is 1; sizes go from 2 to 256"),
            ("LUT_3D_SIZE 2", "LUT_3D_SIZE 99999999999", "line 3: LUT_3D_SIZE is 99999999999"),
            ("LUT_3D_SIZE 2", "LUT_3D_SIZE 3", "looks/a.cube: there are 8 rows, and its size asks for 27"),
            ("LUT_3D_SIZE 2", "LUT_1D_SIZE 2", "line 6: there are more than the 2 rows"),
            ("LUT_3D_SIZE 2\n", "", "line 3: the table begins before"),
            ("LUT_3D_SIZE 2", "LUT_3D_SIZE 2\nLUT_3D_SIZE 2", "line 4: LUT_3D_SIZE comes a second time"),
            ("0 1 1", "0 NaN 1", "line 7: a row of three finite numbers is needed, not `0 NaN 1`"),
            ("0 1 1", "0 1", "line 7: a row"),
            ("0 1 1", "0 1 1 1", "line 7: a row"),
            ("0 1 1", "inf 1 1", "line 7: a row"),
            ("0 1 1", "DOMAIN_MIN 0 0 0", "line 7: DOMAIN_MIN comes a second time, or after"),
            (
                "# a comment",
                "DOMAIN_MIN 1 0 0",
                "looks/a.cube: a domain must begin below its end: DOMAIN_MIN below DOMAIN_MAX",
            ),
            ("# a comment", "DOMAIN_MAX 1 1", "line 2: DOMAIN_MAX takes three finite numbers"),
        ] {
            assert!(SWAPPED.contains(from), "{from}");
            let error = read(&SWAPPED.replacen(from, to, 1)).expect_err(to).to_string();
            assert!(error.contains(told) && !error.contains('\n'), "{to}: {error}");
        }
        let error = ColorTable::load_bytes(Path::new("a.cube"), &[0xff, 0xfe]).expect_err("no text");
        assert_eq!(error.to_string(), "a.cube: it is not UTF-8");
        assert!(ColorTable::load(Path::new("no/such.cube")).is_err_and(|e| e.to_string().contains("no/such.cube")));
    }
}
