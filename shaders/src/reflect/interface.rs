//! Types that describe a shader's interface.

/// Complete interface of a shader, as needed to create pipelines.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reflection {
    /// Entry points, in the order of the text.
    pub entry_points: Vec<EntryPoint>,
    /// Pipeline-overridable constants, in the order of the text.
    pub overrides: Vec<Override>,
    /// Structs that uniform and storage variables hold directly, in arrays or in other structs. Each is listed once.
    pub structs: Vec<StructLayout>,
}

/// Function that a pipeline can name as its entry point.
#[derive(Clone, Debug, PartialEq)]
pub struct EntryPoint {
    /// Name in the WGSL text.
    pub name: String,
    /// Shader stage.
    pub stage: Stage,
    /// Resources that the entry point and its callees use, ordered by group and binding.
    pub bindings: Vec<Binding>,
    /// Attributes by location for the vertex stage; empty for other stages.
    pub vertex_inputs: Vec<Attribute>,
    /// Color outputs by location for the fragment stage; empty for other stages.
    pub color_outputs: Vec<Attribute>,
    /// Invocations per workgroup for the compute stage; zeros for other stages.
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

/// Resource variable.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Binding {
    /// Number in `@group`.
    pub group: u32,
    /// Number in `@binding`.
    pub binding: u32,
    /// Name of the variable.
    pub name: String,
    /// Type of the bound resource.
    pub kind: BindingKind,
}

/// Type of a bound resource.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum BindingKind {
    /// Uniform buffer, `var<uniform>`.
    Uniform {
        /// Size of the struct in bytes.
        size_bytes: u32,
    },
    /// Storage buffer, `var<storage>`.
    Storage {
        /// False for `read_write`.
        read_only: bool,
        /// Minimum size of the buffer in bytes; for a runtime-sized array, the size of one element.
        min_size_bytes: u32,
    },
    /// Sampled or depth texture, `texture_*`.
    Texture {
        /// Dimension of the view.
        dimension: Dimension,
        /// Type of the values that shaders read.
        sample: Sample,
        /// True for multisampled textures.
        multisampled: bool,
    },
    /// Storage texture, `texture_storage_*`.
    StorageTexture {
        /// Dimension of the view.
        dimension: Dimension,
        /// Texel format as written in WGSL.
        format: naga::StorageFormat,
        /// True if shaders can read it.
        read: bool,
        /// True if shaders can write it.
        write: bool,
    },
    /// `sampler` or `sampler_comparison`.
    Sampler {
        /// True for a comparison sampler.
        comparison: bool,
    },
}

/// Dimension of a texture view.
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

/// Type of the values read from a texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Sample {
    /// Floats.
    Float {
        /// True if an entry point samples the texture through a filtering sampler, so the format must support linear
        /// filtering.
        filterable: bool,
    },
    /// Depth, read by comparison or as a number.
    Depth,
    /// Signed integers.
    Sint,
    /// Unsigned integers.
    Uint,
}

/// Value that enters or leaves a stage at a location.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Attribute {
    /// Number in `@location`.
    pub location: u32,
    /// Component type.
    pub scalar: Scalar,
    /// Number of components, 1…4.
    pub components: u32,
}

/// Type of a component.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[expect(missing_docs, reason = "the names are the field's own")]
pub enum Scalar {
    F16,
    F32,
    I32,
    U32,
    Bool,
}

/// Pipeline-overridable constant.
#[derive(Clone, Debug, PartialEq)]
pub struct Override {
    /// Name, which is the key for setting it in a pipeline.
    pub name: String,
    /// Type of the value.
    pub scalar: Scalar,
    /// Default value, if it is a literal; booleans are 0 and 1.
    pub default: Option<f64>,
}

/// Memory layout of a struct by the rules of WGSL (section 14.4).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StructLayout {
    /// Name of the struct.
    pub name: String,
    /// Size in bytes, including padding at the end.
    pub size_bytes: u32,
    /// Members in order.
    pub members: Vec<Member>,
}

/// Member of a struct.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Member {
    /// Name of the member.
    pub name: String,
    /// Offset from the start of the struct, in bytes.
    pub offset_bytes: u32,
    /// Size in bytes, without padding.
    pub size_bytes: u32,
}

/// Binding, and the stages of one pipeline that use it.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Slot {
    /// The resource variable.
    pub binding: Binding,
    /// True if the vertex stage uses it.
    pub vertex: bool,
    /// True if the fragment stage uses it.
    pub fragment: bool,
    /// True if the compute stage uses it.
    pub compute: bool,
}

impl Reflection {
    /// Returns the entry point of this name.
    pub fn entry_point(&self, name: &str) -> Option<&EntryPoint> {
        self.entry_points.iter().find(|entry| entry.name == name)
    }

    /// Returns the bind groups of a pipeline with the named entry points: for each group from zero to the highest in
    /// use, its slots by binding. Unused groups are empty. Unknown names are ignored.
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

/// Adds a stage to the slot of a binding; creates the slot if necessary.
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

/// Merges the kinds of one binding in two stages. A texture that either stage filters must be filterable.
fn widest(a: BindingKind, b: BindingKind) -> BindingKind {
    let filterable = |kind| matches!(kind, BindingKind::Texture { sample: Sample::Float { filterable: true }, .. });
    if filterable(b) { b } else { a }
}
