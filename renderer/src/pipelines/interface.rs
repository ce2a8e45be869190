//! Interface of a shader's source: what its entry points expect from recorders. A reload must not change it.

use crate::pipelines::shader::{InterfaceChange, ShaderError};
use std::collections::BTreeMap;
use wgpu::naga::{self, AddressSpace, Module, ShaderStage, TypeInner};

/// Entry points of a source. See the [module documentation](self).
pub(crate) struct Interface {
    entries: BTreeMap<String, Entry>,
    /// `override` constants by name or number, with whether they need a value.
    constants: BTreeMap<String, bool>,
}

/// Expectations of one entry point.
#[derive(Default)]
struct Entry {
    /// Variables that the entry point uses, by bind group and binding.
    bindings: BTreeMap<(u32, u32), Variable>,
    /// Types of vertex inputs by location; empty for other stages.
    inputs: BTreeMap<u32, String>,
    /// Types of fragment outputs by location; empty for other stages.
    outputs: BTreeMap<u32, String>,
}

struct Variable {
    kind: Kind,
    /// Declaration in the source.
    text: String,
}

/// Type of a variable as a bind group layout distinguishes it.
#[derive(PartialEq)]
enum Kind {
    Uniform {
        bytes: u32,
    },
    Storage {
        access: naga::StorageAccess,
        bytes: u32,
    },
    Image {
        dim: naga::ImageDimension,
        arrayed: bool,
        class: naga::ImageClass,
    },
    Sampler {
        comparison: bool,
    },
    /// Arrays of resources, which are compared by their declaration.
    Other(String),
}

impl Kind {
    /// Returns whether a resource for `old` can be bound to `self`. Buffers may be larger than the shader's type.
    fn accepts(&self, old: &Self) -> bool {
        match (self, old) {
            (Self::Uniform { bytes }, Self::Uniform { bytes: bound }) => bytes <= bound,
            (Self::Storage { access, bytes }, Self::Storage { access: of, bytes: bound }) => {
                access == of && bytes <= bound
            }
            _ => self == old,
        }
    }
}

impl Interface {
    /// Reads the interface of a source; `None` if it is invalid.
    pub(crate) fn read(text: &str) -> Option<Self> {
        let module = naga::front::wgsl::parse_str(text).ok()?;
        let (flags, all) = (naga::valid::ValidationFlags::all(), naga::valid::Capabilities::all());
        let info = naga::valid::Validator::new(flags, all).validate(&module).ok()?;
        let entry = |(index, point): (usize, &naga::EntryPoint)| {
            let (function, uses) = (&point.function, info.get_entry_point(index));
            let used = module.global_variables.iter().filter(|(handle, _)| !uses[*handle].is_empty());
            let bindings = used.filter_map(|(handle, variable)| {
                let place = variable.binding.as_ref()?;
                let span = module.global_variables.get_span(handle).to_range().unwrap_or_default();
                let declared = text.get(span).unwrap_or_default().trim_end_matches(';');
                let name = variable.name.as_deref().unwrap_or_default();
                let text = if declared.is_empty() { name } else { declared };
                Some((
                    (place.group, place.binding),
                    Variable { kind: kind(&module, variable, text), text: text.into() },
                ))
            });
            let (bindings, mut inputs, mut outputs) = (bindings.collect(), BTreeMap::new(), BTreeMap::new());
            match point.stage {
                ShaderStage::Vertex => function
                    .arguments
                    .iter()
                    .for_each(|argument| locations(&module, argument.ty, argument.binding.as_ref(), &mut inputs)),
                ShaderStage::Fragment => function
                    .result
                    .iter()
                    .for_each(|result| locations(&module, result.ty, result.binding.as_ref(), &mut outputs)),
                _ => {}
            }
            (point.name.clone(), Entry { bindings, inputs, outputs })
        };
        let constants = module.overrides.iter().filter_map(|(_, constant)| {
            let name = constant.id.map(|id| id.to_string()).or(constant.name.clone())?;
            Some((name, constant.init.is_none()))
        });
        let constants = constants.collect();
        Some(Self { entries: module.entry_points.iter().enumerate().map(entry).collect(), constants })
    }

    /// Returns the names of all entry points.
    pub(crate) fn entries(&self) -> impl Iterator<Item = &str> {
        self.entries.keys().map(String::as_str)
    }

    /// Checks that `new` has all entry points of `self`.
    pub(crate) fn check_entries(&self, name: &str, new: &Self) -> Result<(), ShaderError> {
        if self.entries.keys().all(|entry| new.entries.contains_key(entry)) {
            return Ok(());
        }
        let list = |of: &Self| of.entries().map(|entry| format!("`{entry}`")).collect::<Vec<_>>().join(", ");
        Err(changed(name, "the entry points", list(self), list(new)))
    }

