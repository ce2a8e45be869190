//! Tables of colors from `.cube` files (Adobe, "Cube LUT Specification" 1.0, 2013), as grading programs write them.

use crate::error::SceneError;
use crate::read::read_file;
use glam::DVec3;
use std::path::{Path, PathBuf};

/// Most entries along each axis of a table in three dimensions, as the specification says.
pub const MOST_CUBE_ENTRIES: usize = 256;
/// Most entries of a table of one dimension, as the specification says.
pub const MOST_CURVE_ENTRIES: usize = 65536;

/// A file is no table of colors.
#[derive(thiserror::Error)]
#[non_exhaustive]
pub enum ColorTableError {
    /// The file cannot be read.
    #[error(transparent)]
    Read(#[from] SceneError),
    /// A line is wrong.
    #[error("{}: line {line}: {fault}", .file.display())]
    Line {
        /// The file.
        file: PathBuf,
        /// From 1.
        line: usize,
        /// What is wrong.
        fault: ColorTableFault,
    },
    /// The file ends too early, or has no table at all.
    #[error("{}: {fault}", .file.display())]
    Whole {
        /// The file.
        file: PathBuf,
        /// What is wrong.
        fault: ColorTableFault,
    },
}

impl std::fmt::Debug for ColorTableError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}

/// What is wrong with a table of colors.
#[derive(Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ColorTableFault {
    /// The bytes are no text.
    #[error("it is not UTF-8")]
    Text,
    /// A keyword that the specification does not have.
    #[error(
        "`{0}` is no keyword of .cube files; they have TITLE, DOMAIN_MIN, DOMAIN_MAX, LUT_1D_SIZE, LUT_3D_SIZE, \
         LUT_1D_INPUT_RANGE and LUT_3D_INPUT_RANGE"
    )]
    Keyword(String),
    /// A keyword comes after the numbers have begun, or twice.
    #[error("{0} comes a second time, or after the table has begun")]
    Late(&'static str),
    /// A keyword has other values than it takes.
    #[error("{keyword} takes {takes}")]
    Values {
        /// The keyword.
        keyword: &'static str,
        /// What it takes.
        takes: &'static str,
    },
    /// A size is out of range.
    #[error("{keyword} is {value}; sizes go from 2 to {most}")]
    Size {
        /// The keyword.
        keyword: &'static str,
        /// The size.
        value: String,
        /// The largest.
        most: usize,
    },
    /// A row is not three finite numbers.
    #[error("a row of three finite numbers is needed, not `{0}`")]
    Row(String),
    /// Numbers come before a size.
    #[error("the table begins before LUT_1D_SIZE or LUT_3D_SIZE says how large it is")]
    NoSize,
    /// The domain is empty.
    #[error("DOMAIN_MIN must lie below DOMAIN_MAX in each channel")]
    Domain,
    /// There are more rows than the size asks for.
    #[error("there are more than the {0} rows that its size asks for")]
    TooManyRows(usize),
    /// There are fewer rows than the size asks for.
    #[error("there are {rows} rows, and its size asks for {needed}")]
    TooFewRows {
        /// Rows that there are.
        rows: usize,
        /// Rows that there should be.
        needed: usize,
    },
}

impl std::fmt::Debug for ColorTableFault {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}

/// A table of colors by color, of each channel alone or of all three together.
#[derive(Clone, Debug, PartialEq)]
pub struct ColorTable {
    /// Entries along each axis, at least 2.
    entries: usize,
    /// In three dimensions; otherwise a curve for each channel.
    cube: bool,
    /// The color at the first entry of each axis, and that at the last.
    domain: [DVec3; 2],
    /// Red fastest.
    rows: Vec<[f32; 3]>,
}

impl ColorTable {
    /// Reads a `.cube` file.
    ///
    /// # Errors
    /// One line that names the file, the line and what is wrong.
    pub fn load(file: &Path) -> Result<Self, ColorTableError> {
        Self::load_bytes(file, &read_file(file)?)
    }

    /// Reads bytes; `file` names them in errors. What a file claims takes no memory before its rows are there.
    ///
    /// # Errors
    /// As [`ColorTable::load`].
    pub fn load_bytes(file: &Path, bytes: &[u8]) -> Result<Self, ColorTableError> {
        let text = str::from_utf8(bytes)
            .map_err(|_| ColorTableError::Whole { file: file.into(), fault: ColorTableFault::Text })?;
        let mut read = Reading::default();
        for (index, line) in text.lines().enumerate() {
            let words = line.split('#').next().unwrap_or_default().trim();
            if !words.is_empty() {
                read.line(words).map_err(|fault| ColorTableError::Line {
                    file: file.into(),
                    line: index + 1,
                    fault,
                })?;
            }
        }
        read.done().map_err(|fault| ColorTableError::Whole { file: file.into(), fault })
    }

