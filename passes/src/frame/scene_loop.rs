//! A scene with everything that draws it: device, frame loop, view and target, made by one call.

use crate::error::PassError;
use crate::frame::world::{World, WorldError};
use crate::frame::{Settings, standard};
use crate::gpu_scene::lighting::{Lighting, LightingError};
use crate::gpu_scene::shadow_views::ShadowSettings;
use crate::gpu_scene::view::{Background, CameraView, ViewId, ViewSettings};
use crate::stages::StageError;
use framegraph::{Entry, Exit, Extent, Format, Target, TextureDesc};
use framegraph_scene::environment::Sky;
use framegraph_scene::{Environment, Scene, SceneError, progress};
use framegraph_wgpu::wgpu::{self, SurfaceTarget, TextureUsages};
use framegraph_wgpu::{
    AdapterRequest, FrameError, FrameLoop, Gpu, OpenError, Pixels, ReadbackError, SurfaceError, WindowSurface,
    format_of, read_texture, texture_2d,
};
use glam::DVec2;

/// Draws a scene with the standard frame, into a window or a texture.
///
/// A starting point for programs without an engine of their own. All parts are public, and each can be made separately.
///
/// ```no_run
/// use framegraph_passes::frame::scene_loop::SceneLoop;
/// use framegraph_scene::{Scene, progress};
///
/// let scene = Scene::open("columns", &mut progress::silent)?;
/// let mut shown = SceneLoop::for_texture(scene, [640, 360])?;
/// shown.draw()?;
/// let rgba = shown.pixels()?.rgba8();
/// # let _ = rgba;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct SceneLoop {
    /// Device.
    pub gpu: Gpu,
    /// Frame loop, with plan, executor and options.
    pub frames: FrameLoop<World>,
    /// Scene, light and views on the device.
    pub world: World,
    /// Scene on the CPU. Call [`SceneLoop::set_view`] after moving instances.
    pub scene: Scene,
    /// Settings of the frame. Take effect in the next frame.
    pub settings: Settings,
    view: ViewSettings,
    made: Made,
    /// True if the current view was drawn.
    is_drawn: bool,
    /// View of the last drawn frame, if the current view was not drawn yet.
    before: Option<CameraView>,
    target: Screen,
}

/// Values of [`Settings`] that a view depends on.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Made {
    shadows: Option<ShadowSettings>,
    drawn_px: [u32; 2],
    jitter_px: DVec2,
}

/// Target of the frames.
#[derive(Debug)]
enum Screen {
    Window(Box<WindowSurface>),
    Texture(wgpu::Texture),
}

