//! The rows of a plan, found by name.

use super::rows::{Access, Attachment, Form, Step};
use framegraph::Plan;
use std::collections::HashMap;
use std::sync::Arc;

/// A plan with its rows found by name.
#[derive(Clone, Debug, Default)]
pub struct PlanData {
    /// The fields of the form.
    pub form: Form,
    /// What the reader has to say about the file: fields that it does not know, and what an older file lacks.
    pub notes: Vec<String>,
    /// Where each pass was declared, by its index; empty where nobody knows, as in a saved plan.
    pub declared_at: Vec<String>,
    /// The plan itself; none of a saved one.
    pub plan: Option<Arc<Plan>>,
    passes: HashMap<String, usize>,
    resources: HashMap<String, usize>,
}

impl PlanData {
    /// The rows of a form, with an index of their names. Of several rows with one name, the first is found.
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

    /// The index of a pass in [`Form::passes`].
    pub fn pass(&self, name: &str) -> Option<usize> {
        self.passes.get(name).copied()
    }

    /// The index of a resource in [`Form::resources`].
    pub fn resource(&self, name: &str) -> Option<usize> {
        self.resources.get(name).copied()
    }

    /// Bytes that the shaders and copies of a step read from memory if they read each texture and buffer once and whole:
    /// what is sampled, fetched, read as storage or copied, and not kept in the tile. Attachments that are loaded are
    /// counted elsewhere ([`Step::unresolve_bytes`]).
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

    /// The attachments of a step that are this resource.
    pub fn attached<'a>(&self, step: &'a Step, resource: &'a str) -> impl Iterator<Item = &'a Attachment> {
        step.attachments.iter().filter(move |a| a.resource == resource)
    }
}
