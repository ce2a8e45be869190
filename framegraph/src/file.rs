//! Graphs as RON files.
//!
//! A file lists resources, passes and exports; `docs/reference/graph-format.md` documents every field. A pass lists its accesses,
//! or refers to a [`Plugin`] by kind. Passes can be listed in any order.
//!
//! A plain name refers to the newest version of a resource at that position of the file. `"hdr@scene"` refers to the
//! version written by pass `scene`. Passes are declared in the topological order closest to the order of the file.
//! Cycles, and two writers of one version, are errors.
//!
//! This crate performs no I/O, so the text is passed as a string. Every error is one line with the path given by the
//! caller, line, column, reason and hint.
//!
//! ```
//! use framegraph::file::GraphFile;
//!
//! let text = r#"(
//!     version: 1,
//!     features: {"bloom": false},
//!     resources: [
//!         Texture(name: "screen", format: Rgba8UnormSrgb, kind: Import(entry: Undefined, exit: Keep)),
//!         Texture(name: "hdr", format: Rgba16Float),
//!         Texture(name: "glow", format: Rg11b10Ufloat, size: Scale(num: 1, den: 2), when: "bloom"),
//!     ],
//!     passes: [
//!         Raster(name: "scene", accesses: [Color(to: "hdr", intent: ClearColor(0, 0, 0, 1))]),
//!         Raster(name: "bloom", when: "bloom", accesses: [
//!             Sampled(of: "hdr"),
//!             Color(to: "glow", intent: Overwrite),
//!         ]),
//!         Raster(name: "tonemap", accesses: [
//!             Sampled(of: "hdr"),
//!             Sampled(of: "glow", when: "bloom"),
//!             Color(to: "screen", intent: Overwrite),
//!         ]),
//!     ],
//! )"#;
//! let file = GraphFile::parse("frame.ron", text)?;
//! assert_eq!(file.graph(&[])?.passes().len(), 2);
//! assert_eq!(file.graph(&[("bloom".into(), true)])?.passes().len(), 3);
//!
//! let typo = text.replace("Color(to: \"glow\"", "Color(to: \"glo\"");
//! let errors = GraphFile::parse("frame.ron", &typo)?.graph(&[("bloom".into(), true)]).unwrap_err();
//! assert_eq!(errors.to_string(), "frame.ron:13:23: unknown resource `glo`; did you mean `glow`?");
//! # Ok::<(), framegraph::file::FileErrors>(())
//! ```

mod access_form;
mod caps;
mod declare;
mod document;
mod effect;
mod entries;
mod error;
mod expand;
mod features;
mod form;
mod include;
mod names;
mod params;
mod plugin;
mod select;
mod selected;
mod shape;
mod slot;
mod spanned;
mod syntax;
mod value;
mod version;
mod versions;
mod work;
mod write;

pub use caps::{CAPS_VERSION, caps};
pub use document::{document, to_document};
pub use error::{FileError, FileErrors, FileReason};
pub use include::Included;
pub use plugin::{Call, Host, Plugin, PluginError, Registry};
pub use slot::{PluginSlot, SlotType};
pub use value::ValueReason;
pub use version::GRAPH_VERSION;
pub use write::to_ron;

use crate::caps::Caps;
use crate::compile::{CompileErrors, CompileReason, Scratch, compile};
use crate::graph::Graph;
use crate::options::Options;
use crate::plan::Plan;
use declare::Declaring;
use expand::Expanded;
use features::Features;
use form::{GraphForm, PassForm, ResourceForm};
use selected::Selected;
use serde::Deserialize;
use spanned::{Source, Spanned};

/// A parsed graph file. Nothing is declared yet.
#[derive(Debug)]
pub struct GraphFile<'t> {
    source: Source<'t>,
    form: GraphForm,
    entries: Expanded,
    features: Vec<(String, bool)>,
}

impl<'t> GraphFile<'t> {
    /// Parses `text`, which must not include other files. `path` is used in errors.
    ///
    /// # Errors
    /// Returns an error if `text` is not valid RON, or has an unsupported form or version.
    pub fn parse(path: &'t str, text: &'t str) -> Result<Self, FileErrors> {
        const NONE: &Included = &Included { files: Vec::new() };
        Self::parse_with(path, text, NONE)
    }

