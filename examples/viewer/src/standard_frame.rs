//! The standard frame of `framegraph_passes` as a source of plans: a preset or a file of settings, its effects as features.

use crate::plan_data::PlanData;
use crate::what_if::{Planner, WhatIf};
use framegraph::{Extent, Format, Options, Plan, Scratch, Target, TextureDesc, compile};
use framegraph_passes::{Effect, FrameSettings, Preset, Settings, World, standard};
use framegraph_scene::Scene;
use framegraph_wgpu::Frame;

/// The size of the frame when nobody says one, in texels.
const FRAME: [u32; 2] = [1920, 1080];

/// The standard frame of some settings, for a scene without glass.
#[derive(Clone, Debug)]
pub struct StandardFrame {
    name: String,
    frame: FrameSettings,
}

impl StandardFrame {
    /// The frame of a preset, or of a file of settings (`docs/settings.md`).
    ///
    /// # Errors
    /// No such preset, a file that cannot be read, and everything that is wrong with it.
    pub fn open(which: &str) -> Result<Self, String> {
        if let Some(preset) = Preset::from_name(which) {
            return Ok(Self { name: format!("standard frame, {which}"), frame: preset.frame() });
        }
        if !which.ends_with(".ron") {
            let presets = Preset::ALL.map(Preset::name).join(", ");
            return Err(format!("`{which}` is neither {presets} nor a file of settings (SETTINGS.ron)"));
        }
        let text = std::fs::read_to_string(which).map_err(|e| format!("{which}: cannot be read: {e}"))?;
        let frame = FrameSettings::from_ron(which, &text).map_err(|e| e.to_string())?;
        Ok(Self { name: format!("standard frame, {which}"), frame })
    }

    /// The settings with some effects switched off, for a frame of that size.
    fn settings(&self, features: &[(String, bool)], size_texels: [u32; 2]) -> Settings {
        let off = features.iter().filter(|(_, on)| !on).filter_map(|(name, _)| Effect::from_name(name));
        off.fold(self.frame.settings, Settings::without).for_scene(&Scene::default(), size_texels)
    }
}

impl Planner for StandardFrame {
    fn name(&self) -> &str {
        &self.name
    }

    /// The effects that the settings ask for.
    fn features(&self) -> Vec<(String, bool)> {
        let asked = Effect::ALL.into_iter().filter(|effect| self.frame.settings.has(*effect));
        asked.map(|effect| (effect.name().to_owned(), true)).collect()
    }

    fn plan(&self, what_if: &WhatIf) -> Result<PlanData, String> {
        let WhatIf { caps, frame, order, alias, cull, merge, inline, memoryless, features } = what_if.clone();
        let size = frame.unwrap_or(FRAME);
        let inline = inline && self.frame.inline;
        let options = Options { frame: size, order, alias, cull, merge, inline, memoryless, ..Options::default() };
        let settings = self.settings(&features, size);
        let mut frame = Frame::<World>::new();
        let desc = TextureDesc::new(Extent::FRAME, Format::Rgba8UnormSrgb);
        let picture = frame.graph_mut().texture("picture", desc);
        let io = standard(&mut frame, &settings, Target::from(picture)).map_err(|e| e.to_string())?;
        frame.graph_mut().export(io.output).map_err(|e| e.to_string())?;
        let mut plan = Plan::new();
        compile(frame.graph(), &caps, &options, &mut Scratch::new(), &mut plan).map_err(|e| e.to_string())?;
        PlanData::of(&plan, &self.name).map_err(|e| e.to_string())
    }
}
