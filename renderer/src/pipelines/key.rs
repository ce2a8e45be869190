//! Keys of the pipeline cache: the recorder's pipeline description with the targets of the step.

use crate::device::format::texture_format;
use crate::execute::targets::Targets;
use crate::pipelines::shader::Shader;
use crate::pipelines::state::{Compute, Constants, Depth, Output, Raster, VertexBuffer};
use std::num::NonZeroU32;
use wgpu::{
    BindGroupLayout, ColorTargetState, ColorWrites, DepthStencilState, PrimitiveState, StencilState, VertexAttribute,
    VertexStepMode,
};

/// Key of a raster pipeline.
#[derive(Debug)]
pub(crate) struct RasterKey {
    pub(crate) stages: StagesKey,
    fragment: Option<String>,
    buffers: Vec<(u64, VertexStepMode, Vec<VertexAttribute>)>,
    primitive: PrimitiveState,
    depth: Depth,
    colors: Vec<Output>,
    alpha_to_coverage: bool,
    targets: Targets,
    /// Mask of the color slots that the pass declares.
    own_slots: u8,
}

/// Part of the key shared by raster and compute pipelines.
#[derive(Debug)]
pub(crate) struct StagesKey {
    /// Hash of the shader ([`Shader::hash`]).
    pub(crate) shader: u64,
    entry: String,
    constants: Vec<(String, u64)>,
    groups: Vec<BindGroupLayout>,
}

/// Pipeline state derived from the description and the targets.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Fixed {
    pub(crate) colors: [Option<ColorTargetState>; 8],
    pub(crate) depth: Option<DepthStencilState>,
    pub(crate) samples: u32,
    pub(crate) multiview_mask: Option<NonZeroU32>,
    pub(crate) alpha_to_coverage: bool,
}

impl StagesKey {
    pub(crate) fn new(shader: &Shader<'_>, entry: &str, constants: Constants<'_>, groups: &[BindGroupLayout]) -> Self {
        Self {
            shader: shader.hash(),
            entry: entry.to_owned(),
            constants: constants.0.iter().map(|(n, v)| ((*n).to_owned(), v.to_bits())).collect(),
            groups: groups.to_vec(),
        }
    }

    /// Calls `make` with the description that the key was created from.
    pub(crate) fn with<T>(&self, shader: Shader<'_>, make: impl FnOnce(&Compute<'_>) -> T) -> T {
        let Self { entry, constants, groups, .. } = self;
        let constants: Vec<_> = constants.iter().map(|(n, v)| (n.as_str(), f64::from_bits(*v))).collect();
        make(&Compute { shader, entry, constants: Constants(&constants), groups })
    }

    pub(crate) fn is(
        &self,
        shader: &Shader<'_>,
        entry: &str,
        constants: Constants<'_>,
        groups: &[BindGroupLayout],
    ) -> bool {
        let Self { shader: hash, entry: own, constants: values, groups: layouts } = self;
        let same = |((a, x), (b, y)): (&(String, u64), &(&str, f64))| a == b && *x == y.to_bits();
        *hash == shader.hash()
            && own == entry
            && layouts == groups
            && values.len() == constants.0.len()
            && values.iter().zip(constants.0).all(same)
    }
}

impl RasterKey {
    pub(crate) fn new(raster: &Raster<'_>, targets: &Targets, own_slots: u8) -> Self {
        Self {
            stages: StagesKey::new(&raster.shader, raster.vertex, raster.constants, raster.groups),
            fragment: raster.fragment.map(str::to_owned),
            buffers: raster.buffers.iter().map(|b| (b.stride_bytes, b.step, b.attributes.to_vec())).collect(),
            primitive: raster.primitive,
            depth: raster.depth.clone(),
            colors: raster.colors.to_vec(),
            alpha_to_coverage: raster.alpha_to_coverage,
            targets: *targets,
            own_slots,
        }
    }

