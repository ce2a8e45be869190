//! Accessors: typed arrays from buffer views (glTF 2.0, sections 3.6.2 and 5.1), strided, normalized or sparse; zeros
//! without a view.

use std::borrow::Cow;

use gltf_json::accessor::{ComponentType, Type, sparse};
use gltf_json::validation::Checked;

use super::limits::MAX_ELEMENTS;
use super::packed::Values;
use super::source::{Source, beyond, slice};
use crate::error::{Quantity, SceneError};

/// An accessor whose byte ranges are validated.
struct Elements<'a> {
    /// Bytes from the first element on; `None` for zeros.
    data: Option<Cow<'a, [u8]>>,
    stride: usize,
    count: usize,
    component: ComponentType,
    /// Components of an element: 1 to 4, or 16 for a matrix.
    width: usize,
    normalized: bool,
    /// Sparse positions, and the replacement bytes.
    sparse: Option<(Vec<u32>, &'a [u8], usize)>,
}

/// Reads an accessor of vectors of `N` components, or of 4×4 matrices if `N` is 16, as f32. Integers are normalized if
/// the accessor says so, and otherwise converted unchanged (KHR_mesh_quantization).
pub(super) fn floats<const N: usize>(
    source: &Source<'_>,
    values: impl Into<Values>,
    user: &str,
) -> Result<Vec<[f32; N]>, SceneError> {
    let values = values.into();
    let elements = resolve(source, values, user)?;
    if elements.width != N {
        let reason = format!("accessor {} has {} components, not {N}", values.accessor, elements.width);
        return Err(source.malformed(user, reason));
    }
    source.charge(elements.count as u64 * 4 * N as u64)?;
    let size = elements.component.size();
    let normalized = elements.normalized;
    let component = elements.component;
    let read = |bytes: &[u8]| -> [f32; N] {
        std::array::from_fn(|i| float_from_bytes(&bytes[i * size..], component, normalized))
    };
    Ok(collect(&elements, [0.0; N], read))
}

/// Reads an accessor of unsigned integers.
pub(super) fn integers(source: &Source<'_>, index: usize, user: &str) -> Result<Vec<u32>, SceneError> {
    let elements = resolve(source, index.into(), user)?;
    let whole = matches!(elements.component, ComponentType::U8 | ComponentType::U16 | ComponentType::U32);
    if elements.width != 1 || !whole {
        let reason = format!("accessor {index} does not hold unsigned scalars");
        return Err(source.malformed(user, reason));
    }
    source.charge(elements.count as u64 * 4)?;
    let component = elements.component;
    Ok(collect(&elements, 0, |b| integer_from_bytes(b, component)))
}

/// Returns the number of components of an accessor's elements, if the accessor exists.
pub(super) fn width(source: &Source<'_>, index: usize) -> Option<usize> {
    match source.root.accessors.get(index)?.type_ {
        Checked::Valid(kind) => Some(kind.multiplicity()),
        Checked::Invalid => None,
    }
}

/// Decodes each element, sparse replacements included. Ranges were checked by [`resolve`].
fn collect<T: Copy>(elements: &Elements<'_>, zero: T, read: impl Fn(&[u8]) -> T) -> Vec<T> {
    let mut values = match &elements.data {
        Some(data) => (0..elements.count).map(|i| read(&data[i * elements.stride..])).collect(),
        None => vec![zero; elements.count],
    };
    if let Some((positions, data, stride)) = &elements.sparse {
        for (i, position) in positions.iter().enumerate() {
            values[*position as usize] = read(&data[i * stride..]);
        }
    }
    values
}

/// Looks up an accessor and checks every byte range it uses. `user` names the referring object.
fn resolve<'a>(source: &'a Source<'_>, values: Values, user: &str) -> Result<Elements<'a>, SceneError> {
    let index = values.accessor;
    let accessors = &source.root.accessors;
    let accessor = accessors.get(index).ok_or_else(|| source.malformed(user, beyond("accessor", index, accessors)))?;
    let at = format!("{user}: accessor {index}");
    let (Checked::Valid(component), Checked::Valid(kind)) = (&accessor.component_type, &accessor.type_) else {
        return Err(source.malformed(&at, "unknown component type or element type"));
    };
    let component = component.0;
    // Columns of smaller matrices may be padded; no caller reads such matrices. Columns of four components have no
    // padding (section 3.6.2.4).
    if matches!(kind, Type::Mat2 | Type::Mat3) {
        return Err(source.malformed(&at, "it holds 2×2 or 3×3 matrices, which are not supported"));
    }
    let count = accessor.count.0;
    if count == 0 {
        return Err(source.malformed(&at, "holds no elements"));
    }
    if count > MAX_ELEMENTS {
        return Err(source.too_large(Quantity::AccessorElements(index), count, MAX_ELEMENTS));
    }
    let width = kind.multiplicity();
    let size = component.size() * width;
    if let Some((view, id)) = values.packed {
        // The accessor's own view and sparse values are for programs without a decoder.
        let data = packed(source, &at, view, id, component, width)?;
        if data.len() as u64 != count * size as u64 {
            let reason = format!("states {count} elements, but the compressed mesh has {}", data.len() / size);
            return Err(source.malformed(&at, reason));
        }
        let (data, normalized) = (Some(data), accessor.normalized);
        return Ok(Elements { data, stride: size, count: count as usize, component, width, normalized, sparse: None });
    }
    let (data, stride) = match accessor.buffer_view {
        Some(view) => {
            let offset = accessor.byte_offset.map_or(0, |o| o.0);
            let (data, stride) = array(source, &at, view.value(), offset, count, size)?;
            (Some(Cow::Borrowed(data)), stride)
        }
        None => (None, size),
    };
    let sparse = match &accessor.sparse {
        Some(sparse) => Some(resolve_sparse(source, &at, sparse, count, size)?),
        None => None,
    };
    Ok(Elements { data, stride, count: count as usize, component, width, normalized: accessor.normalized, sparse })
}