    /// Checks that recorders can bind the same resources to the entry points of `new`. With `exact`, unused bindings
    /// are errors too, because a layout derived from the source lacks them.
    pub(crate) fn check_bindings(
        &self,
        name: &str,
        new: &Self,
        entries: &[&str],
        exact: bool,
    ) -> Result<(), ShaderError> {
        let [old, new] = [self, new].map(|of| {
            let points = entries.iter().filter_map(|entry| of.entries.get(*entry));
            points.flat_map(|entry| &entry.bindings).collect::<BTreeMap<_, _>>()
        });
        let fits = |place: &(u32, u32)| match (old.get(place), new.get(place)) {
            (Some(old), Some(new)) => new.kind.accepts(&old.kind),
            (Some(_), None) => !exact,
            (None, Some(_)) => false,
            (None, None) => true,
        };
        let Some(wrong) = old.keys().chain(new.keys()).find(|place| !fits(place)) else { return Ok(()) };
        let (group, binding) = **wrong;
        let place = format!("binding {binding} of group {group}");
        Err(changed(name, &place, described(old.get(wrong).copied()), described(new.get(wrong).copied())))
    }

    /// Checks that `new` has the constants to which a pipeline gives values, and needs no others.
    pub(crate) fn check_constants(&self, name: &str, new: &Self, given: &[(&str, f64)]) -> Result<(), ShaderError> {
        let set = |constant: &str| given.iter().any(|(known, _)| *known == constant);
        let unset = new.constants.iter().find(|(constant, needed)| **needed && !set(constant)).map(|(c, _)| c.as_str());
        let missing = given.iter().map(|(constant, _)| *constant).find(|c| !new.constants.contains_key(*c));
        let Some(wrong) = unset.or(missing) else { return Ok(()) };
        let described = |of: &Self| match of.constants.get(wrong) {
            None => "nothing".to_owned(),
            Some(true) => format!("`override {wrong}` without a default value"),
            Some(false) => format!("`override {wrong}` with a default value"),
        };
        Err(changed(name, &format!("constant `{wrong}`"), described(self), described(new)))
    }

    /// Checks that vertex inputs and fragment outputs of `entry` are those of `self`. `new` may have fewer vertex
    /// inputs.
    pub(crate) fn check_locations(&self, name: &str, new: &Self, entry: &str) -> Result<(), ShaderError> {
        let (Some(old), Some(new)) = (self.entries.get(entry), new.entries.get(entry)) else { return Ok(()) };
        if new.inputs.iter().any(|(location, of)| old.inputs.get(location) != Some(of)) {
            let place = format!("the vertex inputs of `{entry}`");
            return Err(changed(name, &place, listed(&old.inputs), listed(&new.inputs)));
        }
        if old.outputs != new.outputs {
            let place = format!("the outputs of `{entry}`");
            return Err(changed(name, &place, listed(&old.outputs), listed(&new.outputs)));
        }
        Ok(())
    }
}

fn changed(name: &str, place: &str, old: String, new: String) -> ShaderError {
    ShaderError::Reload(Box::new(InterfaceChange { name: name.to_owned(), place: place.to_owned(), old, new }))
}

fn described(variable: Option<&Variable>) -> String {
    let Some(Variable { kind, text }) = variable else { return "nothing".to_owned() };
    match kind {
        Kind::Uniform { bytes } | Kind::Storage { bytes, .. } => format!("`{text}` ({bytes} bytes)"),
        _ => format!("`{text}`"),
    }
}

fn listed(locations: &BTreeMap<u32, String>) -> String {
    let each: Vec<_> = locations.iter().map(|(location, of)| format!("@location({location}) {of}")).collect();
    if each.is_empty() { "nothing".to_owned() } else { format!("`{}`", each.join(", ")) }
}

fn kind(module: &Module, variable: &naga::GlobalVariable, text: &str) -> Kind {
    let inner = &module.types[variable.ty].inner;
    let bytes = || inner.try_size(module.to_ctx()).unwrap_or(u32::MAX);
    match (variable.space, inner) {
        (AddressSpace::Uniform, _) => Kind::Uniform { bytes: bytes() },
        (AddressSpace::Storage { access }, _) => Kind::Storage { access, bytes: bytes() },
        (_, TypeInner::Image { dim, arrayed, class }) => Kind::Image { dim: *dim, arrayed: *arrayed, class: *class },
        (_, TypeInner::Sampler { comparison }) => Kind::Sampler { comparison: *comparison },
        _ => Kind::Other(text.to_owned()),
    }
}

