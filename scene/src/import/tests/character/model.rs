//! A character as numbers: nodes, skins, meshes and animations, and its file.

use super::super::fixture::Fixture;
use super::math::{Matrix, Quaternion, Vector, rounded};
use serde_json::{Value, json};

/// Transform of a node relative to its parent.
#[derive(Clone, Copy)]
pub enum Local {
    Parts(Vector, Quaternion, Vector),
    Matrix(Matrix),
}

#[derive(Clone)]
pub struct Node {
    pub parent: Option<usize>,
    pub local: Local,
}

/// Encoding of numbers.
#[derive(Clone, Copy, PartialEq)]
pub enum Code {
    F32,
    I8,
    I16,
    U8,
    U16,
}

impl Code {
    /// Returns the maximum of a normalized integer; `None` for floats.
    fn largest(self) -> Option<f64> {
        match self {
            Self::F32 => None,
            Self::I8 => Some(127.0),
            Self::I16 => Some(32767.0),
            Self::U8 => Some(255.0),
            Self::U16 => Some(65535.0),
        }
    }

    /// Returns the closest storable number.
    pub fn stored(self, number: f64) -> f64 {
        self.largest().map_or(rounded(number), |largest| (number * largest).round() / largest)
    }

    /// Returns the bytes of a stored number.
    fn bytes(self, number: f64) -> Vec<u8> {
        let code = (number * self.largest().unwrap_or(1.0)).round();
        match self {
            Self::F32 => (number as f32).to_le_bytes().to_vec(),
            Self::I8 => (code as i8).to_le_bytes().to_vec(),
            Self::I16 => (code as i16).to_le_bytes().to_vec(),
            Self::U8 => (code as u8).to_le_bytes().to_vec(),
            Self::U16 => (code as u16).to_le_bytes().to_vec(),
        }
    }

    fn component(self) -> u32 {
        match self {
            Self::F32 => 5126,
            Self::I8 => 5120,
            Self::I16 => 5122,
            Self::U8 => 5121,
            Self::U16 => 5123,
        }
    }

    fn write(self, fixture: &mut Fixture, width: usize, numbers: &[f64]) -> usize {
        let kind = ["SCALAR", "VEC2", "VEC3", "VEC4"][width - 1];
        let bytes: Vec<u8> = numbers.iter().flat_map(|number| self.bytes(*number)).collect();
        let accessor = fixture.array(&bytes, self.component(), kind, numbers.len() / width);
        if self != Self::F32 {
            fixture.set(&format!("/accessors/{accessor}/normalized"), json!(true));
        }
        accessor
    }
}

/// Four influences per vertex: indices into the skin's joints, and weights as stored.
#[derive(Clone, Default)]
pub struct Influences {
    pub joints: Vec<[u16; 4]>,
    pub weights: Vec<[f64; 4]>,
}

#[derive(Clone)]
pub struct Morph {
    pub positions: Vec<Vector>,
    pub normals: Option<Vec<Vector>>,
}

#[derive(Clone)]
pub struct Shape {
    pub positions: Vec<Vector>,
    pub normals: Vec<Vector>,
    pub influences: Vec<Influences>,
    /// Encoding of weights.
    pub weights: Code,
    /// True if joints are stored in 16 bits instead of 8.
    pub wide_joints: bool,
    pub morphs: Vec<Morph>,
    pub morph_weights: Vec<f64>,
}

#[derive(Clone)]
pub struct Skin {
    pub joints: Vec<usize>,
    pub inverse_bind: Option<Vec<Matrix>>,
    pub skeleton: Option<usize>,
}

/// A node that draws a shape.
#[derive(Clone, Copy)]
pub struct Drawn {
    pub node: usize,
    pub shape: usize,
    pub skin: Option<usize>,
}

#[derive(Clone, Copy, PartialEq)]
pub enum Path {
    Translation,
    Rotation,
    Scale,
    Weights,
}

#[derive(Clone, Copy, PartialEq)]
pub enum Way {
    Step,
    Linear,
    Cubic,
}

#[derive(Clone)]
pub struct Channel {
    pub node: usize,
    pub path: Path,
    pub way: Way,
    pub times: Vec<f64>,
    /// Stored numbers: for each key a value, or in-tangent, value and out-tangent.
    pub values: Vec<f64>,
    pub code: Code,
}

#[derive(Clone, Default)]
pub struct Character {
    /// Nodes; parents precede their children.
    pub nodes: Vec<Node>,
    /// Roots outside of the scene.
    pub outside: Vec<usize>,
    pub shapes: Vec<Shape>,
    pub skins: Vec<Skin>,
    pub drawn: Vec<Drawn>,
    pub channels: Vec<Channel>,
}

