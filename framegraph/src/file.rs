//! Graphs as files: the RON form of a graph, names to ids, plugins by name.
//!
//! A file lists resources, passes and exports; `docs/graph-format.md` documents every field. Passes are spelled out with
//! their accesses, or named by the kind of a [`Plugin`]. They may stand in any order: a plain name means the newest
//! version at that place of the file, `"hdr@scene"` the version that pass `scene` wrote, and the passes are declared in
//! the topological order nearest to the order of the file. So cycles and two writers of one version can be said, and are
//! refused.
//!
//! The text goes in as a string, since this crate does no I/O; every error names the path that the caller gave, line and
//! column, the reason and a hint, in one line.
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
//! assert_eq!(errors.to_string(), "frame.ron:13:23: there is no resource `glo`; did you mean `glow`?");
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
mod suggest;
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
pub use slot::{PluginSlot, Takes};
pub use value::ValueFault;
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

/// A graph file, parsed and not yet declared.
#[derive(Debug)]
pub struct GraphFile<'t> {
    source: Source<'t>,
    form: GraphForm,
    entries: Expanded,
    features: Vec<(String, bool)>,
}

impl<'t> GraphFile<'t> {
    /// Parses `text`, which includes no file; `path` is what errors call it.
    ///
    /// # Errors
    /// Text that is no RON, or not of this form or version.
    pub fn parse(path: &'t str, text: &'t str) -> Result<Self, FileErrors> {
        const NONE: &Included = &Included { files: Vec::new() };
        Self::parse_with(path, text, NONE)
    }

    /// As [`GraphFile::parse`], with the files that it includes: their features, templates, resources, passes and exports
    /// come before its own, and a feature that both name is set as here.
    ///
    /// # Errors
    /// As [`GraphFile::parse`], of any of the files; a file that includes others which are not there.
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
            let fault = ValueFault::Unreadable("the program that reads this file reads no others".into());
            return Err(source.value(first, fault).into());
        }
        form.append(own);
        let mut errors = FileErrors::default();
        let entries = expand::expand(source, &mut form, &mut errors);
        for (name, _) in form.features.0.iter().filter(|(name, _)| !features::is_name(&name.value)) {
            errors.push(|| source.value(name, ValueFault::FeatureName(name.value.clone())));
        }
        if let Some(frame) = form.frame.as_ref().filter(|f| f.value.0 == 0 || f.value.1 == 0) {
            errors.push(|| source.value(frame, ValueFault::EmptyFrame));
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

    /// What errors call the file.
    pub fn path(&self) -> &'t str {
        self.source.path
    }

    /// What the frame is called; empty when the file does not say.
    pub fn name(&self) -> &str {
        &self.form.name
    }

    /// The frame's size in texels, where the file says one.
    pub fn frame(&self) -> Option<[u32; 2]> {
        self.form.frame.as_ref().map(|f| [f.value.0, f.value.1])
    }

    /// The features with their settings in the file, in its order.
    pub fn features(&self) -> &[(String, bool)] {
        &self.features
    }

    /// The `expect` section, which means nothing to the graph; none when there is none.
    ///
    /// # Errors
    /// When it does not fit `T`, with the place in the file.
    pub fn expect<T: Deserialize<'t>>(&self) -> Result<Option<T>, FileErrors> {
        let parsed = self.form.expect.as_ref().map(|raw| self.source.parse(raw));
        parsed.transpose().map_err(FileErrors::from)
    }

    /// Declares the graph, with some features set otherwise than in the file. Plugins are unknown here.
    ///
    /// # Errors
    /// As [`GraphFile::declare`].
    pub fn graph(&self, switches: &[(String, bool)]) -> Result<Graph, FileErrors> {
        let mut graph = Graph::new();
        self.declare(switches, &Registry::new(), &mut graph)?;
        Ok(graph)
    }

    /// Declares the graph into `host`, with some features set otherwise than in the file.
    ///
    /// # Errors
    /// Everything that shows without compiling, a hundred listed at once: names, versions, cycles, values out of range,
    /// declarations that are refused. `host` is left with what is sound then.
    pub fn declare<H: Host + ?Sized>(
        &self,
        switches: &[(String, bool)],
        registry: &Registry<'_, H>,
        host: &mut H,
    ) -> Result<(), FileErrors> {
        self.declare_soundly(switches, registry, host).1.sorted().or(())
    }

    /// Declares and compiles; what is wrong with either is listed together.
    ///
    /// # Errors
    /// As [`GraphFile::declare`], and everything that compiling refuses. What needs the result of a pass that was refused is
    /// not judged. `plan` is empty then.
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
            // Who writes it may be among the passes that were left out. What is only counted may be of that kind too.
            listed.retain(|error| !matches!(error.reason, CompileReason::ReadUnwritten { .. }));
            more = 0;
        }
        let compiled = CompileErrors { listed, more };
        let FileErrors { listed, more } = self.explain(&compiled);
        listed.into_iter().for_each(|error| errors.push(|| error));
        errors.more += more;
        errors.sorted().or(())
    }

    /// Declares what is sound; the rest is in error.
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

    /// What compiling the declared graph refused, with places in the file instead of places in code.
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
            ResourceForm::Previous(_) => None,
        });
        names.find(|n| n.value == name).or_else(|| {
            let plugins = self.entries.passes.iter().filter(|p| matches!(p, PassForm::Plugin(_)));
            plugins.map(|p| p.head().name).find(|p| within(name, &p.value))
        })
    }
}

/// The form of one file.
fn parsed(source: Source<'_>) -> Result<GraphForm, FileErrors> {
    // Of another version, it may well be of another form.
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
    // Refuses a file without one.
    version::check_version(source, GRAPH_VERSION)?;
    Ok(form)
}

/// Whether a pass or resource of that name belongs to the effect.
fn within(name: &str, effect: &str) -> bool {
    name.strip_prefix(effect).is_some_and(|rest| rest.is_empty() || rest.starts_with('/'))
}
