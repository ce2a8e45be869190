//! A board of small surfaces, rendered by the standard frame. The center pixel of each surface evaluates the color pass
//! at a known position.
//!
//! The board is perpendicular to the view, in the plane z = 0 of its origin; the eye is 5 m in front of it.

use crate::executors;
use crate::stage::light_cache;
use framegraph::{Extent, Format, Options, Plan, Scratch, Target, TextureDesc, compile};
use framegraph_passes::gpu_scene::shadow_views::ShadowSettings;
use framegraph_passes::gpu_scene::view::{Background, ViewSettings};
use framegraph_passes::grading::Look;
use framegraph_passes::light::ibl::{DfgSettings, IblSettings};
use framegraph_passes::light::shading::LightSettings;
use framegraph_passes::{CameraView, Lighting, PostSettings, Settings, Shading, World, standard};
use framegraph_scene::texture::{Image, Sampler, TextureRole, TextureSlot, UvTransform};
use framegraph_scene::{Aabb, Camera, Environment, Light, Material, Mesh, Projection, Scene, progress};
use framegraph_shaders::layout::ToneMap;
use framegraph_wgpu::{Frame, Gpu, Imports, read_texture};
use glam::{DMat4, DVec3, Vec2, Vec3, Vec4};
use std::error::Error;

/// Rendered color of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seen {
    /// Radiance, in nits.
    pub nits: DVec3,
    /// Display color in 8 bits: linear tone curve, no dithering.
    pub code: [u8; 3],
}

/// A mesh with a material, in one cell of the board.
#[derive(Clone, Debug)]
pub struct Piece {
    /// Material of the surface.
    pub material: Material,
    /// Shape relative to the center of its cell, a square of 1 m.
    pub mesh: Mesh,
    /// Transform of the mesh about the center: rotation, mirroring and scale.
    pub placed: DMat4,
}

/// Projection of the board's camera.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Eye {
    /// Parallel, along -z.
    #[default]
    Parallel,
    /// Perspective, from a point in front of the board's center.
    Perspective,
}

/// Pieces per row.
const COLUMNS: usize = 20;
/// Width of a cell, in pixels.
const SIDE_PX: u32 = 3;
/// Distance from the eye to the board, in m.
const DISTANCE_M: f64 = 5.0;
/// 1 / (1.2 · 2^EV): one nit is displayed as 0.5.
pub const EXPOSURE: f64 = 0.5;

/// A grid of surfaces.
#[derive(Clone, Debug, Default)]
pub struct Board {
    /// Scene with the lights and the textures of the materials, and nothing else.
    pub scene: Scene,
    /// Pieces of the board, row by row.
    pub pieces: Vec<Piece>,
    /// Projection of the camera.
    pub eye: Eye,
    /// Upper left corner of the board in world space, in m.
    pub origin: DVec3,
    /// Shadow settings; without them, nothing casts shadows.
    pub shadows: Option<ShadowSettings>,
}

impl Board {
    /// Adds a texture with rows of `width` texels, for use in one role.
    pub fn texture(&mut self, width: u32, texels: &[[u8; 4]], role: TextureRole, sampler: Sampler) -> TextureSlot {
        let height = texels.len() as u32 / width;
        let image = Image::from_rgba8("card", width, height, texels.concat());
        let texture = self.scene.add_texture(image, role, sampler);
        TextureSlot { texture, uv_set: 0, transform: UvTransform::default() }
    }

    /// Adds a piece, and returns its index.
    pub fn hang(&mut self, material: Material, mesh: Mesh, placed: DMat4) -> usize {
        self.pieces.push(Piece { material, mesh, placed });
        self.pieces.len() - 1
    }

    /// Returns the center of a piece's cell in world space.
    pub fn middle(&self, index: usize) -> DVec3 {
        let (column, row) = ((index % COLUMNS) as f64, (index / COLUMNS) as f64);
        self.origin + DVec3::new(column + 0.5, -row - 0.5, 0.0)
    }

    fn rows(&self) -> usize {
        self.pieces.len() / COLUMNS + 1
    }

    /// Returns the unit vector from the center of a piece's cell toward the viewer.
    pub fn toward_viewer(&self, index: usize) -> DVec3 {
        match self.eye {
            Eye::Parallel => DVec3::Z,
            Eye::Perspective => (self.camera_m() - self.middle(index)).normalize(),
        }
    }

    /// Returns the position of the eye in world space, in m.
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

    /// Renders the board under `environment`. Returns the pieces in order, then the background, which is the
    /// environment.
    ///
    /// # Errors
    /// The device fails.
    pub fn render(&self, gpu: &Gpu, environment: &Environment, shading: &Shading) -> Result<Vec<Seen>, Box<dyn Error>> {
        let settings = LightSettings {
            image: IblSettings { cube_texels: 64, bands: shading.bands, ..IblSettings::default() },
            dfg: DfgSettings { texels: 64, visibility: shading.table },
        };
        let lighting = Lighting::new(gpu, environment, &settings, &light_cache(), &mut progress::silent)?;
        self.render_lit(gpu, lighting, shading)
    }

    /// Renders the board with precomputed light. Returns the pieces in order, then the background.
    ///
    /// # Errors
    /// The device fails.
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

    /// Returns the view of the board; its positions are relative to the eye.
    ///
    /// # Errors
    /// The board is too large for a camera.
    pub fn view(&self, lighting: &Lighting) -> Result<CameraView, Box<dyn Error>> {
        let moment = ViewSettings {
            camera: self.camera()?,
            size_px: self.size_px(),
            ev100: (1.0 / (1.2 * EXPOSURE as f32)).log2(),
            shadows: self.shadows,
            ..ViewSettings::default()
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

/// Creates a square with side `side_m` that faces the viewer, shaded with another normal. All of it has the same
/// texture coordinates.
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

/// Creates a red, a green and a blue light of π lux each, in directions `toward`. The color that a white surface
/// reflects separates their three cosines.
pub fn punctual_lights(toward: [DVec3; 3]) -> Vec<Light> {
    let lamp = |(i, toward): (usize, DVec3)| {
        let color = [Vec3::X, Vec3::Y, Vec3::Z][i];
        Light { color, ..Light::directional("lamp", -toward.as_vec3(), std::f32::consts::PI) }
    };
    toward.into_iter().enumerate().map(lamp).collect()
}
