//! Nodes, skins and animations.

use std::collections::{BTreeMap, BTreeSet};

use glam::{DMat4, DVec4};
use gltf_json::animation::{Interpolation as Way, Property as Path};
use gltf_json::validation::Checked;

use super::accessor::{floats, width as components};
use super::channel_pointer;
use super::document::NO_NODE;
use super::node::{Attached, FlatNode};
use super::pointer::{self, Pointed, Scale};
use super::source::{Source, Warnings, beyond};
use crate::error::{SceneError, one_line};
use crate::material::MaterialId;
use crate::motion::{
    Animation, Body, Channel, Curve, Interpolation, Motion, Moves, Node, NodeProperty, Rest, Shape, Skin, Target,
};
use crate::scene::Scene;

/// Nodes and transforms of the instances of a scene, in their order.
#[derive(Default)]
pub(super) struct Placed {
    /// Node of each instance, by list position.
    pub nodes: Vec<usize>,
    /// Transform of each instance relative to its node.
    pub node_from_model: Vec<DMat4>,
}

/// Instances, lights and cameras attached to nodes, and materials.
pub(super) struct Attachments {
    /// Nodes and transforms of instances.
    pub placed: Placed,
    /// Nodes of lights.
    pub lights: Vec<Attached>,
    /// Nodes of cameras.
    pub cameras: Vec<Attached>,
    /// Materials by file index.
    pub materials: BTreeMap<Option<usize>, MaterialId>,
}

