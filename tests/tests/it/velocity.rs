//! Velocity of moving objects: cost, accuracy, and effect on temporal anti-aliasing.

use crate::stage::{self, gpu, lighting};
use framegraph::{Caps, Counts, Options, Plan, Scratch, Target, Texture, compile};
use framegraph_passes::SettingsTable;
use framegraph_passes::gpu_scene::view::{Background, ViewSettings};
use framegraph_passes::stages::{Handles, Slot};
use framegraph_passes::{CameraView, Settings, Shading, TaaSettings, ViewId, World, stages};
use framegraph_scene::geometry::{plane, sphere};
use framegraph_scene::motion::{Body, Moves, Shape};
use framegraph_scene::texture::{Filter, Image, Sampler, TextureRole, TextureSlot, UvTransform};
use framegraph_scene::{Aabb, AlphaMode, Camera, Environment, Material, Mesh, MeshId, Projection, Scene, progress};
use framegraph_wgpu::{Executor, Frame, Gpu, Imports, read_texture};
use glam::{DMat4, DVec2, DVec3, Vec2, Vec3, Vec4};
use std::error::Error;

type TestResult = Result<(), Box<dyn Error>>;

const MOVING: Settings =
    Settings { taa: Some(TaaSettings::DEFAULT), moving: true, shadows: None, fxaa: false, ..Settings::DEFAULT };

/// Velocity shares the step of prepass and color pass: one more clear and store, no load and no step. With four
/// samples, each is cleared and discarded after the resolve, which is stored. A frame without moving objects has none
/// of it.
#[test]
fn velocity_costs_one_store() {
    let counts = |settings: Settings| stage::plan(&settings, &Caps::wgpu(), &Options::for_frame(1280, 720)).counts();
    for samples in [1, 4] {
        let still = counts(Settings { samples, moving: false, ..MOVING });
        let more = u32::from(samples > 1);
        let expected = Counts {
            resolves: still.resolves + 1,
            clears: still.clears + 1,
            discards: still.discards + more,
            multisample_resolves: still.multisample_resolves + more,
            memoryless: still.memoryless + more,
            passes: still.passes + 1,
            ..still
        };
        assert_eq!(counts(Settings { samples, ..MOVING }), expected, "{samples} samples");
    }
    let without = Settings { taa: None, ..MOVING };
    assert_eq!(counts(without), counts(Settings { moving: false, ..without }), "nothing reads it");
}

const RADIUS_M: f64 = 0.6;

/// Returns the positions of a ball over a floor and of the eye in a frame.
fn moment(frame: f64) -> (DVec3, DVec3) {
    (DVec3::new(-0.9 + 0.12 * frame, 0.7, 0.1 * frame), DVec3::new(0.02 * frame, 1.0, 4.0))
}

/// Returns the positions of a rising ball and of the eye in a frame.
fn rising(frame: f64) -> (DVec3, DVec3) {
    let (ball, eye) = moment(frame);
    (ball + DVec3::Y * (0.25 * frame), eye)
}

fn camera(eye: DVec3) -> Result<Camera, Box<dyn Error>> {
    Ok(Camera::look_at(eye, eye - DVec3::new(0.0, 0.1, 1.0), DVec3::Y, Projection::perspective(0.8, 0.1))?)
}

/// Consecutive frames of the moving ball.
struct Film<'g> {
    gpu: &'g Gpu,
    scene: Scene,
    world: Option<World>,
    frame: Frame<World>,
    executor: Executor,
    size_px: [u32; 2],
    /// Positions of the ball and the eye in a frame.
    path: fn(f64) -> (DVec3, DVec3),
}

impl<'g> Film<'g> {
    fn new(gpu: &'g Gpu, size_px: [u32; 2]) -> Self {
        let mut scene = Scene::default();
        let red = scene.add_material(Material::dielectric("red", Vec3::new(0.7, 0.1, 0.05), 1.0));
        let grey = scene.add_material(Material::dielectric("grey", Vec3::splat(0.3), 1.0));
        let ball = scene.add_mesh(sphere(RADIUS_M as f32, 128, 64));
        let floor = scene.add_mesh(plane(Vec2::splat(4.0), 1, Vec2::ONE));
        scene.add_instance("ball", ball, red, DMat4::IDENTITY);
        scene.add_instance("floor", floor, grey, DMat4::IDENTITY);
        Self { gpu, scene, world: None, frame: Frame::new(), executor: Executor::new(gpu), size_px, path: moment }
    }