    /// Calls `make` with the description that the key was created from, and the state derived from it.
    pub(crate) fn with<T>(&self, shader: Shader<'_>, make: impl FnOnce(&Raster<'_>, &Fixed) -> T) -> T {
        let Self { stages, fragment, buffers, primitive, depth, colors, alpha_to_coverage, targets, own_slots } = self;
        let buffers: Vec<_> = buffers
            .iter()
            .map(|(stride_bytes, step, attributes)| VertexBuffer {
                stride_bytes: *stride_bytes,
                step: *step,
                attributes,
            })
            .collect();
        stages.with(shader, |Compute { shader, entry, constants, groups }| {
            let raster = Raster {
                vertex: entry,
                fragment: fragment.as_deref(),
                constants: *constants,
                groups,
                buffers: &buffers,
                primitive: *primitive,
                depth: depth.clone(),
                colors,
                alpha_to_coverage: *alpha_to_coverage,
                shader: *shader,
            };
            make(&raster, &fixed(&raster, targets, *own_slots))
        })
    }

    /// Returns whether the key has these targets.
    pub(crate) fn fits(&self, targets: &Targets, own_slots: u8) -> bool {
        let own = &self.targets;
        self.own_slots == own_slots
            && (own.colors, own.depth) == (targets.colors, targets.depth)
            && (own.samples, own.layers) == (targets.samples, targets.layers)
    }

    /// Returns whether the key has this description. Does not allocate, since it is called for every pipeline in every
    /// frame.
    pub(crate) fn describes(&self, raster: &Raster<'_>) -> bool {
        let Self { stages, fragment, buffers, primitive, depth, colors, alpha_to_coverage, .. } = self;
        let same =
            |((stride, step, attributes), b): (&(u64, VertexStepMode, Vec<VertexAttribute>), &VertexBuffer<'_>)| {
                *stride == b.stride_bytes && *step == b.step && attributes == b.attributes
            };
        *primitive == raster.primitive
            && (self.targets.depth.is_none() || *depth == raster.depth)
            && colors == raster.colors
            && *alpha_to_coverage == raster.alpha_to_coverage
            && fragment.as_deref() == raster.fragment
            && buffers.len() == raster.buffers.len()
            && buffers.iter().zip(raster.buffers).all(same)
            && stages.is(&raster.shader, raster.vertex, raster.constants, raster.groups)
    }
}

/// Combines a pipeline description with the targets of a step.
pub(crate) fn fixed(raster: &Raster<'_>, targets: &Targets, own_slots: u8) -> Fixed {
    let colors = std::array::from_fn(|slot| color_state(raster, targets, own_slots, slot));
    let (samples, multiview_mask) = (targets.samples, targets.multiview_mask());
    let alpha_to_coverage = covers(raster, targets);
    Fixed { colors, depth: depth_state(raster, targets), samples, multiview_mask, alpha_to_coverage }
}

fn covers(raster: &Raster<'_>, targets: &Targets) -> bool {
    raster.alpha_to_coverage && targets.samples > 1
}

fn color_state(raster: &Raster<'_>, targets: &Targets, own_slots: u8, slot: usize) -> Option<ColorTargetState> {
    let format = texture_format(targets.colors[slot]?);
    let wanted = raster.colors.get(slot).copied().unwrap_or(Output::REPLACE);
    let own = own_slots & (1 << slot) != 0 && raster.fragment.is_some();
    let Output { blend, write } = if own { wanted } else { Output { blend: None, write: ColorWrites::empty() } };
    Some(ColorTargetState { format, blend, write_mask: write })
}

