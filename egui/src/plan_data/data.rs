//! Rows of a plan with lookup by name.

use super::part::part_bytes;
use super::rows::{Access, Attachment, Form, Step};
use framegraph::Plan;
use std::collections::HashMap;
use std::sync::Arc;

/// Rows of a plan with lookup by name.
#[derive(Clone, Debug, Default)]
pub struct PlanData {
    /// Fields of the JSON form.
    pub form: Form,
    /// Notes of the reader: unknown fields, and missing fields of older files.
    pub notes: Vec<String>,
    /// Source location of each pass by index; empty if unknown, as in a saved plan.
    pub declared_at: Vec<String>,
    /// The plan itself; `None` for a saved plan.
    pub plan: Option<Arc<Plan>>,
    passes: HashMap<String, usize>,
    resources: HashMap<String, usize>,
}

impl PlanData {
    /// Indexes the rows of a form by name. The first row of a name wins.
    pub fn new(form: Form, notes: Vec<String>) -> Self {
        let mut passes = HashMap::new();
        for (index, pass) in form.passes.iter().enumerate() {
            passes.entry(pass.name.clone()).or_insert(index);
        }
        let mut resources = HashMap::new();
        for (index, resource) in form.resources.iter().enumerate() {
            resources.entry(resource.name.clone()).or_insert(index);
        }
        Self { form, notes, declared_at: Vec::new(), plan: None, passes, resources }
    }

    /// Returns the index of a pass in [`Form::passes`].
    pub fn pass(&self, name: &str) -> Option<usize> {
        self.passes.get(name).copied()
    }

    /// Returns the index of a resource in [`Form::resources`].
    pub fn resource(&self, name: &str) -> Option<usize> {
        self.resources.get(name).copied()
    }

    /// Returns the bytes that shaders and copies of a step read from memory, each part of a texture or buffer once and
    /// completely.
    ///
    /// Sampled, fetched, storage and copy reads count, unless the data stays in the tile. Attachment loads are counted
    /// separately ([`Step::unresolve_bytes`]).
    pub fn fetched_bytes(&self, step: &Step) -> u64 {
        let mut read: Vec<(usize, Option<&str>)> = Vec::new();
        for pass in step.passes.iter().filter_map(|name| self.pass(name)) {
            let pass = &self.form.passes[pass];
            let in_tile = matches!(pass.join.as_deref(), Some("same_pixel" | "inlined"));
            let from_memory = |access: &&Access| match access.kind.as_str() {
                "same_pixel" => !in_tile,
                "sampled" | "storage_read" | "copy_source" => true,
                "storage_write" => access.mode == "modify",
                _ => false,
            };
            let accesses = pass.accesses.iter().filter(from_memory);
            read.extend(accesses.filter_map(|a| Some((self.resource(&a.resource)?, a.part.as_deref()))));
        }
        read.sort_unstable();
        read.dedup();
        let of_resource = read.chunk_by(|a, b| a.0 == b.0);
        of_resource.fold(0, |sum: u64, parts| {
            let resource = &self.form.resources[parts[0].0];
            let bytes = parts.iter().fold(0u64, |sum, (_, part)| sum.saturating_add(part_bytes(resource, *part)));
            sum.saturating_add(bytes.min(resource.bytes))
        })
    }

    /// Returns the attachments of a step that are this resource.
    pub fn attached<'a>(&self, step: &'a Step, resource: &'a str) -> impl Iterator<Item = &'a Attachment> {
        step.attachments.iter().filter(move |a| a.resource == resource)
    }
}