    /// The color that the table has for `color`, between its entries linearly; beyond the domain that of its end.
    pub fn sample(&self, color: DVec3) -> DVec3 {
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

/// A file as far as it has been read.
#[derive(Debug, Default)]
struct Reading {
    size: Option<(usize, bool)>,
    low: Option<DVec3>,
    high: Option<DVec3>,
    rows: Vec<[f32; 3]>,
}

impl Reading {
    fn line(&mut self, line: &str) -> Result<(), ColorTableFault> {
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
            _ => return Err(ColorTableFault::Keyword(first.chars().take(40).collect())),
        };
        let late = ColorTableFault::Late(keyword);
        if !self.rows.is_empty() {
            return Err(late);
        }
        let set =
            |place: &mut Option<DVec3>, value| if place.replace(value).is_some() { Err(late.clone()) } else { Ok(()) };
        let three = || {
            let wrong = ColorTableFault::Values { keyword, takes: "three finite numbers" };
            numbers::<3>(rest).map(DVec3::from_array).ok_or(wrong)
        };
        match keyword {
            "DOMAIN_MIN" => set(&mut self.low, three()?),
            "DOMAIN_MAX" => set(&mut self.high, three()?),
            "LUT_1D_INPUT_RANGE" | "LUT_3D_INPUT_RANGE" => {
                let wrong = ColorTableFault::Values { keyword, takes: "two finite numbers" };
                let [low, high] = numbers::<2>(rest).ok_or(wrong)?;
                set(&mut self.low, DVec3::splat(low))?;
                set(&mut self.high, DVec3::splat(high))
            }
            _ => {
                let cube = keyword == "LUT_3D_SIZE";
                let most = if cube { MOST_CUBE_ENTRIES } else { MOST_CURVE_ENTRIES };
                let value = rest.trim();
                let size = value.parse().ok().filter(|size| (2..=most).contains(size));
                let wrong = || ColorTableFault::Size { keyword, value: value.chars().take(40).collect(), most };
                let size = size.ok_or_else(wrong)?;
                if self.size.replace((size, cube)).is_some() { Err(late) } else { Ok(()) }
            }
        }
    }

    fn needed(&self) -> Result<usize, ColorTableFault> {
        let (entries, cube) = self.size.ok_or(ColorTableFault::NoSize)?;
        Ok(if cube { entries.pow(3) } else { entries })
    }

    fn row(&mut self, line: &str) -> Result<(), ColorTableFault> {
        let needed = self.needed()?;
        let row = numbers::<3>(line).filter(|row| row.iter().all(|x| x.abs() <= f64::from(f32::MAX)));
        let row = row.ok_or_else(|| ColorTableFault::Row(line.chars().take(40).collect()))?;
        if self.rows.len() >= needed {
            return Err(ColorTableFault::TooManyRows(needed));
        }
        self.rows.push(row.map(|x| x as f32));
        Ok(())
    }

    fn done(self) -> Result<ColorTable, ColorTableFault> {
        let (needed, rows) = (self.needed()?, self.rows.len());
        if rows < needed {
            return Err(ColorTableFault::TooFewRows { rows, needed });
        }
        let domain = [self.low.unwrap_or(DVec3::ZERO), self.high.unwrap_or(DVec3::ONE)];
        // A width that is no number would make coordinates that are none.
        let width = domain[1] - domain[0];
        if !(width.cmpgt(DVec3::ZERO).all() && width.is_finite()) {
            return Err(ColorTableFault::Domain);
        }
        let (entries, cube) = self.size.ok_or(ColorTableFault::NoSize)?;
        Ok(ColorTable { entries, cube, domain, rows: self.rows })
    }
}

/// So many finite numbers, and nothing else.
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

    /// Red and blue change places.
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
            ("0 1 1", "GAMMA 2", "line 7: `GAMMA` is no keyword"),
            ("0 1 1", "DOMAIN_MIN 0 0 0", "line 7: DOMAIN_MIN comes a second time, or after"),
            ("# a comment", "DOMAIN_MIN 1 0 0", "looks/a.cube: DOMAIN_MIN must lie below DOMAIN_MAX"),
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
