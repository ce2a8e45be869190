//! Errors documented in docs/design/lens.md, compared by tests: `cargo test -p tests --test it -- bloom:: dof:: fog::
//! --nocapture` prints its rows.

const DOCUMENT: &str = include_str!("../../../docs/design/lens.md");

/// Prints a row of the document, and checks that its last column is within 10 %, plus rounding, of the measured value.
#[allow(clippy::print_stdout, reason = "shown with --nocapture")]
pub fn documented(row: &str, found: f64) {
    println!("| {row} | {found:.4} |");
    let line = DOCUMENT.lines().find(|line| line.starts_with(&format!("| {row} |")));
    let line = line.unwrap_or_else(|| panic!("docs/design/lens.md has no row {row}"));
    let stated = line.trim_end_matches([' ', '|']).rsplit('|').next().and_then(|cell| cell.trim().parse::<f64>().ok());
    let stated = stated.unwrap_or_else(|| panic!("{line}: no number"));
    assert!(
        (stated - found).abs() <= 0.1 * stated + 5e-4,
        "{row}: docs/design/lens.md says {stated}, and {found} was found"
    );
}
