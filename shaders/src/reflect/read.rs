//! Conversion of naga's module into plain data.

use std::collections::BTreeSet;

use naga::valid::{FunctionInfo, ModuleInfo};
use naga::{
    AddressSpace, Expression, GlobalVariable, Handle, ImageClass, ImageDimension, Literal, Module, ScalarKind,
    ShaderStage, StorageAccess, TypeInner,
};

use super::interface::{
    Attribute, Binding, BindingKind, Dimension, EntryPoint, Member, Override, Reflection, Sample, Scalar, Stage,
    StructLayout,
};

impl Reflection {
    /// Reads a validated module.
    pub fn of(module: &Module, info: &ModuleInfo) -> Self {
        Self { entry_points: entry_points(module, info), overrides: overrides(module), structs: structs(module) }
    }
}

fn entry_points(module: &Module, info: &ModuleInfo) -> Vec<EntryPoint> {
    let read = module.entry_points.iter().enumerate().filter_map(|(index, entry)| {
        let stage = match entry.stage {
            ShaderStage::Vertex => Stage::Vertex,
            ShaderStage::Fragment => Stage::Fragment,
            ShaderStage::Compute => Stage::Compute,
            _ => return None,
        };
        let arguments = entry.function.arguments.iter();
        let inputs = arguments.flat_map(|a| attributes(module, a.ty, a.binding.as_ref()));
        let outputs = entry.function.result.iter();
        let outputs = outputs.flat_map(|r| attributes(module, r.ty, r.binding.as_ref()));
        Some(EntryPoint {
            name: entry.name.clone(),
            stage,
            bindings: bindings(module, info.get_entry_point(index)),
            vertex_inputs: by_location(inputs, stage == Stage::Vertex),
            color_outputs: by_location(outputs, stage == Stage::Fragment),
            workgroup_size: entry.workgroup_size,
        })
    });
    read.collect()
}

fn by_location(attributes: impl Iterator<Item = Attribute>, wanted: bool) -> Vec<Attribute> {
    if !wanted {
        return Vec::new();
    }
    let mut list: Vec<Attribute> = attributes.collect();
    list.sort_by_key(|attribute| attribute.location);
    list
}

/// Returns the values with a location in an argument or result: the value itself, or the members of a struct.
fn attributes(module: &Module, ty: Handle<naga::Type>, binding: Option<&naga::Binding>) -> Vec<Attribute> {
    let located = |ty: Handle<naga::Type>, binding: Option<&naga::Binding>| {
        let Some(naga::Binding::Location { location, .. }) = binding else {
            return None;
        };
        let (scalar, components) = match module.types[ty].inner {
            TypeInner::Scalar(scalar) => (scalar, 1),
            TypeInner::Vector { size, scalar } => (scalar, size as u32),
            _ => return None,
        };
        Some(Attribute { location: *location, scalar: scalar_of(scalar)?, components })
    };
    match &module.types[ty].inner {
        TypeInner::Struct { members, .. } => members.iter().filter_map(|m| located(m.ty, m.binding.as_ref())).collect(),
        _ => located(ty, binding).into_iter().collect(),
    }
}

fn scalar_of(scalar: naga::Scalar) -> Option<Scalar> {
    match (scalar.kind, scalar.width) {
        (ScalarKind::Float, 2) => Some(Scalar::F16),
        (ScalarKind::Float, 4) => Some(Scalar::F32),
        (ScalarKind::Sint, 4) => Some(Scalar::I32),
        (ScalarKind::Uint, 4) => Some(Scalar::U32),
        (ScalarKind::Bool, _) => Some(Scalar::Bool),
        _ => None,
    }
}

/// Returns the resources that an entry point uses, ordered by group and binding.
fn bindings(module: &Module, info: &FunctionInfo) -> Vec<Binding> {
    let mut list: Vec<Binding> = module
        .global_variables
        .iter()
        .filter(|(handle, _)| !info[*handle].is_empty())
        .filter_map(|(handle, variable)| {
            let place = variable.binding.as_ref()?;
            let filtered = info.sampling_set.iter().any(|key| key.image == handle);
            Some(Binding {
                group: place.group,
                binding: place.binding,
                name: variable.name.clone().unwrap_or_default(),
                kind: kind_of(module, variable, filtered)?,
            })
        })
        .collect();
    list.sort_by_key(|binding| (binding.group, binding.binding));
    list
}