fn depth_state(raster: &Raster<'_>, targets: &Targets) -> Option<DepthStencilState> {
    let format = targets.depth_format()?;
    let Depth { compare, write, bias, stencil } = raster.depth.clone();
    Some(DepthStencilState {
        format,
        depth_write_enabled: format.has_depth_aspect().then_some(write),
        depth_compare: format.has_depth_aspect().then_some(compare),
        stencil: if format.has_stencil_aspect() { stencil } else { StencilState::default() },
        bias,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use framegraph::Format;
    use wgpu::{BlendState, CompareFunction, TextureFormat};

    const SHADER: Shader<'static> = Shader::new("s", "text");

    fn targets() -> Targets {
        let mut targets = Targets { samples: 4, ..Targets::default() };
        targets.colors[0] = Some(Format::Rgba16Float);
        targets.colors[2] = Some(Format::Rg8Unorm);
        targets.depth = Some(Format::Depth32Float);
        targets
    }

    #[test]
    fn undeclared_color_slots_are_not_written() {
        let colors = [Output { blend: Some(BlendState::ALPHA_BLENDING), ..Output::REPLACE }];
        let raster = Raster { colors: &colors, alpha_to_coverage: true, ..Raster::new(SHADER) };
        let Fixed { colors, depth, samples, multiview_mask, alpha_to_coverage } = fixed(&raster, &targets(), 0b001);
        assert_eq!(multiview_mask, None, "one layer");
        let masks = colors.each_ref().map(|c| c.as_ref().map(|c| (c.format, c.blend.is_some(), c.write_mask)));
        assert_eq!(masks[0], Some((TextureFormat::Rgba16Float, true, ColorWrites::ALL)));
        assert_eq!(masks[1], None);
        assert_eq!(masks[2], Some((TextureFormat::Rg8Unorm, false, ColorWrites::empty())));
        let depth = depth.map(|d| (d.depth_write_enabled, d.depth_compare));
        assert_eq!(depth, Some((Some(false), Some(CompareFunction::Always))));
        assert_eq!((samples, alpha_to_coverage), (4, true));
    }

    #[test]
    fn keys_differ_in_every_part() {
        let base = Raster::new(SHADER);
        let key = RasterKey::new(&base, &targets(), 1);
        let is = |raster: &Raster<'_>| key.describes(raster);
        assert!(is(&base));
        let values = [("A", 1.0)];
        let attributes = wgpu::vertex_attr_array![0 => Float32x3];
        let buffers = [VertexBuffer { stride_bytes: 12, step: VertexStepMode::Vertex, attributes: &attributes }];
        let mut culled = base.clone();
        culled.primitive.cull_mode = Some(wgpu::Face::Back);
        let others = [
            Raster { shader: Shader::new("t", "text"), ..base.clone() },
            Raster { shader: Shader::new("s", "other"), ..base.clone() },
            Raster { vertex: "other", ..base.clone() },
            Raster { fragment: None, ..base.clone() },
            Raster { constants: Constants(&values), ..base.clone() },
            Raster { buffers: &buffers, ..base.clone() },
            culled,
        ];
        for other in &others {
            assert!(!is(other), "{other:?}");
        }
        let blended = [Output { blend: Some(BlendState::ALPHA_BLENDING), ..Output::REPLACE }];
        assert!(!is(&Raster { depth: Depth::NEARER, ..base.clone() }));
        let without_depth = RasterKey::new(&base, &Targets { depth: None, ..targets() }, 1);
        assert!(
            without_depth.describes(&Raster { depth: Depth::NEARER, ..base.clone() }),
            "depth state is ignored without a depth target"
        );
        assert!(!is(&Raster { colors: &blended, ..base.clone() }));
        assert!(!is(&Raster { alpha_to_coverage: true, ..base.clone() }));
        let mut fewer = targets();
        fewer.colors[2] = None;
        let others = [Targets { samples: 1, ..targets() }, Targets { layers: 2, ..targets() }, fewer];
        let others = others.into_iter().chain([Targets { depth: None, ..targets() }]);
        others.for_each(|other| assert!(!key.fits(&other, 1), "{other:?}"));
        assert!(key.fits(&targets(), 1));
        assert!(!key.fits(&targets(), 0b100), "the pass declares another slot");
        assert!(key.fits(&Targets { extent: [9, 9], ..targets() }, 1), "of any size");
        let negative = [("A", -0.0)];
        let zero = RasterKey::new(&Raster { constants: Constants(&[("A", 0.0)]), ..base.clone() }, &targets(), 1);
        assert!(!zero.describes(&Raster { constants: Constants(&negative), ..base }), "constants compare by bits");
    }
}
