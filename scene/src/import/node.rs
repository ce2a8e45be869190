//! The node hierarchy, flattened to world transforms.

use glam::{DMat4, DQuat, DVec3};
use gltf_json::scene::Node;

use super::limits::MAX_NODES;
use super::source::{Source, beyond};
use crate::error::{Quantity, SceneError, one_line};
use crate::motion::Transform;

/// A node with its place in the world and what hangs on it.
#[derive(Clone, Debug)]
pub(super) struct FlatNode {
    /// Its name, or empty.
    pub name: String,
    /// For messages: `node 3 "name"`.
    pub at: String,
    /// Its number in the file.
    pub index: usize,
    /// Its parent's place in the list of these.
    pub parent: Option<usize>,
    /// Its own transform.
    pub rest: Transform,
    /// Transform to world axes, in meters.
    pub world_from_node: DMat4,
    /// Index of its skin in the file, unchecked.
    pub skin: Option<usize>,
    /// Weights of its mesh's morph targets, if it has its own.
    pub weights: Option<Vec<f32>>,
    /// Index of its mesh in the file, unchecked.
    pub mesh: Option<usize>,
    /// Index of its camera in the file, unchecked.
    pub camera: Option<usize>,
    /// Index of its light in the file, unchecked.
    pub light: Option<usize>,
}

/// Walks the default scene, or the first, or all roots, parents before children. Transforms
/// accumulate in f64.
///
/// The hierarchy must be a forest (section 3.5.2): a node that is reached twice, by a cycle or from
/// two parents, is an error. The walk keeps its own stack, so depth is no danger.
pub(super) fn flatten(source: &Source<'_>) -> Result<Vec<FlatNode>, SceneError> {
    let nodes = &source.root.nodes;
    if nodes.len() > MAX_NODES {
        return Err(source.too_large(Quantity::Nodes, nodes.len() as u64, MAX_NODES as u64));
    }
    let mut reached = vec![false; nodes.len()];
    let mut flat: Vec<FlatNode> = Vec::new();
    let mut stack: Vec<(usize, Option<usize>)> = Vec::new();
    let push_all = |stack: &mut Vec<_>, children: Vec<usize>, parent: Option<usize>| {
        stack.extend(children.into_iter().rev().map(|child| (child, parent)));
    };
    push_all(&mut stack, roots(source)?, None);
    while let Some((index, parent)) = stack.pop() {
        let node = nodes.get(index).ok_or_else(|| source.malformed("node hierarchy", beyond("node", index, nodes)))?;
        let name = one_line(node.name.as_deref().unwrap_or_default());
        let at = if name.is_empty() { format!("node {index}") } else { format!("node {index} {name:?}") };
        if std::mem::replace(&mut reached[index], true) {
            return Err(source.malformed(&at, "it has two parents or is its own ancestor"));
        }
        let rest = own_transform(node).map_err(|reason| source.malformed(&at, reason))?;
        let world_from_parent = parent.map_or(DMat4::IDENTITY, |parent: usize| flat[parent].world_from_node);
        let world_from_node = world_from_parent * rest.matrix();
        if !world_from_node.is_finite() {
            return Err(source.malformed(&at, "its transform overflows"));
        }
        let children = node.children.as_deref().unwrap_or_default();
        let children = children.iter().map(|child| child.value()).collect();
        push_all(&mut stack, children, Some(flat.len()));
        let light = node.extensions.as_ref().and_then(|e| e.khr_lights_punctual.as_ref());
        flat.push(FlatNode {
            name,
            at,
            index,
            parent,
            rest,
            world_from_node,
            skin: node.skin.map(|i| i.value()),
            weights: node.weights.clone(),
            mesh: node.mesh.map(|i| i.value()),
            camera: node.camera.map(|i| i.value()),
            light: light.map(|l| l.light.value()),
        });
    }
    Ok(flat)
}

/// The nodes to start from.
fn roots(source: &Source<'_>) -> Result<Vec<usize>, SceneError> {
    let scenes = &source.root.scenes;
    if let Some(default) = source.root.scene
        && default.value() >= scenes.len()
    {
        let reason = beyond("scene", default.value(), scenes);
        return Err(source.malformed("default scene", reason));
    }
    let default = source.root.scene.map_or(0, |index| index.value());
    if let Some(scene) = scenes.get(default) {
        return Ok(scene.nodes.iter().map(|node| node.value()).collect());
    }
    let nodes = &source.root.nodes;
    let mut is_child = vec![false; nodes.len()];
    for child in nodes.iter().flat_map(|n| n.children.as_deref().unwrap_or_default()) {
        if let Some(flag) = is_child.get_mut(child.value()) {
            *flag = true;
        }
    }
    Ok((0..nodes.len()).filter(|i| !is_child[*i]).collect())
}

/// A node's own transform (section 3.5.3): a column-major matrix, or scale, rotation, translation.
fn own_transform(node: &Node) -> Result<Transform, String> {
    let transform = if let Some(matrix) = node.matrix {
        let mut matrix = DMat4::from_cols_array(&matrix.map(f64::from));
        let last = matrix.row(3);
        if (last - glam::DVec4::W).abs().max_element() > 1e-4 {
            return Err(format!("the last row of its matrix is {last}, not 0, 0, 0, 1"));
        }
        for column in 0..4 {
            matrix.col_mut(column).w = if column == 3 { 1.0 } else { 0.0 };
        }
        Transform::Matrix(matrix)
    } else {
        let vector = |v: Option<[f32; 3]>, default: DVec3| v.map_or(default, |v| DVec3::from_array(v.map(f64::from)));
        let rotation = node.rotation.map_or(DQuat::IDENTITY, |q| DQuat::from_array(q.0.map(f64::from)));
        let length = rotation.length();
        if !(length > 1e-6 && length.is_finite()) {
            return Err(format!("its rotation {rotation} has no length"));
        }
        Transform::Parts {
            translation: vector(node.translation, DVec3::ZERO),
            rotation: rotation / length,
            scale: vector(node.scale, DVec3::ONE),
        }
    };
    if transform.matrix().is_finite() { Ok(transform) } else { Err("its transform is not finite".into()) }
}
