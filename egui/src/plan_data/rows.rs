//! Rows of a saved plan, one field each as documented in `docs/reference/plan-json.md`.
#![expect(missing_docs, reason = "docs/reference/plan-json.md documents each field under the same name")]

use serde::Deserialize;

/// The whole form.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
pub struct Form {
    pub schema: String,
    pub version: u64,
    pub name: String,
    pub caps: String,
    pub frame: [u32; 2],
    pub order: String,
    pub alias: String,
    pub warnings: Vec<Warning>,
    #[serde(default)]
    pub notes: Vec<Note>,
    pub totals: Totals,
    pub peak: Option<Peak>,
    pub passes: Vec<Pass>,
    /// `None` in files saved before the form had flows.
    pub flows: Option<Vec<Flow>>,
    pub steps: Vec<Step>,
    pub resources: Vec<Resource>,
    pub histories: Vec<History>,
    pub slots: Vec<Slot>,
    pub barriers: Vec<Barrier>,
    pub decisions: Vec<Decision>,
}

/// Probable mistake in the graph.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
pub struct Warning {
    pub warning: String,
    pub sentence: String,
}

/// Reason that an effect is in the frame, or was dropped.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
pub struct Note {
    pub about: String,
    pub sentence: String,
}

/// Counts and bytes of the whole plan.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
pub struct Totals {
    pub unresolves: u64,
    pub resolves: u64,
    pub unresolve_bytes: u64,
    pub resolve_bytes: u64,
    pub multisample_resolves: u64,
    pub multisample_resolve_bytes: u64,
    pub clears: u64,
    pub discards: u64,
    pub memoryless: u64,
    pub inlined: u64,
    pub steps: u64,
    pub render_passes: u64,
    pub passes: u64,
    pub culled: u64,
    pub heap_bytes: u64,
    pub lower_bound_bytes: u64,
    pub gap_bytes: u64,
    pub optimal: bool,
    pub unaliased_bytes: u64,
    pub avoided_bytes: u64,
    pub own_bytes: u64,
}

impl Totals {
    /// Returns every figure with its name, and whether it counts bytes, in the order of the form.
    pub fn rows(&self) -> [(&'static str, u64, bool); 21] {
        [
            ("unresolves", self.unresolves, false),
            ("resolves", self.resolves, false),
            ("unresolve_bytes", self.unresolve_bytes, true),
            ("resolve_bytes", self.resolve_bytes, true),
            ("multisample_resolves", self.multisample_resolves, false),
            ("multisample_resolve_bytes", self.multisample_resolve_bytes, true),
            ("clears", self.clears, false),
            ("discards", self.discards, false),
            ("memoryless", self.memoryless, false),
            ("inlined", self.inlined, false),
            ("steps", self.steps, false),
            ("render_passes", self.render_passes, false),
            ("passes", self.passes, false),
            ("culled", self.culled, false),
            ("heap_bytes", self.heap_bytes, true),
            ("lower_bound_bytes", self.lower_bound_bytes, true),
            ("gap_bytes", self.gap_bytes, true),
            ("optimal", self.optimal.into(), false),
            ("unaliased_bytes", self.unaliased_bytes, true),
            ("avoided_bytes", self.avoided_bytes, true),
            ("own_bytes", self.own_bytes, true),
        ]
    }
}

/// Step with the most live memory.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
pub struct Peak {
    pub step: usize,
    pub passes: Vec<String>,
    pub resources: Vec<String>,
}

/// Declared pass.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
pub struct Pass {
    pub name: String,
    pub kind: String,
    pub culled: bool,
    pub reason: String,
    pub step: Option<usize>,
    pub join: Option<String>,
    pub accesses: Vec<Access>,
}

/// Use of a resource by a pass.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
pub struct Access {
    pub resource: String,
    pub kind: String,
    pub mode: String,
    #[serde(default)]
    pub part: Option<String>,
}

impl Access {
    /// Returns whether the access changes contents.
    pub fn writes(&self) -> bool {
        self.mode != "read"
    }

    /// Returns whether the access needs earlier contents.
    pub fn reads(&self) -> bool {
        matches!(self.mode.as_str(), "read" | "modify")
    }
}

/// Dependency between two passes.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
pub struct Flow {
    pub from: String,
    pub to: String,
    pub resources: Vec<String>,
}

/// Step of the plan.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
pub struct Step {
    pub index: usize,
    pub kind: String,
    pub passes: Vec<String>,
    pub full_screen_resolve: bool,
    pub extent: [u32; 2],
    pub layers: u64,
    pub samples: u64,
    pub attachments: Vec<Attachment>,
    pub unresolves: u64,
    pub resolves: u64,
    pub unresolve_bytes: u64,
    pub resolve_bytes: u64,
}

/// Attachment of a step.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
pub struct Attachment {
    pub resource: String,
    pub role: String,
    pub slot: Option<u64>,
    pub resolve_mode: Option<String>,
    pub mip: u64,
    pub layer: u64,
    pub layers: u64,
    pub view: Option<String>,
    pub load: String,
    pub store: String,
    pub stencil_load: Option<String>,
    pub stencil_store: Option<String>,
    pub load_reason: String,
    pub store_reason: String,
    pub unresolve_bytes: u64,
    pub resolve_bytes: u64,
}

/// Declared resource.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
pub struct Resource {
    pub name: String,
    pub kind: String,
    pub entry: Option<Entry>,
    pub exit: Option<String>,
    /// Imports that may be bound to the same texture or buffer.
    #[serde(default)]
    pub may_alias: Vec<String>,
    pub shape: String,
    pub format: Option<String>,
    pub extent: Option<[u32; 2]>,
    pub mips: Option<u64>,
    pub layers: Option<u64>,
    pub samples: Option<u64>,
    pub usage: Vec<String>,
    pub first_step: Option<usize>,
    pub last_step: Option<usize>,
    pub held_steps: Option<[usize; 2]>,
    pub bytes: u64,
    pub memoryless: bool,
    pub placement: String,
    pub offset: Option<u64>,
    pub slot: Option<usize>,
}

/// Initial state of an import.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
pub struct Entry {
    pub defined: bool,
    pub state: String,
    pub stages: Vec<String>,
}

/// Texture that later frames read.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
pub struct History {
    pub name: String,
    pub images: u64,
    pub image_bytes: u64,
    pub offsets: Vec<u64>,
    pub previous: Vec<Previous>,
}

/// Earlier image of a history.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
pub struct Previous {
    pub resource: String,
    pub age: u64,
}

/// Physical texture or buffer of the pool.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
pub struct Slot {
    pub index: usize,
    pub shape: String,
    pub usage: Vec<String>,
    pub bytes: u64,
    pub offset: u64,
    pub tenants: Vec<String>,
}

/// Barrier: a layout transition or an aliasing barrier.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
pub struct Barrier {
    pub before_step: usize,
    pub resource: String,
    pub first_part: u64,
    pub parts: u64,
    pub from: String,
    pub to: String,
    pub from_stages: Vec<String>,
    pub to_stages: Vec<String>,
    pub after_step: Option<usize>,
    pub hand_over: Option<String>,
}

/// Decision with its reason.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
pub struct Decision {
    pub about: String,
    pub pass: Option<String>,
    pub resource: Option<String>,
    pub step: Option<usize>,
    pub reason: String,
    pub refusal: Option<String>,
    pub other_pass: Option<String>,
    pub other_resource: Option<String>,
    pub sentence: String,
    pub hint: Option<String>,
}
