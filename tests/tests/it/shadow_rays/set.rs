//! A scene with a light, whose shadows are rendered and ray traced.

use crate::stage::lighting;
use framegraph::{Options, Plan, Scratch, Target, compile};
use framegraph_passes::effects::occlusion::OcclusionSettings;
use framegraph_passes::gpu_scene::shadow_views::ShadowSettings;
use framegraph_passes::gpu_scene::view::Background;
use framegraph_passes::{CameraView, Precision, Quality, Settings, Shading, ViewSettings, World, standard};
use framegraph_scene::{Camera, Environment, Light, LightKind, Projection, Scene, progress};
use framegraph_wgpu::{Frame, Gpu, Imports, read_texture};
use glam::{DVec3, Mat4, Vec2};
use std::error::Error;
use tests::executors;
use truth::rays::{Hit, Triangles};

/// Width and height of the pictures, in pixels.
pub const SIZE: [u32; 2] = [128, 72];
/// Minimum number of pixels for which rays give a verdict, a sixth of a picture. With fewer, as when the camera sees
/// the sky, any shadow map would pass.
pub const JUDGED: u32 = SIZE[0] * SIZE[1] / 6;

/// Cosine below which a pixel is ignored: 6°. The grazing sun of these tests is at 8°.
pub const GRAZING: f64 = 0.1;

/// The only light of a scene.
#[derive(Clone, Debug)]
pub enum Lamp {
    /// The sun, with the direction toward it.
    Sun { toward: DVec3, radius_rad: f32 },
    /// A punctual light.
    Local(Light),
}

/// A scene, a camera and a light.
#[derive(Clone)]
pub struct Set {
    pub scene: Scene,
    pub camera: Camera,
    pub lamp: Lamp,
    /// Precision of shading.
    pub precision: Precision,
    /// Ambient occlusion, which shares its depth with contact shadows; no light depends on it.
    pub occlusion: Option<OcclusionSettings>,
    /// Offset of every shadow map from its fit, in texels.
    pub moved_texels: Vec2,
}

impl Set {
    pub fn new(scene: Scene, camera: Camera, toward: DVec3) -> Self {
        let lamp = Lamp::Sun { toward: toward.normalize(), radius_rad: 0.0 };
        Self { scene, camera, lamp, precision: Precision::Full, occlusion: None, moved_texels: Vec2::ZERO }
    }

    /// Returns the red channel of the radiance.
    pub fn radiance(&self, gpu: &Gpu, shadows: Option<ShadowSettings>) -> Result<Vec<f32>, Box<dyn Error>> {
        let mut scene = self.scene.clone();
        let mut environment = Environment::uniform(DVec3::ZERO)?;
        match &self.lamp {
            Lamp::Sun { toward, radius_rad } => {
                let kind = LightKind::Directional { illuminance_lux: 1e5, angular_radius_rad: *radius_rad };
                let sun = Light::directional("sun", -toward.as_vec3(), 1e5);
                environment.sun = Some(Light { kind, ..sun });
            }
            Lamp::Local(light) => scene.lights.push(light.clone()),
        }
        let shading = Shading { specular_aa: None, precision: self.precision, ..Quality::Low.shading() };
        let settings = Settings { shading, shadows, occlusion: self.occlusion, fxaa: false, ..Settings::DEFAULT };
        let lighting = lighting(gpu, &environment, &settings.shading)?;
        let seen = ViewSettings {
            camera: self.camera.clone(),
            size_px: SIZE,
            ev100: 10.0,
            shadows: settings.shadows,
            ..ViewSettings::default()
        };
        let mut view = CameraView::new(&scene, &lighting.image, &Background::None, &seen);
        for map in view.shadows.iter_mut().flat_map(|shadows| &mut shadows.maps) {
            let by = Mat4::from_translation((2.0 * self.moved_texels / map.place.texels as f32).extend(0.0));
            map.uniforms.clip_from_world = by * map.uniforms.clip_from_world;
            map.view.clip_from_world = by * map.view.clip_from_world;
        }
        let world = World::new(gpu, &scene, lighting, [view], &mut progress::silent)?;
        let mut frame = Frame::<World>::new();
        let io = standard(&mut frame, &settings, Target::New)?;
        frame.graph_mut().readback(io.hdr)?;
        let mut plan = Plan::new();
        compile(frame.graph(), &gpu.caps(), &Options::for_frame(SIZE[0], SIZE[1]), &mut Scratch::new(), &mut plan)?;
        let mut executor = executors::lend(gpu);
        executor.execute(&plan, &frame, &world, &Imports::new())?;
        let texture = executor.texture(&plan, io.hdr).ok_or("the frame left no picture")?;
        Ok(read_texture(gpu, texture)?.rgba().into_iter().map(|[red, ..]| red).collect())
    }

    /// Returns the visibility of the light at each pixel by its shadow map; `None` for surfaces that face away.
    pub fn visibility(&self, gpu: &Gpu, shadows: ShadowSettings) -> Result<Vec<Option<f64>>, Box<dyn Error>> {
        self.visibility_beside(gpu, &self.radiance(gpu, None)?, shadows)
    }

    /// Returns the visibility at each pixel, given [`Set::radiance`] without shadows.
    pub fn visibility_beside(
        &self,
        gpu: &Gpu,
        without: &[f32],
        shadows: ShadowSettings,
    ) -> Result<Vec<Option<f64>>, Box<dyn Error>> {
        let with = self.radiance(gpu, Some(shadows))?;
        assert!(with.iter().all(|light| light.to_bits() & 0x7f80_0000 != 0x7f80_0000), "light that is not finite");
        let brightest = without.iter().copied().fold(0.0, f32::max);
        let share = |(with, without): (&f32, &f32)| {
            (*without > 0.02 * brightest).then(|| f64::from(*with) / f64::from(*without))
        };
        Ok(with.iter().zip(without).map(share).collect())
    }

