//! Standard shaders whose loops are counted, or whose indices are checked, at run time.

use framegraph_shaders::{Feature, Features, library, resolve};
use framegraph_wgpu::{endless_loop, unproved_index};
use std::collections::BTreeMap;
use std::error::Error;

/// Returns the standard shaders with a variant for which `of` returns a message, and the number of the others.
fn told(of: impl Fn(&str) -> Option<String>) -> (BTreeMap<String, String>, usize) {
    let (mut found, mut free) = (BTreeMap::new(), 0);
    for module in library::passes() {
        let features = std::iter::once(Features::NONE).chain(Feature::all().map(|own| Features::NONE.with(own)));
        let mut texts = 0;
        for shader in features.filter_map(|features| resolve(&module, &features, &[]).ok()) {
            texts += 1;
            if let Some(function) = of(&shader.wgsl) {
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
    let (counted, free) = told(endless_loop);
    program::line(format_args!("{free} shaders whose loops are proved to end"));
    compare("loops", &counted)
}

/// The document lists exactly the shaders that load texels by position, or have arrays of dynamic length.
#[test]
fn the_document_names_the_shaders_whose_indices_are_tested() -> Result<(), Box<dyn Error>> {
    let (tested, free) = told(unproved_index);
    program::line(format_args!("{free} shaders whose indices are proved to be in range"));
    compare("indices", &tested)
}
