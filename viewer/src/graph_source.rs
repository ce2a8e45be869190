//! Graph file as a source of plans: its text is kept and compiled for every what-if.

use crate::plan_data::PlanData;
use crate::what_if::{Planner, WhatIf};
use framegraph::file::{GraphFile, Included};
use framegraph::{Caps, Graph, Options, Plan, Scratch};
use program::input::{MAX_TEXT_BYTES, in_utf8};
use std::path::{Path, PathBuf};

/// Frame size in texels if neither the file nor the user sets one.
const FRAME: [u32; 2] = [1920, 1080];

/// Graph file with its included files.
#[derive(Debug)]
pub struct GraphSource {
    path: String,
    text: String,
    included: Included,
    features: Vec<(String, bool)>,
}

impl GraphSource {
    /// Reads a file and its includes, and checks the syntax.
    ///
    /// # Errors
    /// Unreadable files, and all errors of their form, one line each.
    pub fn open(path: &Path) -> Result<Self, String> {
        let text = text_of(path)?;
        let path = path.display().to_string();
        let included = Included::load(&path, &text, |path| text_of(Path::new(path))).map_err(|e| e.to_string())?;
        let file = GraphFile::parse_with(&path, &text, &included).map_err(|e| e.to_string())?;
        let features = file.features().to_vec();
        drop(file);
        Ok(Self { path, text, included, features })
    }

    /// Takes the text of a graph that includes no files and has no features, such as one from an engine.
    pub fn of_text(name: String, text: String) -> Self {
        Self { path: name, text, included: Included::default(), features: Vec::new() }
    }

    /// Returns the file and its includes, for watching.
    pub fn files(&self) -> Vec<PathBuf> {
        [self.path.as_str()].into_iter().chain(self.included.paths()).map(PathBuf::from).collect()
    }

    /// Returns `path:line` of the row that names a pass; empty if a template or plugin composes the name.
    fn place_of(&self, pass: &str) -> String {
        let named = format!("name: \"{pass}\"");
        let line =
            self.text.lines().position(|line| line.contains(&named) && !line.trim_start().starts_with("Texture("));
        line.map_or_else(String::new, |line| format!("{}:{}", self.path, line + 1))
    }
}

impl Planner for GraphSource {
    fn name(&self) -> &str {
        &self.path
    }

    fn features(&self) -> Vec<(String, bool)> {
        self.features.clone()
    }

    fn plan(&self, what_if: &WhatIf) -> Result<PlanData, String> {
        let file = GraphFile::parse_with(&self.path, &self.text, &self.included).map_err(|e| e.to_string())?;
        let options = what_if.options(Options { frame: file.frame().unwrap_or(FRAME), ..Options::default() });
        let (mut graph, mut plan) = (Graph::new(), Plan::new());
        let registry = framegraph_passes::frame::plugins::registry();
        file.plan(&what_if.features, &registry, &mut graph, (&what_if.caps, &options), &mut Scratch::new(), &mut plan)
            .map_err(|e| e.to_string())?;
        let mut data = PlanData::of(&plan, file.name()).map_err(|e| e.to_string())?;
        data.declared_at = data.form.passes.iter().map(|pass| self.place_of(&pass.name)).collect();
        Ok(data)
    }
}

/// Reads a device file.
///
/// # Errors
/// One line: the file cannot be read, or contains an error.
pub fn read_device(path: &Path) -> Result<Caps, String> {
    framegraph::file::caps(&path.display().to_string(), &text_of(path)?).map_err(|e| e.to_string())
}

/// Reads a text file.
fn text_of(path: &Path) -> Result<String, String> {
    let bytes = crate::file_bytes::bytes_of(path, MAX_TEXT_BYTES, &crate::job::Handle::default())?;
    in_utf8(path, bytes)
}
