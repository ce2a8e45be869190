//! Plugin kinds that graph files can name: the standard passes.

use framegraph::Graph;
use framegraph::file::{Registry, SlotType};

/// Returns the registry of the standard passes.
pub fn registry() -> Registry<'static, Graph> {
    framegraph_passes::frame::plugins::registry()
}

/// Lists every kind with its slots, one line per kind.
pub fn listed(registry: &Registry<'_, Graph>) -> String {
    let mut lines = String::new();
    for kind in registry.kinds() {
        let slots = registry.slots(kind).unwrap_or_default().iter().map(|slot| {
            let takes = match slot.ty {
                SlotType::Texture => "texture to read",
                SlotType::Buffer => "buffer to read",
                SlotType::Target => "texture to write",
                SlotType::TargetBuffer => "buffer to write",
            };
            format!("{}: {takes}{}", slot.name, if slot.optional { " (optional)" } else { "" })
        });
        lines += &format!("{kind}  {}\n", slots.collect::<Vec<_>>().join(", "));
    }
    lines
}