    /// Parses `text` together with the files it includes.
    ///
    /// Features, templates, resources, passes and exports of included files come before those of `text`. If both set a
    /// feature, the setting of `text` wins.
    ///
    /// # Errors
    /// Returns the errors of [`GraphFile::parse`] for any of the files, and an error if an included file is missing.
    pub fn parse_with(path: &'t str, text: &'t str, included: &'t Included) -> Result<Self, FileErrors> {
        let source = Source { path, text: version::without_mark(text), included: &included.files };
        let mut form = GraphForm::default();
        for (path, text) in &included.files {
            let file = Source { path, text: version::without_mark(text), included: &[] };
            form.append(parsed(file)?);
        }
        let own = parsed(source)?;
        if included.files.is_empty()
            && let Some(first) = own.include.first()
        {
            let fault = ValueReason::Unreadable("this program does not support includes".into());
            return Err(source.value(first, fault).into());
        }
        form.append(own);
        let mut errors = FileErrors::default();
        let entries = expand::expand(source, &mut form, &mut errors);
        for (name, _) in form.features.0.iter().filter(|(name, _)| !features::is_name(&name.value)) {
            errors.push(|| source.value(name, ValueReason::FeatureName(name.value.clone())));
        }
        if let Some(frame) = form.frame.as_ref().filter(|f| f.value.0 == 0 || f.value.1 == 0) {
            errors.push(|| source.value(frame, ValueReason::EmptyFrame));
        }
        let mut features: Vec<(String, bool)> = Vec::new();
        for (name, on) in &form.features.0 {
            match features.iter_mut().find(|(known, _)| *known == name.value) {
                Some(known) => known.1 = *on,
                None => features.push((name.value.clone(), *on)),
            }
        }
        errors.sorted().or(Self { source, form, entries, features })
    }

