//! Skin influences and morph targets of a primitive.

use glam::Vec3;
use gltf_json::mesh::{Primitive, Semantic};

use super::packed::{self, Values};
use super::source::{Repair, Source, Warnings};
use super::stream::{finite, stream};
use crate::error::SceneError;
use crate::motion::{InfluenceSet, MorphTarget, Moves};

/// Largest deviation from 1 of a vertex's weight sum that counts as rounding: 8-bit weights round by up to 0.002 each.
/// Larger deviations are normalized with a warning.
const ROUNDING: f32 = 0.02;

/// Accessors of skin influences and morph targets, and the node whose mesh they deform.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct MovesKey {
    node: usize,
    /// Number of a skinned primitive, which has a deformable mesh of its own.
    primitive: Option<usize>,
    /// Joints and weights of each set.
    influences: Vec<[Values; 2]>,
    targets: Vec<[Option<usize>; 3]>,
}

impl MovesKey {
    /// Returns the accessors of primitive `number` of a mesh, or `None` if nothing deforms it.
    pub fn new(primitive: &Primitive, number: usize, node: usize, skinned: bool) -> Option<Self> {
        let values = |semantic| packed::values(primitive, &semantic);
        let set = |number| values(Semantic::Joints(number)).zip(values(Semantic::Weights(number)));
        let sets = (0..).map_while(|number| set(number).filter(|_| skinned));
        let influences: Vec<_> = sets.map(|(joints, weights)| [joints, weights]).collect();
        let value = |index: Option<gltf_json::Index<_>>| index.map(|index| index.value());
        let targets = primitive.targets.iter().flatten();
        let targets: Vec<_> = targets.map(|t| [value(t.positions), value(t.normals), value(t.tangents)]).collect();
        let is_moved = !influences.is_empty() || !targets.is_empty();
        is_moved.then_some(Self { node, primitive: skinned.then_some(number), influences, targets })
    }
}

/// Reads the influences and targets of `vertices` vertices. Weights are normalized; joints are checked later, against
/// the skin.
pub(super) fn read(
    source: &Source<'_>,
    key: &MovesKey,
    at: &str,
    vertices: usize,
    warnings: &mut Warnings,
) -> Result<Moves, SceneError> {
    let count = Some(vertices);
    let mut moves = Moves::default();
    for (number, [joints, weights]) in key.influences.iter().enumerate() {
        let what = format!("JOINTS_{number}");
        let joints = stream(source, at, &what, *joints, count, |joints: [f32; 4]| joints)?;
        let fits = |joint: &f32| (0.0..=f32::from(u16::MAX)).contains(joint);
        if let Some(vertex) = joints.iter().position(|own| !own.iter().all(fits)) {
            return Err(
                source.malformed(at, format!("{what} of vertex {vertex} are {:?}, not 0 to 65535", joints[vertex]))
            );
        }
        let joints = joints.into_iter().map(|own| own.map(|joint| joint as u16)).collect();
        let weights = stream(source, at, &format!("WEIGHTS_{number}"), *weights, count, |weights: [f32; 4]| weights)?;
        moves.influences.push(InfluenceSet { joints, weights });
    }
    let repaired = normalize(&mut moves.influences, vertices);
    warnings.count(Repair::Weights, at, repaired);
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

/// Normalizes the weights of each vertex to a sum of 1 over all sets; returns the number of corrected vertices.
///
/// Negative and non-finite weights count as 0. A vertex without weights follows its first joint, as in three.js.
fn normalize(sets: &mut [InfluenceSet], vertices: usize) -> usize {
    let mut repaired = 0;
    for vertex in 0..if sets.is_empty() { 0 } else { vertices } {
        let mut is_wrong = false;
        let mut sum = 0.0;
        for weight in sets.iter_mut().flat_map(|set| &mut set.weights[vertex]) {
            if !(*weight >= 0.0 && weight.is_finite()) {
                (*weight, is_wrong) = (0.0, true);
            }
            sum += *weight;
        }
        is_wrong |= (sum - 1.0).abs() > ROUNDING;
        if sum > 0.0 && sum.is_finite() {
            sets.iter_mut().flat_map(|set| &mut set.weights[vertex]).for_each(|weight| *weight /= sum);
        } else {
            for (number, set) in sets.iter_mut().enumerate() {
                set.weights[vertex] = if number == 0 { [1.0, 0.0, 0.0, 0.0] } else { [0.0; 4] };
            }
        }
        repaired += usize::from(is_wrong);
    }
    repaired
}
