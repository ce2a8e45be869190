//! Figures of `docs/measurements/image-light.md`. Tests that measure less than the program compare with its output. `cargo xtask
//! documents` prints the document again and compares every row.

const DOCUMENT: &str = include_str!("../../../docs/measurements/image-light.md");

/// Returns the cells of rows below a heading, with the heads of tables.
pub fn rows(heading: &str) -> Vec<Vec<&'static str>> {
    let start = format!("\n## {heading}");
    let (_, after) = DOCUMENT.split_once(&start).unwrap_or_else(|| panic!("there is no {heading}"));
    let section = after.split("\n## ").next().unwrap_or_default();
    let rows = section.lines().filter(|line| line.starts_with("| ") && !line.contains("---"));
    rows.map(|row| row.trim_matches('|').split('|').map(str::trim).collect()).collect()
}

/// Returns the numbers of the row that starts with these cells, for each further cell; percentages become shares.
pub fn numbers(heading: &str, first: &[&str]) -> Vec<Vec<f64>> {
    let rows = rows(heading);
    let row = rows.iter().find(|row| row.starts_with(first)).unwrap_or_else(|| panic!("{heading}: no row {first:?}"));
    let of_cell = |cell: &&str| {
        let share = if cell.contains('%') { 0.01 } else { 1.0 };
        let words = cell.split([' ', ',', '(', ')', '%']).filter_map(|word| word.parse::<f64>().ok());
        words.map(|number| number * share).collect()
    };
    row[first.len()..].iter().map(of_cell).collect()
}

#[test]
fn cells_hold_their_numbers() {
    let sun = numbers("Spherical harmonics", &["sun delta"]);
    assert!(sun.len() == 4 && sun[1].len() == 2 && sun[1][1] < 0.0, "{sun:?}");
    assert_eq!(numbers("DFG tables", &["Exact 64²"])[0].len(), 1);
}
