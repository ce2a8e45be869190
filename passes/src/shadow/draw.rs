//! Draws what casts into one layer of the shadow maps.

use super::fitted::ShadowMap;
use super::settings::{ShadowFilter, ShadowSettings};
use crate::draw::SurfaceDraw;
use crate::program::{Interface, ProgramDesc, Programs};
use crate::upload::{GpuScene, MATERIAL_BINDINGS};
use crate::view::{ViewId, Views};
use framegraph::{ClearValue, DeclareError, Extent, Format, Intent, Pass, PassBuilder, Texture, TextureDesc};
use framegraph_shaders::{Module, library};
use framegraph_wgpu::{Cx, Depth, Record, RecordError};
use wgpu::DepthBiasState;

/// Format of depth: sixteen bits would do for a fitted view, but not every adapter compares them alike.
pub const SHADOW_FORMAT: Format = Format::Depth32Float;

static SHADER: Module<'static> = library::pass("pass/shadow.wgsl").unwrap();

static INTERFACE: Interface =
    Interface { groups: &[&["shadow_view"], &MATERIAL_BINDINGS, &["objects", "origins"]], constants: &[] };

/// Draws every caster of one map into its layer: reversed depth, or moments of it, cleared to the far end.
#[derive(Clone, Copy, Debug)]
pub struct Shadow {
    /// The view whose map it is.
    pub view: ViewId,
    /// How shadows are made, as the view's [`ViewSettings`](crate::ViewSettings) have it.
    pub settings: ShadowSettings,
    /// Which map.
    pub layer: u16,
    /// The texture with the layers before this one; none makes it.
    pub maps: Option<Texture>,
}

/// The texture that holds all maps, depth or moments, and its name.
pub(super) fn maps_desc(settings: &ShadowSettings) -> (TextureDesc, &'static str) {
    let of = |format| TextureDesc::new(Extent::absolute(settings.map_texels, settings.map_texels), format);
    match settings.filter.moments() {
        None => (of(SHADOW_FORMAT).layers(settings.layers()), "shadow_map"),
        Some(format) => (of(format).layers(settings.layers()).mips(settings.moments.levels.max(1)), "shadow_moments"),
    }
}

impl Pass for Shadow {
    type Io = Texture;

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<Texture, DeclareError> {
        let Self { settings, layer, .. } = *self;
        let extent = Extent::absolute(settings.map_texels, settings.map_texels);
        let desc = |format| TextureDesc::new(extent, format);
        let far = Intent::Clear(ClearValue::FAR_REVERSED);
        let (whole, name) = maps_desc(&settings);
        let maps = self.maps.unwrap_or_else(|| pass.texture(name, whole));
        let Some(format) = settings.filter.moments() else {
            return pass.depth(maps.layer(layer), far);
        };
        let samples = settings.moments.samples;
        if samples > 1 && settings.filter == ShadowFilter::Evsm {
            return Err(pass.error(
                "moments in 32 bits cannot be averaged over samples",
                "use one sample, or the filter `vsm`, whose moments have 16 bits",
            ));
        }
        let depth = pass.texture("shadow_depth", desc(SHADOW_FORMAT).samples(samples));
        pass.depth(depth, far)?;
        let warped = f64::from(settings.filter.exponent()).exp();
        let far = Intent::Clear(ClearValue::Color([warped, warped * warped, 0.0, 0.0]));
        let into = maps.mip(0).layer(layer);
        if samples <= 1 {
            return pass.color(into, far);
        }
        let many = pass.texture("shadow_samples", desc(format).samples(samples));
        let many = pass.color(many, far)?;
        pass.resolve(many, into)
    }
}

impl<W: AsRef<Programs> + AsRef<GpuScene> + AsRef<Views> + ?Sized> Record<W> for Shadow {
    fn record(&self, _: &Texture, world: &W, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        let views: &Views = world.as_ref();
        let view = views.get(self.view)?;
        let maps = &view.shadows(self.settings.layers())?.maps;
        let Some(ShadowMap { view: seen, texels, .. }) = maps.get(usize::from(self.layer)) else {
            return Ok(());
        };
        let used = *texels as f32;
        cx.render_pass()?.set_viewport(0.0, 0.0, used, used, 0.0, 1.0);
        let has_moments = self.settings.has_moments();
        let bias = &self.settings.bias;
        // Depth is reversed: away from the light is less. The variance of moments takes the place of a bias.
        let bias = DepthBiasState { constant: -bias.steps, slope_scale: -bias.slope, clamp: 0.0 };
        let bias = if has_moments { DepthBiasState::default() } else { bias };
        let fragment = |depth, moments| if has_moments { Some(moments) } else { depth };
        let of = |vertex, fragment| ProgramDesc { vertex, fragment, ..ProgramDesc::new(&SHADER, &INTERFACE) };
        // The draws of a view are made of its maps, so each has its own.
        let Some([opaque, masked]) = view.view.draws.casters.get(usize::from(self.layer)) else { return Ok(()) };
        let opaque = (of("vs_opaque", fragment(None, "fs_opaque_moments")), opaque);
        let masked = (of("vs_mask", fragment(Some("fs_mask"), "fs_mask_moments")), masked);
        let programs: &Programs = world.as_ref();
        let frame = [Some(cx.uniform(seen))];
        for (desc, batches) in [opaque, masked] {
            let draw = SurfaceDraw {
                program: &|_| programs.get(&desc),
                frame: &frame,
                constants: &[],
                depth: Depth { bias, ..Depth::NEARER },
                colors: &[],
            };
            draw.draw(batches, view.instances(world.as_ref()), cx)?;
        }
        Ok(())
    }
}
