// What a quality of shading chooses. Only arithmetic changes, so these are overrides: one
// resolved text serves all qualities, and what is off is folded away when the pipeline is made.
// The defaults are those of the high preset.

/// Hammon's visibility term instead of the exact one; needs the DFG table built with it.
override FAST_VISIBILITY: bool = false;
/// Smallest perceptual roughness shaded: 0.045 in f32, no less than 0.089 in half floats.
@if(HALF)
override ROUGHNESS_FLOOR: f32 = 0.089;
@else
override ROUGHNESS_FLOOR: f32 = 0.045;
/// Reflectance at grazing fades with an f0 below 0.02 instead of being one.
override F90_FADES: bool = true;
/// Gives back to image-based light the energy that single scattering loses.
override ENERGY_COMPENSATION: bool = true;
/// The same for the sun and punctual lights.
override PUNCTUAL_COMPENSATION: bool = true;
/// Bands of irradiance that are evaluated: 2, 3 or 5.
override SH_BANDS: u32 = 3u;
/// Irradiance is the last level of the specular cube instead of harmonics.
override IRRADIANCE_FROM_CUBE: bool = false;
/// Footprint of a pixel in specular antialiasing, 0.15 … 0.25; zero is off.
override SPECULAR_AA_VARIANCE: f32 = 0.15;
/// The most that specular antialiasing may add to alpha².
override SPECULAR_AA_THRESHOLD: f32 = 0.2;
/// Ambient occlusion is brightened by light that bounces between the surfaces that occlude.
override MULTI_BOUNCE_OCCLUSION: bool = true;
/// Reflections are occluded by an estimate from ambient occlusion, instead of not at all.
override SPECULAR_OCCLUSION: bool = true;
/// The sun is occluded by what the material says of ambient occlusion.
override MICRO_SHADOWS: bool = true;
/// f0 under a clear coat by a cubic instead of a square root.
override FAST_COAT: bool = false;
/// The base under a clear coat meets the coat instead of air, which lowers its f0; else its f0
/// stays, as in Filament's materials whose `clearCoatIorChange` is off. While this is on, the trait
/// TRAIT_COAT_KEEPS_F0 switches it off for one material.
override COAT_IOR_CHANGE: bool = true;
/// Blurs things behind rough bodies by an angle from the eye, as in Filament, instead of by their
/// distance from the body.
override TRANSMISSION_BY_ANGLE: bool = false;
/// Filament's range window of punctual lights: the square of glTF's.
override SQUARED_LIGHT_WINDOW: bool = false;
/// 1 / (distance in m from the eye beyond which no punctual light shines)²; 0: they never fade.
override LIGHT_FADE_INV_FAR2: f32 = 0.0;