    /// Moves the ball by its vertices, as skinning and morph targets do, instead of by its transform.
    fn by_vertices(mut self) -> Self {
        let Mesh { positions, normals, tangents, .. } = self.scene.meshes[0].clone();
        let rest = Shape { positions, normals, tangents };
        let body = Body { mesh: MeshId::new(0), instance: 0, node: 0, skin: None, rest, moves: Moves::default() };
        self.scene.motion.bodies.push(body);
        self
    }

    /// Adds a mask that keeps the ball whole: its texture has a hole only where the other set of coordinates points.
    /// Vertex colors affect only alpha.
    fn masked(mut self, uv_set: u32) -> Self {
        let sampler = Sampler { mag: Filter::Nearest, min: Filter::Nearest, mip: None, ..Sampler::default() };
        let texels = vec![255, 255, 255, 255, 255, 255, 255, 0];
        let image = Image::from_rgba8("hole", 2, 1, texels);
        let texture = self.scene.add_texture(image, TextureRole::Color, sampler);
        let slot = TextureSlot { texture, uv_set, transform: UvTransform::default() };
        let red = &mut self.scene.materials[0];
        (red.alpha, red.base_color_texture) = (AlphaMode::Mask { cutoff: 0.5 }, Some(slot));
        let ball = &mut self.scene.meshes[0];
        let count = ball.positions.len();
        let at = |set| vec![Vec2::new(if set == uv_set { 0.25 } else { 0.75 }, 0.5); count];
        (ball.uv0, ball.uv1, ball.colors) = (at(0), at(1), vec![Vec4::W; count]);
        self
    }

    /// Draws a frame. Returns the texture that `wanted` selects.
    fn shoot(
        &mut self,
        settings: Settings,
        number: u32,
        wanted: fn(&Handles) -> Option<Texture>,
    ) -> Result<Vec<[f32; 4]>, Box<dyn Error>> {
        let (at, eye) = (self.path)(number.into());
        let mut placed = DMat4::from_translation(at);
        if let Some(body) = self.scene.motion.bodies.first() {
            placed = DMat4::IDENTITY;
            let mesh = &mut self.scene.meshes[0];
            mesh.positions = body.rest.positions.iter().map(|place| *place + at.as_vec3()).collect();
            mesh.bounds = Aabb::from_points(&mesh.positions);
        }
        self.scene.instances[0].world_from_model = placed;
        self.scene.instances[0].bounds = self.scene.meshes[0].bounds.transformed(&placed);
        let seen = ViewSettings {
            camera: camera(eye)?,
            size_px: self.size_px,
            ev100: 0.0,
            shadows: None,
            ..ViewSettings::default()
        };
        let light = lighting(self.gpu, &Environment::uniform(DVec3::ONE)?, &settings.shading)?;
        let background = Background::Constant(Vec3::splat(0.02));
        let mut view = CameraView::new(&self.scene, &light.image, &background, &seen);
        match &mut self.world {
            Some(world) => {
                let before = world.views.get(ViewId::MAIN)?.view.clone();
                world.scene.repose(self.gpu, &self.scene)?;
                view = view.after(&before).deformed(&before, &self.scene);
                view.jitter(settings.taa.map_or(DVec2::ZERO, |taa| taa.jitter_px(number)));
                world.set_view(self.gpu, ViewId::MAIN, view)?;
            }
            none => *none = Some(World::new(self.gpu, &self.scene, light, [view], &mut progress::silent)?),
        }
        let world = self.world.as_ref().ok_or("it was made above")?;
        let frame = &mut self.frame;
        frame.reset();
        let handles = stages(&settings).declare(frame, Handles::default(), Target::New)?;
        let wanted = wanted(&handles).ok_or("there is no such texture")?;
        frame.graph_mut().readback(wanted)?;
        let mut plan = Plan::new();
        let options = Options::for_frame(self.size_px[0], self.size_px[1]);
        compile(frame.graph(), &self.gpu.caps(), &options, &mut Scratch::new(), &mut plan)?;
        self.executor.execute(&plan, frame, world, &Imports::new())?;
        Ok(read_texture(self.gpu, self.executor.texture(&plan, wanted).ok_or("there is no picture")?)?.rgba())
    }
}

