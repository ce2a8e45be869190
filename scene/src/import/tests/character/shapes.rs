//! Test characters: a biped and a chain, with many kinds of rest poses, binds, skins and animations.

use super::math::{IDENTITY, Matrix, Noise, Quaternion, Vector, inverse, of_parts, point, product, rounded};
use super::model::{Channel, Character, Code, Drawn, Influences, Local, Morph, Node, Path, Shape, Skin, Way};

/// Joints of a biped: parent and offset from it in meters.
const BIPED: [(Option<usize>, Vector); 11] = [
    (None, [0.0, 1.0, 0.0]),         // 0 hips
    (Some(0), [0.0, 0.3, 0.02]),     // 1 spine
    (Some(1), [0.0, 0.45, -0.03]),   // 2 head
    (Some(1), [0.25, 0.3, 0.0]),     // 3 left arm
    (Some(3), [0.3, -0.05, 0.0]),    // 4 left elbow
    (Some(1), [-0.25, 0.3, 0.0]),    // 5 right arm
    (Some(5), [-0.3, -0.05, 0.0]),   // 6 right elbow
    (Some(0), [0.12, -0.1, 0.0]),    // 7 left leg
    (Some(7), [0.02, -0.45, 0.03]),  // 8 left knee
    (Some(0), [-0.12, -0.1, 0.0]),   // 9 right leg
    (Some(9), [-0.02, -0.45, 0.03]), // 10 right knee
];

/// Joints before they are added as nodes: parents, bind pose and rest pose.
pub struct Joints {
    parents: Vec<Option<usize>>,
    rest: Vec<(Vector, Quaternion, Vector)>,
    /// Transforms from the joint's axes to those above the first joint.
    pub bind: Vec<Matrix>,
}

/// Returns the joints of a biped with `unit` units per meter. Bind pose and rest pose differ in every joint.
pub fn biped(noise: &mut Noise, unit: f64) -> Joints {
    joints(noise, BIPED.iter().map(|(parent, t)| (*parent, t.map(|x| rounded(x * unit)))))
}

/// Returns `count` joints with 5 cm between neighbors.
pub fn chain(noise: &mut Noise, count: usize) -> Joints {
    joints(noise, (0..count).map(|joint| (joint.checked_sub(1), [0.05, 0.0, 0.0].map(rounded))))
}

fn joints(noise: &mut Noise, skeleton: impl Iterator<Item = (Option<usize>, Vector)>) -> Joints {
    let mut joints = Joints { parents: Vec::new(), rest: Vec::new(), bind: Vec::<Matrix>::new() };
    for (parent, t) in skeleton {
        let own = of_parts(t, noise.rotation(0.7), [1.0; 3]);
        joints.bind.push(parent.map_or(own, |parent: usize| product(&joints.bind[parent], &own)));
        let moved = noise.vector(0.02);
        let size = |t: Vector| t.map(f64::abs).into_iter().fold(0.0, f64::max);
        let t = std::array::from_fn(|axis| rounded(t[axis] + size(t) * moved[axis]));
        let scale = noise.vector(0.1).map(|s| rounded(1.0 + s));
        joints.rest.push((t, noise.rotation(0.5), scale));
        joints.parents.push(parent);
    }
    joints
}

impl Joints {
    /// Appends the joints to a character below `parent`; returns their nodes.
    pub fn add(&self, character: &mut Character, parent: Option<usize>) -> Vec<usize> {
        let first = character.nodes.len();
        for (own, (t, r, s)) in self.parents.iter().zip(&self.rest) {
            let parent = own.map_or(parent, |own| Some(first + own));
            character.nodes.push(Node { parent, local: Local::Parts(*t, *r, *s) });
        }
        (first..character.nodes.len()).collect()
    }

    /// Returns inverse bind matrices of a mesh modeled in axes that `above` maps to those above the first joint.
    pub fn inverse_bind(&self, above: &Matrix) -> Vec<Matrix> {
        let stored = |bind: &Matrix| product(&inverse(bind), above).map(|column| column.map(rounded));
        self.bind.iter().map(stored).collect()
    }
}

/// Returns a shape with six vertices at each joint, which follow `sets` · 4 nearby joints. `shape_from_above` maps the
/// axes above the first joint to those of the mesh.
pub fn shape(
    noise: &mut Noise,
    joints: &Joints,
    shape_from_above: &Matrix,
    unit: f64,
    sets: usize,
    weights: Code,
) -> Shape {
    let mut shape = Shape {
        positions: Vec::new(),
        normals: Vec::new(),
        influences: vec![Influences::default(); sets],
        weights,
        wide_joints: joints.bind.len() > 256 || weights == Code::U16,
        morphs: Vec::new(),
        morph_weights: Vec::new(),
    };
    for (joint, bind) in joints.bind.iter().enumerate() {
        for _ in 0..6 {
            let near = noise.vector(0.15 * unit);
            let place = point(shape_from_above, std::array::from_fn(|axis| bind[3][axis] + near[axis]));
            shape.positions.push(place.map(rounded));
            let [x, y, z] = noise.vector(1.0);
            shape.normals.push(super::math::unit([x, y, z + 1.2]).map(rounded));
            let all: Vec<f64> =
                (0..4 * sets).map(|i| (noise.number() + 1.05) * if i == 0 { 2.0 } else { 0.5 }).collect();
            let all = stored_weights(&all, weights);
            for (set, influences) in shape.influences.iter_mut().enumerate() {
                let other = |i: usize| match (set, i) {
                    (0, 0) => joint,
                    (0, 1) => joints.parents[joint].unwrap_or(joint),
                    _ => (joint + 3 * set + 2 * i) % joints.bind.len(),
                };
                influences.joints.push(std::array::from_fn(|i| other(i) as u16));
                influences.weights.push(std::array::from_fn(|i| all[4 * set + i]));
            }
        }
    }
    shape
}

