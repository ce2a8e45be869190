//! Motion of a scene: a hierarchy of nodes, animations, and bodies (glTF 2.0, sections 3.5, 3.7.3 and 3.11).
//!
//! Animations change nodes, and by KHR_animation_pointer materials, lights and cameras. The vertices of bodies follow joints
//! and morph targets.
//!
//! ```text
//! Animation ─ sample ─> nodes' transforms and weights ─ pose ─> Instance::world_from_model
//!                                                      └ body ─> Mesh::positions, normals, tangents
//! ```
//!
//! All of it is computed in f64, as everything between file and device is.

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

/// What moves. A scene from code has none of it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Motion {
    /// Nodes, parents before their children.
    pub nodes: Vec<Node>,
    /// The node that each instance hangs on, in the order of the scene's instances; empty for a scene without nodes.
    pub instance_nodes: Vec<usize>,
    /// Transform of each instance to its node's axes: the identity, or a place of EXT_mesh_gpu_instancing. One for each
    /// of `instance_nodes`.
    pub node_from_model: Vec<DMat4>,
    /// Joints that bodies follow.
    pub skins: Vec<Skin>,
    /// Meshes whose vertices move.
    pub bodies: Vec<Body>,
    /// What moves them, in the order of the file.
    pub animations: Vec<Animation>,
    /// Lights, cameras and materials at rest.
    pub rest: Rest,
}

/// Lights, cameras and materials while nothing moves them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Rest {
    /// Lights that hang on nodes, each with its node; [`Light::rest`] is a place in this list.
    pub lights: Vec<(usize, Light)>,
    /// Cameras that hang on nodes, each with its node: the first cameras of the scene, in their order.
    pub cameras: Vec<(usize, Camera)>,
    /// Materials that animations change.
    pub materials: Vec<(MaterialId, Material)>,
}

/// A node of the hierarchy.
#[derive(Clone, Debug, PartialEq)]
pub struct Node {
    /// Its parent, before it in the list.
    pub parent: Option<usize>,
    /// Its transform to its parent's axes while nothing moves it.
    pub rest: Transform,
    /// Weights of the morph targets of its mesh while nothing moves them.
    pub weights: Vec<f64>,
}

/// A node's own transform.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Transform {
    /// As a matrix, which animations do not change.
    Matrix(DMat4),
    /// As what animations change.
    Parts {
        /// In meters.
        translation: DVec3,
        /// Of unit length.
        rotation: DQuat,
        /// By axis.
        scale: DVec3,
    },
}

impl Transform {
    /// The transform to the parent's axes.
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

/// A movement of nodes over time.
#[derive(Clone, Debug, PartialEq)]
pub struct Animation {
    /// By which users choose it; may be empty.
    pub name: String,
    /// What changes what.
    pub channels: Vec<Channel>,
}

/// The values of one property over time.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// The property.
    pub target: Target,
    /// Its values over time.
    pub curve: Curve,
}

impl Animation {
    /// When its last channel ends, in seconds.
    #[must_use]
    pub fn duration_s(&self) -> f64 {
        self.channels.iter().map(|channel| channel.curve.end_s()).fold(0.0, f64::max)
    }
}
