//! Draws casters into one layer of the shadow maps.

use crate::gpu_scene::draw::SurfaceDraw;
use crate::gpu_scene::shadow_views::ShadowMap;
use crate::gpu_scene::shadow_views::ShadowSettings;
use crate::gpu_scene::shadow_views::ViewShadows;
use crate::gpu_scene::upload::{GpuScene, MATERIAL_BINDINGS};
use crate::gpu_scene::view::{ViewId, Views};
use crate::program::full_screen::FullScreen;
use crate::program::{Interface, ProgramDesc, Programs};
use framegraph::{ClearValue, DeclareError, Extent, Format, Intent, Pass, PassBuilder, Texture, TextureDesc};
use framegraph_shaders::{Module, library};
use framegraph_wgpu::{Cx, Depth, Record, RecordError};
use wgpu::DepthBiasState;

/// Format of depth. 16 bits would suffice for fitted views, but adapters compare them differently.
pub const SHADOW_FORMAT: Format = Format::Depth32Float;

static SHADER: Module<'static> = library::pass("pass/shadow.wgsl").unwrap();

static INTERFACE: Interface = Interface {
    groups: &[&["shadow_view"], &MATERIAL_BINDINGS, &["objects", "origins"]],
    constants: &[SurfaceDraw::TRAITS],
};

/// Layer of the shadow maps, and the maps in it that a pass draws.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ShadowLayer {
    /// Index of the layer.
    pub layer: u16,
    /// Bit mask of the maps to draw over the contents of the layer; `None` clears the layer and draws all of its maps.
    pub only: Option<u64>,
}

impl ShadowLayer {
    /// Returns the layer with all of its maps, cleared first.
    pub const fn anew(layer: u16) -> Self {
        Self { layer, only: None }
    }

    /// Returns the maps to draw, with their indices.
    pub(super) fn maps<'a>(&self, shadows: &'a ViewShadows) -> impl Iterator<Item = (usize, &'a ShadowMap)> + use<'a> {
        let Self { layer, only } = *self;
        let drawn = move |number: usize| only.is_none_or(|only| only >> number & 1 == 1);
        let here = move |(number, map): &(usize, &ShadowMap)| map.place.layer == layer && drawn(*number);
        shadows.maps.iter().enumerate().filter(here)
    }
}

/// Draws all casters of the maps of one layer: reversed depth or its moments, cleared to the far plane.
///
/// Returns the texture with all maps. Multisampled moments are resolved into a separate texture of a layer's size
/// instead.
#[derive(Clone, Copy, Debug)]
pub struct Shadow {
    /// View of the maps.
    pub view: ViewId,
    /// Shadow settings, as in the view's [`ViewSettings`](crate::ViewSettings).
    pub settings: ShadowSettings,
    /// Layer and maps to draw.
    pub layer: ShadowLayer,
    /// Texture with all layers.
    pub maps: Texture,
}

/// Returns the description and name of the texture for all maps, depth or moments.
pub(crate) fn maps_desc(settings: &ShadowSettings) -> (TextureDesc, &'static str) {
    let of = |format| TextureDesc::new(Extent::absolute(settings.map_texels, settings.map_texels), format);
    match settings.filter.moments() {
        None => (of(SHADOW_FORMAT).layers(settings.layers()), "shadow_map"),
        Some(format) => (of(format).layers(settings.layers()).mips(settings.moments.levels.max(1)), "shadow_moments"),
    }
}

/// Restricts draws to the rectangle of a map.
pub(super) fn confine(map: &ShadowMap, cx: &mut Cx<'_>) -> Result<(), RecordError> {
    let ([x, y], texels) = (map.place.corner, map.place.texels);
    let pass = cx.render_pass()?;
    pass.set_viewport(x as f32, y as f32, texels as f32, texels as f32, 0.0, 1.0);
    pass.set_scissor_rect(x, y, texels, texels);
    Ok(())
}

impl Pass for Shadow {
    type Io = Texture;

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<Texture, DeclareError> {
        let Self { settings, layer: ShadowLayer { layer, only }, .. } = *self;
        let extent = Extent::absolute(settings.map_texels, settings.map_texels);
        let desc = |format| TextureDesc::new(extent, format);
        let far = Intent::Clear(ClearValue::FAR_REVERSED);
        let before = |clear| if only.is_some() { Intent::Modify } else { clear };
        let Some(format) = settings.filter.moments() else {
            return pass.depth(self.maps.layer(layer), before(far));
        };
        let samples = settings.moments.samples;
        let depth = pass.texture("shadow_depth", desc(SHADOW_FORMAT).samples(samples));
        pass.depth(depth, far)?;
        let warped = f64::from(settings.filter.exponent()).exp();
        let far = Intent::Clear(ClearValue::Color([warped, warped * warped, 0.0, 0.0]));
        if samples <= 1 {
            return pass.color(self.maps.mip(0).layer(layer), before(far));
        }
        // Not directly into the layer: Mesa 22.3 (software) always resolves into the first layer.
        let averages = pass.texture("shadow_averages", desc(format));
        let many = pass.texture("shadow_samples", desc(format).samples(samples));
        let many = pass.color(many, far)?;
        pass.resolve(many, averages)
    }
}

impl<W: AsRef<Programs> + AsRef<GpuScene> + AsRef<Views> + ?Sized> Record<W> for Shadow {
    fn record(&self, _: &Texture, world: &W, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        let views: &Views = world.as_ref();
        let view = views.get(self.view)?;
        let has_moments = self.settings.has_moments();
        let bias = &self.settings.bias;
        // Depth is reversed, so away from the light is smaller. Moments need no bias because of their variance.
        let bias = DepthBiasState { constant: -bias.steps, slope_scale: -bias.slope, clamp: 0.0 };
        let bias = if has_moments { DepthBiasState::default() } else { bias };
        let fragment = |depth, moments| if has_moments { Some(moments) } else { depth };
        let of = |vertex, fragment| ProgramDesc { vertex, fragment, ..ProgramDesc::new(&SHADER, &INTERFACE) };
        let far = of("vs_far", fragment(None, "fs_opaque_moments"));
        let opaque = of("vs_opaque", fragment(None, "fs_opaque_moments"));
        let masked = of("vs_mask", fragment(Some("fs_mask"), "fs_mask_moments"));
        let programs: &Programs = world.as_ref();
        for (number, map) in self.layer.maps(view.shadows(self.settings.layers())?) {
            confine(map, cx)?;
            let frame = [Some(cx.uniform(&map.view))];
            if self.layer.only.is_some() {
                // Clears contents of other or earlier maps.
                FullScreen { depth: Depth { write: true, ..Depth::NONE }, ..FullScreen::new(far, &[&frame]) }
                    .draw(programs, cx)?;
            }
            // Draws are merged separately for each map.
            let batches = view.view.draws.casters.get(number).map_or(&[][..], |own| own);
            for (desc, batches) in [opaque, masked].into_iter().zip(batches) {
                let draw = SurfaceDraw {
                    program: &|variant| programs.get(&ProgramDesc { features: &variant.vertex_features(), ..desc }),
                    frame: &frame,
                    constants: &[],
                    depth: Depth { bias, ..Depth::NEARER },
                    colors: &[],
                };
                draw.draw(batches, view.instances(world.as_ref()), cx)?;
            }
        }
        Ok(())
    }
}
