//! Node hierarchy, flattened to world transforms.

use glam::{DMat4, DQuat, DVec3};
use gltf_json::Value;
use gltf_json::scene::Node;

use super::limits::MAX_NODES;
use super::source::{Source, Warnings, beyond};
use crate::error::{Quantity, SceneError, one_line};
use crate::motion::Transform;

/// A node with its world transform and attached objects.
#[derive(Clone, Debug)]
pub(super) struct FlatNode {
    /// Name; may be empty.
    pub name: String,
    /// Place for messages: `node 3 "name"`.
    pub at: String,
    /// File index.
    pub index: usize,
    /// List position of the parent.
    pub parent: Option<usize>,
    /// Local transform.
    pub rest: Transform,
    /// Transform to world space, in meters.
    pub world_from_node: DMat4,
    /// True if the node and all its ancestors are visible (KHR_node_visibility).
    pub is_visible: bool,
    /// File index of the skin, unchecked.
    pub skin: Option<usize>,
    /// Weights of the morph targets, if the node sets them.
    pub weights: Option<Vec<f32>>,
    /// File index of the mesh, unchecked.
    pub mesh: Option<usize>,
    /// File index of the camera, unchecked.
    pub camera: Option<usize>,
    /// File index of the light, unchecked.
    pub light: Option<usize>,
}

/// A light or camera attached to a node.
#[derive(Clone, Copy, Debug)]
pub(super) struct Attached {
    /// List position of the node.
    pub node: usize,
    /// File index of the light or camera.
    pub index: usize,
}

/// Flattens the default scene, otherwise the first scene, otherwise all roots; parents precede children. Transforms are
/// accumulated in f64.
///
/// Joints outside of that scene follow with their trees; only their transforms are used.
///
/// The hierarchy must be a forest (section 3.5.2): a node that is reached twice, by a cycle or from two parents, is an
/// error. The traversal uses an explicit stack, so its depth is not limited.
pub(super) fn flatten(source: &Source<'_>, warnings: &mut Warnings) -> Result<Vec<FlatNode>, SceneError> {
    let nodes = &source.root.nodes;
    if nodes.len() > MAX_NODES {
        return Err(source.too_large(Quantity::Nodes, nodes.len() as u64, MAX_NODES as u64));
    }
    let mut walk = Walk { source, reached: vec![false; nodes.len()], flat: Vec::new() };
    let parents = parents(nodes);
    walk.walk(roots(source, &parents)?, true)?;
    let joints = source
        .root
        .skins
        .iter()
        .enumerate()
        .flat_map(|(skin, json)| json.joints.iter().map(move |joint| (skin, joint.value())));
    for (skin, joint) in joints {
        if walk.reached.get(joint) != Some(&false) {
            continue;
        }
        warnings.push(format!("skin {skin}: joints outside of the scene keep their place in their own hierarchy"));
        // Root of the joint, or any node of a cycle.
        let mut root = joint;
        let mut steps = 0;
        while let Some(parent) = parents[root].filter(|parent| !walk.reached[*parent] && steps < nodes.len()) {
            (root, steps) = (parent, steps + 1);
        }
        walk.walk(vec![root], false)?;
    }
    Ok(walk.flat)
}

/// Traversal of the hierarchy, with the nodes reached so far.
struct Walk<'a> {
    source: &'a Source<'a>,
    reached: Vec<bool>,
    flat: Vec<FlatNode>,
}

impl Walk<'_> {
    /// Appends the trees below `roots`. Nodes outside of the scene get no mesh, camera or light.
    fn walk(&mut self, roots: Vec<usize>, is_in_scene: bool) -> Result<(), SceneError> {
        let (source, nodes) = (self.source, &self.source.root.nodes);
        let mut stack: Vec<(usize, Option<usize>)> = Vec::new();
        let push_all = |stack: &mut Vec<_>, children: Vec<usize>, parent: Option<usize>| {
            stack.extend(children.into_iter().rev().map(|child| (child, parent)));
        };
        push_all(&mut stack, roots, None);
        while let Some((index, parent)) = stack.pop() {
            let node =
                nodes.get(index).ok_or_else(|| source.malformed("node hierarchy", beyond("node", index, nodes)))?;
            let name = one_line(node.name.as_deref().unwrap_or_default());
            let at = if name.is_empty() { format!("node {index}") } else { format!("node {index} {name:?}") };
            if std::mem::replace(&mut self.reached[index], true) {
                if !is_in_scene {
                    continue;
                }
                return Err(source.malformed(&at, "it has two parents or is its own ancestor"));
            }
            let rest = own_transform(node).map_err(|reason| source.malformed(&at, reason))?;
            let parent_node = parent.map(|parent: usize| &self.flat[parent]);
            let world_from_parent = parent_node.map_or(DMat4::IDENTITY, |parent| parent.world_from_node);
            let world_from_node = world_from_parent * rest.matrix();
            if !world_from_node.is_finite() {
                return Err(source.malformed(&at, "its transform overflows"));
            }
            let is_visible = parent_node.is_none_or(|parent| parent.is_visible) && is_visible(node);
            let children = node.children.as_deref().unwrap_or_default();
            let children = children.iter().map(|child| child.value()).collect();
            push_all(&mut stack, children, Some(self.flat.len()));
            let light = node.extensions.as_ref().and_then(|e| e.khr_lights_punctual.as_ref());
            self.flat.push(FlatNode {
                name,
                at,
                index,
                parent,
                rest,
                world_from_node,
                is_visible,
                skin: node.skin.map(|i| i.value()),
                weights: node.weights.clone(),
                mesh: node.mesh.map(|i| i.value()).filter(|_| is_in_scene && is_visible),
                camera: node.camera.map(|i| i.value()).filter(|_| is_in_scene),
                light: light.map(|l| l.light.value()).filter(|_| is_in_scene && is_visible),
            });
        }
        Ok(())
    }
}

/// Returns the node's own visibility (KHR_node_visibility), `true` by default.
fn is_visible(node: &Node) -> bool {
    let extension = node.extensions.as_ref().and_then(|e| e.others.get("KHR_node_visibility"));
    extension.and_then(|extension| extension.get("visible")).and_then(Value::as_bool).unwrap_or(true)
}

/// Returns the parent of each node; the first if there are two.
fn parents(nodes: &[Node]) -> Vec<Option<usize>> {
    let mut parents = vec![None; nodes.len()];
    for (parent, node) in nodes.iter().enumerate() {
        for child in node.children.as_deref().unwrap_or_default() {
            if let Some(slot) = parents.get_mut(child.value()) {
                slot.get_or_insert(parent);
            }
        }
    }
    parents
}

/// Returns the root nodes of the traversal.
fn roots(source: &Source<'_>, parents: &[Option<usize>]) -> Result<Vec<usize>, SceneError> {
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
    Ok((0..parents.len()).filter(|i| parents[*i].is_none()).collect())
}

/// Returns a node's local transform (section 3.5.3): a column-major matrix, or scale, rotation, translation.
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