    /// Path of the file, as used in errors.
    pub fn path(&self) -> &'t str {
        self.source.path
    }

    /// Name of the frame; empty if the file does not set one.
    pub fn name(&self) -> &str {
        &self.form.name
    }

    /// Size of the frame in texels, if the file sets one.
    pub fn frame(&self) -> Option<[u32; 2]> {
        self.form.frame.as_ref().map(|f| [f.value.0, f.value.1])
    }

    /// The features and their settings, in the order of the file.
    pub fn features(&self) -> &[(String, bool)] {
        &self.features
    }

    /// Returns the `expect` section, which has no influence on the graph; `None` if the file has none.
    ///
    /// # Errors
    /// Returns an error with the position in the file if the section does not fit `T`.
    pub fn expect<T: Deserialize<'t>>(&self) -> Result<Option<T>, FileErrors> {
        let parsed = self.form.expect.as_ref().map(|raw| self.source.parse(raw));
        parsed.transpose().map_err(FileErrors::from)
    }

    /// Declares the graph. `switches` override the settings of features. Plugins are not available.
    ///
    /// # Errors
    /// Returns the errors of [`GraphFile::declare`].
    pub fn graph(&self, switches: &[(String, bool)]) -> Result<Graph, FileErrors> {
        let mut graph = Graph::new();
        self.declare(switches, &Registry::new(), &mut graph)?;
        Ok(graph)
    }

    /// Declares the graph into `host`. `switches` override the settings of features.
    ///
    /// # Errors
    /// Returns all errors that can be found without compiling, at most a hundred of them in detail: names, versions,
    /// cycles, values out of range and invalid declarations. `host` then contains the valid declarations.
    pub fn declare<H: Host + ?Sized>(
        &self,
        switches: &[(String, bool)],
        registry: &Registry<'_, H>,
        host: &mut H,
    ) -> Result<(), FileErrors> {
        self.declare_soundly(switches, registry, host).1.sorted().or(())
    }

    /// Declares and compiles the graph. Errors of both are listed together.
    ///
    /// # Errors
    /// Returns the errors of [`GraphFile::declare`] and of compiling. Passes that depend on an invalid pass are not
    /// checked. `plan` is empty in case of an error.
    pub fn plan<H: Host + ?Sized>(
        &self,
        switches: &[(String, bool)],
        registry: &Registry<'_, H>,
        host: &mut H,
        (caps, options): (&Caps, &Options),
        scratch: &mut Scratch,
        plan: &mut Plan,
    ) -> Result<(), FileErrors> {
        let (selected, mut errors) = self.declare_soundly(switches, registry, host);
        let Err(compiled) = compile(host.graph(), caps, options, scratch, plan) else {
            return errors.sorted().or(()).inspect_err(|_| *plan = Plan::new());
        };
        let declared = errors.count() == 0;
        let CompileErrors { mut listed, mut more } = compiled;
        if !declared && selected.blind {
            // The writer may be one of the omitted passes. Errors that are only counted may be of that kind too.
            listed.retain(|error| !matches!(error.reason, CompileReason::ReadUnwritten { .. }));
            more = 0;
        }
        let compiled = CompileErrors { listed, more };
        let FileErrors { listed, more } = self.explain(&compiled);
        listed.into_iter().for_each(|error| errors.push(|| error));
        errors.more += more;
        errors.sorted().or(())
    }

    /// Declares everything that is valid and collects errors.
    fn declare_soundly<H: Host + ?Sized>(
        &self,
        switches: &[(String, bool)],
        registry: &Registry<'_, H>,
        host: &mut H,
    ) -> (Selected<'_>, FileErrors) {
        let source = self.source;
        let mut features = Features::new(self.features.clone());
        let mut errors = FileErrors::default();
        for (name, on) in switches {
            if !features.switch(name, *on) {
                errors.push(|| source.error_at((1, 1), features.unknown(name)));
            }
        }
        let slots_of = |kind: &str| registry.slots(kind);
        let mut selected = select::select(source, &self.entries, &features, &slots_of, &mut errors);
        for pass in 0..selected.passes.len() {
            let (found, row) = (errors.count(), &selected.passes[pass]);
            if let PassForm::Plugin(form) = row.form {
                Declaring { source, features: &features, selected: &selected }.check(row, form, registry, &mut errors);
            }
            if row.failed || errors.count() != found {
                selected.fail(pass);
            }
        }
        let order = versions::order(source, &mut selected, &mut errors);
        declare::all(source, &features, &mut selected, &order, registry, host, &mut errors);
        (selected, errors)
    }

    /// Replaces source locations in errors of compiling by positions in the file.
    pub fn explain(&self, errors: &CompileErrors) -> FileErrors {
        let explained = errors.listed.iter().map(|error| {
            let (pass, resource) = match &error.reason {
                CompileReason::Declare(inner) => (&inner.pass, &inner.resource),
                _ => (&error.pass, &error.resource),
            };
            let pass = pass.as_ref().map(|p| p.name.clone());
            let resource = resource.as_ref().map(|r| r.name.clone());
            let of_pass = pass.as_ref().and_then(|name| self.pass_named(name));
            let at = of_pass.or_else(|| resource.as_ref().and_then(|name| self.resource_named(name)));
            let reason = FileReason::Compile(error.reason.clone());
            let error = match at {
                Some(at) => self.source.error(at, reason),
                None => self.source.error_at((1, 1), reason),
            };
            FileError { pass, resource, ..error }
        });
        FileErrors { listed: explained.collect(), more: errors.more }
    }

    fn pass_named(&self, name: &str) -> Option<&Spanned<String>> {
        let named = |pass: &&PassForm| match pass {
            PassForm::Plugin(p) => within(name, &p.name.value),
            _ => pass.head().name.value == name,
        };
        self.entries.passes.iter().find(named).map(|pass| pass.head().name)
    }

    fn resource_named(&self, name: &str) -> Option<&Spanned<String>> {
        let mut names = self.entries.resources.iter().filter_map(|resource| match resource {
            ResourceForm::Texture(t) => Some(&t.name),
            ResourceForm::Buffer(b) => Some(&b.name),
            ResourceForm::Previous(_) | ResourceForm::MayAlias(_) => None,
        });
        names.find(|n| n.value == name).or_else(|| {
            let plugins = self.entries.passes.iter().filter(|p| matches!(p, PassForm::Plugin(_)));
            plugins.map(|p| p.head().name).find(|p| within(name, &p.value))
        })
    }
}

/// Parses one file.
fn parsed(source: Source<'_>) -> Result<GraphForm, FileErrors> {
    // Check the version first, because another version may have another form.
    let form: GraphForm = match syntax::options().from_str(source.text) {
        Ok(form) => form,
        Err(error) => {
            version::check_version(source, GRAPH_VERSION)?;
            return Err(source.refused(&error).into());
        }
    };
    if let Some(version) = &form.version {
        version::known(source, version, GRAPH_VERSION)?;
        return Ok(form);
    }
    // Reports a missing version.
    version::check_version(source, GRAPH_VERSION)?;
    Ok(form)
}

/// Returns `true` if a pass or resource of this name belongs to the effect.
fn within(name: &str, effect: &str) -> bool {
    name.strip_prefix(effect).is_some_and(|rest| rest.is_empty() || rest.starts_with('/'))
}
