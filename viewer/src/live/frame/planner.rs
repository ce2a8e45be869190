//! Planner of what-if questions about the live frame.

use super::Running;
use crate::live::capture::Document;
use crate::live::loading::Loaded;
use crate::standard_frame::StandardFrame;
use crate::what_if::WhatIf;
use framegraph::Options;
use framegraph_passes::FrameSettings;
use framegraph_scene::Scene;
use framegraph_wgpu::debug::{Mode, Modes};
use std::sync::Arc;

impl Running {
    /// Returns a planner of the last drawn frame, and its unmodified what-if.
    pub fn planner(&self, document: &Document, modes: &Modes) -> (Arc<StandardFrame>, WhatIf) {
        let Loaded { name, scene, .. } = &self.loaded;
        // Parts of the scene that settings depend on.
        let (materials, instances) = (scene.materials.clone(), scene.instances.clone());
        let needs = Scene { materials, instances, ..Scene::default() };
        let frame = FrameSettings { settings: self.requested, ..document.frame };
        let planner = StandardFrame::live(name, frame, Arc::new(needs), self.facts.clone());
        let options = self.key.map_or_else(Options::default, |(_, options)| options);
        let features = crate::what_if::Planner::features(&planner);
        let no_cull = modes.0.contains(&Mode::NoCull);
        let cull = options.cull && !no_cull;
        let question = WhatIf { cull, features, ..WhatIf::of(self.screen.gpu.caps(), &options) };
        (Arc::new(planner), question)
    }
}
