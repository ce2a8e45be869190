//! Standard shaders whose loops are counted at run time.

use framegraph_shaders::{Feature, Features, library, resolve};
use framegraph_wgpu::endless_loop;
use std::collections::BTreeMap;
use std::error::Error;

/// Returns the standard shaders with a counted loop, each with its first function that has one, and the number of the
/// others.
fn counted() -> (BTreeMap<String, String>, usize) {
    let (mut found, mut free) = (BTreeMap::new(), 0);
    for module in library::passes() {
        let features = std::iter::once(Features::NONE).chain(Feature::all().map(|own| Features::NONE.with(own)));
        let mut texts = 0;
        for shader in features.filter_map(|features| resolve(&module, &features, &[]).ok()) {
            texts += 1;
            if let Some(function) = endless_loop(&shader.wgsl) {
                found.insert(module.name().to_owned(), function);
            }
        }
        assert!(texts > 0, "{} has no variant", module.name());
        free += usize::from(!found.contains_key(module.name()));
    }
    (found, free)
}

fn compare(table: &str, found: &BTreeMap<String, String>) -> Result<(), Box<dyn Error>> {
    let document = include_str!("../../../docs/measurements/performance.md");
    let (_, after) = document.split_once(&format!("<!-- table: {table} -->")).ok_or("the document has the table")?;
    let (rows, _) = after.split_once("<!-- end -->").ok_or("the table ends")?;
    let rows: Vec<_> = rows.lines().filter(|line| line.starts_with("| `")).collect();
    let expected: Vec<_> = found.iter().map(|(pass, function)| format!("| `{pass}` | `{function}` |")).collect();
    program::line(expected.join("\n"));
    assert_eq!(rows, expected, "{table}");
    Ok(())
}

/// The document lists exactly the shaders whose loops use float steps or a bound that is not a constant.
#[test]
fn the_document_names_the_shaders_whose_loops_are_counted() -> Result<(), Box<dyn Error>> {
    let (counted, free) = counted();
    program::line(format_args!("{free} shaders whose loops are proved to end"));
    compare("loops", &counted)
}