/// Imports nodes, skins, deformable meshes and animations into [`Scene::motion`], and applies the rest pose.
///
/// A file without animations, skins and morph targets imports no motion.
pub(super) fn import(
    source: &Source<'_>,
    nodes: &[FlatNode],
    attached: Attachments,
    scene: &mut Scene,
    warnings: &mut Warnings,
) -> Result<(), SceneError> {
    let mut motion = Motion { nodes: nodes.iter().map(|node| rig_node(source, node)).collect(), ..Motion::default() };
    let mut places = vec![None; source.root.nodes.len()];
    nodes.iter().enumerate().for_each(|(place, node)| places[node.index] = Some(place));
    // Skins by file index; unused skins are not read.
    let mut skins = BTreeMap::new();
    for (instance, place) in attached.placed.nodes.iter().enumerate() {
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
    let indices = |all: &[Attached]| all.iter().map(|own| own.index).collect::<Vec<_>>();
    let (lights, cameras) = (indices(&attached.lights), indices(&attached.cameras));
    let parts = pointer::Parts {
        places: &places,
        lights: &lights,
        cameras: &cameras,
        material: &|index| attached.materials.get(&Some(index)).copied(),
        targets: &|place| motion.nodes[place].weights.len(),
    };
    let all = source.root.animations.iter().enumerate();
    let animations = all.map(|(number, animation)| read_animation(source, number, animation, &parts, warnings));
    motion.animations = animations.collect::<Result<_, _>>()?;
    if motion.animations.is_empty() && motion.bodies.is_empty() {
        return Ok(());
    }
    let lit = |(place, own): (usize, &Attached)| (own.node, scene.lights[place].clone());
    let seen = |(place, own): (usize, &Attached)| (own.node, scene.cameras[place].clone());
    let materials: BTreeSet<MaterialId> = motion
        .animations
        .iter()
        .flat_map(|animation| &animation.channels)
        .filter_map(|channel| if let Target::Material(id, _) = channel.target { Some(id) } else { None })
        .collect();
    motion.rest = Rest {
        lights: attached.lights.iter().enumerate().map(lit).collect(),
        cameras: attached.cameras.iter().enumerate().map(seen).collect(),
        materials: materials.into_iter().map(|id| (id, scene.materials[id.index()].clone())).collect(),
    };
    motion.instance_nodes = attached.placed.nodes;
    motion.node_from_model = attached.placed.node_from_model;
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
                    return Err(format!(
                        "vertex {vertex} of its mesh follows joint {joint}, but its skin has {joints}"
                    ));
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

/// Reads the skin of the node `at`.
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
        found.ok_or_else(|| source.malformed(&at, format!("its joint, node {index}, is not below a root node")))
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
    parts: &pointer::Parts<'_>,
    warnings: &mut Warnings,
) -> Result<Animation, SceneError> {
    let name = one_line(animation.name.as_deref().unwrap_or_default());
    let mut channels = Vec::new();
    for (index, channel) in animation.channels.iter().enumerate() {
        let at = format!("animation {number} channel {index}");
        let Some(Pointed { targets, width, scale }) =
            aim(source, (number, index), &at, &channel.target, parts, warnings)?
        else {
            continue;
        };
        let sampler = channel.sampler.value();
        let sampler = animation
            .samplers
            .get(sampler)
            .ok_or_else(|| source.malformed(&at, beyond("sampler", sampler, &animation.samplers)))?;
        match read_curve(source, &at, sampler, width)? {
            Ok(curve) => {
                let width = if matches!(scale, Scale::Spread(_)) { 3 } else { curve.width };
                let curve = Curve { values: scale.apply(curve.values), width, ..curve };
                channels.extend(targets.into_iter().map(|target| Channel { target, curve: curve.clone() }));
            }
            Err(reason) => warnings.push(format!("{at}: {reason}; the channel is left out")),
        }
    }
    channels.sort_by_key(|channel| match channel.target {
        Target::Material(_, property) => property.is_relative(),
        Target::Node(..) | Target::Light(..) | Target::Camera(..) => false,
    });
    Ok(Animation { name, channels })
}

/// Returns the property that a channel animates; `None` for an ignored channel.
fn aim(
    source: &Source<'_>,
    (animation, channel): (usize, usize),
    at: &str,
    target: &gltf_json::animation::Target,
    parts: &pointer::Parts<'_>,
    warnings: &mut Warnings,
) -> Result<Option<Pointed>, SceneError> {
    if let Some(pointer) = channel_pointer::of_channel(source.json, animation, channel) {
        let pointed = pointer::resolve(source, animation, pointer, parts);
        if pointed.is_none() {
            warnings.push(format!("{at}: the property {pointer:?} cannot be animated; the channel is left out"));
        }
        return Ok(pointed.filter(|pointed| !pointed.targets.is_empty()));
    }
    let node = target.node.value();
    // A channel without a node is ignored (section 5.5.1, "node").
    if node == NO_NODE as usize {
        return Ok(None);
    }
    let place = parts.places.get(node).ok_or_else(|| source.malformed(at, beyond("node", node, &source.root.nodes)))?;
    let Some(place) = *place else {
        warnings.push(format!("{at}: node {node} is not in the scene; the channel is left out"));
        return Ok(None);
    };
    let (property, width) = match target.path {
        Checked::Valid(Path::Translation) => (NodeProperty::Translation, 3),
        Checked::Valid(Path::Scale) => (NodeProperty::Scale, 3),
        Checked::Valid(Path::Rotation) => (NodeProperty::Rotation, 4),
        Checked::Valid(Path::MorphTargetWeights) => (NodeProperty::Weights, (parts.targets)(place)),
        Checked::Invalid => {
            warnings.push(format!("{at}: its path is unknown; the channel is left out"));
            return Ok(None);
        }
    };
    Ok(Some(Pointed { targets: vec![Target::Node(place, property)], width, scale: Scale::None }))
}

/// Reads the keyframes of a sampler. The inner error is the reason to skip a channel with unusable keyframes.
///
/// # Errors
///
/// Fails for accessors that do not exist or exceed their bytes.
fn read_curve(
    source: &Source<'_>,
    at: &str,
    sampler: &gltf_json::animation::Sampler,
    width: usize,
) -> Result<Result<Curve, String>, SceneError> {
    let interpolation = match sampler.interpolation {
        Checked::Valid(Way::Step) => Interpolation::Step,
        Checked::Valid(Way::Linear) => Interpolation::Linear,
        Checked::Valid(Way::CubicSpline) => Interpolation::Cubic,
        Checked::Invalid => return Ok(Err("its interpolation is not STEP, LINEAR or CUBICSPLINE".into())),
    };
    let accessor = source.root.accessors.get(sampler.input.value());
    if width == 0 || accessor.is_some_and(|accessor| accessor.count.0 == 0) {
        return Ok(Err("it has no keys, or nothing that they change".into()));
    }
    let times = floats::<1>(source, sampler.input.value(), &format!("{at} input"))?;
    let (accessor, user) = (sampler.output.value(), format!("{at} output"));
    let values: Vec<f32> = match components(source, accessor) {
        Some(2) => floats::<2>(source, accessor, &user)?.into_iter().flatten().collect(),
        Some(3) => floats::<3>(source, accessor, &user)?.into_iter().flatten().collect(),
        Some(4) => floats::<4>(source, accessor, &user)?.into_iter().flatten().collect(),
        _ => floats::<1>(source, accessor, &user)?.into_iter().flatten().collect(),
    };
    let times_s: Vec<f64> = times.into_iter().map(|[time]| f64::from(time)).collect();
    if let Some(key) = times_s.iter().position(|time| !time.is_finite()) {
        return Ok(Err(format!("the time of key {key} is {}, not a finite number", times_s[key])));
    }
    if let Some(key) = times_s.windows(2).position(|pair| pair[1] <= pair[0]) {
        let (earlier, later) = (times_s[key], times_s[key + 1]);
        return Ok(Err(format!("key {} is at {later} s, not after key {key} at {earlier} s", key + 1)));
    }
    let needed = times_s.len() * Curve::parts(interpolation) * width;
    if values.len() != needed {
        return Ok(Err(format!(
            "its output has {} numbers, and its {} keys need {needed}",
            values.len(),
            times_s.len()
        )));
    }
    if let Some(place) = values.iter().position(|value| !value.is_finite()) {
        return Ok(Err(format!("number {place} of its output is {}, not finite", values[place])));
    }
    Ok(Ok(Curve { times_s, width, values: values.into_iter().map(f64::from).collect(), interpolation }))
}
