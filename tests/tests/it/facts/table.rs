//! The table of `docs/design/feature-culling.md` is the program's output, without times.

use super::TestResult;
use framegraph_wgpu::Gpu;
use tests::measure::facts::table::{heads, rows};

const DOCUMENT: &str = include_str!("../../../../docs/design/feature-culling.md");

fn cells(row: &str) -> Vec<&str> {
    row.trim_matches('|').split('|').map(str::trim).collect()
}

/// Plans and feature culling need no device.
#[test]
fn the_table_is_what_the_program_prints() -> TestResult {
    let (_, after) = DOCUMENT.split_once("<!-- table: facts -->\n").ok_or("the mark")?;
    let (table, _) = after.split_once("<!-- end -->").ok_or("the end of the table")?;
    let found: Vec<Vec<&str>> = table.lines().filter(|line| line.starts_with('|')).map(cells).collect();
    let printed = rows(&Gpu::noop()?, false)?;
    assert_eq!(Some(&found[0]), heads().lines().next().map(cells).as_ref());
    assert_eq!(found.len(), printed.len() + 2);
    for (found, printed) in found[2..].iter().zip(&printed) {
        let printed = cells(printed);
        let counts = printed.len() - 1;
        assert_eq!(found[..counts], printed[..counts]);
        // Culling increases no cost, in any column.
        for cell in &printed[4..counts] {
            let numbers: Vec<f64> = cell.split(" → ").map(str::parse).collect::<Result<_, _>>()?;
            assert!(numbers[1] <= numbers[0], "{printed:?}");
        }
    }
    Ok(())
}
