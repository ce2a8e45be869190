//! Post-processing as one compiled graph inside Bevy's render schedule.

use crate::standard::PostWorld;
use bevy_app::{App, Plugin};
use bevy_core_pipeline::tonemapping::tonemapping;
use bevy_core_pipeline::upscaling::{ViewUpscalingPipeline, upscaling};
use bevy_core_pipeline::{Core3d, Core3dSystems};
use bevy_ecs::prelude::*;
use bevy_render::extract_component::{ExtractComponent, ExtractComponentPlugin};
use bevy_render::renderer::{RenderAdapter, RenderContext, RenderDevice, RenderQueue, ViewQuery};
use bevy_render::view::ViewTarget;
use bevy_render::{Render, RenderApp, RenderSystems};
use framegraph::{Entry, Exit, Extent, Plan, Texture, TextureDesc};
use framegraph_passes::StageError;
use framegraph_wgpu::{Frame, FrameLoop, Gpu, Imports, format_of};
use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

/// Textures of the camera, imported into the graph.
#[derive(Clone, Copy, Debug)]
pub struct CameraTextures {
    /// Pre-exposed linear Rec. 709, one sample: Bevy's main texture.
    pub hdr: Texture,
    /// Texture in which the picture must end: the window's or image's.
    pub output: Texture,
    /// Width and height of both, in texels.
    pub size: [u32; 2],
}

type Declare = dyn Fn(&mut Frame<PostWorld>, &CameraTextures) -> Result<(), StageError> + Send + Sync;

/// Component of a camera whose post-processing is a graph. Replaces tone mapping, FXAA, bloom and upscaling of Bevy for
/// this camera: spawn it with `Hdr` and `Tonemapping::None`, and without `Bloom` and `Fxaa`.
///
/// The graph is compiled when its declarations change, and executed in `Core3dSystems::PostProcess` on Bevy's device,
/// in a command buffer of its own. If it fails, its commands are not submitted, the error is logged, and
/// [`Chains::error`] returns it.
#[derive(Clone, Component, ExtractComponent)]
#[extract_app(RenderApp)]
pub struct GraphPost(Arc<Declare>);

impl GraphPost {
    /// Creates a chain. `declare` adds passes that read [`CameraTextures::hdr`] and write [`CameraTextures::output`]. It
    /// is called for every frame.
    pub fn new<F>(declare: F) -> Self
    where
        F: Fn(&mut Frame<PostWorld>, &CameraTextures) -> Result<(), StageError> + Send + Sync + 'static,
    {
        Self(Arc::new(declare))
    }
}

/// Executes [`GraphPost`] for every camera that has one. It must be added after `RenderPlugin`.
#[derive(Clone, Copy, Debug, Default)]
pub struct ExecutePlugin;

impl Plugin for ExecutePlugin {
    fn build(&self, app: &mut App) {
        app.add_plugins(ExtractComponentPlugin::<GraphPost>::default());
    }

    fn finish(&self, app: &mut App) {
        let Some(render) = app.get_sub_app_mut(RenderApp) else { return };
        let world = render.world();
        let resources = (
            world.get_resource::<RenderAdapter>(),
            world.get_resource::<RenderDevice>(),
            world.get_resource::<RenderQueue>(),
        );
        let (Some(adapter), Some(device), Some(queue)) = resources else { return };
        let gpu = Gpu::wrap(adapter, device.wgpu_device(), queue);
        render.insert_resource(Chains { gpu, state: Mutex::default() });
        // Depth of field, auto exposure and Bevy's other effects before tone mapping write the main texture.
        let post = run.in_set(Core3dSystems::PostProcess).after(tonemapping).before(upscaling);
        render.add_systems(Core3d, post);
        render.add_systems(
            Render,
            (skip_upscaling.in_set(RenderSystems::PrepareBindGroups), submitted.in_set(RenderSystems::Cleanup)),
        );
    }
}

/// The compiled chains of all cameras.
#[derive(Resource)]
pub struct Chains {
    gpu: Gpu,
    state: Mutex<State>,
}

#[derive(Default)]
struct State {
    chains: HashMap<Entity, Chain>,
    error: Option<String>,
}

/// Chain of one camera.
struct Chain {
    frames: FrameLoop<PostWorld>,
    world: PostWorld,
    /// Recorded, and not submitted yet.
    recorded: bool,
}

