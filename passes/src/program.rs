//! Shaders made ready for recorders: resolved once, with the bindings of each pair of entry points listed by name.
//!
//! What a pipeline binds is read from the shader, never written down a second time: a recorder offers bindings by the
//! names of the shader's variables, and a [`Program`] picks those that its entry points reach.

use framegraph_shaders::reflect::BindingKind;
use framegraph_shaders::{Feature, Features, Module, ShaderError, library};
use framegraph_wgpu::{Binding, Cx, Effect, RasterPipeline, RecordError, Shader};
use std::sync::{Arc, Mutex, PoisonError};
use wgpu::BindGroup;

/// One pair of entry points of one resolved shader.
#[derive(Clone, Debug)]
pub struct Program {
    name: String,
    text: String,
    /// Of name and text, so that pipelines are found without reading the text ([`Shader::hash`]).
    hash: u64,
    /// The vertex entry point.
    pub vertex: &'static str,
    /// The fragment entry point; none draws depth alone.
    pub fragment: Option<&'static str>,
    /// By group: binding numbers with the names of the variables.
    groups: Vec<Vec<(u32, String)>>,
    sampled: [u32; 2],
    overrides: Vec<String>,
}

impl Program {
    /// Resolves `module` with `features` and lists what the two entry points bind.
    ///
    /// # Errors
    /// When the shader is wrong or lacks an entry point, with file and line.
    pub fn new(
        module: &Module<'_>,
        features: &Features,
        vertex: &'static str,
        fragment: Option<&'static str>,
    ) -> Result<Self, ShaderError> {
        Self::with_effects(module, features, vertex, fragment, &[])
    }

    /// As [`Program::new`], with `effects` at the end of the fragment stage.
    ///
    /// # Errors
    /// As [`Program::new`], and when an effect is wrong.
    pub fn with_effects(
        module: &Module<'_>,
        features: &Features,
        vertex: &'static str,
        fragment: Option<&'static str>,
        effects: &[Effect],
    ) -> Result<Self, ShaderError> {
        let sources: Vec<_> =
            effects.iter().map(|e| framegraph_shaders::Effect { name: e.name, wgsl: e.wgsl }).collect();
        let shader = framegraph_shaders::resolve(module, features, &sources)?;
        let entries: Vec<&str> = [Some(vertex), fragment].into_iter().flatten().collect();
        let groups = shader.reflection.groups(&entries);
        let count = |is: fn(&BindingKind) -> bool| {
            groups.iter().flatten().filter(|slot| slot.fragment && is(&slot.binding.kind)).count() as u32
        };
        let sampled = [
            count(|kind| matches!(kind, BindingKind::Texture { .. })),
            count(|kind| matches!(kind, BindingKind::Sampler { .. })),
        ];
        let overrides = shader.reflection.overrides.iter().map(|o| o.name.clone()).collect();
        let named = |slots: Vec<framegraph_shaders::reflect::Slot>| {
            slots.into_iter().map(|s| (s.binding.binding, s.binding.name)).collect()
        };
        let variants: Vec<&str> = features.iter().map(Feature::name).chain(effects.iter().map(|e| e.name)).collect();
        let name = [vec![module.name()], variants].concat().join("+");
        let groups = groups.into_iter().map(named).collect();
        let text = shader.wgsl;
        let hash = Shader::new(&name, &text).hash();
        Ok(Self { name, text, hash, vertex, fragment, groups, sampled, overrides })
    }

    /// The shader as pipelines take it.
    pub fn shader(&self) -> Shader<'_> {
        Shader::hashed(&self.name, &self.text, self.hash)
    }

    /// Those of `constants` that the shader has: a surface without a lobe has none of its constants.
    pub fn constants<'a>(&self, constants: &[(&'a str, f64)]) -> Vec<(&'a str, f64)> {
        constants.iter().filter(|(name, _)| self.overrides.iter().any(|own| own == name)).copied().collect()
    }

    /// The bind group `index` of a pipeline of this program, with what `offer` returns for each variable's name.
    ///
    /// # Errors
    /// When a variable is not on offer.
    pub fn bind(
        &self,
        cx: &mut Cx<'_>,
        pipeline: &RasterPipeline,
        index: usize,
        mut offer: impl FnMut(&mut Cx<'_>, &str) -> Result<Option<Binding>, RecordError>,
    ) -> Result<BindGroup, RecordError> {
        let slots = self.groups.get(index).map_or(&[][..], Vec::as_slice);
        let mut bindings = Vec::with_capacity(slots.len());
        for (number, name) in slots {
            let Some(binding) = offer(cx, name)? else {
                let Self { name: shader, .. } = self;
                return Err(RecordError::custom(format!(
                    "shader `{shader}` binds `{name}`, which the pass does not offer"
                )));
            };
            bindings.push((*number, binding));
        }
        Ok(cx.bind_group(pipeline.group(index), &bindings))
    }

    /// The bind group `index` of a pipeline of this program, with what `known` returns for each binding's number.
    ///
    /// # Errors
    /// When a number is not known.
    pub fn bind_numbered(
        &self,
        cx: &mut Cx<'_>,
        pipeline: &RasterPipeline,
        index: usize,
        known: impl Fn(u32) -> Option<Binding>,
    ) -> Result<BindGroup, RecordError> {
        let numbers = self.groups.get(index).map_or(&[][..], Vec::as_slice);
        let mut rest = numbers.iter().map(|(number, _)| *number);
        self.bind(cx, pipeline, index, |_, _| Ok(rest.next().and_then(&known)))
    }

    /// How many textures and how many samplers the fragment stage binds.
    pub const fn sampled(&self) -> [u32; 2] {
        self.sampled
    }

    /// Whether the entry points reach anything in group `index`.
    pub fn has_group(&self, index: usize) -> bool {
        self.groups.get(index).is_some_and(|g| !g.is_empty())
    }
}

