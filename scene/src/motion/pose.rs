//! Posing a scene at an animation time.

use std::collections::BTreeMap;

use super::{Motion, NodeProperty, Target, Transform};
use crate::bounds::{Aabb, MAX_COORDINATE_M};
use crate::camera::Camera;
use crate::error::one_line;
use crate::light::{Light, LightKind};
use crate::scene::Scene;
use glam::{DMat4, DVec3};

/// Error of posing a scene.
#[derive(Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PoseError {
    /// The scene has no animation with this number.
    #[error("animation {animation}: there are {count}; choose one of them")]
    NoAnimation {
        /// Requested number.
        animation: usize,
        /// Number of animations.
        count: usize,
    },
    /// A computed value is infinite or NaN.
    #[error("{animation}: at {time_s} s {what} is not finite; choose another time, or repair the file")]
    NotFinite {
        /// Name of the animation.
        animation: String,
        /// Time in seconds.
        time_s: f64,
        /// Object with the value.
        what: String,
    },
    /// An instance is moved beyond [`MAX_COORDINATE_M`].
    #[error(
        "{animation}: at {time_s} s instance {instance:?} is more than {MAX_COORDINATE_M:e} m from the origin; choose another time, or repair the file"
    )]
    TooFar {
        /// Name of the animation.
        animation: String,
        /// Time in seconds.
        time_s: f64,
        /// Name of the instance.
        instance: String,
    },
}

impl std::fmt::Debug for PoseError {
    /// Prints the message, which `unwrap` shows.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}

impl Motion {
    /// Returns the world transforms and weights of all nodes at a time of an animation, by its number, or at rest
    /// without one.
    #[must_use]
    pub fn nodes_at(&self, animation: Option<usize>, time_s: f64) -> (Vec<DMat4>, Vec<Vec<f64>>) {
        let mut own: Vec<Transform> = self.nodes.iter().map(|node| node.rest).collect();
        let mut weights: Vec<Vec<f64>> = self.nodes.iter().map(|node| node.weights.clone()).collect();
        let found = animation.and_then(|number| self.animations.get(number));
        for channel in found.map_or(&[][..], |found| &found.channels) {
            let Target::Node(node, property) = channel.target else { continue };
            if property == NodeProperty::Weights {
                weights[node] = channel.curve.at(time_s);
            }
            // A node with a matrix must not be animated (section 3.11); such channels are ignored.
            let Transform::Parts { translation, rotation, scale } = &mut own[node] else { continue };
            match property {
                NodeProperty::Translation => *translation = DVec3::from_slice(&channel.curve.at(time_s)),
                NodeProperty::Scale => *scale = DVec3::from_slice(&channel.curve.at(time_s)),
                NodeProperty::Rotation => *rotation = channel.curve.rotation_at(time_s),
                NodeProperty::Weights => {}
            }
        }
        let mut world: Vec<DMat4> = Vec::with_capacity(own.len());
        for (node, transform) in self.nodes.iter().zip(&own) {
            let parent = node.parent.map_or(DMat4::IDENTITY, |parent| world[parent]);
            world.push(parent * transform.matrix());
        }
        (world, weights)
    }
}

impl Scene {
    /// Poses the scene at a time, in seconds, of one of its animations, or at rest without one. This updates instances,
    /// vertices of bodies, lights, cameras and animated materials. Times before the first and after the last keyframe
    /// are clamped.
    ///
    /// # Errors
    /// Fails if the animation does not exist, or if an object is moved too far; the scene may then be partly posed.
    pub fn pose(&mut self, animation: Option<usize>, time_s: f64) -> Result<(), PoseError> {
        let count = self.motion.animations.len();
        if let Some(animation) = animation.filter(|number| *number >= count) {
            return Err(PoseError::NoAnimation { animation, count });
        }
        let (world, weights) = self.motion.nodes_at(animation, time_s);
        let named = animation.map(|number| (number, one_line(&self.motion.animations[number].name)));
        let named = || named.as_ref().map_or("at rest".into(), |(number, name)| format!("animation {number} {name:?}"));
        let not_finite = |what: String| PoseError::NotFinite { animation: named(), time_s, what };
        if let Some(node) = world.iter().position(|matrix| !matrix.is_finite()) {
            return Err(not_finite(format!("the transform of the scene's node {node}")));
        }
        let places = self.motion.instance_nodes.iter().zip(&self.motion.node_from_model);
        let mut placed: Vec<DMat4> = places.map(|(node, node_from_model)| world[*node] * *node_from_model).collect();
        for body in &self.motion.bodies {
            let mesh = &mut self.meshes[body.mesh.index()];
            let mut joints = Vec::new();
            if let Some(skin) = body.skin.map(|skin| &self.motion.skins[skin]) {
                // Only joints position a body (section 3.7.3.3). Its vertices are relative to the first joint, which
                // preserves f32 precision far from the origin.
                let first = world[skin.joints[0]];
                let home = first.w_axis.truncate();
                // Mirroring joints mirror the instance, which flips the winding of its triangles (section 3.7.4).
                let is_mirrored = (first * skin.joint_from_mesh[0]).determinant() < 0.0;
                let side = DMat4::from_scale(DVec3::new(if is_mirrored { -1.0 } else { 1.0 }, 1.0, 1.0));
                let near = side * DMat4::from_translation(-home);
                let pairs = skin.joints.iter().zip(&skin.joint_from_mesh);
                joints = pairs.map(|(joint, joint_from_mesh)| near * world[*joint] * *joint_from_mesh).collect();
                placed[body.instance] = DMat4::from_translation(home) * side;
            }
            body.deform(&weights[body.node], &joints, mesh);
            if let Some(vertex) = mesh.positions.iter().position(|position| !position.is_finite()) {
                return Err(not_finite(format!("vertex {vertex} of mesh `{}`", one_line(&mesh.name))));
            }
            mesh.bounds = Aabb::from_points(&mesh.positions);
        }
        self.pose_attached(animation, time_s, &world);
        for (instance, world_from_model) in self.instances.iter_mut().zip(placed) {
            instance.world_from_model = world_from_model;
            instance.bounds = self.meshes[instance.mesh.index()].bounds.transformed(&world_from_model);
        }
        let reach = |bounds: &Aabb| bounds.min.abs().max(bounds.max.abs()).max_element();
        match self.instances.iter().find(|instance| reach(&instance.bounds) > MAX_COORDINATE_M) {
            Some(instance) => Err(PoseError::TooFar { animation: named(), time_s, instance: one_line(&instance.name) }),
            None => Ok(()),
        }
    }

