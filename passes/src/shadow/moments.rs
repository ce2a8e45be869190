//! Moments of a layer, blurred along one axis at a time, and halved level by level.

use super::draw::{ShadowLayer, confine};
use super::settings::ShadowSettings;
use crate::full_screen::FullScreen;
use crate::program::{Interface, ProgramDesc, Programs};
use crate::view::{ViewId, Views};
use framegraph::{ClearValue, DeclareError, Extent, Format, Intent, Pass, PassBuilder, Texture, TextureDesc, View};
use framegraph_shaders::layout::ShadowBlurUniforms;
use framegraph_shaders::{Module, library};
use framegraph_wgpu::{Cx, Record, RecordError};
use glam::IVec2;

static SHADER: Module<'static> = library::pass("pass/shadow_blur.wgsl").unwrap();

static INTERFACE: Interface = Interface { groups: &[&["shadow_blur", "moments"]], constants: &[] };

/// One half of a Gaussian blur of the maps of a layer, each within its place: across into a texture of its own, then up from
/// that into the layer.
#[derive(Clone, Copy, Debug)]
pub struct ShadowBlur {
    /// The view whose maps they are.
    pub view: ViewId,
    /// How shadows are made.
    pub settings: ShadowSettings,
    /// Which maps.
    pub layer: ShadowLayer,
    /// The maps.
    pub maps: Texture,
    /// What was blurred across; none: this is that half.
    pub across: Option<Texture>,
}

/// What the pass reads and wrote.
#[derive(Clone, Copy, Debug)]
pub struct ShadowBlurIo {
    source: View,
    /// The blurred texture, or the maps.
    pub blurred: Texture,
}

impl Pass for ShadowBlur {
    type Io = ShadowBlurIo;

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<ShadowBlurIo, DeclareError> {
        let Self { settings, layer: ShadowLayer { layer, only }, maps, across, .. } = *self;
        let own = maps.mip(0).layer(layer);
        // A cascade is all of its layer. What is beside other maps is not read.
        let is_whole = layer < u16::from(settings.cascades);
        let anew = if is_whole { Intent::Overwrite } else { Intent::Clear(ClearValue::BLACK) };
        match across {
            None => {
                let extent = Extent::absolute(settings.map_texels, settings.map_texels);
                let format = settings.filter.moments().unwrap_or(Format::Rg16Float);
                let source = pass.sampled(own)?;
                let blurred = pass.texture("shadow_across", TextureDesc::new(extent, format));
                Ok(ShadowBlurIo { source, blurred: pass.color(blurred, anew)? })
            }
            Some(across) => {
                let source = pass.sampled(across)?;
                let intent = if only.is_some() { Intent::Modify } else { anew };
                Ok(ShadowBlurIo { source, blurred: pass.color(own, intent)? })
            }
        }
    }
}

impl<W: AsRef<Programs> + AsRef<Views> + ?Sized> Record<W> for ShadowBlur {
    fn record(&self, io: &ShadowBlurIo, world: &W, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        let width = self.settings.moments.blur_texels.clamp(1.0, 125.0);
        // Filament's: a sixth of the width, the taps as far as the width reaches.
        let sigma = (width + 1.0) / 6.0;
        let (views, programs): (&Views, &Programs) = (world.as_ref(), world.as_ref());
        let program = ProgramDesc { fragment: Some("fs_blur"), ..ProgramDesc::new(&SHADER, &INTERFACE) };
        for map in self.layer.maps(views.get(self.view)?.shadows(self.settings.layers())?) {
            confine(map, cx)?;
            let first = IVec2::from(map.place.corner.map(|texel| texel as i32));
            let uniforms = ShadowBlurUniforms {
                step: if self.across.is_none() { IVec2::X } else { IVec2::Y },
                reach: (0.5 * width).ceil() as i32,
                falloff: -0.5 / (sigma * sigma),
                first,
                last: first + map.place.texels as i32 - 1,
            };
            let provided = [cx.uniform(&uniforms), cx.view(io.source)?.into()].map(Some);
            FullScreen::new(program, &[&provided]).draw(programs, cx)?;
        }
        Ok(())
    }
}

/// One further level of a layer's moments, made of the one above.
#[derive(Clone, Copy, Debug)]
pub struct ShadowLevel {
    /// Which layer.
    pub layer: u16,
    /// Which level, 1 or more.
    pub level: u8,
    /// The maps, the levels above written.
    pub maps: Texture,
}

/// What the pass reads and wrote.
#[derive(Clone, Copy, Debug)]
pub struct ShadowLevelIo {
    above: View,
    /// The maps, this level written too.
    pub maps: Texture,
}

impl Pass for ShadowLevel {
    type Io = ShadowLevelIo;

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<ShadowLevelIo, DeclareError> {
        let Self { layer, level, maps } = *self;
        let above = pass.sampled(maps.mip(level - 1).layer(layer))?;
        Ok(ShadowLevelIo { above, maps: pass.color(maps.mip(level).layer(layer), Intent::Overwrite)? })
    }
}

impl<W: AsRef<Programs> + ?Sized> Record<W> for ShadowLevel {
    fn record(&self, io: &ShadowLevelIo, world: &W, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        let provided = [None, Some(cx.view(io.above)?.into())];
        let program = ProgramDesc { fragment: Some("fs_halve"), ..ProgramDesc::new(&SHADER, &INTERFACE) };
        FullScreen::new(program, &[&provided]).draw(world.as_ref(), cx)
    }
}
