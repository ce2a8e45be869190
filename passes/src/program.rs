//! Shaders made ready for recorders: resolved once, with the bindings of each pair of entry points listed by name.
//!
//! What a pipeline binds is read from the shader, never written down a second time: a recorder offers bindings by the
//! names of the shader's variables, and a [`Program`] picks those that its entry points reach.

use renderer::wgpu::{Binding, Cx, RasterPipeline, RecordError, Shader};
use shaders::{Feature, Features, ShaderError, ShaderId};
use wgpu::BindGroup;

/// One pair of entry points of one resolved shader.
#[derive(Clone, Debug)]
pub struct Program {
    name: String,
    text: String,
    /// The vertex entry point.
    pub vertex: &'static str,
    /// The fragment entry point; none draws depth alone.
    pub fragment: Option<&'static str>,
    /// By group: binding numbers with the names of the variables.
    groups: Vec<Vec<(u32, String)>>,
}

impl Program {
    /// Resolves the pass `id` with `features` and lists what the two entry points bind.
    ///
    /// # Errors
    /// When the shader is wrong or lacks an entry point, with file and line.
    pub fn new(
        id: ShaderId,
        features: Features,
        vertex: &'static str,
        fragment: Option<&'static str>,
    ) -> Result<Self, ShaderError> {
        let shader = shaders::resolve(id, features)?;
        let entries: Vec<&str> = [Some(vertex), fragment].into_iter().flatten().collect();
        let groups = shader.reflection.groups(&entries);
        let named = |slots: Vec<shaders::reflect::Slot>| {
            slots.into_iter().map(|s| (s.binding.binding, s.binding.name)).collect()
        };
        let variants: Vec<&str> = features.iter().map(Feature::name).collect();
        let name = [vec![id.name()], variants].concat().join("+");
        Ok(Self { name, text: shader.wgsl, vertex, fragment, groups: groups.into_iter().map(named).collect() })
    }

    /// The shader as pipelines take it.
    pub fn shader(&self) -> Shader<'_> {
        Shader::new(&self.name, &self.text)
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

    /// The bind group `index` of a pipeline of this program, with those of `known` that it binds, by number.
    ///
    /// # Errors
    /// When a number is not among them.
    pub fn bind_known(
        &self,
        cx: &mut Cx<'_>,
        pipeline: &RasterPipeline,
        index: usize,
        known: &[(u32, Binding)],
    ) -> Result<BindGroup, RecordError> {
        let numbers = self.groups.get(index).map_or(&[][..], Vec::as_slice);
        let mut rest = numbers.iter().map(|(number, _)| *number);
        self.bind(cx, pipeline, index, |_, _| {
            let number = rest.next();
            Ok(known.iter().find(|(n, _)| Some(*n) == number).map(|(_, binding)| binding.clone()))
        })
    }

    /// Whether the entry points reach anything in group `index`.
    pub fn has_group(&self, index: usize) -> bool {
        self.groups.get(index).is_some_and(|g| !g.is_empty())
    }
}

/// Every program of the standard frame.
#[derive(Clone, Debug)]
pub struct Programs {
    /// Depth from the sun: opaque, masked.
    pub shadow: [Program; 2],
    /// Depth from the camera: opaque, masked.
    pub prepass: [Program; 2],
    /// Lit surfaces: without and with shadows.
    pub color: [Program; 2],
    /// The environment map as background.
    pub sky_map: Program,
    /// The clear sky as background.
    pub sky_clear: Program,
    /// Exposure, tone curve, dither.
    pub post: Program,
    /// Edge filter.
    pub fxaa: Program,
}

impl Programs {
    /// Resolves all of them.
    ///
    /// # Errors
    /// When a shader is wrong, with file and line.
    pub fn new() -> Result<Self, ShaderError> {
        let depth = |id| -> Result<[Program; 2], ShaderError> {
            let opaque = Program::new(id, Features::NONE, "vs_opaque", None)?;
            Ok([opaque, Program::new(id, Features::NONE, "vs_mask", Some("fs_mask"))?])
        };
        let full = |id, features, fragment| Program::new(id, features, "vs_main", Some(fragment));
        let map = Features::NONE.with(Feature::EnvironmentMap);
        Ok(Self {
            shadow: depth(ShaderId::Shadow)?,
            prepass: depth(ShaderId::Prepass)?,
            color: [
                full(ShaderId::Color, map, "fs_main")?,
                full(ShaderId::Color, map.with(Feature::Shadows), "fs_main")?,
            ],
            sky_map: full(ShaderId::Sky, Features::NONE, "fs_environment")?,
            sky_clear: full(ShaderId::Sky, Features::NONE, "fs_procedural")?,
            post: full(ShaderId::Post, Features::NONE, "fs_main")?,
            fxaa: full(ShaderId::Fxaa, Features::NONE, "fs_main")?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_program_resolves_and_names_its_bindings() -> Result<(), ShaderError> {
        let programs = Programs::new()?;
        let names = |p: &Program, group: usize| p.groups[group].iter().map(|(_, n)| n.clone()).collect::<Vec<_>>();
        assert_eq!(names(&programs.post, 0), ["post", "hdr"]);
        assert!(names(&programs.color[1], 0).contains(&"shadow_map".to_owned()));
        assert!(!names(&programs.color[0], 0).contains(&"shadow_map".to_owned()));
        assert!(!programs.shadow[0].has_group(1) && programs.shadow[1].has_group(1));
        assert_eq!(programs.color[1].name, "color+SHADOWS+ENVIRONMENT_MAP");
        Ok(())
    }
}
