//! What moves the vertices of a primitive: joints with weights, and morph targets.

use glam::{Vec3, Vec4};
use gltf_json::mesh::{Primitive, Semantic};

use super::packed::{self, Values};
use super::source::Source;
use super::stream::{finite, stream};
use crate::error::SceneError;
use crate::motion::{MorphTarget, Moves};

/// How far the weights of a vertex may be from a sum of 1, as bytes round them; what is nearer is made 1.
const LOOSE_SUM: f32 = 0.02;

/// Accessors of what moves a mesh, and of which node it is.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct MovesKey {
    node: usize,
    joints: Option<[Values; 2]>,
    targets: Vec<[Option<usize>; 3]>,
}

impl MovesKey {
    /// None where nothing moves the vertices.
    pub fn new(primitive: &Primitive, node: usize, skinned: bool) -> Option<Self> {
        let values = |semantic| packed::values(primitive, &semantic);
        let joints = values(Semantic::Joints(0)).zip(values(Semantic::Weights(0))).filter(|_| skinned);
        let value = |index: Option<gltf_json::Index<_>>| index.map(|index| index.value());
        let targets = primitive.targets.iter().flatten();
        let targets: Vec<_> = targets.map(|t| [value(t.positions), value(t.normals), value(t.tangents)]).collect();
        let joints = joints.map(|(joints, weights)| [joints, weights]);
        (joints.is_some() || !targets.is_empty()).then_some(Self { node, joints, targets })
    }
}

/// Reads what moves `vertices`. Weights are made to add up to 1; joints are checked where the skin is known.
pub(super) fn read(source: &Source<'_>, key: &MovesKey, at: &str, vertices: usize) -> Result<Moves, SceneError> {
    let count = Some(vertices);
    let mut moves = Moves::default();
    if let Some([joints, weights]) = key.joints {
        moves.joints = stream(source, at, "JOINTS_0", joints, count, |joints: [f32; 4]| joints.map(|j| j as u16))?;
        let weights = stream(source, at, "WEIGHTS_0", weights, count, Vec4::from_array)?;
        finite(source, at, "WEIGHTS_0", &weights, |w| w.is_finite())?;
        for (vertex, own) in weights.iter().enumerate() {
            let sum = own.element_sum();
            if own.min_element() < 0.0 || (sum - 1.0).abs() > LOOSE_SUM {
                let reason = format!(
                    "WEIGHTS_0 of vertex {vertex} are {own}, of sum {sum}: none below 0 and a sum of 1 are needed"
                );
                return Err(source.malformed(at, reason));
            }
            moves.weights.push((*own / sum).to_array());
        }
    }
    for (number, target) in key.targets.iter().enumerate() {
        let read = |place: usize, name: &str| -> Result<Vec<Vec3>, SceneError> {
            let Some(accessor) = target[place] else { return Ok(Vec::new()) };
            let what = format!("{name} of target {number}");
            let values = stream(source, at, &what, accessor, count, Vec3::from_array)?;
            finite(source, at, &what, &values, |v| v.is_finite())?;
            Ok(values)
        };
        let [positions, normals, tangents] = [read(0, "POSITION")?, read(1, "NORMAL")?, read(2, "TANGENT")?];
        moves.targets.push(MorphTarget { positions, normals, tangents });
    }
    Ok(moves)
}
