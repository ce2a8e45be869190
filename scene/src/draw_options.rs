//! Draw options of an instance, as in Filament's renderables.

/// Default layer mask of instances and channel mask of lights: the first of eight, as in Filament.
pub const DEFAULT_MASK: u8 = 1;

/// Default priority of instances, the middle of 0 to 7, as in Filament.
pub const DEFAULT_PRIORITY: u8 = 4;

/// Maximum priority; its instances are drawn last.
pub const MAX_PRIORITY: u8 = 7;

/// Draw options of an instance. In files they are part of `extras`, see `docs/reference/files.md`.
///
/// ```
/// use framegraph_scene::{DrawOptions, Material, Scene, geometry};
///
/// let mut scene = Scene::default();
/// let ball = scene.add_mesh(geometry::sphere(0.5, 32, 16));
/// let white = scene.add_material(Material::default());
/// scene.add_instance("ball", ball, white, glam::DMat4::IDENTITY);
/// scene.instances[0].draw = DrawOptions { casts_shadows: false, ..DrawOptions::default() };
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct DrawOptions {
    /// Bit mask of the instance's layers. A view draws an instance if one of its layers is visible; hidden instances
    /// cast no shadows. Filament's `RenderableManager::setLayerMask`.
    pub layers: u8,
    /// Bit mask of light channels. A light affects the instance if they share a channel. Filament's
    /// `RenderableManager::setLightChannel`.
    pub light_channels: u8,
    /// Drawing priority among instances of one kind (opaque, alpha-tested or blended), 0 to [`MAX_PRIORITY`]; lower
    /// ones are drawn first. Higher values count as [`MAX_PRIORITY`]. Transmissive surfaces are ordered by distance
    /// alone. Filament's `RenderableManager::setPriority`.
    pub priority: u8,
    /// Order of blended instances of equal priority and distance; lower ones are drawn first. Filament's
    /// `RenderableManager::setBlendOrderAt`, which has 15 bits.
    pub blend_order: u16,
    /// Draws a blended instance before others of its priority, ordered by `blend_order` instead of distance. Filament's
    /// `RenderableManager::setGlobalBlendOrderEnabledAt`.
    pub global_blend_order: bool,
    /// True if the instance casts shadows, provided that its material does. Filament's
    /// `RenderableManager::setCastShadows`.
    pub casts_shadows: bool,
    /// True if the instance receives shadows from shadow maps and contact shadows. Filament's
    /// `RenderableManager::setReceiveShadows`.
    pub receives_shadows: bool,
}

impl Default for DrawOptions {
    /// Returns the first layer and light channel, the middle priority, distance-sorted blending, and shadows both cast
    /// and received.
    fn default() -> Self {
        Self {
            layers: DEFAULT_MASK,
            light_channels: DEFAULT_MASK,
            priority: DEFAULT_PRIORITY,
            blend_order: 0,
            global_blend_order: false,
            casts_shadows: true,
            receives_shadows: true,
        }
    }
}

impl DrawOptions {
    /// Returns the light state of an instance in sixteen bits: light channels in the lower eight, and bit 8 (256) if it
    /// receives no shadows.
    #[must_use]
    pub fn light_bits(&self) -> u16 {
        u16::from(self.light_channels) | u16::from(!self.receives_shadows) << 8
    }

    /// Returns the priority, clamped to [`MAX_PRIORITY`].
    #[must_use]
    pub fn priority(&self) -> u8 {
        self.priority.min(MAX_PRIORITY)
    }
}
