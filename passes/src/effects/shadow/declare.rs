//! The passes that make the shadow maps of a view.

use super::draw::{Shadow, ShadowLayer, maps_desc};
use super::moments::{MomentStep, ShadowBlur, ShadowLevel};
use crate::gpu_scene::shadow_views::{MomentSettings, ShadowMaps, ShadowSettings};
use crate::gpu_scene::upload::GpuScene;
use crate::gpu_scene::view::{ViewId, Views};
use crate::program::Programs;
use crate::settings::place::Word;
use crate::stages::Slot;
use framegraph::{DeclareError, Texture};
use framegraph_wgpu::Frame;

/// Declares a pass for each layer of the view's shadow maps. A single pass is named `shadow`; otherwise
/// `shadow/cascade` for each map of the sun, and `shadow/local` for each layer of punctual lights. Moments are blurred
/// and halved afterwards. Returns `None` if no light casts shadows.
///
/// # Errors
/// Fails if a layer is outside the texture.
pub fn shadow_maps<W>(
    frame: &mut Frame<W>,
    view: ViewId,
    settings: &ShadowSettings,
) -> Result<Option<ShadowMaps>, DeclareError>
where
    W: AsRef<Programs> + AsRef<GpuScene> + AsRef<Views> + ?Sized,
{
    let ShadowSettings { cascades, map_texels, filter, .. } = *settings;
    if settings.layers() > 0 {
        let shared = settings.local_layers();
        let told = format_args!(
            "the settings ask for it: a layer for each of {cascades} cascades, {shared} for maps of other lights, {map_texels} \
             texels across, read by `{}`",
            filter.word().unwrap_or_default()
        );
        frame.graph_mut().note("shadow", told);
    }
    let maps = draw_maps(frame, view, settings, None, (0..settings.layers()).map(ShadowLayer::anew))?;
    Ok(maps.map(|texture| ShadowMaps { texture, view }))
}

/// Returns the slot of the shadow maps.
pub const fn maps_slot(settings: &ShadowSettings) -> Slot {
    if settings.has_moments() { Slot::SHADOW_MOMENTS } else { Slot::SHADOW_MAP }
}

/// Declares the passes of these layers, into a given texture or into one that the first pass creates.
pub(super) fn draw_maps<W>(
    frame: &mut Frame<W>,
    view: ViewId,
    settings: &ShadowSettings,
    mut maps: Option<Texture>,
    layers: impl Iterator<Item = ShadowLayer>,
) -> Result<Option<Texture>, DeclareError>
where
    W: AsRef<Programs> + AsRef<GpuScene> + AsRef<Views> + ?Sized,
{
    let settings = *settings;
    let shadow = |layer, maps| Shadow { view, settings, layer, maps };
    if settings.layers() == 1 && !settings.has_moments() {
        for layer in layers {
            let into = maps.unwrap_or_else(|| made(frame, &settings));
            maps = Some(frame.add("shadow", shadow(layer, into))?);
        }
        return Ok(maps);
    }
    frame.scope("shadow", |frame| {
        for layer in layers {
            let into = maps.unwrap_or_else(|| made(frame, &settings));
            let name = if layer.layer < u16::from(settings.cascades) { "cascade" } else { "local" };
            let drawn = frame.add(name, shadow(layer, into))?;
            maps = Some(if settings.has_moments() { filtered(frame, shadow(layer, into), drawn)? } else { drawn });
        }
        Ok(maps)
    })
}

/// Declares a texture for all maps.
fn made<W: ?Sized>(frame: &mut Frame<W>, settings: &ShadowSettings) -> Texture {
    let (desc, name) = maps_desc(settings);
    frame.graph_mut().texture(name, desc)
}

/// Copies the result into its layer if it is not there yet, then blurs and halves it.
fn filtered<W>(frame: &mut Frame<W>, shadow: Shadow, drawn: Texture) -> Result<Texture, DeclareError>
where
    W: AsRef<Programs> + AsRef<Views> + ?Sized,
{
    let Shadow { view, settings, layer, maps } = shadow;
    let MomentSettings { samples, blur_texels, levels, .. } = settings.moments;
    let (mut maps, averages) = if samples > 1 { (maps, Some(drawn)) } else { (drawn, None) };
    let step = |maps, source, step| ShadowBlur { view, settings, layer, maps, source, step };
    if blur_texels > 0.0 {
        let across = frame.add("blur", step(maps, averages, MomentStep::Across))?.blurred;
        maps = frame.add("blur", step(maps, Some(across), MomentStep::Up))?.blurred;
    } else if averages.is_some() {
        maps = frame.add("average", step(maps, averages, MomentStep::Average))?.blurred;
    }
    for level in 1..levels {
        maps = frame.add("level", ShadowLevel { layer: layer.layer, level, maps })?.maps;
    }
    Ok(maps)
}
