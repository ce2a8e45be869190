//! `docs/image-light.md` in numbers: tests that measure less than the program does compare with what it printed.
//! `cargo xtask documents` prints all of it anew and compares every row.

const DOCUMENT: &str = include_str!("../../../docs/image-light.md");

/// The rows under the heading that begins with `heading`, cell by cell, heads of tables among them.
pub fn rows(heading: &str) -> Vec<Vec<&'static str>> {
    let start = format!("\n## {heading}");
    let (_, after) = DOCUMENT.split_once(&start).unwrap_or_else(|| panic!("there is no {heading}"));
    let section = after.split("\n## ").next().unwrap_or_default();
    let rows = section.lines().filter(|line| line.starts_with("| ") && !line.contains("---"));
    rows.map(|row| row.trim_matches('|').split('|').map(str::trim).collect()).collect()
}

/// The numbers of the row that begins with these cells: of each further cell all that it holds, percents as shares.
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
