//! Tables in Markdown.

/// A table: header and rows.
#[derive(Debug)]
pub struct Table {
    rows: Vec<Vec<String>>,
}

impl Table {
    /// Creates a table with these columns.
    pub fn new(columns: &[&str]) -> Self {
        let head = columns.iter().map(|c| (*c).to_owned()).collect();
        Self { rows: vec![head, vec!["---".to_owned(); columns.len()]] }
    }

    /// Adds a row.
    pub fn row(&mut self, cells: Vec<String>) {
        assert_eq!(cells.len(), self.rows[0].len(), "a row has a cell for each column");
        self.rows.push(cells);
    }

    /// Returns the table as text.
    pub fn text(&self) -> String {
        self.rows.iter().map(|row| format!("| {} |\n", row.join(" | "))).collect()
    }
}

/// Returns a share in percent, rounded down, so that 100 % means all.
pub fn percent(part: usize, of: usize) -> String {
    let tenths = part * 1000 / of.max(1);
    format!("{}.{} %", tenths / 10, tenths % 10)
}

/// Formats a ratio above 1 as an excess in percent.
pub fn excess(ratio: f64) -> String {
    format!("{:.2} %", (ratio - 1.0) * 100.0)
}

/// Formats bytes in MiB.
pub fn mebibytes(bytes: u64) -> String {
    format!("{:.1}", bytes as f64 / f64::from(1 << 20))
}
