//! Packing instances as CSV: the `id,lower,upper,size` tables of the literature on static memory planning.
//!
//! The first line names the columns, in any order; each further line is one resource. Packings have a fifth column,
//! `offset`. This is the format of the MiniMalloc benchmarks: an item is live from `lower` up to, but not including,
//! `upper`.
//!
//! Older files use the columns `buffer,start,end,size`, with the meaning of MiniMalloc. `start` (or `begin`) is
//! `lower`. `end` is the last step at which the item is live, one less than `upper`. Output always uses `lower` and
//! `upper`.
//!
//! Ids may repeat and are kept unchanged, including spaces. They cannot contain commas, because quoting is not
//! supported. Control characters are escaped as in Rust (`\u{1b}`).
//!
//! ```
//! use framegraph_pack::{Options, Scratch, pack};
//! use framegraph_pack::csv;
//!
//! let table = csv::read("id,lower,upper,size\ndepth,0,3,4\nbloom,3,9,4\n")?;
//! let mut offsets = Vec::new();
//! pack(&table.items, None, &Options::default(), &mut Scratch::default(), &mut offsets)?;
//! assert_eq!(csv::write(&table, &offsets), "id,lower,upper,size,offset\ndepth,0,3,4,0\nbloom,3,9,4,0\n");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use core::fmt::Write as _;

use crate::Interval;

/// An instance and the names of its items.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Table {
    /// The `id` column.
    pub ids: Vec<String>,
    /// Lifetimes and sizes; the alignment is 1.
    pub items: Vec<Interval>,
}

/// Error in a table. Lines count from 1.
#[derive(Clone, PartialEq, Eq, thiserror::Error)]
pub enum CsvError {
    /// The header is missing.
    #[error("line {line}: no header; begin with id,lower,upper,size")]
    NoHeader {
        /// Expected line of the header.
        line: usize,
    },
    /// The header contains an unknown column.
    #[error("line {line}: unknown column {name:?}; the columns are id,lower,upper,size")]
    UnknownColumn {
        /// Line of the header.
        line: usize,
        /// Name of the column.
        name: String,
    },
    /// The header contains a column twice.
    #[error("line {line}: duplicate column {name}; list each of id,lower,upper,size once")]
    DuplicateColumn {
        /// Line of the header.
        line: usize,
        /// Name of the column.
        name: &'static str,
    },
    /// The header lacks a column.
    #[error("line {line}: missing column {name}; list each of id,lower,upper,size once")]
    MissingColumn {
        /// Line of the header.
        line: usize,
        /// Name of the column.
        name: &'static str,
    },
    /// A row has too many or too few fields.
    #[error("line {line}: {found} fields, but the header has 4; ids must not contain commas")]
    FieldCount {
        /// Line of the row.
        line: usize,
        /// Number of fields in the row.
        found: usize,
    },
    /// A field is not a number, or out of range.
    #[error("line {line}: {name} is {text:?}; use a whole number from 0 to {max}")]
    Number {
        /// Line of the row.
        line: usize,
        /// Name of the column.
        name: &'static str,
        /// The text of the field.
        text: String,
        /// Maximum value.
        max: u64,
    },
    /// A lifetime is empty.
    #[error("line {line}: item {id:?} has an empty lifetime, {lower} to {upper}; use an upper above lower")]
    EmptyLifetime {
        /// Line of the row.
        line: usize,
        /// Name of the item.
        id: String,
        /// Start of the lifetime.
        lower: u32,
        /// End of the lifetime.
        upper: u32,
    },
}

impl std::fmt::Debug for CsvError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}

const NAMES: [&str; 4] = ["id", "lower", "upper", "size"];
/// Names of the columns in older files; `end` is the last step of the lifetime.
const OLD_NAMES: [(&str, usize); 5] =
    [("buffer", ID), ("buffer_id", ID), ("start", LOWER), ("begin", LOWER), (LAST, UPPER)];
/// The name of the upper column that denotes the last step of the lifetime.
const LAST: &str = "end";
/// Maximum number of characters of a field in an error.
const MAX_SHOWN: usize = 60;
const ID: usize = 0;
const LOWER: usize = 1;
const UPPER: usize = 2;
const SIZE: usize = 3;

/// Reads an instance. Ignores empty lines, a byte order mark and carriage returns.
///
/// # Errors
/// Returns an error for the first invalid line; see [`CsvError`].
pub fn read(text: &str) -> Result<Table, CsvError> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut lines = (1..).zip(text.lines()).filter(|(_, line)| !line.trim().is_empty());
    let (line, header) = lines.next().ok_or(CsvError::NoHeader { line: 1 })?;
    let (columns, last) = read_header(line, header)?;
    let mut table = Table::default();
    for (line, row) in lines {
        let mut fields = [""; 4];
        let mut found = 0;
        for field in row.split(',') {
            if let Some(&column) = columns.get(found) {
                fields[column] = field;
            }
            found += 1;
        }
        if found != columns.len() {
            return Err(CsvError::FieldCount { line, found });
        }
        let number = |column: usize, max: u64| {
            let text = fields[column].trim();
            text.parse().ok().filter(|&value: &u64| value <= max).ok_or_else(|| CsvError::Number {
                line,
                name: NAMES[column],
                text: text.chars().take(MAX_SHOWN).collect(),
                max,
            })
        };
        let most = u64::from(u32::MAX) - u64::from(last);
        let (lower, upper) = (number(LOWER, most)? as u32, number(UPPER, most)? as u32 + u32::from(last));
        let size = number(SIZE, u64::MAX)?;
        let id = fields[ID].to_owned();
        if lower >= upper {
            let id = id.chars().take(MAX_SHOWN).collect();
            return Err(CsvError::EmptyLifetime { line, id, lower, upper });
        }
        table.ids.push(id);
        table.items.push(Interval { lower, upper, size, align: 1 });
    }
    Ok(table)
}

