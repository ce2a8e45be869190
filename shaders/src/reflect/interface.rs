//! The parts of a shader's interface, as plain data.

/// Everything a pipeline needs to know of a shader.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reflection {
    /// In the order of the text.
    pub entry_points: Vec<EntryPoint>,
    /// Pipeline-overridable constants, in the order of the text.
    pub overrides: Vec<Override>,
    /// Structs that uniform and storage variables hold, directly, in arrays or in other
    /// structs; each once.
    pub structs: Vec<StructLayout>,
}

/// A function that a pipeline can name.
#[derive(Clone, Debug, PartialEq)]
pub struct EntryPoint {
    /// Name in the text.
    pub name: String,
    /// Stage it runs in.
    pub stage: Stage,
    /// Resources it reaches, directly or through what it calls, ordered by group and binding.
    pub bindings: Vec<Binding>,
    /// Vertex stage: attributes by location. Empty for other stages.
    pub vertex_inputs: Vec<Attribute>,
    /// Fragment stage: color outputs by location. Empty for other stages.
    pub color_outputs: Vec<Attribute>,
    /// Compute stage: invocations per workgroup; zeros for other stages.
    pub workgroup_size: [u32; 3],
}

/// Programmable stages.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[expect(missing_docs, reason = "the names are the field's own")]
pub enum Stage {
    Vertex,
    Fragment,
    Compute,
}

/// A resource variable.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Binding {
    /// `@group`.
    pub group: u32,
    /// `@binding`.
    pub binding: u32,
    /// Name of the variable.
    pub name: String,
    /// What is bound there.
    pub kind: BindingKind,
}

/// What a binding holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum BindingKind {
    /// `var<uniform>`.
    Uniform {
        /// Size of the struct in bytes.
        size_bytes: u32,
    },
    /// `var<storage>`.
    Storage {
        /// False for `read_write`.
        read_only: bool,
        /// Least size of the buffer in bytes; for a run-time sized array that of one element.
        min_size_bytes: u32,
    },
    /// `texture_*`.
    Texture {
        /// Shape of the view.
        dimension: Dimension,
        /// What reading it gives.
        sample: Sample,
        /// Whether it has several samples per texel.
        multisampled: bool,
    },
    /// `texture_storage_*`; `format` is the WGSL name.
    StorageTexture {
        /// Shape of the view.
        dimension: Dimension,
        /// Texel format as written in WGSL.
        format: naga::StorageFormat,
        /// Whether shaders may read it.
        read: bool,
        /// Whether shaders may write it.
        write: bool,
    },
    /// `sampler` or `sampler_comparison`.
    Sampler {
        /// Whether it compares.
        comparison: bool,
    },
}

/// Shape of a texture view.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[expect(missing_docs, reason = "the names are the field's own")]
pub enum Dimension {
    D1,
    D2,
    D2Array,
    D3,
    Cube,
    CubeArray,
}

/// What reading a texture gives.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Sample {
    /// Floats; `filterable` where some entry point samples it through a sampler.
    Float {
        /// Whether the format must support linear filtering.
        filterable: bool,
    },
    /// Depth, read by comparison or as a number.
    Depth,
    /// Signed integers.
    Sint,
    /// Unsigned integers.
    Uint,
}

/// A value that enters or leaves a stage at a location.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Attribute {
    /// `@location`.
    pub location: u32,
    /// Kind of its components.
    pub scalar: Scalar,
    /// Number of components, 1…4.
    pub components: u32,
}

/// Kind of a component.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[expect(missing_docs, reason = "the names are the field's own")]
pub enum Scalar {
    F16,
    F32,
    I32,
    U32,
    Bool,
}

/// A pipeline-overridable constant.
#[derive(Clone, Debug, PartialEq)]
pub struct Override {
    /// Name, the key under which a pipeline sets it.
    pub name: String,
    /// Kind of its value.
    pub scalar: Scalar,
    /// Its value where the pipeline sets none, if it is a literal; bools as 0 and 1.
    pub default: Option<f64>,
}

/// Memory layout of a struct by the rules of WGSL (section 14.4).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StructLayout {
    /// Name of the struct.
    pub name: String,
    /// Size in bytes, padding at the end included.
    pub size_bytes: u32,
    /// In order.
    pub members: Vec<Member>,
}

/// A member of a struct.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Member {
    /// Its name.
    pub name: String,
    /// Where it begins, from the start of the struct.
    pub offset_bytes: u32,
    /// Its own size, without what pads it.
    pub size_bytes: u32,
}

/// A binding and the stages of one pipeline that reach it.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Slot {
    /// The binding.
    pub binding: Binding,
    /// Reached by the vertex stage.
    pub vertex: bool,
    /// Reached by the fragment stage.
    pub fragment: bool,
    /// Reached by the compute stage.
    pub compute: bool,
}

impl Reflection {
    /// The entry point of that name.
    pub fn entry_point(&self, name: &str) -> Option<&EntryPoint> {
        self.entry_points.iter().find(|entry| entry.name == name)
    }

    /// The layout of a pipeline made of the named entry points: for each group from zero to
    /// the highest in use, its slots by binding. A group that none reaches is empty. Names
    /// that do not exist contribute nothing.
    pub fn groups(&self, entry_points: &[&str]) -> Vec<Vec<Slot>> {
        let mut groups: Vec<Vec<Slot>> = Vec::new();
        for entry in entry_points.iter().filter_map(|name| self.entry_point(name)) {
            for binding in &entry.bindings {
                let group = binding.group as usize;
                if groups.len() <= group {
                    groups.resize(group + 1, Vec::new());
                }
                add(&mut groups[group], binding, entry.stage);
            }
        }
        groups
    }
}

/// Adds a stage to the slot of a binding, making the slot where there is none.
fn add(slots: &mut Vec<Slot>, binding: &Binding, stage: Stage) {
    let found = slots.binary_search_by_key(&binding.binding, |slot| slot.binding.binding);
    let at = found.unwrap_or_else(|at| {
        let binding = binding.clone();
        slots.insert(at, Slot { binding, vertex: false, fragment: false, compute: false });
        at
    });
    let slot = &mut slots[at];
    slot.binding.kind = widest(slot.binding.kind, binding.kind);
    match stage {
        Stage::Vertex => slot.vertex = true,
        Stage::Fragment => slot.fragment = true,
        Stage::Compute => slot.compute = true,
    }
}

/// A texture that one stage filters and another only loads must be filterable.
fn widest(a: BindingKind, b: BindingKind) -> BindingKind {
    let filterable = |kind| matches!(kind, BindingKind::Texture { sample: Sample::Float { filterable: true }, .. });
    if filterable(b) { b } else { a }
}