/// Returns the values of an attribute of a compressed mesh, in the component type of an accessor.
fn packed<'a>(
    source: &'a Source<'_>,
    at: &str,
    view: usize,
    id: u32,
    component: ComponentType,
    width: usize,
) -> Result<Cow<'a, [u8]>, SceneError> {
    let attribute = source.meshes.get(&view).and_then(|mesh| mesh.attributes.get(&id));
    let attribute = attribute.ok_or_else(|| {
        source.malformed(at, format!("the compressed mesh of buffer view {view} lacks attribute {id}"))
    })?;
    if attribute.width != width {
        let reason =
            format!("has {width} components, but attribute {id} of the compressed mesh has {}", attribute.width);
        return Err(source.malformed(at, reason));
    }
    let values = attribute.values(component).map_err(|reason| source.malformed(at, reason))?;
    if let Cow::Owned(values) = &values {
        source.charge(values.len() as u64)?;
    }
    Ok(values)
}

/// Returns the bytes of `count` elements of `size` bytes, from `offset` in a view, and their stride.
fn array<'a>(
    source: &'a Source<'_>,
    at: &str,
    view: usize,
    offset: u64,
    count: u64,
    size: usize,
) -> Result<(&'a [u8], usize), SceneError> {
    let (bytes, stride) = source.view(view, at)?;
    let stride = stride.unwrap_or(size);
    if stride < size {
        let reason = format!("the stride of {stride} bytes is less than the element's {size}");
        return Err(source.malformed(at, reason));
    }
    // 2^28 elements with a stride of up to 2^64 could overflow, hence the check.
    let length = (count - 1).checked_mul(stride as u64).and_then(|l| l.checked_add(size as u64));
    length.and_then(|length| slice(bytes, offset, length)).map(|data| (data, stride)).ok_or_else(|| {
        source.malformed(
            at,
            format!(
                "{count} elements of {size} bytes every {stride} from {offset} exceed buffer view {view} of {} bytes",
                bytes.len()
            ),
        )
    })
}

/// Returns the positions and replacement bytes of a sparse accessor over `count` elements.
fn resolve_sparse<'a>(
    source: &'a Source<'_>,
    at: &str,
    sparse: &sparse::Sparse,
    count: u64,
    size: usize,
) -> Result<(Vec<u32>, &'a [u8], usize), SceneError> {
    let replaced = sparse.count.0;
    if replaced == 0 || replaced > count {
        let reason = format!("{replaced} sparse elements of {count}");
        return Err(source.malformed(at, reason));
    }
    let Checked::Valid(kind) = &sparse.indices.component_type else {
        return Err(source.malformed(at, "unknown component type of sparse indices"));
    };
    let kind = kind.0;
    let (indices, stride) =
        array(source, at, sparse.indices.buffer_view.value(), sparse.indices.byte_offset.0, replaced, kind.size())?;
    source.charge(replaced * 4)?;
    let positions: Vec<u32> =
        (0..replaced as usize).map(|i| integer_from_bytes(&indices[i * stride..], kind)).collect();
    if let Some(position) = positions.iter().find(|p| u64::from(**p) >= count) {
        let reason = format!("a sparse index is {position}, but there are {count} elements");
        return Err(source.malformed(at, reason));
    }
    let (values, stride) =
        array(source, at, sparse.values.buffer_view.value(), sparse.values.byte_offset.0, replaced, size)?;
    Ok((positions, values, stride))
}

fn float_from_bytes(b: &[u8], component: ComponentType, normalized: bool) -> f32 {
    let (value, largest) = match component {
        ComponentType::F32 => return f32::from_le_bytes([b[0], b[1], b[2], b[3]]),
        ComponentType::I8 => (f32::from(b[0] as i8), 127.0),
        ComponentType::U8 => (f32::from(b[0]), 255.0),
        ComponentType::I16 => (f32::from(i16::from_le_bytes([b[0], b[1]])), 32767.0),
        ComponentType::U16 => (f32::from(u16::from_le_bytes([b[0], b[1]])), 65535.0),
        ComponentType::U32 => {
            let value = u32::from_le_bytes([b[0], b[1], b[2], b[3]]);
            (value as f32, u32::MAX as f32)
        }
    };
    if normalized {
        // The lowest signed integer is slightly below −1 (section 3.6.2.2).
        (value / largest).max(-1.0)
    } else {
        value
    }
}

/// Returns zero for signed and float components, which callers exclude.
fn integer_from_bytes(b: &[u8], component: ComponentType) -> u32 {
    match component {
        ComponentType::U8 => u32::from(b[0]),
        ComponentType::U16 => u32::from(u16::from_le_bytes([b[0], b[1]])),
        ComponentType::U32 => u32::from_le_bytes([b[0], b[1], b[2], b[3]]),
        ComponentType::I8 | ComponentType::I16 | ComponentType::F32 => 0,
    }
}
