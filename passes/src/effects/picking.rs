//! Picking: returns the instance visible at a pixel, its depth and its position.
//!
//! A separate graph draws the view's surfaces into one texel whose clip space is that of the picked pixel. A pick costs
//! the vertices of a depth prepass and one pixel; the frame itself is unaffected. Stencil is ignored. Corresponds to
//! Filament's `View::pick`.

use crate::effects::depth::prepass::DEPTH_FORMAT;
use crate::error::PassError;
use crate::gpu_scene::draw::{SurfaceDraw, SurfaceVariant};
use crate::gpu_scene::indirect::DrawList;
use crate::gpu_scene::upload::{GpuScene, MATERIAL_BINDINGS};
use crate::gpu_scene::view::{CameraView, ViewId, Views};
use crate::program::{Interface, ProgramDesc, Programs};
use framegraph::{
    ClearValue, CompileErrors, DeclareError, Extent, Format, Intent, Options, Pass, PassBuilder, Plan, Scratch,
    Texture, TextureDesc,
};
use framegraph_shaders::layout::FrameUniforms;
use framegraph_shaders::{Module, library};
use framegraph_wgpu::{
    Cx, Depth, ExecuteError, Executor, Frame, Gpu, Imports, ReadbackError, Record, RecordError, read_texture,
};
use glam::{DMat4, DVec2, DVec3};

/// Format of a pick: instance index plus one, and the bits of the depth.
pub const PICK_FORMAT: Format = Format::Rg32Uint;

static SHADER: Module<'static> = library::pass("pass/pick.wgsl").unwrap();

static INTERFACE: Interface =
    Interface { groups: &[&["frame"], &MATERIAL_BINDINGS, &["objects", "origins"]], constants: &[SurfaceDraw::TRAITS] };

/// Surface found by a pick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pick {
    /// Index of the instance in [`Scene::instances`](framegraph_scene::Scene::instances).
    pub instance: usize,
    /// Reversed depth at the pixel center: 1 at the near plane, 0 at the far plane.
    pub depth: f32,
    /// Position of the surface at the pixel center, in meters, world space.
    pub position: DVec3,
}

impl Pick {
    /// Reads the bytes of the texel that [`PickPass`] wrote for a pixel of `view`. Returns `None` for the background.
    #[must_use]
    pub fn from_texel(texel: &[u8], view: &CameraView, pixel: [u32; 2]) -> Option<Self> {
        let (words, _) = texel.as_chunks::<4>();
        let [number, depth] = [words.first()?, words.get(1)?].map(|bytes| u32::from_le_bytes(*bytes));
        let (instance, depth) = (number.checked_sub(1)? as usize, f32::from_bits(depth));
        let ndc = middle_ndc(view, pixel).extend(depth.into());
        let position = view.eye + view.clip_from_world.inverse().project_point3(ndc);
        Some(Self { instance, depth, position })
    }
}

/// Surfaces that can be picked.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Pickable {
    /// Opaque and alpha-tested surfaces, as in Filament.
    #[default]
    Opaque,
    /// All surfaces, including blended and transmissive ones at any alpha. Filament's
    /// `View::setTransparentPickingEnabled`.
    All,
}

/// Draws the index and depth of the instance visible at one pixel of a view into a texture of one texel.
#[derive(Clone, Copy, Debug)]
pub struct PickPass {
    /// View to pick in. Its jitter is ignored.
    pub view: ViewId,
    /// Pixel, from the top left of the view as rendered.
    pub pixel: [u32; 2],
    /// Surfaces that can be picked.
    pub pickable: Pickable,
}

impl Pass for PickPass {
    type Io = Texture;

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<Texture, DeclareError> {
        let one = Extent::absolute(1, 1);
        let depth = pass.texture("pick_depth", TextureDesc::new(one, DEPTH_FORMAT));
        pass.depth(depth, Intent::Clear(ClearValue::FAR_REVERSED))?;
        let picked = pass.texture("pick", TextureDesc::new(one, PICK_FORMAT));
        pass.color(picked, Intent::Clear(ClearValue::TRANSPARENT))
    }
}

