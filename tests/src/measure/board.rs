//! A board of small surfaces, rendered through the standard frame: the pixel in the middle of each is one evaluation of the
//! color pass at a place that is known.
//!
//! The board hangs across the view, in the plane z = 0 about its origin; the eye is five meters in front of it.

use crate::executors;
use crate::stage::light_cache;
use framegraph::{Extent, Format, Options, Plan, Scratch, Target, TextureDesc, compile};
use framegraph_passes::grading::Look;
use framegraph_passes::ibl::{DfgSettings, IblSettings};
use framegraph_passes::shading::LightSettings;
use framegraph_passes::shadow::ShadowSettings;
use framegraph_passes::view::{Background, ViewSettings};
use framegraph_passes::{CameraView, LightSearch, Lighting, PostSettings, Settings, Shading, World, standard};
use framegraph_scene::texture::{Image, Sampler, TextureRole, TextureSlot, UvTransform};
use framegraph_scene::{Aabb, Camera, Environment, Light, Material, Mesh, Projection, Scene, progress};
use framegraph_shaders::layout::ToneMap;
use framegraph_wgpu::{Frame, Gpu, Imports, read_texture};
use glam::{DMat4, DVec3, Vec2, Vec3, Vec4};
use std::error::Error;

/// What a surface of the board looks like.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seen {
    /// Radiance in nits.
    pub nits: DVec3,
    /// Display codes: linear tone curve, no dither.
    pub code: [u8; 3],
}

/// A mesh with a material, in its place on the board.
#[derive(Clone, Debug)]
pub struct Piece {
    /// The surface.
    pub material: Material,
    /// Its shape about the middle of its place, which is a square of one meter.
    pub mesh: Mesh,
    /// Turns, mirrors and scales the mesh about that middle.
    pub placed: DMat4,
}

/// How the eye sees the board.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Eye {
    /// Along -z everywhere.
    #[default]
    Parallel,
    /// From a point in front of the middle of the board.
    Perspective,
}

/// Pieces in a row of the board.
const COLUMNS: usize = 20;
/// Pixels along a side of a piece's place.
const SIDE_PX: u32 = 3;
/// From the eye to the board, in meters.
const DISTANCE_M: f64 = 5.0;
/// 1 / (1.2 · 2^EV): one nit is shown as a half.
pub const EXPOSURE: f64 = 0.5;

/// Surfaces side by side.
#[derive(Clone, Debug, Default)]
pub struct Board {
    /// Textures that the materials name, and lights; nothing else.
    pub scene: Scene,
    /// What hangs on the board, row by row.
    pub pieces: Vec<Piece>,
    /// How it is seen.
    pub eye: Eye,
    /// The upper left corner of the board in the world, in meters.
    pub origin: DVec3,
    /// How shadows are made; without it nothing casts.
    pub shadows: Option<ShadowSettings>,
}

impl Board {
    /// Adds a picture of `width` texels a row that materials may show in one role.
    pub fn texture(&mut self, width: u32, texels: &[[u8; 4]], role: TextureRole, sampler: Sampler) -> TextureSlot {
        let height = texels.len() as u32 / width;
        let image = Image::from_rgba8("card", width, height, texels.concat());
        let texture = self.scene.add_texture(image, role, sampler);
        TextureSlot { texture, uv_set: 0, transform: UvTransform::default() }
    }

    /// Adds a piece and says where its middle is, in the world.
    pub fn hang(&mut self, material: Material, mesh: Mesh, placed: DMat4) -> usize {
        self.pieces.push(Piece { material, mesh, placed });
        self.pieces.len() - 1
    }

    /// The middle of a piece's place, in the world.
    pub fn middle(&self, index: usize) -> DVec3 {
        let (column, row) = ((index % COLUMNS) as f64, (index / COLUMNS) as f64);
        self.origin + DVec3::new(column + 0.5, -row - 0.5, 0.0)
    }

    fn rows(&self) -> usize {
        self.pieces.len() / COLUMNS + 1
    }

    /// The unit vector from the middle of a piece's place toward the viewer.
    pub fn toward_viewer(&self, index: usize) -> DVec3 {
        match self.eye {
            Eye::Parallel => DVec3::Z,
            Eye::Perspective => (self.camera_m() - self.middle(index)).normalize(),
        }
    }

    /// The eye in the world.
    pub fn camera_m(&self) -> DVec3 {
        self.origin + DVec3::new(0.5 * COLUMNS as f64, -0.5 * self.rows() as f64, DISTANCE_M)
    }

    fn camera(&self) -> Result<Camera, Box<dyn Error>> {
        let (half_width, half_height_m) = (0.5 * COLUMNS as f64, 0.5 * self.rows() as f64);
        let projection = match self.eye {
            Eye::Parallel => {
                Projection::Orthographic { half_width_m: Some(half_width), half_height_m, near_m: 1.0, far_m: 10.0 }
            }
            Eye::Perspective => Projection::perspective(2.0 * (half_height_m / DISTANCE_M).atan(), 0.1),
        };
        let eye = self.camera_m();
        Ok(Camera::look_at(eye, eye - DVec3::Z, DVec3::Y, projection)?)
    }