/// Scales weights to a sum of 1 and stores them; normalized integers keep that sum exactly, as section 3.7.3.3
/// requires.
fn stored_weights(weights: &[f64], code: Code) -> Vec<f64> {
    let sum: f64 = weights.iter().sum();
    let mut stored: Vec<f64> = weights.iter().map(|weight| code.stored(weight / sum)).collect();
    if code != Code::F32 {
        stored[0] = code.stored(1.0 - stored[1..].iter().sum::<f64>());
    }
    stored
}

/// Adds morph targets, the second without normals.
pub fn morph(noise: &mut Noise, shape: &mut Shape, size: f64) {
    let mut vectors = |size| (0..shape.positions.len()).map(|_| noise.vector(size)).collect::<Vec<_>>();
    shape.morphs = vec![
        Morph { positions: vectors(size), normals: Some(vectors(0.4)) },
        Morph { positions: vectors(size), normals: None },
    ];
    shape.morph_weights = vec![0.25, rounded(-0.3)];
}

/// Appends a skin and a node that draws a shape with it.
pub fn draw(character: &mut Character, shape: Shape, skin: Option<Skin>, parent: Option<usize>, local: Local) {
    character.nodes.push(Node { parent, local });
    character.shapes.push(shape);
    if let Some(skin) = skin {
        character.skins.push(skin);
        let skin = Some(character.skins.len() - 1);
        let (node, shape) = (character.nodes.len() - 1, character.shapes.len() - 1);
        character.drawn.push(Drawn { node, shape, skin });
    } else {
        let (node, shape) = (character.nodes.len() - 1, character.shapes.len() - 1);
        character.drawn.push(Drawn { node, shape, skin: None });
    }
}

/// Returns a transform that must have no effect.
pub fn ignored(noise: &mut Noise) -> Local {
    Local::Parts(noise.vector(9.0), noise.rotation(3.0), [3.0, 0.5, 2.0])
}

pub fn at_origin() -> Local {
    Local::Matrix(IDENTITY)
}

/// Gives every joint channels for all three paths, alternating interpolations and encodings, with separate times.
pub fn animate(noise: &mut Noise, character: &mut Character, nodes: &[usize]) {
    for (number, &node) in nodes.iter().enumerate() {
        let Local::Parts(t, _, _) = character.nodes[node].local else { panic!("a joint has parts") };
        let reach = t.map(f64::abs).into_iter().fold(0.0, f64::max);
        let ways = [Way::Step, Way::Linear, Way::Cubic];
        let way = |shift: usize| ways[(number + shift) % 3];
        let code = [Code::F32, Code::I16, Code::I8][number / 3 % 3];
        let place = |noise: &mut Noise| -> Vec<f64> {
            let moved = noise.vector(0.3 * reach);
            (0..3).map(|axis| t[axis] + moved[axis]).collect()
        };
        let turned = |noise: &mut Noise| noise.rotation(2.5).to_vec();
        let scaled = |noise: &mut Noise| noise.vector(0.3).map(|s| 1.0 + s).to_vec();
        character.channels.push(channel(noise, node, Path::Translation, way(0), Code::F32, &place));
        character.channels.push(channel(noise, node, Path::Rotation, way(1), code, &turned));
        if number % 2 == 0 {
            character.channels.push(channel(noise, node, Path::Scale, way(2), Code::F32, &scaled));
        }
    }
}

/// Times of the comparison: before, at, between and after the keys.
pub const TIMES: [f64; 5] = [0.0, 0.25, 0.4, 1.0, 3.0];

/// Returns a channel with four keys with the values of `value`.
pub fn channel(
    noise: &mut Noise,
    node: usize,
    path: Path,
    way: Way,
    code: Code,
    value: &dyn Fn(&mut Noise) -> Vec<f64>,
) -> Channel {
    let times = vec![0.25, 0.5, 1.25, 2.0 + node as f64 / 8.0];
    let mut values = Vec::new();
    for _ in &times {
        let width = value(noise).len();
        let tangent = |noise: &mut Noise| (0..width).map(|_| 0.4 * noise.number()).collect::<Vec<_>>();
        if way == Way::Cubic {
            values.extend(tangent(noise));
        }
        values.extend(value(noise));
        if way == Way::Cubic {
            values.extend(tangent(noise));
        }
    }
    let values = values.into_iter().map(|number| code.stored(number)).collect();
    Channel { node, path, way, times, values, code }
}
