//! Facts about the displayed scene that panels and guards need while another thread works on its frame.

use super::loading::{EnvironmentSource, Lit, Loaded};
use framegraph_passes::light::shading::LightSettings;
use std::path::PathBuf;

/// Source and settings of image-based light.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct LightRequest {
    pub environment: EnvironmentSource,
    pub settings: LightSettings,
}

/// Displayed scene.
pub(super) struct Shown {
    /// Requested name: a built-in scene or a path.
    pub name: String,
    /// Selected material variant.
    pub variant: Option<String>,
    /// True if levels of detail exist or were requested.
    pub levels: bool,
    /// Light of the scene.
    pub light: LightRequest,
    /// Metered exposure value at ISO 100.
    pub metered_ev100: f32,
    /// Input files of the scene, without its environment.
    scene_files: Vec<PathBuf>,
}

impl Shown {
    /// Describes a loaded scene.
    pub fn of(loaded: &Loaded) -> Self {
        Self {
            name: loaded.name.clone(),
            variant: loaded.variant.clone(),
            levels: loaded.levels,
            light: LightRequest { environment: loaded.environment.clone(), settings: loaded.light_settings },
            metered_ev100: loaded.metered_ev100,
            scene_files: loaded.scene.files.clone(),
        }
    }

    /// Describes new light.
    pub fn relight(&mut self, lit: &Lit) {
        self.light = LightRequest { environment: lit.environment.clone(), settings: lit.settings };
        self.metered_ev100 = lit.metered_ev100;
    }

    /// Returns the input files of the scene and its light, which exports must not overwrite.
    pub fn files(&self) -> Vec<PathBuf> {
        let environment = if let EnvironmentSource::File(file) = &self.light.environment { Some(file) } else { None };
        self.scene_files.iter().chain(environment).cloned().collect()
    }
}