const SHADOW: Module<'_> = library::pass("pass/shadow.wgsl").unwrap();
const PREPASS: Module<'_> = library::pass("pass/prepass.wgsl").unwrap();
const FXAA: Module<'_> = library::pass("pass/fxaa.wgsl").unwrap();

/// Every program of the standard frame.
#[derive(Debug)]
pub struct Programs {
    /// Depth from the sun: opaque, masked.
    pub shadow: [Arc<Program>; 2],
    /// Depth from the camera: opaque, masked.
    pub prepass: [Arc<Program>; 2],
    /// Edge filter.
    pub fxaa: Program,
    /// Those that end with effects, as they were asked for.
    ending: Mutex<Vec<(Wanted, Arc<Program>)>>,
}

/// What tells programs apart that end with effects.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Wanted {
    module: Module<'static>,
    features: Features,
    fragment: &'static str,
    effects: Vec<Effect>,
}

impl Programs {
    /// Resolves those that are always the same.
    ///
    /// # Errors
    /// When a shader is wrong, with file and line.
    pub fn new() -> Result<Self, ShaderError> {
        let depth = |module| -> Result<[Arc<Program>; 2], ShaderError> {
            let opaque = Program::new(module, &Features::NONE, "vs_opaque", None)?;
            let mask = Program::new(module, &Features::NONE, "vs_mask", Some("fs_mask"))?;
            Ok([opaque, mask].map(Arc::new))
        };
        Ok(Self {
            shadow: depth(&SHADOW)?,
            prepass: depth(&PREPASS)?,
            fxaa: Program::new(&FXAA, &Features::NONE, "vs_main", Some("fs_main"))?,
            ending: Mutex::default(),
        })
    }

    /// The program of `vs_main` and `fragment` that ends with `effects`: resolved when it is first asked for, since which
    /// effects there are is the plan's choice.
    ///
    /// # Errors
    /// When a shader or an effect is wrong, with file and line.
    pub fn ending(
        &self,
        module: &Module<'static>,
        features: &Features,
        fragment: &'static str,
        effects: &[Effect],
    ) -> Result<Arc<Program>, RecordError> {
        // A panic in another thread leaves the list as it was.
        let mut known = self.ending.lock().unwrap_or_else(PoisonError::into_inner);
        let same = |w: &Wanted| {
            w.module == *module && w.features == *features && w.fragment == fragment && w.effects == effects
        };
        if let Some((_, program)) = known.iter().find(|(wanted, _)| same(wanted)) {
            return Ok(Arc::clone(program));
        }
        let program = Program::with_effects(module, features, "vs_main", Some(fragment), effects);
        let program = Arc::new(program.map_err(|error| RecordError::custom(error.to_string()))?);
        let wanted = Wanted { module: *module, features: features.clone(), fragment, effects: effects.to_vec() };
        known.push((wanted, Arc::clone(&program)));
        Ok(program)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::color::{COLOR, SKY};
    use crate::post::POST;

    fn names(program: &Program, group: usize) -> Vec<&str> {
        program.groups[group].iter().map(|(_, name)| name.as_str()).collect()
    }

    #[test]
    fn every_program_resolves_and_names_its_bindings() -> Result<(), Box<dyn std::error::Error>> {
        let programs = Programs::new()?;
        let map = Features::NONE.with(Feature::ENVIRONMENT_MAP);
        let color = |features: Features| programs.ending(&COLOR, &features, "fs_main", &[]);
        let (plain, shadowed) = (color(map.clone())?, color(map.with(Feature::SHADOWS))?);
        assert!(names(&shadowed, 0).contains(&"shadow_map") && !names(&plain, 0).contains(&"shadow_map"));
        assert_eq!(shadowed.name, "color+ENVIRONMENT_MAP+SHADOWS");
        assert!(!programs.shadow[0].has_group(1) && programs.shadow[1].has_group(1));
        for fragment in ["fs_environment", "fs_procedural", "fs_black"] {
            programs.ending(&SKY, &Features::NONE, fragment, &[])?;
        }
        Ok(())
    }

    #[test]
    fn effects_bring_their_bindings_and_are_resolved_once() -> Result<(), Box<dyn std::error::Error>> {
        let programs = Programs::new()?;
        let effects = [crate::effect::EXPOSE, crate::effect::TONE];
        let post = |effects: &[Effect]| programs.ending(&POST, &Features::NONE, "fs_main", effects);
        let first = post(&effects)?;
        assert_eq!((names(&first, 0), first.name.as_str()), (vec!["hdr", "exposing"], "post+expose+tone"));
        assert!(Arc::ptr_eq(&first, &post(&effects)?));
        assert!(!Arc::ptr_eq(&first, &post(&effects[..1])?));
        let color = programs.ending(&COLOR, &Features::NONE, "fs_main", &effects)?;
        assert!(names(&color, 0).contains(&"exposing") && names(&color, 0).contains(&"frame"));
        Ok(())
    }
}
