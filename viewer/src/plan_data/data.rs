//! Rows of a plan with lookup by name.

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

    /// Returns the bytes that shaders and copies of a step read from memory, each texture and buffer once and completely.
    ///
    /// Sampled, fetched, storage and copy reads count, unless the data stays in the tile. Attachment loads are counted
    /// separately ([`Step::unresolve_bytes`]).
    pub fn fetched_bytes(&self, step: &Step) -> u64 {
        let mut read: Vec<usize> = Vec::new();
        for pass in step.passes.iter().filter_map(|name| self.pass(name)) {
            let pass = &self.form.passes[pass];
            let in_tile = matches!(pass.join.as_deref(), Some("same_pixel" | "inlined"));
            let from_memory = |access: &&Access| match access.kind.as_str() {
                "same_pixel" => !in_tile,
                "sampled" | "storage_read" | "copy_source" => true,
                "storage_write" => access.mode == "modify",
                _ => false,
            };
            let names = pass.accesses.iter().filter(from_memory);
            read.extend(names.filter_map(|access| self.resource(&access.resource)));
        }
        read.sort_unstable();
        read.dedup();
        read.iter().fold(0, |sum: u64, r| sum.saturating_add(self.form.resources[*r].bytes))
    }

    /// Returns the attachments of a step that are this resource.
    pub fn attached<'a>(&self, step: &'a Step, resource: &'a str) -> impl Iterator<Item = &'a Attachment> {
        step.attachments.iter().filter(move |a| a.resource == resource)
    }
}