fn kind_of(module: &Module, variable: &GlobalVariable, filtered: bool) -> Option<BindingKind> {
    let inner = &module.types[variable.ty].inner;
    match variable.space {
        AddressSpace::Uniform => Some(BindingKind::Uniform { size_bytes: inner.size(module.to_ctx()) }),
        AddressSpace::Storage { access } => Some(BindingKind::Storage {
            read_only: !access.contains(StorageAccess::STORE),
            min_size_bytes: inner.size(module.to_ctx()),
        }),
        AddressSpace::Handle => handle_kind(inner, filtered),
        _ => None,
    }
}

fn handle_kind(inner: &TypeInner, filtered: bool) -> Option<BindingKind> {
    match *inner {
        TypeInner::Sampler { comparison } => Some(BindingKind::Sampler { comparison }),
        TypeInner::Image { dim, arrayed, class } => {
            let dimension = dimension_of(dim, arrayed);
            match class {
                ImageClass::Sampled { kind, multi } => Some(BindingKind::Texture {
                    dimension,
                    sample: match kind {
                        ScalarKind::Sint => Sample::Sint,
                        ScalarKind::Uint => Sample::Uint,
                        _ => Sample::Float { filterable: filtered },
                    },
                    multisampled: multi,
                }),
                ImageClass::Depth { multi } => {
                    Some(BindingKind::Texture { dimension, sample: Sample::Depth, multisampled: multi })
                }
                ImageClass::Storage { format, access } => Some(BindingKind::StorageTexture {
                    dimension,
                    format,
                    read: access.contains(StorageAccess::LOAD),
                    write: access.contains(StorageAccess::STORE),
                }),
                ImageClass::External => None,
            }
        }
        _ => None,
    }
}

fn dimension_of(dim: ImageDimension, arrayed: bool) -> Dimension {
    match (dim, arrayed) {
        (ImageDimension::D1, _) => Dimension::D1,
        (ImageDimension::D2, false) => Dimension::D2,
        (ImageDimension::D2, true) => Dimension::D2Array,
        (ImageDimension::D3, _) => Dimension::D3,
        (ImageDimension::Cube, false) => Dimension::Cube,
        (ImageDimension::Cube, true) => Dimension::CubeArray,
    }
}

fn overrides(module: &Module) -> Vec<Override> {
    let read = module.overrides.iter().filter_map(|(_, constant)| {
        let TypeInner::Scalar(scalar) = module.types[constant.ty].inner else {
            return None;
        };
        Some(Override {
            name: constant.name.clone()?,
            scalar: scalar_of(scalar)?,
            default: constant.init.and_then(|init| literal(module, init)),
        })
    });
    read.collect()
}

fn literal(module: &Module, expression: Handle<Expression>) -> Option<f64> {
    match module.global_expressions[expression] {
        Expression::Literal(Literal::F32(value)) => Some(f64::from(value)),
        Expression::Literal(Literal::U32(value)) => Some(f64::from(value)),
        Expression::Literal(Literal::I32(value)) => Some(f64::from(value)),
        Expression::Literal(Literal::Bool(value)) => Some(f64::from(u8::from(value))),
        _ => None,
    }
}

/// Returns the structs that uniform and storage variables hold directly, in arrays or in other structs. Each appears
/// once, in the order of the text.
fn structs(module: &Module) -> Vec<StructLayout> {
    let mut reached = BTreeSet::new();
    for (_, variable) in module.global_variables.iter() {
        if matches!(variable.space, AddressSpace::Uniform | AddressSpace::Storage { .. }) {
            reach(module, variable.ty, &mut reached);
        }
    }
    let size = |ty: Handle<naga::Type>| module.types[ty].inner.size(module.to_ctx());
    let layouts = module.types.iter().filter(|(handle, _)| reached.contains(&handle.index()));
    let layouts = layouts.filter_map(|(_, ty)| match &ty.inner {
        TypeInner::Struct { members, span } => Some(StructLayout {
            name: ty.name.clone()?,
            size_bytes: *span,
            members: members
                .iter()
                .map(|member| Member {
                    name: member.name.clone().unwrap_or_default(),
                    offset_bytes: member.offset,
                    size_bytes: size(member.ty),
                })
                .collect(),
        }),
        _ => None,
    });
    layouts.collect()
}

fn reach(module: &Module, ty: Handle<naga::Type>, out: &mut BTreeSet<usize>) {
    out.insert(ty.index());
    match &module.types[ty].inner {
        TypeInner::Struct { members, .. } => {
            members.iter().for_each(|member| reach(module, member.ty, out));
        }
        TypeInner::Array { base, .. } => reach(module, *base, out),
        _ => {}
    }
}
