//! Conversion of stated image-based light.

use super::document::Ibl;
use framegraph_scene::environment::{FilteredLight, Sh};
use framegraph_scene::{Environment, progress};
use glam::DVec3;
use std::error::Error;
use std::path::Path;

/// Returns the environment, from `file` if the statement names one; black by default. Stated harmonics override those
/// of the cube, as in Filament.
///
/// # Errors
/// An invalid statement or file.
pub fn around(stated: Option<&Ibl>, file: Option<&Path>) -> Result<Environment, Box<dyn Error>> {
    let Some(ibl) = stated else { return Ok(Environment::uniform(DVec3::ZERO)?) };
    let harmonics = ibl.sh.as_deref().map(harmonics).transpose()?;
    let mut environment = match file {
        Some(file) => Environment::load(file, &mut progress::silent)?,
        None => Environment::uniform(ibl.uniform_cube.map_or(DVec3::ZERO, DVec3::from_array))?,
    };
    if file.is_some() && environment.filtered.is_none() {
        return Err(format!("scene.ibl.ktx1: {} has no irradiance (`sh`) or only one level", environment.name).into());
    }
    let Some(factors) = harmonics else { return Ok(environment) };
    let sh = Sh::from_irradiance_over_pi(factors);
    match &mut environment.filtered {
        Some(filtered) => filtered.sh = sh,
        None => {
            let texel = environment.map.texels()[0];
            let levels = vec![vec![texel; 6 * 4], vec![texel; 6]];
            environment.filtered = Some(FilteredLight { size_texels: 2, levels, sh });
        }
    }
    Ok(environment)
}

/// Returns nine colors; missing ones are zero.
fn harmonics(numbers: &[f64]) -> Result<[[f32; 3]; 9], String> {
    if !matches!(numbers.len(), 3 | 12 | 27) || numbers.iter().any(|number| !number.is_finite()) {
        return Err("scene.ibl.sh: needs 3, 12 or 27 finite numbers: one, two or three bands of colors".into());
    }
    let mut factors = [[0.0; 3]; 9];
    factors.as_flattened_mut().iter_mut().zip(numbers).for_each(|(factor, number)| *factor = *number as f32);
    Ok(factors)
}
