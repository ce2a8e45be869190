//! Why a bind group was refused, in the words of the shader: which variable, what was given, what it takes.

use crate::pipelines::bind_groups::Binding;
use std::fmt;
use wgpu::naga;

/// wgpu refused a bind group.
#[derive(Clone, PartialEq, Eq, thiserror::Error)]
#[error("{}: {reason}", place(.shader, *.group, *.binding, .variable.as_deref()))]
pub struct BindingError {
    /// Name of the shader; empty for a layout that was made without one.
    pub shader: String,
    /// Index of the bind group.
    pub group: usize,
    /// The `@binding` number, where one is at fault.
    pub binding: Option<u32>,
    /// The shader's variable of that number.
    pub variable: Option<String>,
    /// What is wrong.
    pub reason: BindingReason,
}

/// What is wrong with a bind group.
#[derive(Clone, PartialEq, Eq, thiserror::Error)]
pub enum BindingReason {
    /// The pipeline has no such group.
    #[error("the pipeline has {groups} bind groups, counted from 0; ask for one that its entry points use")]
    NoGroup {
        /// How many it has.
        groups: usize,
    },
    /// A buffer that is smaller than the shader's type.
    #[error(
        "{given} bytes were given and the shader's type takes {needed}; give the struct WGSL's padding, also behind its last \
         member"
    )]
    TooSmall {
        /// Bytes given.
        given: u64,
        /// Bytes of the shader's type.
        needed: u64,
    },
    /// A variable that nothing was given for.
    #[error("nothing was given for it; pass its number and a binding to `Cx::bind_group`")]
    Missing,
    /// A number that the shader does not use in this group.
    #[error("the entry points of this pipeline use no such binding; leave it out, or number it as the shader does")]
    Unused,
    /// Something else, in wgpu's words.
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

/// What wgpu's `message` means for a group of the shader of that name and text.
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
        // wgpu compares how many there are; which one it misses, or has too many, it does not say.
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

/// The number behind the word "binding" in wgpu's message.
fn numbered(message: &str) -> Option<u32> {
    let mut behind = message.split("inding ").skip(1);
    behind.find_map(|text| text.split(|c: char| !c.is_ascii_digit()).next()?.parse().ok())
}

/// A variable of the shader that is bound.
struct Variable {
    number: u32,
    name: String,
    /// The least bytes that a buffer has; 0 for textures and samplers.
    bytes: u64,
}

/// The variables of one group of a shader; none when its text cannot be read.
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
