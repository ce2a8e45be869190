//! Shader programs for recorders: resolved once, with every variable and constant found by name.
//!
//! The bindings of a pipeline are read from its shader. A pass lists by name what it provides ([`Interface`]). When a
//! [`Program`] is made, each variable that its entry points use gets the index of its name in that list. Recording
//! then fills bind groups and constants by index. [`Programs`] caches programs by their description, also for passes
//! of other crates.
//!
//! ```
//! use framegraph_passes::program::{Interface, ProgramDesc, Programs};
//! use framegraph_shaders::Module;
//!
//! static INTERFACE: Interface = Interface { groups: &[&["picture"]], constants: &[] };
//! static GREY: Module<'static> = Module::new(
//!     "grey.wgsl",
//!     "import package::lib::fullscreen::fullscreen_position;
//!         import package::lib::luminance::luminance;
//!         @group(0) @binding(0) var picture: texture_2d<f32>;
//!         @vertex fn vs_main(@builtin(vertex_index) i: u32) -> @builtin(position) vec4<f32> {
//!             return fullscreen_position(i, 0.0);
//!         }
//!         @fragment fn fs_main(@builtin(position) at: vec4<f32>) -> @location(0) vec4<f32> {
//!             return vec4<f32>(luminance(textureLoad(picture, vec2<i32>(at.xy), 0).rgb));
//!         }",
//! );
//! let programs = Programs::new();
//! let grey = programs.get(&ProgramDesc::new(&GREY, &INTERFACE))?;
//! assert_eq!(grey.sampled(), [1, 0]);
//! # Ok::<(), framegraph_passes::PassError>(())
//! ```

pub mod full_screen;

use crate::error::PassError;
use framegraph_shaders::reflect::BindingKind;
use framegraph_shaders::{Feature, Features, Module, ShaderError};
use framegraph_wgpu::{Binding, Cx, Epilogue, RasterPipeline, Shader};
use std::hash::{DefaultHasher, Hash, Hasher};
use wgpu::BindGroup;

mod cache;

pub use cache::Programs;

/// Bindings and constants that a pass provides, by the names of shader variables and `override` constants. A shader
/// may use fewer, and no others.
///
/// Must be a `static`, since programs are identified by its address.
#[derive(Debug)]
pub struct Interface {
    /// Names of the provided variables, for each bind group in order.
    pub groups: &'static [&'static [&'static str]],
    /// Names of the provided constants.
    pub constants: &'static [&'static str],
}

/// Bind group to which effects add their variables.
const GROUP_EFFECTS: usize = 0;

/// Empty epilogue, for shaders without effects.
static NO_EPILOGUE: Epilogue = Epilogue { effects: Vec::new(), constants: Vec::new(), bindings: Vec::new() };

static NO_FEATURES: Features = Features::NONE;

/// Description of a program: entry points of a shader with features, and the interface of its pass.
#[derive(Clone, Copy, Debug)]
pub struct ProgramDesc<'a> {
    /// The shader: an embedded pass ([`library::pass`](framegraph_shaders::library::pass)), or one of the
    /// application, which may import the library. Must be a `static`, since programs are identified by its address.
    pub shader: &'static Module<'static>,
    /// Features compiled into the shader.
    pub features: &'a Features,
    /// Vertex entry point.
    pub vertex: &'static str,
    /// Fragment entry point; `None` draws depth alone.
    pub fragment: Option<&'static str>,
    /// Bindings and constants that the pass provides.
    pub interface: &'static Interface,
    /// Effects at the end of the fragment stage, for shaders that call `package::interface::epilogue`. Their
    /// constants and bindings follow those of the interface, in the epilogue's order.
    pub epilogue: &'a Epilogue,
}

