//! Explanation of rejected bind groups, in terms of the shader's variables.

use crate::pipelines::bind_groups::Binding;
use std::fmt;
use wgpu::naga;

/// Error: wgpu rejected a bind group.
#[derive(Clone, PartialEq, Eq, thiserror::Error)]
#[error("{}: {reason}", place(.shader, *.group, *.binding, .variable.as_deref()))]
pub struct BindingError {
    /// Name of the shader; empty if the layout was created without one.
    pub shader: String,
    /// Index of the bind group.
    pub group: usize,
    /// `@binding` number at fault, if known.
    pub binding: Option<u32>,
    /// Shader variable with this number.
    pub variable: Option<String>,
    /// Reason.
    pub reason: BindingReason,
}

/// Reason why a bind group was rejected.
#[derive(Clone, PartialEq, Eq, thiserror::Error)]
pub enum BindingReason {
    /// The pipeline has no bind group with this index.
    #[error("the pipeline has {groups} bind groups, counted from 0; use one that its entry points use")]
    NoGroup {
        /// Number of bind groups of the pipeline.
        groups: usize,
    },
    /// The bound buffer range is smaller than the shader's type.
    #[error(
        "{given} bytes are bound, but the shader's type needs {needed}; pad the struct as in WGSL, also after its last \
         member"
    )]
    TooSmall {
        /// Size of the bound range in bytes.
        given: u64,
        /// Size of the shader's type in bytes.
        needed: u64,
    },
    /// A variable has no binding.
    #[error("no resource is bound; pass its number and a resource to `Cx::bind_group`")]
    Missing,
    /// The shader does not use this binding number.
    #[error("the entry points of this pipeline do not use this binding; leave it out, or change its number")]
    Unused,
    /// Another reason, as reported by wgpu.
    #[error("{0}")]
    Refused(String),
}

impl fmt::Debug for BindingReason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl fmt::Debug for BindingError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

fn place(shader: &str, group: usize, binding: Option<u32>, variable: Option<&str>) -> String {
    let shader = if shader.is_empty() { String::new() } else { format!("shader `{shader}`, ") };
    let binding = binding.map_or_else(String::new, |number| format!(", binding {number}"));
    let variable = variable.map_or_else(String::new, |name| format!(" (`{name}`)"));
    format!("{shader}bind group {group}{binding}{variable}")
}

/// Explains wgpu's `message` about a bind group of the shader with this name and source.
pub(crate) fn explain(
    (shader, text): (&str, &str),
    group: usize,
    bindings: &[(u32, Binding)],
    message: String,
) -> BindingError {
    let variables = variables(text, group);
    let named = |number: u32| variables.iter().find(|v| v.number == number);
    let given = |number: u32| bindings.iter().find(|(n, _)| *n == number).map(|(_, binding)| binding);
    let small = variables.iter().find_map(|variable| match given(variable.number)? {
        Binding::Buffer { bytes: Some(bytes), .. } if bytes.get() < variable.bytes => {
            Some((variable.number, BindingReason::TooSmall { given: bytes.get(), needed: variable.bytes }))
        }
        _ => None,
    });
    let missing = || variables.iter().find(|v| given(v.number).is_none()).map(|v| (v.number, BindingReason::Missing));
    let unused = || bindings.iter().find(|(n, _)| named(*n).is_none()).map(|(n, _)| (*n, BindingReason::Unused));
    let found = match small {
        Some(small) => Some(small),
        // In this case wgpu only reports the number of bindings, not which one is missing or unused.
        None if message.contains("Number of bindings") => missing().or_else(unused),
        None if message.contains("corresponding declaration") => numbered(&message).map(|n| (n, BindingReason::Unused)),
        None => None,
    };
    let (binding, reason) = match found {
        Some((number, reason)) => (Some(number), reason),
        None => (numbered(&message), BindingReason::Refused(message)),
    };
    let variable = binding.and_then(named).map(|v| v.name.clone());
    BindingError { shader: shader.to_owned(), group, binding, variable, reason }
}

/// Parses the number after the word "binding" in wgpu's message.
fn numbered(message: &str) -> Option<u32> {
    let mut behind = message.split("inding ").skip(1);
    behind.find_map(|text| text.split(|c: char| !c.is_ascii_digit()).next()?.parse().ok())
}

/// A resource variable of a shader.
struct Variable {
    number: u32,
    name: String,
    /// Minimum buffer size in bytes; 0 for textures and samplers.
    bytes: u64,
}

/// Returns the variables of one bind group of a shader; none if its source does not parse.
fn variables(text: &str, group: usize) -> Vec<Variable> {
    let Ok(module) = naga::front::wgsl::parse_str(text) else { return Vec::new() };
    let all = module.global_variables.iter().filter_map(|(_, variable)| {
        let place = variable.binding.as_ref().filter(|place| place.group as usize == group)?;
        let buffer = matches!(variable.space, naga::AddressSpace::Uniform | naga::AddressSpace::Storage { .. });
        let bytes = if buffer { u64::from(module.types[variable.ty].inner.size(module.to_ctx())) } else { 0 };
        Some(Variable { number: place.binding, name: variable.name.clone().unwrap_or_default(), bytes })
    });
    all.collect()
}