impl<W: AsRef<Programs> + AsRef<GpuScene> + AsRef<Views> + ?Sized> Record<W> for PickPass {
    fn record(&self, _: &Texture, world: &W, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        let (views, programs): (&Views, &Programs) = (world.as_ref(), world.as_ref());
        let seen = views.get(self.view)?;
        let frame = [Some(cx.uniform(&frame_of_pixel(&seen.view, self.pixel)))];
        let draws = &seen.view.draws;
        let [opaque, mask] = &draws.depth;
        let transmit = DrawList::from(draws.transmit.clone());
        let lists = [(opaque, false), (mask, true), (&transmit, false), (&draws.blend, false)];
        let count = if self.pickable == Pickable::All { lists.len() } else { 2 };
        for (list, masked) in lists.into_iter().take(count) {
            let (vertex, fragment) = if masked { ("vs_mask", "fs_mask") } else { ("vs_opaque", "fs_opaque") };
            let surfaces = SurfaceDraw {
                program: &|variant: SurfaceVariant| {
                    let (fragment, features) = (Some(fragment), &variant.vertex_features());
                    programs.get(&ProgramDesc { vertex, fragment, features, ..ProgramDesc::new(&SHADER, &INTERFACE) })
                },
                frame: &frame,
                constants: &[],
                depth: Depth::NEARER,
                colors: &[],
            };
            surfaces.draw(list, seen.instances(world.as_ref()), cx)?;
        }
        Ok(())
    }
}

/// Returns the pixel center in normalized device coordinates.
fn middle_ndc(view: &CameraView, [x, y]: [u32; 2]) -> DVec2 {
    let uv = (DVec2::new(x.into(), y.into()) + 0.5) / size_px(view);
    DVec2::new(2.0 * uv.x - 1.0, 1.0 - 2.0 * uv.y)
}

fn size_px(view: &CameraView) -> DVec2 {
    view.frame.viewport_size_px.as_dvec2().max(DVec2::ONE)
}

/// Returns the frame uniforms of a view whose clip space is that of one pixel.
fn frame_of_pixel(view: &CameraView, pixel: [u32; 2]) -> FrameUniforms {
    let to_middle = DMat4::from_translation(-middle_ndc(view, pixel).extend(0.0));
    let to_pixel = DMat4::from_scale(size_px(view).extend(1.0)) * to_middle;
    FrameUniforms { clip_from_world: (to_pixel * view.clip_from_world).as_mat4(), ..view.frame }
}

/// Error of a pick.
#[derive(thiserror::Error)]
#[non_exhaustive]
pub enum PickError {
    /// The pixel is outside the view.
    #[error("pixel {},{} is outside of the view of {}x{} pixels; pick one within it", pixel[0], pixel[1], size[0], size[1])]
    Outside {
        /// The requested pixel.
        pixel: [u32; 2],
        /// Width and height of the view in pixels.
        size: [u32; 2],
    },
    /// The world has no such view.
    #[error(transparent)]
    Pass(#[from] PassError),
    /// The pass was refused.
    #[error(transparent)]
    Declare(#[from] DeclareError),
    /// The graph of the pick does not compile.
    #[error(transparent)]
    Compile(#[from] CompileErrors),
    /// The device failed.
    #[error(transparent)]
    Execute(#[from] ExecuteError),
    /// The texel could not be read back.
    #[error(transparent)]
    Readback(#[from] ReadbackError),
}

impl std::fmt::Debug for PickError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}

/// Picks single pixels in the views of a world and waits for the result. Keeps its pipelines and plan between picks.
pub struct Picker<W: ?Sized> {
    executor: Executor,
    frame: Frame<W>,
    plan: Plan,
    scratch: Scratch,
}

impl<W> Picker<W>
where
    W: AsRef<Programs> + AsRef<GpuScene> + AsRef<Views> + Sync + ?Sized,
{
    /// Creates a picker for this device.
    #[must_use]
    pub fn new(gpu: &Gpu) -> Self {
        Self { executor: Executor::new(gpu), frame: Frame::new(), plan: Plan::new(), scratch: Scratch::new() }
    }

    /// Returns the surface at the center of a pixel, counted from the top left of the view as rendered. Returns `None`
    /// for the background.
    ///
    /// # Errors
    /// Fails if the pixel is outside the view, the world does not have the view, or the device fails.
    pub fn pick(
        &mut self,
        world: &W,
        view: ViewId,
        pixel: [u32; 2],
        pickable: Pickable,
    ) -> Result<Option<Pick>, PickError> {
        let views: &Views = world.as_ref();
        let seen = &views.get(view)?.view;
        let size = seen.frame.viewport_size_px.to_array().map(|side| side as u32);
        if pixel[0] >= size[0] || pixel[1] >= size[1] {
            return Err(PickError::Outside { pixel, size });
        }
        let Self { executor, frame, plan, scratch } = self;
        frame.reset();
        let picked = frame.add("pick", PickPass { view, pixel, pickable })?;
        frame.graph_mut().readback(picked)?;
        executor.compile(frame.graph(), &Options::for_frame(1, 1), scratch, plan)?;
        executor.execute(plan, frame, world, &Imports::new())?;
        let texture = executor.texture(plan, picked).ok_or(ReadbackError::Usage)?;
        let texel = read_texture(executor.gpu(), texture)?.bytes;
        Ok(Pick::from_texel(&texel, seen, pixel))
    }
}