/// Returns the column of each field of a row, and `true` if the upper column denotes the last step.
fn read_header(line: usize, header: &str) -> Result<([usize; 4], bool), CsvError> {
    let (mut columns, mut last) = ([usize::MAX; 4], false);
    for (found, name) in header.split(',').map(str::trim).enumerate() {
        let known = NAMES.into_iter().zip(0..).chain(OLD_NAMES);
        let Some((known, column)) = known.into_iter().find(|(known, _)| name.eq_ignore_ascii_case(known)) else {
            return Err(CsvError::UnknownColumn { line, name: name.chars().take(MAX_SHOWN).collect() });
        };
        last |= known == LAST;
        if columns.contains(&column) {
            return Err(CsvError::DuplicateColumn { line, name: NAMES[column] });
        }
        columns[found] = column; // a fifth column would be a duplicate
    }
    match (0..NAMES.len()).find(|column| !columns.contains(column)) {
        Some(column) => Err(CsvError::MissingColumn { line, name: NAMES[column] }),
        None => Ok((columns, last)),
    }
}

/// Writes a packing as `id,lower,upper,size,offset`, in the order of the items.
///
/// # Panics
/// Panics if the number of offsets differs from the number of items.
pub fn write(table: &Table, offsets: &[u64]) -> String {
    assert_eq!(table.items.len(), offsets.len(), "one offset per item");
    let mut text = String::from("id,lower,upper,size,offset\n");
    for ((id, item), offset) in table.ids.iter().zip(&table.items).zip(offsets) {
        let Interval { lower, upper, size, align: _ } = item;
        for letter in id.chars() {
            if letter.is_control() {
                text.extend(letter.escape_default());
            } else {
                text.push(letter);
            }
        }
        writeln!(text, ",{lower},{upper},{size},{offset}").expect("writing to a string cannot fail");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_may_stand_in_any_order_and_have_their_old_names() {
        let table = read("\u{feff}size, end ,start,buffer\r\n4,3,0, a b \r\n\r\n5,9,3,c\r\n").unwrap();
        assert_eq!(table.ids, [" a b ", "c"]);
        // `end` is the last step of the lifetime.
        assert_eq!(table.items[0], Interval { lower: 0, upper: 4, size: 4, align: 1 });
        assert_eq!(table.items[1], Interval { lower: 3, upper: 10, size: 5, align: 1 });
        assert_eq!(write(&table, &[7, 0]), "id,lower,upper,size,offset\n a b ,0,4,4,7\nc,3,10,5,0\n");
        assert_eq!(read("id,begin,upper,size\na,1,2,3\n").unwrap().items[0].upper, 2);
        assert_eq!(read("buffer_id,start,end,size\na,2,2,3\n").unwrap().items[0].upper, 3);
        assert_eq!(read("id,lower,upper,size").unwrap(), Table::default());
    }

    #[test]
    fn no_control_character_of_an_id_is_written() {
        let table = read("id,lower,upper,size\na\u{1b}[31m\0\tb,0,1,2\n").unwrap();
        assert_eq!(write(&table, &[0]), "id,lower,upper,size,offset\na\\u{1b}[31m\\u{0}\\tb,0,1,2,0\n");
    }

    #[test]
    fn errors_name_line_and_remedy() {
        let says = |text: &str, what: &str| {
            let error = read(text).unwrap_err().to_string();
            assert!(error.contains(what), "{error}");
        };
        says("", "line 1: no header");
        says("\n\n", "line 1: no header");
        says("\nid,lower,upper,bytes\n", "line 2: unknown column \"bytes\"");
        says("id,lower,upper,size,offset\n", "line 1: unknown column \"offset\"");
        says("id,lower,upper,size,lower\n", "line 1: duplicate column lower");
        says("id,lower,size\n", "line 1: missing column upper");
        says("id,lower,upper,size\na,0,1\n", "line 2: 3 fields");
        says("id,lower,upper,size\na,0,1,2,3\n", "line 2: 5 fields");
        says("id,lower,upper,size\n\na,0,x,2\n", "line 3: upper is \"x\"");
        says("id,lower,upper,size\na,-1,2,2\n", "line 2: lower is \"-1\"");
        says("id,lower,upper,size\na,0,4294967296,2\n", "from 0 to 4294967295");
        says("id,lower,upper,size\na,0,2,18446744073709551616\n", "from 0 to 18446744073709551615");
        says("id,lower,end,size\na,3,2,1\n", "line 2: item \"a\" has an empty lifetime, 3 to 3");
        says("id,lower,end,size\na,0,4294967295,2\n", "from 0 to 4294967294");
        says("id,lower,upper,size\na,2,2,1\n", "line 2: item \"a\" has an empty lifetime, 2 to 2");
    }

    #[test]
    #[should_panic(expected = "one offset per item")]
    fn offsets_must_match() {
        write(&Table::default(), &[1]);
    }
}
