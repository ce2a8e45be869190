//! Vertex positions of a character at a time, computed directly from the formulas of the specification (glTF 2.0,
//! sections 3.7.3 and 3.11, appendix C).

use super::math::{IDENTITY, Matrix, Quaternion, Vector, determinant, normal, of_parts, point, product, slerp, unit};
use super::model::{Channel, Character, Drawn, Local, Path, Way};

/// A drawn shape in world axes.
pub struct Posed {
    pub positions: Vec<Vector>,
    pub normals: Vec<Vector>,
    /// True if the shape is mirrored by its node, or as a whole by the first joint of its skin.
    pub is_mirrored: bool,
}

/// Poses all drawn shapes at a time of the animation, or at rest.
pub fn posed(character: &Character, time: Option<f64>) -> Vec<Posed> {
    let mut worlds = Vec::new();
    for node in 0..character.nodes.len() {
        let own = own_transform(character, node, time);
        worlds.push(character.nodes[node].parent.map_or(own, |parent| product(&worlds[parent], &own)));
    }
    character.drawn.iter().map(|drawn| pose(character, drawn, time, &worlds)).collect()
}

fn pose(character: &Character, drawn: &Drawn, time: Option<f64>, worlds: &[Matrix]) -> Posed {
    let shape = &character.shapes[drawn.shape];
    let weights = sampled(character, drawn.node, Path::Weights, time).unwrap_or_else(|| shape.morph_weights.clone());
    let mut posed = Posed { positions: Vec::new(), normals: Vec::new(), is_mirrored: false };
    let whole = match drawn.skin.map(|skin| &character.skins[skin]) {
        Some(skin) => product(&worlds[skin.joints[0]], &skin.inverse_bind.as_ref().map_or(IDENTITY, |all| all[0])),
        None => worlds[drawn.node],
    };
    posed.is_mirrored = determinant(&whole) < 0.0;
    for vertex in 0..shape.positions.len() {
        let (mut position, mut direction) = (shape.positions[vertex], shape.normals[vertex]);
        for (morph, weight) in shape.morphs.iter().zip(&weights) {
            for axis in 0..3 {
                position[axis] += weight * morph.positions[vertex][axis];
                direction[axis] += weight * morph.normals.as_ref().map_or(0.0, |all| all[vertex][axis]);
            }
        }
        let matrix = match drawn.skin {
            // The node's own transform is ignored.
            Some(skin) => blended(character, drawn, skin, vertex, worlds),
            None => worlds[drawn.node],
        };
        posed.positions.push(point(&matrix, position));
        // Blending may invert a vertex; the normal stays on the visible side of the triangles.
        let side = if (determinant(&matrix) < 0.0) == posed.is_mirrored { 1.0 } else { -1.0 };
        posed.normals.push(normal(&matrix, direction).map(|n| side * n));
    }
    posed
}

/// Returns the weighted sum of the joint matrices of a vertex.
fn blended(character: &Character, drawn: &Drawn, skin: usize, vertex: usize, worlds: &[Matrix]) -> Matrix {
    let skin = &character.skins[skin];
    let mut sum = [[0.0; 4]; 4];
    let mut total = 0.0;
    for set in &character.shapes[drawn.shape].influences {
        for (joint, weight) in set.joints[vertex].iter().zip(set.weights[vertex]) {
            let joint = usize::from(*joint);
            let bind = skin.inverse_bind.as_ref().map_or(IDENTITY, |all| all[joint]);
            let matrix = product(&worlds[skin.joints[joint]], &bind);
            for (sum, number) in sum.as_flattened_mut().iter_mut().zip(matrix.as_flattened()) {
                *sum += weight * number;
            }
            total += weight;
        }
    }
    sum.map(|column| column.map(|number| number / total))
}

fn own_transform(character: &Character, node: usize, time: Option<f64>) -> Matrix {
    match character.nodes[node].local {
        Local::Matrix(matrix) => matrix,
        Local::Parts(t, r, s) => {
            let vector = |path, rest: Vector| {
                sampled(character, node, path, time).map_or(rest, |value| [value[0], value[1], value[2]])
            };
            let rotation = sampled(character, node, Path::Rotation, time);
            let rotation: Quaternion = rotation.map_or(r, |value| [value[0], value[1], value[2], value[3]]);
            of_parts(vector(Path::Translation, t), rotation, vector(Path::Scale, s))
        }
    }
}

/// Returns the value of a node's property, if a channel animates it.
fn sampled(character: &Character, node: usize, path: Path, time: Option<f64>) -> Option<Vec<f64>> {
    let channel = character.channels.iter().find(|channel| channel.node == node && channel.path == path)?;
    Some(value(channel, time?))
}

fn value(channel: &Channel, time: f64) -> Vec<f64> {
    let keys = channel.times.len();
    let parts = if channel.way == Way::Cubic { 3 } else { 1 };
    let width = channel.values.len() / keys / parts;
    let key = |key: usize, part: usize| {
        let first = (key * parts + part) * width;
        &channel.values[first..first + width]
    };
    let middle = parts / 2;
    if time <= channel.times[0] {
        return key(0, middle).to_vec();
    }
    if time >= channel.times[keys - 1] {
        return key(keys - 1, middle).to_vec();
    }
    let mut k = 0;
    while time >= channel.times[k + 1] {
        k += 1;
    }
    let step = channel.times[k + 1] - channel.times[k];
    let t = (time - channel.times[k]) / step;
    match channel.way {
        Way::Step => key(k, 0).to_vec(),
        Way::Linear if channel.path == Path::Rotation => {
            let quaternion = |k: usize| -> Quaternion { std::array::from_fn(|i| key(k, 0)[i]) };
            slerp(quaternion(k), quaternion(k + 1), t).to_vec()
        }
        Way::Linear => (0..width).map(|i| (1.0 - t) * key(k, 0)[i] + t * key(k + 1, 0)[i]).collect(),
        Way::Cubic => {
            let number = |i: usize| {
                (2.0 * t.powi(3) - 3.0 * t.powi(2) + 1.0) * key(k, 1)[i]
                    + step * (t.powi(3) - 2.0 * t.powi(2) + t) * key(k, 2)[i]
                    + (-2.0 * t.powi(3) + 3.0 * t.powi(2)) * key(k + 1, 1)[i]
                    + step * (t.powi(3) - t.powi(2)) * key(k + 1, 0)[i]
            };
            let value: Vec<f64> = (0..width).map(number).collect();
            if channel.path == Path::Rotation { unit([value[0], value[1], value[2], value[3]]).to_vec() } else { value }
        }
    }
}
