//! How an instance takes part in drawing: Filament's switches of renderables.

/// Layers of instances and channels of lights by default: the first of eight, as in Filament.
pub const DEFAULT_MASK: u8 = 1;

/// Priority of instances by default, the middle of 0 to 7, as in Filament.
pub const DEFAULT_PRIORITY: u8 = 4;

/// The highest priority: such instances are drawn last.
pub const MAX_PRIORITY: u8 = 7;

/// How an instance takes part in drawing. Files state it in `extras`, see `docs/reference/files.md`.
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
    /// Layers that the instance is in, a bit each. A view draws an instance that is in one of its visible layers; others
    /// neither show nor cast shadows. Filament's `RenderableManager::setLayerMask`.
    pub layers: u8,
    /// Channels, a bit each: lights that share one light the instance. Filament's `RenderableManager::setLightChannel`.
    pub light_channels: u8,
    /// When the instance is drawn among those of its kind, 0 to [`MAX_PRIORITY`]: lower ones first. Kinds are opaque,
    /// alpha-tested and blended surfaces. Higher values count as [`MAX_PRIORITY`]. Surfaces that transmit are drawn by
    /// distance alone. Filament's `RenderableManager::setPriority`.
    pub priority: u8,
    /// Order of blended instances of one priority and one distance, lower ones first. Filament's
    /// `RenderableManager::setBlendOrderAt`, which has 15 bits.
    pub blend_order: u16,
    /// Blended instances with this flag are drawn before others of their priority, by `blend_order` and not by distance.
    /// Filament's `RenderableManager::setGlobalBlendOrderEnabledAt`.
    pub global_blend_order: bool,
    /// True if the instance casts shadows, where its material does. Filament's `RenderableManager::setCastShadows`.
    pub casts_shadows: bool,
    /// True if shadows fall on the instance: shadow maps of all lights and contact shadows. Filament's
    /// `RenderableManager::setReceiveShadows`.
    pub receives_shadows: bool,
}

impl Default for DrawOptions {
    /// The first layer and light channel, the middle priority, blended by distance, casting and receiving shadows.
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
    /// Sixteen bits of what shading an instance depends on: the light channels in the lower eight, and 256 for an instance
    /// that receives no shadows.
    #[must_use]
    pub fn light_bits(&self) -> u16 {
        u16::from(self.light_channels) | u16::from(!self.receives_shadows) << 8
    }

    /// The priority, 0 to [`MAX_PRIORITY`].
    #[must_use]
    pub fn priority(&self) -> u8 {
        self.priority.min(MAX_PRIORITY)
    }
}
