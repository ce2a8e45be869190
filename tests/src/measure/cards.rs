//! A wall of cards, rendered through the standard frame: a card for each material and angle of view.
//!
//! Cards face a parallel camera, but their vertex normals lean away from it, so each is shaded at one angle exactly, and
//! the pixel in its middle is one evaluation of the color pass.

use framegraph::{Extent, Format, Options, Plan, Scratch, Target, TextureDesc, compile};
use framegraph_passes::ibl::cache::Cache;
use framegraph_passes::ibl::{DfgSettings, IblSettings};
use framegraph_passes::shading::LightSettings;
use framegraph_passes::view::{Background, ViewSettings};
use framegraph_passes::{CameraView, Lighting, PostSettings, Settings, Shading, World, standard};
use framegraph_scene::{Aabb, Camera, Environment, Light, Material, Mesh, Projection, Scene, progress};
use framegraph_shaders::layout::ToneMap;
use framegraph_wgpu::Frame;
use framegraph_wgpu::{Executor, Gpu, Imports, read_texture};
use glam::{DMat4, DVec3, Vec2, Vec3, Vec4};
use std::error::Error;

/// A surface and how it is seen.
#[derive(Clone, Debug)]
pub struct Card {
    /// The surface.
    pub material: Material,
    /// n·v, above 0: the normal leans toward +x.
    pub nov: f64,
}

/// What a card looks like.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seen {
    /// Radiance in nits.
    pub nits: DVec3,
    /// Display codes: linear tone curve, no dither.
    pub code: [u8; 3],
}

/// Cards in a row of the wall.
const COLUMNS: usize = 20;
/// Pixels along a side of a card.
const SIDE_PX: u32 = 3;

/// The scene: its first textures may be used by materials.
#[derive(Clone, Debug, Default)]
pub struct Wall {
    /// Textures that the cards' materials name; nothing else.
    pub scene: Scene,
    /// The cards.
    pub cards: Vec<Card>,
    /// What lights them directly.
    pub light: Option<Light>,
}

impl Wall {
    /// Renders the wall under `environment`; the cards in their order, and last what is seen beside them, which is the
    /// environment. One nit is shown as 0.5.
    ///
    /// # Errors
    /// What the device refuses.
    pub fn render(&self, gpu: &Gpu, environment: &Environment, shading: &Shading) -> Result<Vec<Seen>, Box<dyn Error>> {
        let settings = LightSettings {
            image: IblSettings { cube_texels: 64, bands: shading.bands, ..IblSettings::default() },
            dfg: DfgSettings { texels: 64, visibility: shading.table },
        };
        let lighting = Lighting::new(gpu, environment, &settings, &Cache::off(), &mut progress::silent)?;
        let scene = self.placed();
        let rows = self.cards.len() / COLUMNS + 1;
        let size_px = [COLUMNS as u32 * SIDE_PX, rows as u32 * SIDE_PX];
        let (half_width, half_height_m) = (0.5 * COLUMNS as f64, 0.5 * rows as f64);
        let camera = Camera::look_at(
            DVec3::new(half_width, -half_height_m, 5.0),
            DVec3::new(half_width, -half_height_m, 0.0),
            DVec3::Y,
            Projection::Orthographic { half_width_m: Some(half_width), half_height_m, near_m: 1.0, far_m: 10.0 },
        )?;
        // 1 / (1.2 · 2^EV) is one half.
        let ev100 = (2.0_f32 / 1.2).log2();
        let moment = ViewSettings { camera, size_px, ev100, environment_intensity: 1.0, shadows: None };
        let view = CameraView::new(&scene, &lighting.image, &Background::Environment, &moment);
        let world = World::new(gpu, &scene, lighting, [view], &mut progress::silent)?;
        let post = PostSettings { tone_map: ToneMap::Linear, dither: 0.0, ..PostSettings::DEFAULT };
        let settings = Settings { shading: *shading, shadows: None, fxaa: false, post, ..Settings::default() };
        let mut frame = Frame::new();
        let output = frame.graph_mut().texture("output", TextureDesc::new(Extent::FRAME, Format::Rgba8UnormSrgb));
        let io = standard(&mut frame, &settings, Target::from(output))?;
        frame.graph_mut().readback(io.output);
        frame.graph_mut().readback(io.hdr);
        let mut plan = Plan::new();
        let options = Options::for_frame(size_px[0], size_px[1]);
        compile(frame.graph(), &gpu.caps(), &options, &mut Scratch::new(), &mut plan)?;
        let mut executor = Executor::new(gpu);
        executor.execute(&plan, &frame, &world, &Imports::new())?;
        let texture = |handle| executor.texture(&plan, handle).ok_or("the frame left no picture");
        let codes = read_texture(gpu, texture(io.output)?)?.rgba8();
        let linear = read_texture(gpu, texture(io.hdr)?)?.rgba();
        let at = |index: usize| {
            let (column, row) = ((index % COLUMNS) as u32, (index / COLUMNS) as u32);
            ((row * SIDE_PX + SIDE_PX / 2) * size_px[0] + column * SIDE_PX + SIDE_PX / 2) as usize
        };
        let seen = |index: usize| {
            let pixel = at(index);
            let [r, g, b, _] = linear[pixel];
            let nits = Vec3::new(r, g, b).as_dvec3() / 0.5;
            Seen { nits, code: [0, 1, 2].map(|c| codes[4 * pixel + c]) }
        };
        Ok((0..=self.cards.len()).map(seen).collect())
    }

    fn placed(&self) -> Scene {
        let mut scene = self.scene.clone();
        for (index, Card { material, nov }) in self.cards.iter().enumerate() {
            let mesh = scene.add_mesh(leaning(*nov));
            let material = scene.add_material(material.clone());
            let (column, row) = ((index % COLUMNS) as f64, (index / COLUMNS) as f64);
            scene.add_instance(
                "card",
                mesh,
                material,
                DMat4::from_translation(DVec3::new(column + 0.5, -row - 0.5, 0.0)),
            );
        }
        scene.lights.extend(self.light.clone());
        scene
    }
}

/// A unit square across the view, shaded as if it leaned toward +x.
fn leaning(nov: f64) -> Mesh {
    let (cos, sin) = (nov as f32, (1.0 - nov * nov).max(0.0).sqrt() as f32);
    let corners = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)];
    let positions: Vec<Vec3> = corners.iter().map(|(x, y)| Vec3::new(*x, *y, 0.0)).collect();
    Mesh {
        name: "card".into(),
        bounds: Aabb::from_points(&positions),
        positions,
        normals: vec![Vec3::new(sin, 0.0, cos); 4],
        tangents: vec![Vec4::new(cos, 0.0, -sin, 1.0); 4],
        uv0: vec![Vec2::splat(0.5); 4],
        indices: vec![0, 1, 2, 0, 2, 3],
        ..Mesh::default()
    }
}
