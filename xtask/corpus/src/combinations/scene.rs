//! Small scenes with any selection of what frames distinguish, as glTF.

use serde_json::{Value, json};
use std::io;
use std::path::Path;

/// A part of a scene, beside the ground and two panes, one of which turns, that are always there.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Part {
    /// A point light and a spot light.
    TwoLights,
    /// Eight punctual lights of limited range: more than `--lights auto` takes lists for.
    EightLights,
    /// A pane of glass (KHR_materials_transmission).
    Glass,
    /// Two panes, one with a volume behind another.
    GlassBehindGlass,
    /// A pane that blends.
    Blend,
    /// A pane with a cut-out material.
    Mask,
    /// A pane that a skin bends, with an animation.
    Skin,
    /// A pane with a morph target, with an animation.
    Morph,
    /// Lines and points.
    Lines,
    /// Materials with clear coat, sheen, anisotropy and iridescence.
    Lobes,
    /// A material without lighting (KHR_materials_unlit).
    Unlit,
}

impl Part {
    /// Returns a word for file names.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::TwoLights => "lights2",
            Self::EightLights => "lights8",
            Self::Glass => "glass",
            Self::GlassBehindGlass => "glass2",
            Self::Blend => "blend",
            Self::Mask => "mask",
            Self::Skin => "skin",
            Self::Morph => "morph",
            Self::Lines => "lines",
            Self::Lobes => "lobes",
            Self::Unlit => "unlit",
        }
    }
}

/// Name of the file with the geometry of all scenes.
const BUFFER: &str = "scene.bin";

/// Writes the geometry into a folder, where all scenes share it.
///
/// # Errors
/// When the folder cannot be written.
pub fn write_geometry(folder: &Path) -> io::Result<()> {
    std::fs::write(folder.join(BUFFER), Geometry::new().bytes)
}

/// Writes a scene of these parts into a folder, unless it is there. Returns the file's name.
///
/// # Errors
/// When the folder cannot be written.
pub fn write(folder: &Path, parts: &[Part]) -> io::Result<String> {
    let words: Vec<_> = std::iter::once("panes").chain(parts.iter().map(|part| part.word())).collect();
    let name = format!("{}.gltf", words.join("-"));
    let file = folder.join(&name);
    if !file.exists() {
        std::fs::write(file, document(parts).to_string())?;
    }
    Ok(name)
}

/// Vertices, indices and key frames of all scenes, with the accessors into them.
struct Geometry {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

/// Accessors, in the order in which [`Geometry::new`] makes them.
#[derive(Clone, Copy)]
enum Accessor {
    Positions,
    Normals,
    Coordinates,
    Indices,
    Joints,
    Weights,
    Displacements,
    InverseBind,
    Times,
    Rotations,
    MorphWeights,
}

impl Geometry {
    /// A pane from −1 to 1 in x and y, that faces +z, of 4 by 4 quads.
    fn new() -> Self {
        let mut own = Self { bytes: Vec::new(), views: Vec::new(), accessors: Vec::new() };
        let grid: Vec<[f32; 2]> = (0..25).map(|i| [(i % 5) as f32 / 2.0 - 1.0, (i / 5) as f32 / 2.0 - 1.0]).collect();
        let floats = |each: &dyn Fn(&[f32; 2]) -> Vec<f32>| grid.iter().flat_map(each).collect::<Vec<f32>>();
        let bounds = json!({"min": [-1, -1, 0], "max": [1, 1, 0]});
        own.add("VEC3", 25, &floats(&|[x, y]| vec![*x, *y, 0.0]), bounds);
        own.add("VEC3", 25, &floats(&|_| vec![0.0, 0.0, 1.0]), json!({}));
        own.add("VEC2", 25, &floats(&|[x, y]| vec![0.5 + x / 2.0, 0.5 - y / 2.0]), json!({}));
        let corners = |quad: u32| {
            let at = quad / 4 * 5 + quad % 4;
            [at, at + 1, at + 6, at, at + 6, at + 5]
        };
        let indices: Vec<u8> = (0..16).flat_map(corners).flat_map(|index| (index as u16).to_le_bytes()).collect();
        own.raw("SCALAR", 5123, 96, &indices, json!({}));
        own.raw("VEC4", 5121, 25, &[0, 1, 0, 0].repeat(25), json!({}));
        own.add("VEC4", 25, &floats(&|[x, _]| vec![0.5 - x / 2.0, 0.5 + x / 2.0, 0.0, 0.0]), json!({}));
        let bounds = json!({"min": [0, 0, -0.5], "max": [0, 0, 0.5]});
        own.add("VEC3", 25, &floats(&|[x, y]| vec![0.0, 0.0, 0.5 * x * y]), bounds);
        let unit = [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0];
        own.add("MAT4", 2, &[unit, unit].concat(), json!({}));
        own.add("SCALAR", 2, &[0.0, 1.0], json!({"min": [0], "max": [1]}));
        own.add("VEC4", 2, &[0.0, 0.0, 0.0, 1.0, 0.0, 0.6, 0.0, 0.8], json!({}));
        own.add("SCALAR", 2, &[0.0, 1.0], json!({}));
        own
    }