impl Character {
    /// Returns the file. The node of drawn shape N is named `drawn N`.
    pub fn file(&self) -> Fixture {
        let mut fixture = Fixture::new();
        fixture.json["meshes"] = json!([]);
        let is_root = |node: &usize| self.nodes[*node].parent.is_none() && !self.outside.contains(node);
        let roots: Vec<usize> = (0..self.nodes.len()).filter(is_root).collect();
        fixture.json["scenes"] = json!([{"nodes": roots}]);
        fixture.json["nodes"] = (0..self.nodes.len()).map(|node| self.node(node)).collect();
        for shape in &self.shapes {
            let primitive = shape.write(&mut fixture);
            let mut mesh = json!({"primitives": [primitive]});
            if !shape.morphs.is_empty() {
                mesh["weights"] = json!(shape.morph_weights);
            }
            fixture.push("meshes", mesh);
        }
        for skin in &self.skins {
            let mut json = json!({"joints": skin.joints});
            if let Some(matrices) = &skin.inverse_bind {
                let numbers = matrices.iter().flatten().flatten();
                let bytes: Vec<u8> = numbers.flat_map(|number| (*number as f32).to_le_bytes()).collect();
                json["inverseBindMatrices"] = json!(fixture.array(&bytes, 5126, "MAT4", matrices.len()));
            }
            if let Some(skeleton) = skin.skeleton {
                json["skeleton"] = json!(skeleton);
            }
            fixture.push("skins", json);
        }
        self.write_animation(&mut fixture);
        fixture
    }

    fn node(&self, index: usize) -> Value {
        let mut json = match self.nodes[index].local {
            Local::Parts(t, r, s) => json!({"translation": t, "rotation": r, "scale": s}),
            Local::Matrix(matrix) => json!({"matrix": matrix.as_flattened()}),
        };
        let is_child = |child: &usize| self.nodes[*child].parent == Some(index);
        let children: Vec<usize> = (0..self.nodes.len()).filter(is_child).collect();
        if !children.is_empty() {
            json["children"] = json!(children);
        }
        if let Some(number) = self.drawn.iter().position(|drawn| drawn.node == index) {
            let drawn = self.drawn[number];
            json["name"] = json!(format!("drawn {number}"));
            json["mesh"] = json!(drawn.shape);
            if let Some(skin) = drawn.skin {
                json["skin"] = json!(skin);
            }
        }
        json
    }

    fn write_animation(&self, fixture: &mut Fixture) {
        let (mut samplers, mut channels) = (Vec::new(), Vec::new());
        for channel in &self.channels {
            let way = match channel.way {
                Way::Step => "STEP",
                Way::Linear => "LINEAR",
                Way::Cubic => "CUBICSPLINE",
            };
            let (path, width) = match channel.path {
                Path::Translation => ("translation", 3),
                Path::Rotation => ("rotation", 4),
                Path::Scale => ("scale", 3),
                Path::Weights => ("weights", 1),
            };
            let input = Code::F32.write(fixture, 1, &channel.times);
            let output = channel.code.write(fixture, width, &channel.values);
            channels.push(json!({"sampler": samplers.len(), "target": {"node": channel.node, "path": path}}));
            samplers.push(json!({"input": input, "output": output, "interpolation": way}));
        }
        if !channels.is_empty() {
            fixture.push("animations", json!({"samplers": samplers, "channels": channels}));
        }
    }
}

impl Shape {
    /// Returns the primitive; every three vertices are a triangle.
    fn write(&self, fixture: &mut Fixture) -> Value {
        let vectors = |fixture: &mut Fixture, all: &[Vector]| Code::F32.write(fixture, 3, all.as_flattened());
        let position = vectors(fixture, &self.positions);
        let normal = vectors(fixture, &self.normals);
        let mut primitive = json!({"attributes": {"POSITION": position, "NORMAL": normal}});
        for (set, influences) in self.influences.iter().enumerate() {
            let joints = influences.joints.as_flattened();
            let bytes: Vec<u8> = if self.wide_joints {
                joints.iter().flat_map(|joint| joint.to_le_bytes()).collect()
            } else {
                joints.iter().map(|joint| u8::try_from(*joint).expect("it fits")).collect()
            };
            let component = if self.wide_joints { 5123 } else { 5121 };
            let joints = fixture.array(&bytes, component, "VEC4", influences.joints.len());
            let weights = self.weights.write(fixture, 4, influences.weights.as_flattened());
            primitive["attributes"][format!("JOINTS_{set}")] = json!(joints);
            primitive["attributes"][format!("WEIGHTS_{set}")] = json!(weights);
        }
        for morph in &self.morphs {
            let mut target = json!({"POSITION": vectors(fixture, &morph.positions)});
            if let Some(normals) = &morph.normals {
                target["NORMAL"] = json!(vectors(fixture, normals));
            }
            if primitive["targets"].is_null() {
                primitive["targets"] = json!([]);
            }
            primitive["targets"].as_array_mut().expect("a list").push(target);
        }
        primitive
    }
}
