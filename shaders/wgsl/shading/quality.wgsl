// Quality settings of shading. They change only arithmetic, so they are overrides: one resolved
// text serves all presets, and the driver removes disabled code. The defaults are the high preset.

/// Hammon's visibility term instead of the exact one; needs the DFG table built with it.
override FAST_VISIBILITY: bool = false;
/// Minimum perceptual roughness: 0.045 in f32, at least 0.089 in half floats.
@if(HALF)
override ROUGHNESS_FLOOR: f32 = 0.089;
@else
override ROUGHNESS_FLOOR: f32 = 0.045;
/// Fades the reflectance at grazing incidence for f0 below 0.02; otherwise it is one.
override F90_FADES: bool = true;
/// Compensates image-based light for the energy lost in multiple scattering.
override ENERGY_COMPENSATION: bool = true;
/// Compensates the sun and punctual lights for the energy lost in multiple scattering.
override PUNCTUAL_COMPENSATION: bool = true;
/// Number of irradiance bands: 2, 3 or 5.
override SH_BANDS: u32 = 3u;
/// Reads irradiance from the last level of the specular cube instead of spherical harmonics.
override IRRADIANCE_FROM_CUBE: bool = false;
/// Footprint of a pixel in specular antialiasing, 0.15 … 0.25; zero is off.
override SPECULAR_AA_VARIANCE: f32 = 0.15;
/// Maximum increase of alpha² by specular antialiasing.
override SPECULAR_AA_THRESHOLD: f32 = 0.2;
/// Brightens ambient occlusion by interreflection between occluders.
override MULTI_BOUNCE_OCCLUSION: bool = true;
/// Estimates the occlusion of reflections from ambient occlusion; otherwise they are not occluded.
override SPECULAR_OCCLUSION: bool = true;
/// Shadows the sun by the material's ambient occlusion.
override MICRO_SHADOWS: bool = true;
/// Computes f0 under a clear coat with a cubic instead of a square root.
override FAST_COAT: bool = false;
/// Lowers the base's f0 under a clear coat, because it borders the coat instead of air; false keeps
/// it, like Filament's `clearCoatIorChange = false`. The trait TRAIT_COAT_KEEPS_F0 disables it for
/// one material.
override COAT_IOR_CHANGE: bool = true;
/// Blurs transmission by an angle from the eye, as in Filament, instead of by the distance behind
/// the surface.
override TRANSMISSION_BY_ANGLE: bool = false;
/// Uses Filament's range window of punctual lights: the square of glTF's.
override SQUARED_LIGHT_WINDOW: bool = false;
/// 1 / (distance in m from the eye beyond which punctual lights have faded)²; 0 for no fade.
override LIGHT_FADE_INV_FAR2: f32 = 0.0;