impl Chains {
    /// Returns the plan of the chain of a camera's render entity; `None` before its first frame.
    pub fn plan(&self, camera: Entity) -> Option<Plan> {
        self.lock().chains.get(&camera).map(|chain| chain.frames.plan().clone())
    }

    /// Returns the error of the last frame, if it failed.
    pub fn error(&self) -> Option<String> {
        self.lock().error.clone()
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, State> {
        // A panic leaves a frame unrecorded; the next one starts clean.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Records the chain of one camera.
fn run(view: ViewQuery<(&ViewTarget, &GraphPost)>, chains: Res<Chains>, mut context: RenderContext) {
    let camera = view.entity();
    let (target, post) = view.into_inner();
    let Some(output) = target.out_texture() else { return };
    // Tells Bevy that the output is written.
    let _ = target.out_texture_color_attachment(None);
    let mut state = chains.lock();
    let State { chains: known, error } = &mut *state;
    let made = || PostWorld::new(&chains.gpu).map(|world| (FrameLoop::new(&chains.gpu), world));
    let chain = match known.entry(camera) {
        std::collections::hash_map::Entry::Occupied(known) => known.into_mut(),
        std::collections::hash_map::Entry::Vacant(place) => match made() {
            Ok((frames, world)) => place.insert(Chain { frames, world, recorded: false }),
            Err(failed) => return report(error, failed.to_string()),
        },
    };
    if chain.recorded {
        return;
    }
    let textures = [target.main_texture(), output.texture()];
    match chain.record(textures, post, &chains.gpu, &mut context) {
        Ok(()) => *error = None,
        Err(failed) => report(error, failed),
    }
}

impl Chain {
    fn record(
        &mut self,
        [main, output]: [&wgpu::Texture; 2],
        post: &GraphPost,
        gpu: &Gpu,
        context: &mut RenderContext,
    ) -> Result<(), String> {
        let described = |texture: &wgpu::Texture| {
            let format = format_of(texture.format());
            let unknown = || format!("camera: texture format {:?} is not supported; use another one", texture.format());
            format.map(|format| TextureDesc::new(Extent::FRAME, format)).ok_or_else(unknown)
        };
        let size = [output.width(), output.height()];
        let descs = (described(main)?, described(output)?);
        let declare = |frame: &mut Frame<PostWorld>, imports: &mut Imports| {
            let graph = frame.graph_mut();
            let hdr = graph.import_texture("bevy/hdr", descs.0, Entry::Defined, Exit::Discard);
            let target = graph.import_texture("bevy/output", descs.1, Entry::Undefined, Exit::Keep);
            imports.texture(hdr, main).surface(target, output);
            (post.0)(frame, &CameraTextures { hdr, output: target, size })
        };
        // After an error, the encoder is dropped with what it recorded.
        let mut encoder =
            gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("framegraph") });
        let recorded = self.frames.record_into(size, &self.world, &mut encoder, declare);
        self.recorded = recorded.map_err(|error| error.to_string())?.is_some();
        if self.recorded {
            context.add_command_buffer(encoder.finish());
        }
        self.world.next_frame();
        if self.frames.plan().steps().is_empty() {
            return Err("the chain draws nothing; add a pass that writes `CameraTextures::output`".into());
        }
        Ok(())
    }
}

fn report(last: &mut Option<String>, error: String) {
    if last.as_ref() != Some(&error) {
        tracing::error!("framegraph-bevy: {error}");
    }
    *last = Some(error);
}

/// Removes Bevy's last copy for cameras whose chain writes the output.
fn skip_upscaling(cameras: Query<Entity, (With<GraphPost>, With<ViewUpscalingPipeline>)>, mut commands: Commands) {
    for camera in &cameras {
        commands.entity(camera).remove::<ViewUpscalingPipeline>();
    }
}

/// Reports the submission to the chains, and drops those of removed cameras.
fn submitted(chains: Res<Chains>, queue: Res<RenderQueue>, cameras: Query<(), With<GraphPost>>) {
    let mut state = chains.lock();
    state.chains.retain(|camera, _| cameras.contains(*camera));
    if state.chains.values().any(|chain| chain.recorded) {
        let submission = queue.submit([]);
        for chain in state.chains.values_mut().filter(|chain| chain.recorded) {
            chain.frames.submitted(submission.clone());
            chain.recorded = false;
        }
    }
}
