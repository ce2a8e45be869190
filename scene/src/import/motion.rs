//! Nodes, skins and animations.

use std::collections::BTreeMap;

use glam::{DMat4, DVec4};
use gltf_json::animation::{Interpolation as Way, Property as Path};
use gltf_json::validation::Checked;

use super::accessor::{floats, width};
use super::Placed;
use super::document::NO_NODE;
use super::node::FlatNode;
use super::source::{Source, Warnings, beyond};
use crate::error::{SceneError, one_line};
use crate::motion::{Animation, Body, Channel, Curve, Interpolation, Motion, Moves, Node, Property, Shape, Skin};
use crate::scene::Scene;

/// Imports nodes, skins, bodies and animations into [`Scene::motion`], and poses the scene at rest.
///
/// `placed` has the node and place of each instance. A file without animations, skins and morph targets
/// imports nothing.
pub(super) fn import(
    source: &Source<'_>,
    nodes: &[FlatNode],
    placed: Placed,
    scene: &mut Scene,
    warnings: &mut Warnings,
) -> Result<(), SceneError> {
    let mut motion = Motion { nodes: nodes.iter().map(|node| rig_node(source, node)).collect(), ..Motion::default() };
    let mut places = vec![None; source.root.nodes.len()];
    nodes.iter().enumerate().for_each(|(place, node)| places[node.index] = Some(place));
    // Skins by their index in the file. Skins that no mesh uses are not read.
    let mut skins = BTreeMap::new();
    for (instance, place) in placed.nodes.iter().enumerate() {
        let id = scene.instances[instance].mesh;
        let mesh = &mut scene.meshes[id.index()];
        let Some(moves) = mesh.moves.take() else { continue };
        let mut moves = *moves;
        let node = &nodes[*place];
        let skin = match node.skin.filter(|_| !moves.influences.is_empty()) {
            Some(number) => Some(match skins.get(&number) {
                Some(skin) => *skin,
                None => {
                    motion.skins.push(read_skin(source, &node.at, number, &places, warnings)?);
                    *skins.entry(number).or_insert(motion.skins.len() - 1)
                }
            }),
            None => None,
        };
        if let Some(skin) = skin {
            let joints = motion.skins[skin].joints.len();
            check_joints(&mut moves, joints).map_err(|reason| source.malformed(&node.at, reason))?;
        }
        let weights = &mut motion.nodes[*place].weights;
        weights.resize(weights.len().max(moves.targets.len()), 0.0);
        let rest =
            Shape { positions: mesh.positions.clone(), normals: mesh.normals.clone(), tangents: mesh.tangents.clone() };
        motion.bodies.push(Body { mesh: id, instance, node: *place, skin, rest, moves });
    }
    for (number, animation) in source.root.animations.iter().enumerate() {
        motion.animations.push(read_animation(source, number, animation, &places, &motion, warnings)?);
    }
    if motion.animations.is_empty() && motion.bodies.is_empty() {
        return Ok(());
    }
    motion.instance_nodes = placed.nodes;
    motion.node_from_model = placed.node_from_model;
    scene.motion = motion;
    scene.pose(None, 0.0).map_err(|error| source.malformed("skins", error.to_string()))
}

/// Checks that every joint with a weight is one of `joints`. Joints without a weight become joint 0.
fn check_joints(moves: &mut Moves, joints: usize) -> Result<(), String> {
    for set in &mut moves.influences {
        for (vertex, (own, weights)) in set.joints.iter_mut().zip(&set.weights).enumerate() {
            for (joint, weight) in own.iter_mut().zip(weights) {
                if *weight <= 0.0 {
                    *joint = 0;
                } else if usize::from(*joint) >= joints {
                    return Err(format!("vertex {vertex} of its mesh follows joint {joint}, but its skin has {joints}"));
                }
            }
        }
    }
    Ok(())
}

fn rig_node(source: &Source<'_>, node: &FlatNode) -> Node {
    let of_mesh = || source.root.meshes.get(node.mesh?)?.weights.clone();
    let weights = node.weights.clone().or_else(of_mesh).unwrap_or_default();
    let weights = weights.into_iter().map(|w| if w.is_finite() { f64::from(w) } else { 0.0 }).collect();
    Node { parent: node.parent, rest: node.rest, weights }
}