    /// Poses lights, cameras and materials, with world transforms `world` of the nodes.
    fn pose_attached(&mut self, animation: Option<usize>, time_s: f64, world: &[DMat4]) {
        let Self { motion, lights, cameras, materials, .. } = self;
        let mut attached: BTreeMap<usize, &mut Light> = BTreeMap::new();
        for light in lights {
            let Some((place, (node, rest))) =
                light.rest.and_then(|place| Some((place, motion.rest.lights.get(place)?)))
            else {
                continue;
            };
            *light = rest.clone();
            light.direction = Light::direction_of_node(&world[*node]).unwrap_or(rest.direction);
            if !matches!(light.kind, LightKind::Directional { .. }) {
                light.position = world[*node].w_axis.truncate();
            }
            attached.insert(place, light);
        }
        for (camera, (node, rest)) in cameras.iter_mut().zip(&motion.rest.cameras) {
            *camera = Camera::of_node(&rest.name, &world[*node], rest.projection).unwrap_or_else(|| rest.clone());
        }
        for (material, rest) in &motion.rest.materials {
            materials[material.index()] = rest.clone();
        }
        let found = animation.and_then(|number| motion.animations.get(number));
        let channels = found.map_or(&[][..], |found| &found.channels);
        for channel in channels {
            if let Target::Material(material, property) = channel.target {
                property.write(&mut materials[material.index()], &channel.curve.at(time_s));
            }
        }
        // Applied twice: cone angles and clip planes are clamped by a related property, which may change later in the
        // list.
        for channel in channels.iter().chain(channels) {
            let value = || channel.curve.at(time_s);
            match channel.target {
                Target::Node(..) | Target::Material(..) => {}
                Target::Light(light, property) => {
                    attached.get_mut(&light).into_iter().for_each(|light| property.write(light, &value()));
                }
                Target::Camera(camera, property) => {
                    cameras.get_mut(camera).into_iter().for_each(|camera| property.write(camera, &value()));
                }
            }
        }
    }
}