    /// Renders the board under `environment`; the pieces in their order, and last what is seen beside them, which is the
    /// environment.
    ///
    /// # Errors
    /// What the device refuses.
    pub fn render(&self, gpu: &Gpu, environment: &Environment, shading: &Shading) -> Result<Vec<Seen>, Box<dyn Error>> {
        let settings = LightSettings {
            image: IblSettings { cube_texels: 64, bands: shading.bands, ..IblSettings::default() },
            dfg: DfgSettings { texels: 64, visibility: shading.table },
        };
        let lighting = Lighting::new(gpu, environment, &settings, &light_cache(), &mut progress::silent)?;
        self.render_lit(gpu, lighting, shading)
    }

    /// The same by light that was made before.
    ///
    /// # Errors
    /// What the device refuses.
    pub fn render_lit(&self, gpu: &Gpu, lighting: Lighting, shading: &Shading) -> Result<Vec<Seen>, Box<dyn Error>> {
        let (scene, size_px) = (self.placed(), self.size_px());
        let view = self.view(&lighting)?;
        let world = World::new(gpu, &scene, lighting, [view], &mut progress::silent)?;
        let post = PostSettings {
            look: Look { tone_map: ToneMap::Linear, ..Look::default() },
            dither: 0.0,
            ..PostSettings::DEFAULT
        };
        let settings = Settings { shading: *shading, shadows: self.shadows, fxaa: false, post, ..Settings::default() };
        let mut frame = Frame::new();
        let output = frame.graph_mut().texture("output", TextureDesc::new(Extent::FRAME, Format::Rgba8UnormSrgb));
        let io = standard(&mut frame, &settings.for_scene(&scene, size_px), Target::from(output))?;
        frame.graph_mut().readback(io.output)?;
        frame.graph_mut().readback(io.hdr)?;
        let mut plan = Plan::new();
        let options = Options::for_frame(size_px[0], size_px[1]);
        compile(frame.graph(), &gpu.caps(), &options, &mut Scratch::new(), &mut plan)?;
        let mut executor = executors::lend(gpu);
        executor.execute(&plan, &frame, &world, &Imports::new())?;
        let texture = |handle| executor.texture(&plan, handle).ok_or("the frame left no picture");
        let codes = read_texture(gpu, texture(io.output)?)?.rgba8();
        let linear = read_texture(gpu, texture(io.hdr)?)?.rgba();
        let seen = |index: usize| {
            let (column, row) = ((index % COLUMNS) as u32, (index / COLUMNS) as u32);
            let pixel = ((row * SIDE_PX + SIDE_PX / 2) * size_px[0] + column * SIDE_PX + SIDE_PX / 2) as usize;
            let [r, g, b, _] = linear[pixel];
            let nits = Vec3::new(r, g, b).as_dvec3() / EXPOSURE;
            Seen { nits, code: [0, 1, 2].map(|c| codes[4 * pixel + c]) }
        };
        Ok((0..=self.pieces.len()).map(seen).collect())
    }

    fn size_px(&self) -> [u32; 2] {
        [COLUMNS as u32 * SIDE_PX, self.rows() as u32 * SIDE_PX]
    }

    /// What the board is rendered with: positions in it are relative to the eye.
    ///
    /// # Errors
    /// When the board is too large for a camera.
    pub fn view(&self, lighting: &Lighting) -> Result<CameraView, Box<dyn Error>> {
        let moment = ViewSettings {
            camera: self.camera()?,
            size_px: self.size_px(),
            ev100: (1.0 / (1.2 * EXPOSURE as f32)).log2(),
            environment_intensity: 1.0,
            shadows: self.shadows,
            lights: LightSearch::default(),
            lod_error_px: 0.0,
            visible_layers: 1,
        };
        Ok(CameraView::new(&self.placed(), &lighting.image, &Background::Environment, &moment))
    }

    fn placed(&self) -> Scene {
        let mut scene = self.scene.clone();
        for (index, Piece { material, mesh, placed }) in self.pieces.iter().enumerate() {
            let mesh = scene.add_mesh(mesh.clone());
            let material = scene.add_material(material.clone());
            scene.add_instance("piece", mesh, material, DMat4::from_translation(self.middle(index)) * *placed);
        }
        scene
    }
}

/// A square of `side_m` across the view, shaded as if it had another normal; its texture coordinates are those of one point.
pub fn card(side_m: f32, normal: DVec3, tangent: DVec3, handedness: f32) -> Mesh {
    let half = 0.5 * side_m;
    let corners = [(-half, -half), (half, -half), (half, half), (-half, half)];
    let positions: Vec<Vec3> = corners.iter().map(|(x, y)| Vec3::new(*x, *y, 0.0)).collect();
    Mesh {
        name: "card".into(),
        bounds: Aabb::from_points(&positions),
        positions,
        normals: vec![normal.as_vec3(); 4],
        tangents: vec![Vec4::from((tangent.as_vec3(), handedness)); 4],
        uv0: vec![Vec2::splat(0.5); 4],
        indices: vec![0, 1, 2, 0, 2, 3],
        ..Mesh::default()
    }
}

/// Three lamps of π lux, a red, a green and a blue one, the first of which comes from `toward[0]`: what a white surface
/// reflects of them tells three cosines apart.
pub fn lamps(toward: [DVec3; 3]) -> Vec<Light> {
    let lamp = |(i, toward): (usize, DVec3)| {
        let color = [Vec3::X, Vec3::Y, Vec3::Z][i];
        Light { color, ..Light::directional("lamp", -toward.as_vec3(), std::f32::consts::PI) }
    };
    toward.into_iter().enumerate().map(lamp).collect()
}
