//! Decoded meshes of `KHR_draco_mesh_compression`.

use std::borrow::Cow;
use std::collections::BTreeMap;

use gltf_json::Value;
use gltf_json::accessor::ComponentType;
use gltf_json::mesh::{Mode, Primitive, Semantic};
use gltf_json::validation::Checked;

/// Name of the extension.
pub(super) const NAME: &str = "KHR_draco_mesh_compression";

/// Location of the values of an accessor.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Values {
    /// Index of the accessor, unchecked.
    pub accessor: usize,
    /// Buffer view of the compressed mesh, and id of the attribute in it. `None` if the values are in the accessor's
    /// own view.
    pub packed: Option<(usize, u32)>,
}

impl From<usize> for Values {
    fn from(accessor: usize) -> Self {
        Self { accessor, packed: None }
    }
}

/// The extension of a primitive.
#[derive(Clone, Copy, Debug)]
pub(super) struct Packed<'a> {
    json: &'a Value,
}

/// Returns the extension of a primitive, if present and decoded by this build. It applies to triangles only.
pub(super) fn of(primitive: &Primitive) -> Option<Packed<'_>> {
    let triangles = matches!(primitive.mode, Checked::Valid(Mode::Triangles | Mode::TriangleStrip));
    let json = primitive.extensions.as_ref()?.others.get(NAME)?;
    (cfg!(feature = "draco") && triangles).then_some(Packed { json })
}

impl Packed<'_> {
    /// Returns the index of the buffer view with the compressed mesh, unchecked.
    pub fn view(self) -> Option<usize> {
        self.json.get("bufferView")?.as_u64()?.try_into().ok()
    }

    /// Returns the id of an attribute in the compressed mesh, or `None` if the attribute is not compressed. An id that
    /// is not a 32-bit number is `Err`.
    pub fn id(self, semantic: &str) -> Option<Result<u32, ()>> {
        let id = self.json.get("attributes")?.get(semantic)?;
        Some(id.as_u64().and_then(|id| id.try_into().ok()).ok_or(()))
    }
}

/// Returns the location of the values of an attribute, if the primitive has it. Invalid ids, which decoding has
/// rejected before, give `None`.
pub(super) fn values(primitive: &Primitive, semantic: &Semantic) -> Option<Values> {
    let accessor = primitive.attributes.get(&Checked::Valid(semantic.clone()))?.value();
    let packed = of(primitive).and_then(|extension| {
        let id = extension.id(&semantic.to_string())?.ok()?;
        Some((extension.view()?, id))
    });
    Some(Values { accessor, packed })
}

/// A decoded mesh.
#[derive(Debug, Default)]
pub(super) struct PackedMesh {
    /// Corner indices of the triangles.
    pub indices: Vec<u32>,
    /// Attributes that a primitive uses, by id.
    pub attributes: BTreeMap<u32, PackedAttribute>,
}

/// The values of an attribute, one for each vertex.
#[derive(Debug)]
pub(super) struct PackedAttribute {
    /// Type of the components.
    pub kind: Kind,
    /// Components of a value.
    pub width: usize,
    /// Tightly packed values, little-endian.
    pub bytes: Vec<u8>,
}

/// Type of the components of a decoded attribute.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
}

impl Kind {
    /// Bytes of a component.
    pub fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
        }
    }

    /// Reads an integer; `None` for floats.
    fn integer(self, b: &[u8]) -> Option<i64> {
        match self {
            Self::I8 => Some((b[0] as i8).into()),
            Self::U8 => Some(b[0].into()),
            Self::I16 => Some(i16::from_le_bytes([b[0], b[1]]).into()),
            Self::U16 => Some(u16::from_le_bytes([b[0], b[1]]).into()),
            Self::I32 => Some(i32::from_le_bytes([b[0], b[1], b[2], b[3]]).into()),
            Self::U32 => Some(u32::from_le_bytes([b[0], b[1], b[2], b[3]]).into()),
            Self::F32 => None,
        }
    }
}

/// Returns the component type of an accessor.
fn kind_of(component: ComponentType) -> Kind {
    match component {
        ComponentType::I8 => Kind::I8,
        ComponentType::U8 => Kind::U8,
        ComponentType::I16 => Kind::I16,
        ComponentType::U16 => Kind::U16,
        ComponentType::U32 => Kind::U32,
        ComponentType::F32 => Kind::F32,
    }
}

impl PackedAttribute {
    /// Converts the values to the component type of an accessor. Encoders widen integers, so their size may differ in
    /// the stream; each value must fit.
    ///
    /// # Errors
    ///
    /// Returns the reason if an integer does not fit, or if floats and integers are mixed up.
    pub fn values(&self, component: ComponentType) -> Result<Cow<'_, [u8]>, String> {
        let wanted = kind_of(component);
        if wanted == self.kind {
            return Ok(Cow::Borrowed(&self.bytes));
        }
        let (min, max) = match wanted {
            Kind::I8 => (i8::MIN.into(), i8::MAX.into()),
            Kind::U8 => (0, u8::MAX.into()),
            Kind::I16 => (i16::MIN.into(), i16::MAX.into()),
            Kind::U16 => (0, u16::MAX.into()),
            Kind::I32 => (i32::MIN.into(), i32::MAX.into()),
            Kind::U32 => (0, u32::MAX.into()),
            Kind::F32 => return Err("the accessor states floats, but the compressed attribute has integers".into()),
        };
        let mut bytes = Vec::with_capacity(self.bytes.len() / self.kind.size() * wanted.size());
        for component in self.bytes.chunks_exact(self.kind.size()) {
            let Some(number) = self.kind.integer(component) else {
                return Err("the accessor states integers, but the compressed attribute has floats".into());
            };
            if !(min..=max).contains(&number) {
                return Err(format!("a value of the compressed attribute is {number}, outside {min}…{max}"));
            }
            bytes.extend_from_slice(&number.to_le_bytes()[..wanted.size()]);
        }
        Ok(Cow::Owned(bytes))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn integers_change_their_size_where_they_fit() {
        let of = |kind, bytes: &[u8]| PackedAttribute { kind, width: 1, bytes: bytes.into() };
        let halves = of(Kind::I16, &[7, 0, 0xff, 0xff]);
        assert!(matches!(halves.values(ComponentType::I16), Ok(Cow::Borrowed([7, 0, 0xff, 0xff]))));
        assert_eq!(halves.values(ComponentType::I8).as_deref(), Ok(&[7, 0xff][..]));
        let error = halves.values(ComponentType::U8).expect_err("−1 does not fit");
        assert!(error.contains("is -1, outside 0…255"), "{error}");
        let words = of(Kind::I32, &[255, 0, 0, 0, 0, 1, 0, 0]);
        assert_eq!(words.values(ComponentType::U16).as_deref(), Ok(&[255, 0, 0, 1][..]));
        assert!(words.values(ComponentType::U8).is_err_and(|error| error.contains("256")));
        assert!(words.values(ComponentType::F32).is_err_and(|error| error.contains("states floats")));
        assert!(of(Kind::F32, &[0; 4]).values(ComponentType::U8).is_err_and(|error| error.contains("has floats")));
        assert_eq!(of(Kind::U8, &[200]).values(ComponentType::U32).as_deref(), Ok(&[200, 0, 0, 0][..]));
    }
}