    fn add(&mut self, shape: &str, count: usize, values: &[f32], bounds: Value) {
        let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
        self.raw(shape, 5126, count, &bytes, bounds);
    }

    fn raw(&mut self, shape: &str, component: u32, count: usize, bytes: &[u8], mut accessor: Value) {
        self.views.push(json!({"buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len()}));
        self.bytes.extend_from_slice(bytes);
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        accessor["bufferView"] = (self.views.len() - 1).into();
        accessor["componentType"] = component.into();
        accessor["count"] = count.into();
        accessor["type"] = shape.into();
        self.accessors.push(accessor);
    }
}

/// Nodes, meshes and the rest of a scene, as it grows.
#[derive(Default)]
struct Growing {
    nodes: Vec<Value>,
    meshes: Vec<Value>,
    materials: Vec<Value>,
    lights: Vec<Value>,
    channels: Vec<Value>,
    samplers: Vec<Value>,
    skins: Vec<Value>,
}

impl Growing {
    /// Adds a mesh of one primitive with a material of its own; returns its number.
    fn mesh(&mut self, mut primitive: Value, material: Value) -> usize {
        primitive["material"] = self.materials.len().into();
        self.materials.push(material);
        self.meshes.push(json!({"primitives": [primitive]}));
        self.meshes.len() - 1
    }

    /// Adds a node with a mesh.
    fn put(&mut self, primitive: Value, material: Value, mut node: Value) {
        node["mesh"] = self.mesh(primitive, material).into();
        self.nodes.push(node);
    }

    /// Adds an animation of a node's property by key frames.
    fn animate(&mut self, node: usize, path: &str, output: Accessor) {
        self.channels.push(json!({"sampler": self.samplers.len(), "target": {"node": node, "path": path}}));
        self.samplers.push(json!({"input": Accessor::Times as usize, "output": output as usize}));
    }

    fn light(&mut self, light: Value, node: Value) {
        let mut node = node;
        node["extensions"] = json!({"KHR_lights_punctual": {"light": self.lights.len()}});
        self.lights.push(light);
        self.nodes.push(node);
    }
}

/// Returns a pane as a primitive.
fn pane() -> Value {
    json!({
        "attributes": {
            "POSITION": Accessor::Positions as usize,
            "NORMAL": Accessor::Normals as usize,
            "TEXCOORD_0": Accessor::Coordinates as usize
        },
        "indices": Accessor::Indices as usize
    })
}

fn color(rgba: [f32; 4], extensions: Value) -> Value {
    json!({
        "pbrMetallicRoughness": {"baseColorFactor": rgba, "metallicFactor": 0, "roughnessFactor": 0.4},
        "extensions": extensions
    })
}

/// Returns the glTF document of a scene.
fn document(parts: &[Part]) -> Value {
    let mut own = Growing::default();
    // The ground, and two panes on it.
    let lie = [-std::f32::consts::FRAC_1_SQRT_2, 0.0, 0.0, std::f32::consts::FRAC_1_SQRT_2];
    own.put(pane(), color([0.5, 0.5, 0.5, 1.0], json!({})), json!({"rotation": lie, "scale": [4, 4, 1]}));
    own.put(pane(), color([0.8, 0.3, 0.2, 1.0], json!({})), json!({"translation": [-1, 1, -0.5]}));
    // A pane turns in each scene: without an animation, a time would be refused.
    own.animate(own.nodes.len() - 1, "rotation", Accessor::Rotations);
    // One-sided like the panes, which saves a shader per case. Masked surfaces are two-sided.
    let metal = json!({"pbrMetallicRoughness": {"metallicFactor": 1, "roughnessFactor": 0.1}});
    own.put(pane(), metal, json!({"translation": [0, 0.7, -1], "scale": [0.7, 0.7, 1]}));
    for part in parts {
        add(&mut own, *part);
    }
    let Geometry { bytes, views, accessors } = Geometry::new();
    let mut found = json!({
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": (0..own.nodes.len()).collect::<Vec<_>>()}],
        "nodes": own.nodes,
        "meshes": own.meshes,
        "materials": own.materials,
        "buffers": [{"uri": BUFFER, "byteLength": bytes.len()}],
        "bufferViews": views,
        "accessors": accessors,
    });
    if !own.skins.is_empty() {
        found["skins"] = own.skins.into();
    }
    if !own.channels.is_empty() {
        found["animations"] = json!([{"channels": own.channels, "samplers": own.samplers}]);
    }
    if !own.lights.is_empty() {
        found["extensions"] = json!({"KHR_lights_punctual": {"lights": own.lights}});
        found["extensionsUsed"] = json!(["KHR_lights_punctual"]);
    }
    found
}

fn add(own: &mut Growing, part: Part) {
    let glass = |volume: Value| {
        let mut extensions = json!({"KHR_materials_transmission": {"transmissionFactor": 0.9}});
        if !volume.is_null() {
            extensions["KHR_materials_volume"] = volume;
        }
        color([0.9, 1.0, 0.9, 1.0], extensions)
    };
    match part {
        Part::TwoLights => lights(own, 2),
        Part::EightLights => lights(own, 8),
        Part::Glass => own.put(pane(), glass(Value::Null), json!({"translation": [0.3, 1, 1]})),
        Part::GlassBehindGlass => {
            own.put(pane(), glass(Value::Null), json!({"translation": [0.3, 1, 1]}));
            let volume = json!({"thicknessFactor": 0.2, "attenuationDistance": 1, "attenuationColor": [0.5, 0.9, 0.9]});
            own.put(pane(), glass(volume), json!({"translation": [0.6, 1, 1.5]}));
        }
        Part::Blend => {
            let mut blend = color([0.2, 0.4, 0.9, 0.5], json!({}));
            blend["alphaMode"] = "BLEND".into();
            own.put(pane(), blend, json!({"translation": [0.8, 1, 0.5]}));
        }
        Part::Mask => {
            let mut mask = color([0.2, 0.9, 0.4, 0.7], json!({}));
            mask["alphaMode"] = "MASK".into();
            mask["doubleSided"] = true.into();
            own.put(pane(), mask, json!({"translation": [-1.5, 1, 0.4]}));
        }
        Part::Skin => {
            let mut primitive = pane();
            primitive["attributes"]["JOINTS_0"] = (Accessor::Joints as usize).into();
            primitive["attributes"]["WEIGHTS_0"] = (Accessor::Weights as usize).into();
            let at = own.nodes.len();
            own.nodes.push(json!({"translation": [-1, 1, 0.7]}));
            own.nodes.push(json!({"translation": [-0.8, 1.2, 0.7]}));
            own.animate(at + 1, "rotation", Accessor::Rotations);
            let skin = own.skins.len();
            own.skins.push(json!({"joints": [at, at + 1], "inverseBindMatrices": Accessor::InverseBind as usize}));
            own.put(primitive, color([0.9, 0.8, 0.3, 1.0], json!({})), json!({"skin": skin}));
        }
        Part::Morph => {
            let mut primitive = pane();
            primitive["targets"] = json!([{"POSITION": Accessor::Displacements as usize}]);
            let node = own.nodes.len();
            own.put(primitive, color([0.3, 0.8, 0.8, 1.0], json!({})), json!({"translation": [1.2, 1, -0.2]}));
            own.animate(node, "weights", Accessor::MorphWeights);
        }
        Part::Lines => {
            for (mode, x) in [(3, -0.5), (0, 0.5)] {
                let primitive = json!({"attributes": {"POSITION": Accessor::Positions as usize}, "mode": mode});
                own.put(primitive, color([1.0, 0.2, 0.2, 1.0], json!({})), json!({"translation": [x, 1.5, 0.2]}));
            }
        }
        Part::Lobes => {
            // Two lobes a material: a shader for each lobe would double the time of a case.
            let coat_and_anisotropy = json!({
                "KHR_materials_clearcoat": {"clearcoatFactor": 1, "clearcoatRoughnessFactor": 0.1},
                "KHR_materials_anisotropy": {"anisotropyStrength": 0.7}
            });
            let sheen_and_iridescence = json!({
                "KHR_materials_sheen": {"sheenColorFactor": [0.9, 0.5, 0.5], "sheenRoughnessFactor": 0.5},
                "KHR_materials_iridescence": {"iridescenceFactor": 1}
            });
            for (lobe, x) in [(coat_and_anisotropy, -1.8), (sheen_and_iridescence, 0.6)] {
                let node = json!({"translation": [x, 0.4, 1.4], "scale": [0.4, 0.4, 1]});
                own.put(pane(), color([0.6, 0.6, 0.7, 1.0], lobe), node);
            }
        }
        Part::Unlit => {
            let unlit = color([0.9, 0.9, 0.1, 1.0], json!({"KHR_materials_unlit": {}}));
            own.put(pane(), unlit, json!({"translation": [1.8, 0.5, 0.8], "scale": [0.3, 0.3, 1]}));
        }
    }
}

/// Adds alternating point and spot lights on a circle above the ground.
fn lights(own: &mut Growing, count: usize) {
    let down = [-std::f32::consts::FRAC_1_SQRT_2, 0.0, 0.0, std::f32::consts::FRAC_1_SQRT_2];
    for index in 0..count {
        let turn = index as f32 / count as f32 * std::f32::consts::TAU;
        let node = json!({"translation": [2.0 * turn.cos(), 2.0, 2.0 * turn.sin()], "rotation": down});
        let mut light = json!({"type": "point", "intensity": 2000, "range": 6});
        if index % 2 == 1 {
            light["type"] = "spot".into();
            light["spot"] = json!({"innerConeAngle": 0.3, "outerConeAngle": 0.8});
        }
        own.light(light, node);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn accessors_lie_in_the_buffer_in_the_order_of_their_names() {
        let geometry = Geometry::new();
        for view in &geometry.views {
            let of = |key: &str| view[key].as_u64().expect("a number");
            assert!(of("byteOffset") % 4 == 0 && of("byteOffset") + of("byteLength") <= geometry.bytes.len() as u64);
        }
        let shapes: Vec<_> = geometry.accessors.iter().map(|a| a["type"].as_str().expect("a shape")).collect();
        let at = |accessor: Accessor| shapes[accessor as usize];
        assert_eq!(
            (at(Accessor::InverseBind), at(Accessor::Rotations), at(Accessor::Indices)),
            ("MAT4", "VEC4", "SCALAR")
        );
        assert_eq!(shapes.len(), Accessor::MorphWeights as usize + 1);
    }
}