impl ProgramDesc<'_> {
    /// Describes the entry points `vs_main` and `fs_main`, without features and effects.
    pub fn new(shader: &'static Module<'static>, interface: &'static Interface) -> Self {
        let (vertex, fragment) = ("vs_main", Some("fs_main"));
        Self { shader, features: &NO_FEATURES, vertex, fragment, interface, epilogue: &NO_EPILOGUE }
    }

    /// Returns the name for messages: the shader, its features and its effects.
    fn name(&self) -> String {
        let variants = self.features.iter().map(Feature::name).chain(self.epilogue.effects.iter().map(|e| e.name));
        [self.shader.name()].into_iter().chain(variants).collect::<Vec<_>>().join("+")
    }

    fn resolve(&self) -> Result<framegraph_shaders::Shader, ShaderError> {
        let effects = self.epilogue.effects.iter();
        let effects: Vec<_> = effects.map(|e| framegraph_shaders::Effect { name: e.name, wgsl: e.wgsl }).collect();
        framegraph_shaders::resolve(self.shader, self.features, &effects)
    }

    /// Key of a program. Shaders, interfaces, names and texts are static, so their addresses identify them. Equal
    /// descriptions at two addresses give two equivalent programs.
    fn addresses(&self) -> impl Iterator<Item = (usize, usize)> {
        let Epilogue { effects, constants, bindings } = self.epilogue;
        let entries = [self.vertex, self.fragment.unwrap_or_default()];
        let effects = effects.iter().flat_map(|e| [e.name, e.wgsl]);
        let names = constants.iter().map(|(name, _)| name.text()).chain(bindings.iter().map(|(name, _)| name.text()));
        let address = |text: &'static str| (text.as_ptr() as usize, text.len());
        let shader = (std::ptr::from_ref(self.shader) as usize, 0);
        let interface = (std::ptr::from_ref(self.interface) as usize, self.features.iter().count());
        let features = self.features.iter().map(Feature::name);
        let texts = features.chain(entries).chain(effects).chain(names);
        [shader, interface].into_iter().chain(texts.map(address))
    }

    fn hash(&self) -> u64 {
        let mut state = DefaultHasher::new();
        self.addresses().for_each(|address| address.hash(&mut state));
        state.finish()
    }
}

/// Variable of a bind group, and the source of its binding.
#[derive(Clone, Debug)]
struct Slot {
    /// Its `@binding`.
    number: u32,
    /// Index of its name in the pass's interface, followed by the epilogue's bindings.
    provided: usize,
    name: String,
}

/// Entry points of a resolved shader, matched with the interface of a pass.
#[derive(Clone, Debug)]
pub struct Program {
    name: String,
    text: String,
    /// Hash of name and text, so that finding pipelines does not read the text ([`Shader::hash`]).
    hash: u64,
    /// Vertex entry point.
    pub vertex: &'static str,
    /// Fragment entry point; `None` draws depth alone.
    pub fragment: Option<&'static str>,
    /// Variables by bind group.
    groups: Vec<Vec<Slot>>,
    /// Constants of the shader, each with the index of its value among the provided ones.
    constants: Vec<(usize, &'static str)>,
    sampled: [u32; 2],
}

impl Program {
    /// Resolves the shader and finds each of its variables among those that the pass provides.
    ///
    /// # Errors
    /// Fails with file and line if the shader or an effect is invalid, and if the shader uses a variable that is not
    /// provided.
    pub fn new(desc: &ProgramDesc<'_>) -> Result<Self, PassError> {
        let ProgramDesc { vertex, fragment, interface, epilogue, .. } = *desc;
        let name = desc.name();
        let shader = desc.resolve()?;
        let entries: Vec<&str> = [Some(vertex), fragment].into_iter().flatten().collect();
        let reached = shader.reflection.groups(&entries);
        let count = |is: fn(&BindingKind) -> bool| {
            reached.iter().flatten().filter(|slot| slot.fragment && is(&slot.binding.kind)).count() as u32
        };
        let sampled = [
            count(|kind| matches!(kind, BindingKind::Texture { .. })),
            count(|kind| matches!(kind, BindingKind::Sampler { .. })),
        ];
        let mut groups = Vec::with_capacity(reached.len());
        for (group, slots) in reached.into_iter().enumerate() {
            let own = interface.groups.get(group).copied().unwrap_or_default();
            let effects = if group == GROUP_EFFECTS { epilogue.bindings.as_slice() } else { &[] };
            let slot = |framegraph_shaders::reflect::Slot { binding, .. }| {
                let named = own.iter().position(|own| *own == binding.name);
                let of_effect = || effects.iter().position(|(name, _)| name.text() == binding.name);
                let provided = named.or_else(|| Some(own.len() + of_effect()?));
                let provided = provided.ok_or_else(|| PassError::NotProvided {
                    shader: name.clone(),
                    variable: binding.name.clone(),
                    group: group as u32,
                })?;
                Ok::<_, PassError>(Slot { number: binding.binding, provided, name: binding.name })
            };
            groups.push(slots.into_iter().map(slot).collect::<Result<Vec<_>, _>>()?);
        }
        let overrides = &shader.reflection.overrides;
        let provided =
            interface.constants.iter().copied().chain(epilogue.constants.iter().map(|(name, _)| name.text()));
        let constants = provided.enumerate().filter(|(_, name)| overrides.iter().any(|o| o.name == *name)).collect();
        let text = shader.wgsl;
        let hash = Shader::new(&name, &text).hash();
        Ok(Self { name, text, hash, vertex, fragment, groups, constants, sampled })
    }

