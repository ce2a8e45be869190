//! Scenes of many boxes, and cameras that see nearly all of them.

use framegraph_scene::geometry::cuboid;
use framegraph_scene::{Camera, Light, Material, MaterialId, MeshId, Projection, Scene};
use glam::{DMat4, DVec3, Vec3};

/// Contents of a benchmark scene.
#[derive(Clone, Copy)]
pub struct Workload {
    pub nodes: usize,
    pub meshes: usize,
    pub materials: usize,
    /// True if meshes and materials are combined at random, so that few nodes share both; otherwise each material has
    /// one mesh.
    pub mixed: bool,
    /// Nodes that turn in each frame.
    pub moving: Moving,
}

/// Nodes that move.
#[derive(Clone, Copy, PartialEq)]
pub enum Moving {
    None,
    /// The first quarter of the nodes.
    FirstQuarter,
    /// Every fourth node.
    EveryFourth,
}

impl Workload {
    /// Returns a scene of nodes that share mesh and material.
    pub const fn alike(nodes: usize) -> Self {
        Self { nodes, meshes: 1, materials: 1, mixed: false, moving: Moving::None }
    }

    pub fn name(&self) -> String {
        let Self { meshes, materials, mixed, .. } = self;
        let moving = match self.moving {
            Moving::None => "",
            Moving::FirstQuarter => ", the first quarter turns",
            Moving::EveryFourth => ", every fourth turns",
        };
        format!("{meshes} × {materials}{}{moving}", if *mixed { ", mixed" } else { "" })
    }

    /// Turns the moving nodes, and returns their numbers.
    pub fn turn(&self, scene: &mut Scene, frame: usize) -> Vec<usize> {
        let moved: Vec<usize> = match self.moving {
            Moving::None => Vec::new(),
            Moving::FirstQuarter => (0..self.nodes / 4).collect(),
            Moving::EveryFourth => (0..self.nodes).step_by(4).collect(),
        };
        for &number in &moved {
            let instance = &mut scene.instances[number];
            let turned = glam::DQuat::from_rotation_y((number + frame) as f64);
            let at = instance.world_from_model.w_axis.truncate();
            instance.world_from_model = DMat4::from_rotation_translation(turned, at);
            instance.bounds = scene.meshes[instance.mesh.index()].bounds.transformed(&instance.world_from_model);
        }
        moved
    }

    /// Returns boxes of different sizes and colors in a cube, and a sun.
    pub fn scene(&self) -> Scene {
        let mut scene = Scene { name: "boxes".into(), ..Scene::default() };
        for i in 0..self.meshes {
            scene.add_mesh(cuboid(Vec3::splat(0.1 + 0.2 * i as f32 / self.meshes as f32)));
        }
        for i in 0..self.materials {
            let hue = i as f32 / self.materials as f32;
            scene.add_material(Material::dielectric("box", Vec3::new(hue, 0.5, 1.0 - hue), 0.5));
        }
        let side = (self.nodes as f64).cbrt().ceil() as usize;
        let mut state = 1_u64;
        for i in 0..self.nodes {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let material = i % self.materials;
            let mesh = if self.mixed { (state >> 33) as usize } else { i } % self.meshes;
            let at = [i % side, i / side % side, i / (side * side)].map(|x| x as f64);
            let placed = DMat4::from_rotation_translation(glam::DQuat::from_rotation_y(i as f64), DVec3::from(at));
            scene.add_instance("", MeshId::new(mesh), MaterialId::new(material), placed);
        }
        scene.lights.push(Light::directional("sun", Vec3::new(-0.4, -0.8, -0.3).normalize(), 100_000.0));
        scene
    }

    /// Returns a camera in front of the cube that rotates with the frames; the whole cube is in view.
    pub fn camera(&self, frame: usize) -> Camera {
        let side = (self.nodes as f64).cbrt();
        let middle = DVec3::splat(0.5 * side);
        let around = DVec3::new((0.01 * frame as f64).sin(), 0.3, (0.01 * frame as f64).cos());
        let projection = Projection::perspective(1.0, 0.1);
        Camera::look_at(middle + around * 2.0 * side, middle, DVec3::Y, projection).expect("a camera off its target")
    }
}
