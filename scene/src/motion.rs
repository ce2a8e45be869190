//! Motion of a scene: node hierarchy, animations, and deformable meshes (glTF 2.0, sections 3.5, 3.7.3 and 3.11).
//!
//! Animations change nodes, and with KHR_animation_pointer materials, lights and cameras. Joints and morph targets
//! deform the vertices of bodies.
//!
//! ```text
//! Animation ─ sample ─> nodes' transforms and weights ─ pose ─> Instance::world_from_model
//!                                                      └ body ─> Mesh::positions, normals, tangents
//! ```
//!
//! Computations are in f64.

mod body;
mod pose;
pub(crate) mod property;
mod sample;

pub use crate::moves::{InfluenceSet, MorphTarget, Moves};
pub use body::{Body, Shape, Skin};
pub use pose::PoseError;
pub use property::{CameraProperty, LightProperty, MaterialProperty, NodeProperty, Target, TransformPart};
pub use sample::{Curve, Interpolation};

use glam::{DMat4, DQuat, DVec3};

use crate::camera::Camera;
use crate::light::Light;
use crate::material::{Material, MaterialId};

/// Animations and the objects that they change. Empty for a scene built in code.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Motion {
    /// Nodes; parents precede their children.
    pub nodes: Vec<Node>,
    /// Node of each instance, in the order of the scene's instances; empty for a scene without nodes.
    pub instance_nodes: Vec<usize>,
    /// Transform of each instance relative to its node: the identity, or a transform of EXT_mesh_gpu_instancing.
    /// Parallel to `instance_nodes`.
    pub node_from_model: Vec<DMat4>,
    /// Skins of deformable meshes.
    pub skins: Vec<Skin>,
    /// Deformable meshes.
    pub bodies: Vec<Body>,
    /// Animations, in file order.
    pub animations: Vec<Animation>,
    /// Rest state of lights, cameras and materials.
    pub rest: Rest,
}

/// Rest state of lights, cameras and materials.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Rest {
    /// Lights attached to nodes, each with its node; [`Light::rest`] is an index into this list.
    pub lights: Vec<(usize, Light)>,
    /// Cameras attached to nodes, each with its node: the first cameras of the scene, in their order.
    pub cameras: Vec<(usize, Camera)>,
    /// Materials that animations change.
    pub materials: Vec<(MaterialId, Material)>,
}

/// Node of the hierarchy.
#[derive(Clone, Debug, PartialEq)]
pub struct Node {
    /// Index of the parent, which precedes the node.
    pub parent: Option<usize>,
    /// Local transform at rest.
    pub rest: Transform,
    /// Morph target weights of its mesh at rest.
    pub weights: Vec<f64>,
}

/// Local transform of a node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Transform {
    /// Matrix; cannot be animated.
    Matrix(DMat4),
    /// Translation, rotation and scale; can be animated.
    Parts {
        /// Translation in meters.
        translation: DVec3,
        /// Unit quaternion.
        rotation: DQuat,
        /// Scale per axis.
        scale: DVec3,
    },
}

impl Transform {
    /// Returns the transform to the parent's axes.
    #[must_use]
    pub fn matrix(&self) -> DMat4 {
        match *self {
            Self::Matrix(matrix) => matrix,
            Self::Parts { translation, rotation, scale } => {
                DMat4::from_scale_rotation_translation(scale, rotation, translation)
            }
        }
    }
}

/// Animation: changes of properties over time.
#[derive(Clone, Debug, PartialEq)]
pub struct Animation {
    /// Name for selection by users; may be empty.
    pub name: String,
    /// Animated properties and their curves.
    pub channels: Vec<Channel>,
}

/// Values of one property over time.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// Animated property.
    pub target: Target,
    /// Values over time.
    pub curve: Curve,
}

impl Animation {
    /// Returns the end of the last channel, in seconds.
    #[must_use]
    pub fn duration_s(&self) -> f64 {
        self.channels.iter().map(|channel| channel.curve.end_s()).fold(0.0, f64::max)
    }
}
