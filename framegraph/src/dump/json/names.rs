//! Unique names of passes and resources, used instead of ids.

use crate::graph::Tables;
use crate::id::{PassId, ResourceId};
use std::collections::{HashMap, HashSet};

/// The name of each pass and resource. Duplicates get the suffix `#2`, `#3` and so on.
pub(super) struct Names {
    passes: Vec<String>,
    resources: Vec<String>,
}

impl Names {
    pub(super) fn new(graph: &Tables) -> Self {
        let passes = graph.pass_ids().map(|p| graph.pass_name(p)).collect();
        let resources = graph.resource_ids().map(|r| graph.resource_name(r)).collect();
        Self { passes: deduplicate(passes), resources: deduplicate(resources) }
    }

    pub(super) fn pass(&self, pass: PassId) -> &str {
        &self.passes[pass.index()]
    }

    pub(super) fn resource(&self, resource: ResourceId) -> &str {
        &self.resources[resource.index()]
    }
}

/// Adds suffixes to duplicates. Skips suffixes that would collide with another name.
fn deduplicate(names: Vec<&str>) -> Vec<String> {
    let given: HashSet<&str> = names.iter().copied().collect();
    let mut counts: HashMap<&str, u32> = HashMap::new();
    let unique = names.into_iter().map(|name| {
        let count = counts.entry(name).or_default();
        *count += 1;
        if *count == 1 {
            return name.to_owned();
        }
        loop {
            let unique = format!("{name}#{count}");
            if !given.contains(unique.as_str()) {
                return unique;
            }
            *count += 1;
        }
    });
    unique.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_names_are_told_apart() {
        assert_eq!(deduplicate(vec!["a", "b", "a", "a#2", "a", "b"]), ["a", "b", "a#3", "a#2", "a#4", "b#2"]);
    }
}
