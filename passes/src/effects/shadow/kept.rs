//! Shadow maps kept from frame to frame; only maps whose contents would change are drawn.
//!
//! A map depends on its light, its fit and its casters, but not on the eye; maps of punctual lights are fitted to the
//! light alone. In a still scene they are drawn once, wherever the camera moves; cascades are drawn again when the
//! camera moves. All inputs of a map are compared with those of the frame that drew it last. Meshes and materials of a
//! scene are assumed constant. A map is drawn again if an instance in it changes its level of detail.

use super::declare::draw_maps;
use super::draw::{ShadowLayer, maps_desc};
use crate::gpu_scene::shadow_views::ShadowSettings;
use crate::gpu_scene::shadow_views::ViewShadows;
use crate::gpu_scene::shadow_views::{MapKey, ShadowMaps};
use crate::gpu_scene::upload::GpuScene;
use crate::gpu_scene::view::{ViewId, Views};
use crate::program::Programs;
use framegraph::{DeclareError, Entry, Exit};
use framegraph_wgpu::{DeviceError, Frame, Gpu, Imports, texture_format};
use wgpu::{Extent3d, TextureDescriptor, TextureDimension, TextureUsages};

/// Reason for drawing a map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Redraw {
    /// The map was never drawn, or the frame that should have drawn it failed.
    First,
    /// The light or its fit changed, or the map has another size or place.
    Light,
    /// A caster moved, appeared, disappeared or changed its level of detail.
    Casters,
}

impl std::fmt::Display for Redraw {
    /// Writes the reason, to follow a number of maps.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::First => "never drawn before",
            Self::Light => "with a changed light or fit",
            Self::Casters => "with changed casters",
        })
    }
}

/// Shadow maps of a view, kept by the application from frame to frame.
///
/// ```no_run
/// # use framegraph::{Extent, Target};
/// # use framegraph_passes::{stages, Handles, PassError, Settings, ViewId, World};
/// # use framegraph_passes::effects::shadow::{KeptShadows, maps_slot};
/// # use framegraph_wgpu::{Executor, Frame, Gpu, Imports};
/// # fn a(gpu: &Gpu, world: &World, settings: &Settings, kept: &mut KeptShadows) -> Result<(), Box<dyn std::error::Error>> {
/// let mut frame = Frame::<World>::new();
/// let shadows = world.views.get(ViewId::MAIN)?.view.shadows.as_ref().ok_or("a view with shadows")?;
/// let maps = kept.declare(gpu, &mut frame, ViewId::MAIN, shadows)?.ok_or("something casts")?;
/// let handles = Handles::for_view(ViewId::MAIN, Extent::FRAME).with_shadow_maps(maps_slot(&shadows.settings), maps);
/// stages(settings).declare(&mut frame, handles, Target::New)?;
/// let mut imports = Imports::new();
/// kept.import(maps, &mut imports);
/// // … the plan is executed with these imports …
/// kept.drawn(shadows);
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Default)]
pub struct KeptShadows(Option<Held>);

#[derive(Debug)]
struct Held {
    texture: wgpu::Texture,
    settings: ShadowSettings,
    /// Inputs from which each map was drawn; `None` if the contents of its place are unknown.
    keys: Vec<Option<MapKey>>,
}

impl KeptShadows {
    /// Returns the indices of the maps to draw, and the reason for each.
    pub fn due(&self, shadows: &ViewShadows) -> Vec<(u16, Redraw)> {
        self.due_of(&shadows.settings, &shadows.keys())
    }

    fn due_of(&self, settings: &ShadowSettings, keys: &[MapKey]) -> Vec<(u16, Redraw)> {
        let held = self.0.as_ref().filter(|held| held.settings == *settings);
        let why = |(number, key): (u16, &MapKey)| {
            let before = held.and_then(|held| held.keys.get(usize::from(number))?.as_ref());
            let why = match before {
                None => Redraw::First,
                Some(before) if before == key => return None,
                Some(before) if !before.has_casters_of(key) => Redraw::Casters,
                Some(_) => Redraw::Light,
            };
            Some((number, why))
        };
        (0..).zip(keys).filter_map(why).collect()
    }