/// Error of a scene loop.
#[derive(thiserror::Error)]
#[non_exhaustive]
pub enum SceneLoopError {
    /// No device could be opened.
    #[error(transparent)]
    Open(#[from] OpenError),
    /// The window cannot be drawn into.
    #[error(transparent)]
    Surface(#[from] SurfaceError),
    /// The sky cannot be made.
    #[error(transparent)]
    Sky(#[from] SceneError),
    /// Image-based light cannot be made.
    #[error(transparent)]
    Light(#[from] LightingError),
    /// The scene does not fit the device.
    #[error(transparent)]
    World(#[from] WorldError),
    /// The view does not fit the device.
    #[error(transparent)]
    View(#[from] PassError),
    /// The frame was not drawn.
    #[error(transparent)]
    Frame(#[from] FrameError<StageError>),
    /// The picture cannot be read.
    #[error(transparent)]
    Read(#[from] ReadbackError),
    /// The target is a window, whose pictures cannot be read.
    #[error("the scene is drawn into a window, which cannot be read; use `SceneLoop::for_texture`")]
    Window,
}

impl std::fmt::Debug for SceneLoopError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}

impl SceneLoop {
    /// Opens a device, and draws `scene` into a texture of `size_px` pixels ([`SceneLoop::pixels`]), under a clear sky.
    ///
    /// # Errors
    /// Fails with [`SceneLoopError`].
    pub fn for_texture(scene: Scene, size_px: [u32; 2]) -> Result<Self, SceneLoopError> {
        let gpu = Gpu::open(&AdapterRequest::from_env())?;
        let environment = Sky::default().environment(128)?;
        Self::on(&gpu, scene, &environment, size_px)
    }

    /// Opens a device, and draws `scene` into a window of `size_px` pixels, under a clear sky. `window` is for example
    /// an `Arc<winit::window::Window>`.
    ///
    /// # Errors
    /// Fails with [`SceneLoopError`].
    pub fn for_window(
        scene: Scene,
        window: impl Into<SurfaceTarget<'static>>,
        size_px: [u32; 2],
    ) -> Result<Self, SceneLoopError> {
        let (gpu, surface) = WindowSurface::open(&AdapterRequest::from_env(), window, size_px)?;
        let environment = Sky::default().environment(128)?;
        let lighting = Lighting::with_defaults(&gpu, &environment)?;
        Self::of(&gpu, scene, lighting, size_px, Screen::Window(Box::new(surface)))
    }

    /// Draws `scene` into a texture of `size_px` pixels on an open device.
    ///
    /// # Errors
    /// Fails with [`SceneLoopError`].
    pub fn on(gpu: &Gpu, scene: Scene, environment: &Environment, size_px: [u32; 2]) -> Result<Self, SceneLoopError> {
        let lighting = Lighting::with_defaults(gpu, environment)?;
        Self::of(gpu, scene, lighting, size_px, Screen::Texture(texture(gpu, size_px)))
    }

    fn of(
        gpu: &Gpu,
        scene: Scene,
        lighting: Lighting,
        size_px: [u32; 2],
        target: Screen,
    ) -> Result<Self, SceneLoopError> {
        let [width, height] = size_px.map(|side| f64::from(side.max(1)));
        let camera = scene.default_camera(width / height);
        let view = ViewSettings { camera, size_px, ..ViewSettings::default() };
        let seen = CameraView::new(&scene, &lighting.image, &Background::Environment, &view);
        let world = World::new(gpu, &scene, lighting, [seen], &mut progress::silent)?;
        let frames = FrameLoop::new(gpu);
        let settings = Settings::DEFAULT;
        let made = Made { shadows: view.shadows, drawn_px: size_px, jitter_px: DVec2::ZERO };
        let gpu = gpu.clone();
        Ok(Self { gpu, frames, world, scene, settings, view, made, is_drawn: false, before: None, target })
    }

    /// Returns the settings of the view. Its shadows are those that were drawn last.
    pub fn view(&self) -> &ViewSettings {
        &self.view
    }

    /// Replaces camera, exposure and other settings of the view. Another size resizes texture or window surface.
    ///
    /// Shadow maps are those of [`SceneLoop::settings`]; `view.shadows` is ignored. Temporal effects reproject from the
    /// last drawn frame, however often the view was replaced since.
    ///
    /// # Errors
    /// Fails if the device fails.
    pub fn set_view(&mut self, view: ViewSettings) -> Result<(), SceneLoopError> {
        if view.size_px != self.view.size_px {
            match &mut self.target {
                Screen::Window(surface) => surface.resize(view.size_px),
                Screen::Texture(target) => *target = texture(&self.gpu, view.size_px),
            }
        }
        self.view = view;
        self.make_view()
    }

    /// Returns the values of the settings that the view of the next frame depends on.
    fn needed(&self) -> Made {
        let jitter_px = self.settings.taa.map_or(DVec2::ZERO, |taa| taa.jitter_px(self.world.frame_index.0));
        Made { shadows: self.settings.shadows, drawn_px: self.settings.drawn_px(self.view.size_px), jitter_px }
    }

    /// Makes the view of the next frame.
    fn make_view(&mut self) -> Result<(), SceneLoopError> {
        let made = self.needed();
        self.view.shadows = made.shadows;
        if std::mem::take(&mut self.is_drawn) {
            self.before = Some(self.world.views.get(ViewId::MAIN)?.view.clone());
        }
        let drawn = ViewSettings { size_px: made.drawn_px, ..self.view.clone() };
        let light = &self.world.lighting.image;
        let mut seen = CameraView::new(&self.scene, light, &Background::Environment, &drawn);
        if let Some(before) = &self.before {
            seen = seen.after(before);
        }
        seen.jitter(made.jitter_px);
        self.world.set_view(&self.gpu, ViewId::MAIN, seen)?;
        self.made = made;
        Ok(())
    }

    /// Advances the view to the next frame.
    fn next_view(&mut self) -> Result<(), SceneLoopError> {
        let needed = self.needed();
        if needed == self.made && !self.is_drawn {
            return Ok(());
        }
        if !self.is_drawn || needed != (Made { jitter_px: needed.jitter_px, ..self.made }) {
            return self.make_view();
        }
        self.world.views.again(ViewId::MAIN, needed.jitter_px)?;
        (self.made, self.is_drawn) = (needed, false);
        Ok(())
    }

    /// Draws the next frame. Returns false if it was skipped, because the window is hidden or has no size.
    ///
    /// # Errors
    /// Fails if the frame cannot be drawn. The next one starts clean.
    pub fn draw(&mut self) -> Result<bool, SceneLoopError> {
        let image = match &mut self.target {
            Screen::Window(surface) => match surface.acquire()? {
                Some(image) => Some(image),
                None => return Ok(false),
            },
            Screen::Texture(_) => None,
        };
        self.next_view()?;
        let Self { frames, world, scene, settings, view, target, .. } = self;
        let texture = match (&image, &*target) {
            (Some(image), _) => &image.texture,
            (None, Screen::Texture(texture)) => texture,
            (None, Screen::Window(_)) => return Ok(false),
        };
        let seen = &world.views.get(ViewId::MAIN)?.view;
        let moving = settings.moving || !seen.motions.is_empty();
        let settings = Settings { moving, ..settings.for_scene(scene, settings.drawn_px(view.size_px)) };
        let format = format_of(texture.format()).unwrap_or(Format::Rgba8UnormSrgb);
        let ran = frames.run(view.size_px, world, |frame, imports| {
            let desc = TextureDesc::new(Extent::FRAME, format);
            let picture = frame.graph_mut().import_texture("picture", desc, Entry::Undefined, Exit::Keep);
            match image.is_some() {
                true => imports.surface(picture, texture),
                false => imports.texture(picture, texture),
            };
            standard(frame, &settings, Target::from(picture))
        })?;
        if let (Screen::Window(surface), Some(image)) = (target, image) {
            surface.present(image);
        }
        if ran.is_none() {
            return Ok(false);
        }
        self.world.frame_index.0 += 1;
        (self.is_drawn, self.before) = (true, None);
        Ok(true)
    }

    /// Returns the pixels of the last frame.
    ///
    /// # Errors
    /// Fails if the target is a window, or the device fails.
    pub fn pixels(&self) -> Result<Pixels, SceneLoopError> {
        match &self.target {
            Screen::Texture(texture) => Ok(read_texture(&self.gpu, texture)?),
            Screen::Window(_) => Err(SceneLoopError::Window),
        }
    }
}

fn texture(gpu: &Gpu, size_px: [u32; 2]) -> wgpu::Texture {
    let [width, height] = size_px.map(|side| side.max(1));
    gpu.device.create_texture(&texture_2d(
        "picture",
        [width, height],
        wgpu::TextureFormat::Rgba8UnormSrgb,
        TextureUsages::RENDER_ATTACHMENT | TextureUsages::COPY_SRC | TextureUsages::TEXTURE_BINDING,
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::taa::TaaSettings;

    /// Draws on the noop device, which checks all calls.
    #[test]
    fn one_call_makes_everything_that_draws() -> Result<(), SceneLoopError> {
        let environment = Sky::default().environment(8)?;
        let scene = Scene::open("columns", &mut progress::silent)?;
        let mut shown = SceneLoop::on(&Gpu::noop()?, scene, &environment, [32, 18])?;
        assert!(shown.draw()?);
        assert_eq!(shown.frames.executor().executed(), shown.frames.plan().counts());
        shown.set_view(ViewSettings { size_px: [16, 16], ..shown.view().clone() })?;
        shown.settings.fxaa = false;
        assert!(shown.draw()?);
        assert_eq!((shown.pixels()?.texels, shown.world.frame_index.0), ([16, 16], 2));
        Ok(())
    }

    /// A view follows the last drawn frame, its shadows are those of the settings, and skipped frames do not count.
    #[test]
    fn views_follow_drawn_frames() -> Result<(), SceneLoopError> {
        let environment = Sky::default().environment(8)?;
        let scene = Scene::open("columns", &mut progress::silent)?;
        let mut shown = SceneLoop::on(&Gpu::noop()?, scene, &environment, [32, 18])?;
        shown.settings.taa = Some(TaaSettings::DEFAULT);
        assert!(shown.draw()?);
        let first = shown.view().camera.eye;
        let shifted = |view: &ViewSettings, size_px| {
            let mut view = view.clone();
            (view.camera.eye.x, view.size_px) = (view.camera.eye.x + 0.1, size_px);
            view
        };
        shown.set_view(shifted(shown.view(), [32, 18]))?;
        shown.set_view(shifted(shown.view(), [0, 18]))?;
        assert!(!shown.draw()?, "a picture without width is skipped");
        assert_eq!(shown.world.frame_index.0, 1);
        shown.set_view(shifted(shown.view(), [32, 18]))?;
        assert!(shown.draw()?);
        let seen = |shown: &SceneLoop| Ok::<_, SceneLoopError>(shown.world.views.get(ViewId::MAIN)?.view.clone());
        let second = seen(&shown)?;
        assert_eq!(second.earlier.map(|earlier| earlier.eye), Some(first));
        assert_eq!(second.jitter_px, TaaSettings::DEFAULT.jitter_px(1));
        shown.settings.shadows = None;
        assert!(shown.draw()?);
        let third = seen(&shown)?;
        assert!(second.shadows.is_some() && third.shadows.is_none() && shown.view().shadows.is_none());
        assert_eq!(third.earlier.map(|earlier| earlier.eye), Some(second.eye));
        assert!(shown.draw()?);
        assert_eq!((seen(&shown)?.jitter_px, shown.world.frame_index.0), (TaaSettings::DEFAULT.jitter_px(3), 4));
        Ok(())
    }
}
