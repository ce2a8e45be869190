//! The standard frame of `framegraph_passes` as a source of plans: a preset, a settings file or the live frame. Its effects
//! are features.

use crate::plan_data::PlanData;
use crate::what_if::{Planner, WhatIf};
use framegraph::{Entry, Exit, Extent, Format, Options, Plan, Scratch, Target, Texture, TextureDesc, compile};
use framegraph_passes::{Effect, Facts, FrameSettings, Preset, Settings, StageError, World, standard};
use framegraph_scene::Scene;
use framegraph_wgpu::Frame;
use program::input::{MAX_TEXT_BYTES, text};
use std::sync::Arc;

/// Default frame size in texels.
const FRAME: [u32; 2] = [1920, 1080];

/// Standard frame with its settings.
#[derive(Clone, Debug)]
pub struct StandardFrame {
    name: String,
    frame: FrameSettings,
    scene: Arc<Scene>,
    facts: Facts,
}

impl StandardFrame {
    /// Opens a preset or a settings file (`docs/reference/settings.md`), for a scene without glass.
    ///
    /// # Errors
    /// An unknown preset, an unreadable file, or an invalid setting.
    pub fn open(which: &str) -> Result<Self, String> {
        let frame = settings(which)?;
        Ok(Self { name: format!("standard frame, {which}"), frame, scene: Arc::default(), facts: Facts::default() })
    }

    /// Creates the planner of a live frame. Only materials and instances of `scene` are used.
    pub fn live(scene_name: &str, frame: FrameSettings, scene: Arc<Scene>, facts: Facts) -> Self {
        Self { name: format!("live frame, {scene_name}"), frame, scene, facts }
    }

    /// Returns the settings with some effects disabled, for a frame of a size in texels.
    fn settings(&self, features: &[(String, bool)], size_texels: [u32; 2]) -> Settings {
        let off = features.iter().filter(|(_, on)| !on).filter_map(|(name, _)| Effect::from_name(name));
        let asked = off.fold(self.frame.settings, Settings::without);
        self.facts.apply(&asked.for_scene(&self.scene, asked.drawn_px(size_texels)))
    }
}

/// Loads the settings of a preset or a file.
///
/// # Errors
/// An unknown preset, an unreadable file, or an invalid setting.
pub fn settings(which: &str) -> Result<FrameSettings, String> {
    if let Some(preset) = Preset::from_name(which) {
        return Ok(preset.frame());
    }
    if !which.ends_with(".ron") {
        let presets = Preset::ALL.map(Preset::name).join(", ");
        return Err(format!("invalid value `{which}`; expected {presets} or a settings file (SETTINGS.ron)"));
    }
    let text = text(which.as_ref(), MAX_TEXT_BYTES)?;
    FrameSettings::from_ron(which, &text).map_err(|e| e.to_string())
}

/// Declares the standard frame with an imported target picture, and notes dropped effects. Returns the import.
///
/// # Errors
/// An error of a stage.
pub fn declare(frame: &mut Frame<World>, settings: &Settings, facts: &Facts) -> Result<Texture, StageError> {
    facts.note(frame.graph_mut());
    let desc = TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm);
    let picture = frame.graph_mut().import_texture("picture", desc, Entry::Undefined, Exit::Keep);
    standard(frame, settings, Target::from(picture))?;
    Ok(picture)
}

impl Planner for StandardFrame {
    fn name(&self) -> &str {
        &self.name
    }

    /// Returns the effects requested by the settings.
    fn features(&self) -> Vec<(String, bool)> {
        let asked = Effect::ALL.into_iter().filter(|effect| self.frame.settings.has(*effect));
        asked.map(|effect| (effect.name().to_owned(), true)).collect()
    }

    fn plan(&self, what_if: &WhatIf) -> Result<PlanData, String> {
        let mut options = what_if.options(Options { frame: FRAME, ..Options::default() });
        options.inline &= self.frame.inline;
        let mut frame = Frame::<World>::new();
        declare(&mut frame, &self.settings(&what_if.features, options.frame), &self.facts)
            .map_err(|e| e.to_string())?;
        let mut plan = Plan::new();
        compile(frame.graph(), &what_if.caps, &options, &mut Scratch::new(), &mut plan).map_err(|e| e.to_string())?;
        PlanData::of(&plan, &self.name).map_err(|e| e.to_string())
    }
}