/// Returns where a pixel's ray hits the ball of a frame, and the position of that point in the previous picture. Both
/// are in 0 to 1 from the top left.
fn truth(path: fn(f64) -> (DVec3, DVec3), frame: f64, uv: DVec2, aspect: f64) -> Result<Option<DVec2>, Box<dyn Error>> {
    let [(ball, _), (earlier_ball, _)] = [path(frame), path(frame - 1.0)];
    let clip = |frame: f64| -> Result<DMat4, Box<dyn Error>> {
        let camera = camera(path(frame).1)?;
        Ok(camera.clip_from_view(aspect) * camera.view_from_world())
    };
    let eye = path(frame).1;
    let ndc = DVec3::new(2.0 * uv.x - 1.0, 1.0 - 2.0 * uv.y, 0.5);
    let way = (clip(frame)?.inverse().project_point3(ndc) - eye).normalize();
    let (along, apart) = (way.dot(ball - eye), (ball - eye).length_squared());
    let inside = RADIUS_M * RADIUS_M - (apart - along * along);
    if inside <= 0.0 {
        return Ok(None);
    }
    let place = eye + (along - inside.sqrt()) * way;
    let before = clip(frame - 1.0)?.project_point3(place - ball + earlier_ball);
    Ok(Some(DVec2::new(0.5 + 0.5 * before.x, 0.5 - 0.5 * before.y)))
}

/// Velocity is the motion of each point on the ball, including the camera's, and zero elsewhere. Tested for motion by
/// transform and by vertices.
#[test]
fn velocity_says_where_surfaces_were() -> TestResult {
    let Some(gpu) = gpu("velocity_says_where_surfaces_were") else { return Ok(()) };
    // With one sample, the result is that of the pixel's center; with four, that of a sample beside it.
    type Case = (u8, bool, fn(f64) -> (DVec3, DVec3), f64);
    let cases: [Case; 6] = [
        (1, false, moment, 0.03),
        (4, false, moment, 0.1),
        (1, true, moment, 0.03),
        (4, true, moment, 0.1),
        (1, false, rising, 0.03),
        (1, true, rising, 0.03),
    ];
    for (samples, vertices, path, most) in cases {
        let size = [96_u32, 64];
        let film = Film { path, ..Film::new(&gpu, size) };
        let mut film = if vertices { film.by_vertices() } else { film };
        let frame = Settings { samples, ..MOVING };
        let first = film.shoot(frame, 0, |handles| handles.find(Slot::VELOCITY))?;
        assert!(first.iter().all(|texel| *texel == [0.0; 4]), "no frame was before");
        // Also the third frame, which reuses the vertices of the second one.
        for number in 1..=if samples == 1 { 2 } else { 1 } {
            let found = film.shoot(frame, number, |handles| handles.find(Slot::VELOCITY))?;
            let (mut on, mut worst) = (0, 0.0_f64);
            for (i, texel) in found.iter().enumerate() {
                let uv = DVec2::new(f64::from(i as u32 % size[0]) + 0.5, f64::from(i as u32 / size[0]) + 0.5)
                    / DVec2::new(size[0].into(), size[1].into());
                // The jitter shifts the picture, so uv shows a neighboring point.
                let jitter = TaaSettings::DEFAULT.jitter_px(number) / DVec2::new(size[0].into(), size[1].into());
                let seen = uv - DVec2::new(jitter.x, -jitter.y);
                let Some(before) = truth(path, number.into(), seen, 1.5)? else { continue };
                if texel[3] == 1.0 {
                    let way = DVec2::new(texel[0].into(), texel[1].into());
                    // Near the outline, the mesh's facets deviate more than in the center.
                    on += 1;
                    worst = worst.max((way - (before - seen)).length() * f64::from(size[0]));
                }
            }
            assert!(on > 300, "{samples} samples: the ball is seen in {on} pixels");
            assert!(worst < most, "{samples} samples: off by {worst} pixels");
            let floor = found[(size[0] * (size[1] - 1)) as usize];
            assert_eq!(floor, [0.0; 4], "the floor stands still");
        }
    }
    Ok(())
}

/// Masked surfaces have the same velocity as opaque ones, bit for bit, with either set of coordinates.
#[test]
fn what_a_mask_keeps_moves_as_a_whole() -> TestResult {
    let Some(gpu) = gpu("what_a_mask_keeps_moves_as_a_whole") else { return Ok(()) };
    let told = |mut film: Film<'_>| -> Result<_, Box<dyn Error>> {
        film.shoot(MOVING, 0, |handles| handles.find(Slot::VELOCITY))?;
        film.shoot(MOVING, 1, |handles| handles.find(Slot::VELOCITY))
    };
    let size = [48, 32];
    let whole = told(Film::new(&gpu, size))?;
    assert!(whole.iter().filter(|texel| texel[3] == 1.0).count() > 70, "the ball is seen");
    for uv_set in [0, 1] {
        assert!(told(Film::new(&gpu, size).masked(uv_set))? == whole, "set {uv_set}");
    }
    Ok(())
}