    /// Declares the maps as an import, and a pass for each layer with maps to draw. The pass draws these maps, or the
    /// whole layer if all have to be drawn. Returns `None` if no light casts shadows.
    ///
    /// # Errors
    /// Fails if the texture cannot be created, or a layer is outside the texture.
    pub fn declare<W>(
        &mut self,
        gpu: &Gpu,
        frame: &mut Frame<W>,
        view: ViewId,
        shadows: &ViewShadows,
    ) -> Result<Option<ShadowMaps>, KeptShadowsError>
    where
        W: AsRef<Programs> + AsRef<GpuScene> + AsRef<Views> + ?Sized,
    {
        let settings = &shadows.settings;
        if settings.layers() == 0 {
            return Ok(None);
        }
        let keys = shadows.keys();
        let due = self.due_of(settings, &keys);
        let held = match self.0.take() {
            Some(held) if held.settings == *settings => self.0.insert(held),
            _ => self.0.insert(Held::new(gpu, settings)?),
        };
        let graph = frame.graph_mut();
        if due.is_empty() {
            graph.note("shadow", format_args!("all {} maps are kept", shadows.maps.len()));
        }
        for (number, why) in &due {
            graph.note("shadow", format_args!("map {number} is drawn: {why}"));
        }
        let bits = due.iter().fold(0_u64, |bits, (number, _)| bits | 1 << number);
        // Maps outside of this view may be overwritten.
        held.keys =
            keys.into_iter().enumerate().map(|(number, key)| (bits >> number & 1 == 0).then_some(key)).collect();
        let (desc, name) = maps_desc(settings);
        let maps = frame.graph_mut().import_texture(name, desc, Entry::Defined, Exit::Keep);
        let layer = |layer: u16| {
            let here = shadows.maps.iter().enumerate().filter(|(_, map)| map.place.layer == layer);
            let here = here.fold(0_u64, |bits, (number, _)| bits | 1 << number);
            let only = (here & !bits != 0).then_some(bits);
            (here & bits != 0).then_some(ShadowLayer { layer, only })
        };
        let layers = (0..settings.layers()).filter_map(layer);
        let maps = draw_maps(frame, view, settings, Some(maps), layers)?;
        Ok(maps.map(|texture| ShadowMaps { texture, view }))
    }

    /// Binds the texture to the import returned by [`KeptShadows::declare`].
    pub fn import(&self, maps: ShadowMaps, imports: &mut Imports) {
        if let Some(held) = &self.0 {
            imports.texture(maps.texture, &held.texture);
        }
    }

    /// Marks the maps as drawn after the frame was executed. Without this call, they are drawn again.
    pub fn drawn(&mut self, shadows: &ViewShadows) {
        if let Some(held) = self.0.as_mut().filter(|held| held.settings == shadows.settings) {
            held.keys = shadows.keys().into_iter().map(Some).collect();
        }
    }
}

impl Held {
    fn new(gpu: &Gpu, settings: &ShadowSettings) -> Result<Self, DeviceError> {
        let (desc, name) = maps_desc(settings);
        let size = Extent3d {
            width: settings.map_texels,
            height: settings.map_texels,
            depth_or_array_layers: desc.layers.into(),
        };
        let texture = gpu.guard("shadow maps that are kept", || {
            gpu.device.create_texture(&TextureDescriptor {
                label: Some(name),
                size,
                mip_level_count: desc.mips.into(),
                sample_count: 1,
                dimension: TextureDimension::D2,
                format: texture_format(desc.format),
                usage: TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_SRC,
                view_formats: &[],
            })
        })?;
        Ok(Self { texture, settings: *settings, keys: Vec::new() })
    }
}

/// Error of declaring kept shadow maps.
#[derive(thiserror::Error)]
#[non_exhaustive]
pub enum KeptShadowsError {
    /// The texture cannot be created.
    #[error(transparent)]
    Device(#[from] DeviceError),
    /// A pass was refused.
    #[error(transparent)]
    Declare(#[from] DeclareError),
}

impl std::fmt::Debug for KeptShadowsError {
    /// Writes the message, since `unwrap` shows it.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}
