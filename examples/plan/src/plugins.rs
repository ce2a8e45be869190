//! Plugin kinds that graph files can name: the standard passes.

use framegraph::Graph;
use framegraph::file::{Registry, Takes};

/// Returns the registry of the standard passes.
pub fn registry() -> Registry<'static, Graph> {
    framegraph_passes::plugins::registry()
}

/// Lists every kind with its slots, one line per kind.
pub fn listed(registry: &Registry<'_, Graph>) -> String {
    let mut lines = String::new();
    for kind in registry.kinds() {
        let slots = registry.slots(kind).unwrap_or_default().iter().map(|slot| {
            let takes = match slot.takes {
                Takes::Texture => "texture to read",
                Takes::Buffer => "buffer to read",
                Takes::Target => "texture to write",
                Takes::TargetBuffer => "buffer to write",
            };
            format!("{}: {takes}{}", slot.name, if slot.optional { " (optional)" } else { "" })
        });
        lines += &format!("{kind}  {}\n", slots.collect::<Vec<_>>().join(", "));
    }
    lines
}