/// Adds the types at `@location`s of a value, which is one number or vector, or a struct of them.
fn locations(
    module: &Module,
    ty: naga::Handle<naga::Type>,
    binding: Option<&naga::Binding>,
    found: &mut BTreeMap<u32, String>,
) {
    let inner = &module.types[ty].inner;
    match (binding, inner) {
        (Some(naga::Binding::Location { location, .. }), _) => drop(found.insert(*location, number(inner))),
        (None, TypeInner::Struct { members, .. }) => {
            members.iter().for_each(|member| locations(module, member.ty, member.binding.as_ref(), found));
        }
        _ => {}
    }
}

/// Returns the WGSL name of a number or vector.
fn number(inner: &TypeInner) -> String {
    let name = |scalar: &naga::Scalar| {
        let kind = match scalar.kind {
            naga::ScalarKind::Sint | naga::ScalarKind::AbstractInt => "i",
            naga::ScalarKind::Uint => "u",
            naga::ScalarKind::Float | naga::ScalarKind::AbstractFloat => "f",
            naga::ScalarKind::Bool => return "bool".to_owned(),
        };
        format!("{kind}{}", 8 * u32::from(scalar.width))
    };
    match inner {
        TypeInner::Scalar(scalar) => name(scalar),
        TypeInner::Vector { size, scalar } => format!("vec{}<{}>", u32::from(*size as u8), name(scalar)),
        _ => String::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const OLD: &str = "
        struct Tint { color: vec4f }
        @group(0) @binding(0) var<uniform> tint: Tint;
        @group(0) @binding(1) var image: texture_2d<f32>;
        @group(1) @binding(0) var<storage, read> unused: array<u32>;
        @vertex fn vs(@location(0) at: vec2f) -> @builtin(position) vec4f { return vec4f(at, 0.0, 1.0); }
        @fragment fn fs() -> @location(0) vec4f { return tint.color + textureLoad(image, vec2u(0), 0); }
        @compute @workgroup_size(1) fn count() { _ = tint.color; }";

    /// Replaces a part of the source, and returns the error of the reload.
    fn reported(from: &str, to: &str, exact: bool) -> Option<String> {
        assert!(OLD.contains(from));
        let (old, new) =
            (Interface::read(OLD).expect("valid"), Interface::read(&OLD.replace(from, to)).expect("valid"));
        let all = || {
            old.check_entries("s", &new)?;
            old.check_bindings("s", &new, &["vs", "fs"], exact)?;
            old.entries().try_for_each(|entry| old.check_locations("s", &new, entry))
        };
        all().err().map(|error| error.to_string())
    }

    #[test]
    fn equal_interfaces_may_be_reloaded() {
        for (from, to) in [
            ("vec2u(0)", "vec2u(3)"),
            ("@group(1) @binding(0)", "@group(1) @binding(7)"),
            ("tint", "renamed"),
            ("fn count()", "fn count2() {} @compute @workgroup_size(1) fn count()"),
        ] {
            assert_eq!(reported(from, to, true), None, "{to}");
        }
        assert_eq!(reported("tint.color + ", "", false), None, "an explicit layout keeps the binding");
    }

    #[test]
    fn a_changed_interface_names_both() {
        for (from, to, expected) in [
            ("fn fs()", "fn other()", ["`fs`", "`other`"]),
            ("color: vec4f", "color: vec4f, more: vec4f", ["(16 bytes)", "(32 bytes)"]),
            ("texture_2d", "texture_cube", ["texture_2d<f32>`", "texture_cube<f32>`"]),
            ("@group(0) @binding(1)", "@group(0) @binding(2)", ["image: texture_2d<f32>`", "nothing"]),
            ("tint.color + ", "", ["tint: Tint` (16 bytes)", "nothing"]),
            ("at: vec2f)", "at: vec2f, @location(1) z: f32)", ["@location(0) vec2<f32>`", "@location(1) f32`"]),
            ("fs() -> @location(0)", "fs() -> @location(1)", ["@location(0) vec4<f32>", "@location(1) vec4<f32>"]),
        ] {
            // A cube texture is sampled differently.
            let exchanged = OLD.contains("textureLoad") && to == "texture_cube";
            let error = if exchanged { cube() } else { reported(from, to, true) }.unwrap_or_default();
            assert!(error.contains("`s`") && expected.iter().all(|part| error.contains(part)), "{to}: {error}");
        }
    }

    fn cube() -> Option<String> {
        let text = OLD.replace("texture_2d", "texture_cube");
        let text = text.replace("textureLoad(image, vec2u(0), 0)", "vec4f(vec2f(textureDimensions(image)), 0.0, 0.0)");
        let (old, new) = (Interface::read(OLD)?, Interface::read(&text)?);
        old.check_bindings("s", &new, &["fs"], true).err().map(|error| error.to_string())
    }
}