/// A ball that moves with the eye accumulates as if both stood still: its velocity points to the same pixel of the
/// history.
#[test]
fn motion_with_the_eye_accumulates_like_no_motion() -> TestResult {
    let Some(gpu) = gpu("motion_with_the_eye_accumulates_like_no_motion") else { return Ok(()) };
    const SIZE: [u32; 2] = [72, 48];
    let summed = |path| -> Result<_, Box<dyn Error>> {
        let mut film = Film { path, ..Film::new(&gpu, SIZE) };
        // Bands of seven pixels, so that a shifted history is visible.
        let ball = &mut film.scene.meshes[0];
        let band = |at: &Vec3| Vec3::splat(0.5 + 0.45 * (12.0 * (at.x + at.y)).sin()).extend(1.0);
        ball.colors = ball.positions.iter().map(band).collect();
        let mut sum = Vec::new();
        for frame in 0..12 {
            sum = film.shoot(MOVING, frame, |handles| handles.find(Slot::HDR))?;
        }
        Ok(sum)
    };
    const BALL: DVec3 = DVec3::new(0.0, 1.0, 0.0);
    const EYE: DVec3 = DVec3::new(0.0, 1.0, 4.0);
    let still = summed(|_| (BALL, EYE))?;
    let moved = summed(|frame| (BALL + DVec3::new(0.3, 0.1, 0.0) * frame, EYE + DVec3::new(0.3, 0.1, 0.0) * frame))?;
    // Pixels well inside the outline, which is in front of a moving floor.
    let middle = |at: usize| {
        let [x, y] = [at as u32 % SIZE[0], at as u32 / SIZE[0]].map(f64::from);
        (x + 0.5 - 36.0).hypot(y + 0.5 - 19.0) < 5.0
    };
    let both: Vec<_> = (0..still.len()).filter(|at| middle(*at)).map(|at| (still[at][0], moved[at][0])).collect();
    let least = both.iter().map(|(still, _)| *still).fold(f32::INFINITY, f32::min);
    let most = both.iter().map(|(still, _)| *still).fold(0.0, f32::max);
    let apart = both.iter().map(|(still, moved)| (still - moved).abs()).fold(0.0, f32::max);
    assert!(most > 2.0 * least, "bands from {least} to {most}");
    assert!(apart < 2e-3 * most, "{apart} apart, of {most}");
    Ok(())
}

/// If ball and eye move, the accumulated picture with velocity is closer to 64 samples per pixel than a single frame.
/// It is about twice as close as without velocity.
#[test]
fn sums_follow_what_moves() -> TestResult {
    let Some(gpu) = gpu("sums_follow_what_moves") else { return Ok(()) };
    let shading = Shading { specular_aa: None, ..MOVING.shading };
    let taa = TaaSettings::from_text("on:filter-input=off")?;
    let moving = Settings { taa, shading, ..MOVING };
    let ([width, height], n, last) = ([72_u32, 48_u32], 8, 15);
    let hdr = |handles: &Handles| handles.find(Slot::HDR);
    let alone = Settings { taa: None, moving: false, ..moving };
    let fine = Film::new(&gpu, [width * n, height * n]).shoot(alone, last, hdr)?;
    // Accumulation compresses bright colors, regardless of motion, so the reference does too.
    let held = |texel: &[f32; 4]| {
        let [r, g, b] = [0, 1, 2].map(|c| f64::from(texel[c]));
        [r, g, b].map(|light| light / (1.0 + r.max(g).max(b)))
    };
    let mut truth = vec![[0.0_f64; 3]; (width * height) as usize];
    for (i, texel) in fine.iter().enumerate() {
        let (x, y) = (i as u32 % (width * n), i as u32 / (width * n));
        let block = &mut truth[(y / n * width + x / n) as usize];
        (0..3).for_each(|c| block[c] += held(texel)[c] / f64::from(n * n));
    }
    let off = |settings: Settings| -> Result<f64, Box<dyn Error>> {
        let (mut film, mut sum) = (Film::new(&gpu, [width, height]), Vec::new());
        let first = if settings.taa.is_some() { 0 } else { last };
        for frame in first..=last {
            sum = film.shoot(settings, frame, hdr)?;
        }
        let squared = |(a, b): (&[f32; 4], &[f64; 3])| (0..3).map(|c| (held(a)[c] - b[c]).powi(2)).sum::<f64>();
        Ok((sum.iter().zip(&truth).map(squared).sum::<f64>() / truth.len() as f64).sqrt())
    };
    let [told, untold, once] = [off(moving)?, off(Settings { moving: false, ..moving })?, off(alone)?];
    assert!(told < 0.5 * untold && told < 0.9 * once, "{told} with velocity, {untold} without, {once} of one frame");
    Ok(())
}