/// Reads the skin that the node `at` uses.
fn read_skin(
    source: &Source<'_>,
    at: &str,
    number: usize,
    places: &[Option<usize>],
    warnings: &mut Warnings,
) -> Result<Skin, SceneError> {
    let skins = &source.root.skins;
    let skin = skins.get(number).ok_or_else(|| source.malformed(at, beyond("skin", number, skins)))?;
    let at = format!("skin {number}");
    let place = |joint: &gltf_json::Index<gltf_json::Node>| {
        let index = joint.value();
        let found =
            places.get(index).ok_or_else(|| source.malformed(&at, beyond("node", index, &source.root.nodes)))?;
        found.ok_or_else(|| source.malformed(&at, format!("its joint, node {index}, hangs on no root")))
    };
    let joints: Vec<usize> = skin.joints.iter().map(place).collect::<Result<_, _>>()?;
    if joints.is_empty() {
        return Err(source.malformed(&at, "it has no joints"));
    }
    let matrices = match skin.inverse_bind_matrices {
        Some(accessor) => floats::<16>(source, accessor.value(), &format!("{at} inverseBindMatrices"))?,
        None => vec![DMat4::IDENTITY.as_mat4().to_cols_array(); joints.len()],
    };
    if matrices.len() < joints.len() {
        let reason = format!("{} inverse bind matrices for {} joints", matrices.len(), joints.len());
        return Err(source.malformed(&at, reason));
    }
    let mut joint_from_mesh = Vec::with_capacity(joints.len());
    for (joint, matrix) in matrices.iter().take(joints.len()).enumerate() {
        let mut matrix = DMat4::from_cols_array(&matrix.map(f64::from));
        if !matrix.is_finite() {
            return Err(source.malformed(&at, format!("inverse bind matrix {joint} is not finite")));
        }
        if matrix.row(3) != DVec4::W {
            warnings.push(format!("{at}: the last row of an inverse bind matrix is not 0, 0, 0, 1; it was replaced"));
            for column in 0..4 {
                matrix.col_mut(column).w = if column == 3 { 1.0 } else { 0.0 };
            }
        }
        joint_from_mesh.push(matrix);
    }
    Ok(Skin { joints, joint_from_mesh })
}

fn read_animation(
    source: &Source<'_>,
    number: usize,
    animation: &gltf_json::Animation,
    places: &[Option<usize>],
    motion: &Motion,
    warnings: &mut Warnings,
) -> Result<Animation, SceneError> {
    let name = one_line(animation.name.as_deref().unwrap_or_default());
    let mut channels = Vec::new();
    for (index, channel) in animation.channels.iter().enumerate() {
        let at = format!("animation {number} channel {index}");
        let target = channel.target.node.value();
        // A channel without a node is ignored (section 5.5.1, "node").
        if target == NO_NODE as usize {
            continue;
        }
        let place =
            places.get(target).ok_or_else(|| source.malformed(&at, beyond("node", target, &source.root.nodes)))?;
        let Some(node) = *place else {
            warnings.push(format!("{at}: node {target} is not in the scene; it is left out"));
            continue;
        };
        let (property, wide) = match channel.target.path {
            Checked::Valid(Path::Translation) => (Property::Translation, 3),
            Checked::Valid(Path::Scale) => (Property::Scale, 3),
            Checked::Valid(Path::Rotation) => (Property::Rotation, 4),
            Checked::Valid(Path::MorphTargetWeights) => (Property::Weights, motion.nodes[node].weights.len()),
            Checked::Invalid => {
                warnings.push(format!("{at}: it changes what is not known; it is left out"));
                continue;
            }
        };
        let sampler = channel.sampler.value();
        let sampler = animation
            .samplers
            .get(sampler)
            .ok_or_else(|| source.malformed(&at, beyond("sampler", sampler, &animation.samplers)))?;
        channels.push(Channel { node, property, curve: read_curve(source, &at, sampler, wide)? });
    }
    Ok(Animation { name, channels })
}

fn read_curve(
    source: &Source<'_>,
    at: &str,
    sampler: &gltf_json::animation::Sampler,
    wide: usize,
) -> Result<Curve, SceneError> {
    let interpolation = match sampler.interpolation {
        Checked::Valid(Way::Step) => Interpolation::Step,
        Checked::Valid(Way::Linear) => Interpolation::Linear,
        Checked::Valid(Way::CubicSpline) => Interpolation::Cubic,
        Checked::Invalid => return Err(source.malformed(at, "its interpolation is not STEP, LINEAR or CUBICSPLINE")),
    };
    let accessor = source.root.accessors.get(sampler.input.value());
    if wide == 0 || accessor.is_some_and(|accessor| accessor.count.0 == 0) {
        return Err(source.malformed(at, "it has no keys, or nothing that they change"));
    }
    let times = floats::<1>(source, sampler.input.value(), &format!("{at} input"))?;
    let times_s: Vec<f64> = times.into_iter().map(|[time]| f64::from(time)).collect();
    if let Some(key) = times_s.iter().position(|time| !time.is_finite()) {
        return Err(source.malformed(at, format!("the time of key {key} is {}, not a finite number", times_s[key])));
    }
    if let Some(key) = times_s.windows(2).position(|pair| pair[1] <= pair[0]) {
        let reason = format!("key {} is at {} s, not after key {key} at {} s", key + 1, times_s[key + 1], times_s[key]);
        return Err(source.malformed(at, reason));
    }
    let (accessor, user) = (sampler.output.value(), format!("{at} output"));
    let values: Vec<f32> = match width(source, accessor) {
        Some(3) => floats::<3>(source, accessor, &user)?.into_iter().flatten().collect(),
        Some(4) => floats::<4>(source, accessor, &user)?.into_iter().flatten().collect(),
        _ => floats::<1>(source, accessor, &user)?.into_iter().flatten().collect(),
    };
    let needed = times_s.len() * Curve::parts(interpolation) * wide;
    if values.len() != needed {
        let reason = format!("its output has {} numbers, and its {} keys need {needed}", values.len(), times_s.len());
        return Err(source.malformed(at, reason));
    }
    if let Some(place) = values.iter().position(|value| !value.is_finite()) {
        return Err(source.malformed(at, format!("number {place} of its output is {}, not finite", values[place])));
    }
    Ok(Curve { times_s, width: wide, values: values.into_iter().map(f64::from).collect(), interpolation })
}