    /// Returns the name for messages: the shader with its features and effects, joined by `+`.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns the shader for pipelines.
    pub fn shader(&self) -> Shader<'_> {
        Shader::hashed(&self.name, &self.text, self.hash)
    }

    /// Returns the constants of the shader with their `values`: those of the interface in order, then those of the
    /// epilogue.
    pub fn constants<'a>(&'a self, values: &'a [f64]) -> Vec<(&'a str, f64)> {
        self.constants.iter().filter_map(|(index, name)| Some((*name, *values.get(*index)?))).collect()
    }

    /// Fills the bind group `group` of a pipeline of this program. `binding` gets an index into the interface's
    /// group, followed by the epilogue's bindings.
    ///
    /// # Errors
    /// Fails if `binding` returns nothing for a variable that the shader uses.
    pub fn bind(
        &self,
        cx: &mut Cx<'_>,
        pipeline: &RasterPipeline,
        group: usize,
        binding: impl Fn(usize) -> Option<Binding>,
    ) -> Result<BindGroup, PassError> {
        let slots = self.groups.get(group).map_or(&[][..], Vec::as_slice);
        let bindings: Result<Vec<_>, _> = slots
            .iter()
            .map(|Slot { number, provided, name }| match binding(*provided) {
                Some(binding) => Ok((*number, binding)),
                None => Err(PassError::Unbound { shader: self.name.clone(), variable: name.clone() }),
            })
            .collect();
        Ok(cx.bind_group(pipeline.group(group), &bindings?))
    }

    /// Returns the number of textures and samplers that the fragment stage binds.
    pub const fn sampled(&self) -> [u32; 2] {
        self.sampled
    }

    /// Returns true if the entry points use the variable with index `provided` of the interface's group.
    pub fn binds(&self, group: usize, provided: usize) -> bool {
        self.groups.get(group).is_some_and(|slots| slots.iter().any(|slot| slot.provided == provided))
    }

    /// Returns true if the entry points use bind group `group`.
    pub fn has_group(&self, group: usize) -> bool {
        self.groups.get(group).is_some_and(|g| !g.is_empty())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu_scene::upload::MATERIAL_BINDINGS;
    use framegraph_shaders::library;
    use framegraph_wgpu::SettingName;
    use std::sync::Arc;

    static COLOR_SHADER: Module<'static> = library::pass("pass/color.wgsl").unwrap();
    static POST_SHADER: Module<'static> = library::pass("pass/post.wgsl").unwrap();
    static FXAA_SHADER: Module<'static> = library::pass("pass/fxaa.wgsl").unwrap();

    static POST: Interface = Interface { groups: &[&["hdr"]], constants: &[] };

    /// In another order than the shader's, with names that the shader lacks.
    static COLOR: Interface = Interface {
        groups: &[
            &[
                "specular_map",
                "no_such_texture",
                "shadow_sampler",
                "shadow_map",
                "shadow",
                "local_maps",
                "light_sampler",
                "lights",
                "frame",
                "environment_sampler",
                "environment_map",
                "dfg_table",
            ],
            &MATERIAL_BINDINGS,
            &["objects", "origins"],
        ],
        constants: &["NO_SUCH_CONSTANT", "SH_BANDS", "ALPHA_MODE"],
    };

    fn names(program: &Program, group: usize) -> Vec<&str> {
        program.groups[group].iter().map(|slot| slot.name.as_str()).collect()
    }

    #[test]
    fn variables_and_constants_get_the_indices_of_their_names() -> Result<(), PassError> {
        let programs = Programs::new();
        let map = Features::NONE.with(Feature::ENVIRONMENT_MAP);
        let color =
            |features: &Features| programs.get(&ProgramDesc { features, ..ProgramDesc::new(&COLOR_SHADER, &COLOR) });
        let (plain, shadowed) = (color(&map)?, color(&map.clone().with(Feature::SHADOWS))?);
        assert!(names(&shadowed, 0).contains(&"shadow_map") && !names(&plain, 0).contains(&"shadow_map"));
        assert_eq!(shadowed.name, "color+ENVIRONMENT_MAP+SHADOWS");
        for (group, provided) in COLOR.groups.iter().enumerate() {
            assert!(shadowed.groups[group].iter().all(|slot| provided[slot.provided] == slot.name), "group {group}");
        }
        assert_eq!(plain.constants(&[1.0, 2.0, 3.0]), [("SH_BANDS", 2.0), ("ALPHA_MODE", 3.0)]);
        Ok(())
    }

    #[test]
    fn effects_bring_their_bindings_and_are_resolved_once() -> Result<(), Box<dyn std::error::Error>> {
        let gpu = framegraph_wgpu::Gpu::noop()?;
        let size = wgpu::BufferDescriptor {
            label: None,
            size: 256,
            usage: wgpu::BufferUsages::UNIFORM,
            mapped_at_creation: false,
        };
        let buffer: Binding = gpu.device.create_buffer(&size).into();
        let epilogue = Epilogue {
            effects: vec![crate::effects::post::pixel_effects::EXPOSE, crate::effects::post::pixel_effects::TONE],
            constants: vec![(SettingName::new("TONE_MAP"), 2.0)],
            bindings: vec![(SettingName::new("exposing"), buffer)],
        };
        let programs = Programs::new();
        let post =
            |epilogue: &Epilogue| programs.get(&ProgramDesc { epilogue, ..ProgramDesc::new(&POST_SHADER, &POST) });
        let first = post(&epilogue)?;
        assert_eq!((names(&first, 0), first.name.as_str()), (vec!["hdr", "exposing"], "post+expose+tone"));
        assert_eq!(first.groups[0].iter().map(|slot| slot.provided).collect::<Vec<_>>(), [0, 1]);
        assert_eq!(first.constants(&[2.0]), [("TONE_MAP", 2.0)]);
        assert!(Arc::ptr_eq(&first, &post(&epilogue.clone())?));
        let mut shorter = epilogue.clone();
        shorter.effects.truncate(1);
        assert!(!Arc::ptr_eq(&first, &post(&shorter)?));
        let color = ProgramDesc { epilogue: &epilogue, ..ProgramDesc::new(&COLOR_SHADER, &COLOR) };
        let color = programs.get(&color)?;
        assert!(names(&color, 0).contains(&"exposing") && names(&color, 0).contains(&"frame"));
        Ok(())
    }

    #[test]
    fn a_variable_that_is_not_provided_is_named() {
        static NOTHING: Interface = Interface { groups: &[], constants: &[] };
        let told = Programs::new().get(&ProgramDesc::new(&FXAA_SHADER, &NOTHING)).err();
        let expected = PassError::NotProvided { shader: "fxaa".into(), variable: "fxaa".into(), group: 0 };
        assert_eq!(told, Some(expected));
    }
}
