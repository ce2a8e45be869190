//! The two ways to post-process: Bevy's own passes, and a graph.

use super::letterbox::Letterbox;
use super::{Choice, Scene};
use bevy_ecs::prelude::*;
use bevy_render::sync_world::RenderEntity;
use bevy_render::view::Tonemapping;
use framegraph::Plan;
use framegraph_bevy::{Chains, Device, ExecutePlugin, GraphPost, StandardPost, standard};
use framegraph_passes::effects::bloom::{Blend, Threshold};
use framegraph_passes::{BloomSettings, PostSettings};
use framegraph_shaders::layout::FxaaUniforms;

/// Effects that both ways apply.
#[derive(Clone, Copy, Debug)]
pub struct Effects {
    /// Width and height of the picture, in texels.
    pub size: [u32; 2],
    /// Samples per texel: 1 or 4.
    pub samples: u32,
    /// Bloom.
    pub bloom: bool,
    /// FXAA.
    pub fxaa: bool,
}

impl Effects {
    /// Returns what Bevy renders by itself.
    pub const fn of_bevy(&self) -> Choice {
        let Self { size, samples, bloom, fxaa } = *self;
        Choice { size, samples, bloom, tonemapping: Tonemapping::AcesFitted, fxaa }
    }

    /// Returns the scene with a graph that replaces Bevy's post-processing. If `bars`, the user's pass adds bars.
    pub fn executed(&self, device: &Device, bars: bool) -> Scene {
        let none = Choice { bloom: false, tonemapping: Tonemapping::None, fxaa: false, ..self.of_bevy() };
        let mut scene = Scene::new(device, &none, |app| {
            app.add_plugins(ExecutePlugin);
        });
        let bloom = BloomSettings {
            strength: 0.15,
            height_texels: (self.size[1] / 2).clamp(16, 384),
            blend: Blend::Interpolate,
            threshold: Threshold::None,
            ..BloomSettings::DEFAULT
        };
        let settings = StandardPost {
            bloom: self.bloom.then_some(bloom),
            post: PostSettings { dither: 0.0, ..PostSettings::DEFAULT },
            fxaa: self.fxaa.then(FxaaUniforms::default),
        };
        let post = GraphPost::new(move |frame, camera| {
            let picture = standard(frame, camera, &settings)?;
            if bars {
                frame.add("letterbox", Letterbox { over: picture })?;
            }
            Ok(())
        });
        let camera = scene.camera();
        scene.world().entity_mut(camera).insert(post);
        scene
    }
}

impl Scene {
    /// Returns the plan of the camera's chain, or the error of its last frame.
    pub fn plan(&mut self) -> Result<Plan, String> {
        let camera = self.camera();
        let entity: Entity = self.world().get::<RenderEntity>(camera).ok_or("the camera is not rendered")?.id();
        let chains = self.render().get_resource::<Chains>().ok_or("`ExecutePlugin` is missing")?;
        chains.error().map_or(Ok(()), Err)?;
        chains.plan(entity).ok_or_else(|| "no frame was executed".into())
    }
}
