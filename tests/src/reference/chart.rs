//! Charts: tables of patches, `row,col,in_r,in_g,in_b,out_r,out_g,out_b`, row 0 at the top.

use super::rule::Patch;
use std::path::{Path, PathBuf};

/// A table cannot be read.
#[derive(thiserror::Error)]
pub enum ChartError {
    /// The file system reported an error.
    #[error("{file}: {error}")]
    File {
        /// Path of the file.
        file: PathBuf,
        /// Error of the file system.
        error: std::io::Error,
    },
    /// A line is invalid.
    #[error("{file}: line {line}: {reason}")]
    Line {
        /// Path of the file.
        file: PathBuf,
        /// Line number, from 1.
        line: usize,
        /// Description of the problem.
        reason: String,
    },
}

impl std::fmt::Debug for ChartError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}

const HEAD: &str = "row,col,in_r,in_g,in_b,out_r,out_g,out_b";

/// Reads a table; if `codes`, outputs are 8-bit values, otherwise linear light.
///
/// # Errors
/// [`ChartError`].
pub fn read(file: &Path, codes: bool) -> Result<Vec<Patch>, ChartError> {
    let text = std::fs::read_to_string(file).map_err(|error| ChartError::File { file: file.into(), error })?;
    parse(&text, codes).map_err(|(line, reason)| ChartError::Line { file: file.into(), line, reason })
}

fn parse(text: &str, codes: bool) -> Result<Vec<Patch>, (usize, String)> {
    let mut lines = text.lines().enumerate();
    match lines.next() {
        Some((_, head)) if head.trim() == HEAD => {}
        _ => return Err((1, format!("the head must be {HEAD}"))),
    }
    let mut rows: Vec<([u32; 2], [f64; 3])> = Vec::new();
    for (index, line) in lines.filter(|(_, line)| !line.trim().is_empty()) {
        let wrong = |reason: &str| (index + 1, reason.to_owned());
        let cells: Vec<&str> = line.split(',').map(str::trim).collect();
        let &[row, col, .., r, g, b] = cells.as_slice() else { return Err(wrong("a row needs eight cells")) };
        if cells.len() != 8 {
            return Err(wrong("a row needs eight cells"));
        }
        let place = |cell: &str| cell.parse::<u32>().ok().filter(|n| *n < 1 << 16);
        let number = |cell: &str| cell.parse::<f64>().ok().filter(|n| n.is_finite());
        let (Some(row), Some(col)) = (place(row), place(col)) else {
            return Err(wrong("row and column need small integers"));
        };
        let (Some(r), Some(g), Some(b)) = (number(r), number(g), number(b)) else {
            return Err(wrong("an output is not a number"));
        };
        rows.push(([col, row], [r, g, b]));
    }
    let count = |axis: usize| rows.iter().map(|(place, _)| place[axis] + 1).max().map_or(1.0, f64::from);
    let counts = [count(0), count(1)];
    let middle = |place: [u32; 2]| [0, 1].map(|axis| (f64::from(place[axis]) + 0.5) / counts[axis]);
    Ok(rows.into_iter().map(|(place, expected)| Patch { at: middle(place), expected, codes }).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patches_lie_on_a_grid() {
        let text = format!("{HEAD}\n0,0,1,1,1,5,6,7\n1,3,1,1,1,0.5,0,255\n");
        let patches = parse(&text, true).expect("a sound table");
        assert_eq!(patches[0], Patch { at: [0.125, 0.25], expected: [5.0, 6.0, 7.0], codes: true });
        assert_eq!(patches[1].at, [0.875, 0.75]);
        for (text, line) in
            [("", 1), ("row,col\n", 1), (&format!("{HEAD}\n0,0,1\n"), 2), (&format!("{HEAD}\n0,0,1,1,1,NaN,0,0"), 2)]
        {
            assert_eq!(parse(text, true).map_err(|(line, _)| line), Err(line), "{text}");
        }
    }
}
