//! Which standard shaders are compiled with their loops counted at run time.

use framegraph_shaders::{Feature, Features, library, resolve};
use framegraph_wgpu::endless_loop;
use std::collections::BTreeMap;
use std::error::Error;

/// Whose loops go by steps of floats, or to a bound that the text does not have: the document lists them, and no other.
#[test]
fn the_document_names_the_shaders_whose_loops_are_counted() -> Result<(), Box<dyn Error>> {
    let document = include_str!("../../../docs/performance.md");
    let (mut counted, mut free) = (BTreeMap::new(), 0);
    for module in library::passes() {
        let features = std::iter::once(Features::NONE).chain(Feature::all().map(|own| Features::NONE.with(own)));
        let mut texts = 0;
        for shader in features.filter_map(|features| resolve(&module, &features, &[]).ok()) {
            texts += 1;
            if let Some(function) = endless_loop(&shader.wgsl) {
                counted.insert(module.name().to_owned(), function);
            }
        }
        assert!(texts > 0, "{} has no variant", module.name());
        free += usize::from(!counted.contains_key(module.name()));
    }
    println!("{free} shaders whose loops are proved to end; counted: {counted:?}");
    let (_, after) = document.split_once("<!-- table: loops -->").ok_or("the document has the table")?;
    let (table, _) = after.split_once("<!-- end -->").ok_or("the table ends")?;
    let rows: Vec<_> = table.lines().filter(|line| line.starts_with("| `")).collect();
    let expected: Vec<_> = counted.iter().map(|(pass, function)| format!("| `{pass}` | `{function}` |")).collect();
    assert_eq!(rows, expected);
    Ok(())
}
