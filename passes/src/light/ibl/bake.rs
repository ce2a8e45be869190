//! Prefiltering of environments, with a cache.

use framegraph_scene::color::luminance_from_rec709;
use framegraph_scene::environment::{Environment, EquirectMap, Sh, cleaned};
use framegraph_scene::progress::ProgressFn;
use framegraph_wgpu::{Gpu, texture_format};

use super::cache::{Cache, Key};
use super::cube::{self, SpecularCube, specular_cube};
use super::entry::{self, LightEntry};
use super::error::IblError;
use super::light::ImageLight;
use super::ready_made;
use super::rgbm;
use super::settings::{EnvironmentFormat, IblSettings};
use super::texture::{CubeShape, cube_format, cube_view, write_cube};

impl ImageLight {
    /// Prefilters `environment`, or loads the result from `cache`. Uniform light has a cube of 64 texels and five
    /// levels, whatever `settings` request. If the environment comes with prefiltered light
    /// ([`Environment::filtered`]), its size, levels and bands replace those of `settings`.
    ///
    /// Negative, infinite and NaN texels are clamped as in [`Environment::load`] and counted in
    /// [`warnings`](Self::warnings). Texels of a loaded environment are already clamped.
    ///
    /// Reports each slice of the work as [`Stage::Lighting`](framegraph_scene::Stage::Lighting). `progress` may stop
    /// the work, and then nothing is written to the cache.
    ///
    /// # Errors
    ///
    /// Fails if a setting is out of range, the work is interrupted, or the device fails. A cache that cannot be read
    /// or written causes a warning.
    pub fn new(
        gpu: &Gpu,
        environment: &Environment,
        settings: &IblSettings,
        cache: &Cache,
        progress: &mut ProgressFn<'_>,
    ) -> Result<Self, IblError> {
        settings.check()?;
        let is_rgbm = settings.format == EnvironmentFormat::Rgbm;
        let (map, cleaning) = cleaned(&environment.map);
        let mut warnings = cleaning.warnings(&environment.name, map.texels().len());
        if let Some(filtered) = &environment.filtered {
            let mut shape = ready_made::shape(filtered);
            let mut light = ready_made::entry(filtered, map.average());
            if is_rgbm {
                shape = rgbm::encode(&mut light, shape);
            }
            let cube = write_cube(gpu, &environment.name, &shape, &light.levels)?;
            return Ok(Self::of(environment, settings, &shape, &light, &cube, (false, warnings)));
        }
        // Every texel of uniform light is equal, so the smallest cube suffices.
        let even = IblSettings { cube_texels: 64, levels: 5, ..*settings };
        let settings = if map.is_even() { &even } else { settings };
        let shape = CubeShape {
            texels: settings.cube_texels,
            levels: settings.levels,
            format: cube_format(gpu, settings.format),
        };
        let key = key(&map, settings, &shape);
        let found = cache.load(key, entry::LIGHT, &mut warnings, |payload| entry::decode_light(payload, &shape));
        let from_cache = found.is_some();
        let (mut light, cube) = match found {
            Some(light) if is_rgbm => (light, None),
            Some(light) => {
                let cube = write_cube(gpu, &environment.name, &shape, &light.levels)?;
                (light, Some(cube))
            }
            None => {
                let keeps = cache.keeps_results_of(gpu);
                let read_back = keeps || is_rgbm;
                let (sh, average) = (Sh::project(&map, settings.bands), map.average());
                let map = (environment.name.as_str(), &*map);
                let SpecularCube { texture, texel_nits, levels } =
                    specular_cube(gpu, map, settings, &shape, read_back, progress)?;
                let light = LightEntry { sh, average, texel_nits, levels };
                if keeps {
                    cache.store(key, entry::LIGHT, &entry::encode_light(&light, &shape), &mut warnings);
                }
                (light, Some(texture).filter(|_| !is_rgbm))
            }
        };
        let (shape, cube) = match cube {
            Some(cube) => (shape, cube),
            None => {
                let shape = rgbm::encode(&mut light, shape);
                (shape, write_cube(gpu, &environment.name, &shape, &light.levels)?)
            }
        };
        Ok(Self::of(environment, settings, &shape, &light, &cube, (from_cache, warnings)))
    }

    /// Returns the light of a cache entry whose cube is on the device.
    fn of(
        environment: &Environment,
        settings: &IblSettings,
        shape: &CubeShape,
        light: &LightEntry,
        cube: &wgpu::Texture,
        (from_cache, warnings): (bool, Vec<String>),
    ) -> Self {
        Self {
            name: environment.name.clone(),
            irradiance: light.sh.windowed(settings.window).irradiance_coefficients(),
            bands: light.sh.bands(),
            specular: cube_view(cube),
            format: texture_format(shape.format),
            cube_texels: shape.texels,
            level_count: shape.levels,
            roughness_one_lod: (shape.levels - 1) as f32,
            texel_nits: light.texel_nits,
            luminance_nits: luminance_from_rec709(light.average) as f32,
            dominant_direction: light.sh.dominant_direction().map(|d| d.as_vec3()),
            is_even: environment.filtered.is_none() && environment.map.is_even(),
            sun: environment.sun.clone(),
            from_cache,
            warnings,
            size_bytes: shape.bytes(),
        }
    }
}

/// Returns the key of everything that determines the cube and the coefficients. The window is applied after the cache.
fn key(map: &EquirectMap, settings: &IblSettings, shape: &CubeShape) -> Key {
    let mut key = Key::of("image light", "pass/ibl.wgsl");
    key.add(&[map.width(), map.height(), settings.cube_texels, settings.levels, settings.bands.count() as u32]);
    key.add_text(&format!("{:?}", texture_format(shape.format)));
    key.add(map.texels());
    for level in 0..settings.levels {
        key.add(&cube::level_kernel(settings, level));
    }
    key
}

#[cfg(test)]
mod tests {
    use super::*;
    use framegraph::Format;
    use framegraph_scene::environment::ShBands;

    /// Every input of an entry changes its key, except for the window, which is applied afterwards.
    #[test]
    fn every_part_of_the_key_counts() {
        let map =
            |height, value| EquirectMap::new(2 * height, height, vec![[value; 4]; 2 * (height * height) as usize]);
        let settings = IblSettings { cube_texels: 64, ..IblSettings::default() };
        let shape = |format| CubeShape { texels: 64, levels: settings.levels, format };
        let of = |map: EquirectMap, settings: IblSettings, format| key(&map, &settings, &shape(format)).finish();
        let full = Format::Rgba16Float;
        let keys = [
            of(map(4, 1.0), settings, full),
            of(map(8, 1.0), settings, full),
            of(map(4, 2.0), settings, full),
            of(map(4, 1.0), settings, Format::Rg11b10Ufloat),
            of(map(4, 1.0), IblSettings { cube_texels: 128, ..settings }, full),
            of(map(4, 1.0), IblSettings { levels: settings.levels + 1, ..settings }, full),
            of(map(4, 1.0), IblSettings { bands: ShBands::Five, ..settings }, full),
        ];
        for (i, a) in keys.iter().enumerate() {
            assert!(keys[..i].iter().all(|b| a != b), "{i}");
        }
        let windowed = IblSettings { window: framegraph_scene::environment::ShWindow::Hann, ..settings };
        assert_eq!(of(map(4, 1.0), windowed, full), keys[0]);
    }
}