    /// Returns all triangles, regardless of material.
    pub fn triangles(&self) -> Triangles {
        Triangles::of(self.scene.instances.iter().map(|instance| {
            let mesh = &self.scene.meshes[instance.mesh.index()];
            let at = |i: &u32| instance.world_from_model.transform_point3(mesh.positions[*i as usize].as_dvec3());
            mesh.indices.chunks_exact(3).map(|t| [at(&t[0]), at(&t[1]), at(&t[2])]).collect()
        }))
    }

    /// Returns the surface at the center of each pixel.
    pub fn seen(&self, triangles: &Triangles) -> Vec<Option<Hit>> {
        let aspect = f64::from(SIZE[0]) / f64::from(SIZE[1]);
        let Projection::Perspective { fov_y_rad, .. } = self.camera.projection else { return Vec::new() };
        let half = (0.5 * fov_y_rad).tan();
        let ray = |i: u32| {
            let (x, y) = (f64::from(i % SIZE[0]) + 0.5, f64::from(i / SIZE[0]) + 0.5);
            let x = (2.0 * x / f64::from(SIZE[0]) - 1.0) * half * aspect;
            let y = (1.0 - 2.0 * y / f64::from(SIZE[1])) * half;
            (self.camera.world_from_view * DVec3::new(x, y, -1.0)).normalize()
        };
        (0..SIZE[0] * SIZE[1]).map(|i| triangles.first(self.camera.eye, ray(i))).collect()
    }

    /// Returns the light's position, or a point in the sun's direction, and the direction toward it.
    pub fn toward(&self, from: DVec3) -> (DVec3, DVec3) {
        match &self.lamp {
            Lamp::Sun { toward, .. } => (from + *toward * 1e4, *toward),
            Lamp::Local(light) => (light.position, (light.position - from).normalize()),
        }
    }

    pub fn is_lit(&self, triangles: &Triangles, hit: &Hit, point: DVec3) -> bool {
        let from = point + hit.normal * 1e-5;
        let (to, toward) = self.toward(from);
        hit.normal.dot(toward) > 0.0 && triangles.is_open(from, to, 1e-4)
    }

    /// Traces rays and renders the picture without shadows.
    pub fn judge<'a>(&'a self, gpu: &'a Gpu) -> Result<Judge<'a>, Box<dyn Error>> {
        let triangles = self.triangles();
        let seen = self.seen(&triangles);
        Ok(Judge { set: self, gpu, triangles, seen, without: self.radiance(gpu, None)? })
    }
}

/// Reference for the shadows of a set.
pub struct Judge<'a> {
    set: &'a Set,
    gpu: &'a Gpu,
    pub triangles: Triangles,
    pub seen: Vec<Option<Hit>>,
    /// Picture without shadows.
    pub without: Vec<f32>,
}

impl Judge<'_> {
    /// Returns the number of pixels, in thousandths, whose shadow map contradicts all rays within `blur_m(distance)`:
    /// acne and light leaks.
    pub fn wrong(&self, shadows: ShadowSettings, blur_m: impl Fn(f64) -> f64) -> Result<f64, Box<dyn Error>> {
        let [wrong, count, dark] = self.compared(shadows, blur_m)?;
        assert!(count >= JUDGED && dark > 50, "{count} pixels, {dark} in shadow");
        Ok(1000.0 * f64::from(wrong) / f64::from(count))
    }

    /// Returns whether the neighborhood of a surface within `off_m` is entirely lit or entirely in shadow; `None` if it
    /// is mixed.
    pub fn lit_around(&self, hit: &Hit, off_m: f64) -> Option<bool> {
        let (u, v) = hit.normal.any_orthonormal_pair();
        let is_lit = |way: DVec3| self.set.is_lit(&self.triangles, hit, hit.point + way * off_m);
        let lit = is_lit(DVec3::ZERO);
        [u, -u, v, -v].into_iter().all(|way| is_lit(way) == lit).then_some(lit)
    }

    /// Returns the number of wrong pixels, of judged pixels, and of those in shadow.
    #[allow(clippy::print_stdout, reason = "shown with --nocapture")]
    pub fn compared(&self, shadows: ShadowSettings, blur_m: impl Fn(f64) -> f64) -> Result<[u32; 3], Box<dyn Error>> {
        let Self { set, gpu, seen, without, .. } = self;
        let found = set.visibility_beside(gpu, without, shadows)?;
        let (mut wrong, mut count, mut dark) = (0, 0, 0);
        for (visibility, hit) in found.iter().zip(seen) {
            let (Some(visibility), Some(hit)) = (visibility, hit) else { continue };
            // At grazing angles, interpolated normals may be lit where the flat triangle is not.
            if hit.normal.dot(set.toward(hit.point).1).abs() < GRAZING {
                continue;
            }
            let off = blur_m((hit.point - set.camera.eye).length());
            let Some(lit) = self.lit_around(hit, off) else { continue };
            count += 1;
            dark += u32::from(!lit);
            wrong += u32::from((*visibility - f64::from(u8::from(lit))).abs() > 0.1);
        }
        println!("{:?} {:?} {}: {wrong} of {count} wrong, {dark} dark", shadows.filter, shadows.fit, shadows.cascades);
        Ok([wrong, count, dark])
    }
}
