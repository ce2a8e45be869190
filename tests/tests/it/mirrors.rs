//! Every function of the shader library on the default adapter matches its f64 mirror within the documented bound.

use crate::light_document::rows;
use crate::stage;
use framegraph_shader_mirrors::cases;
use std::error::Error;
use tests::mirror;

/// Points in each function's domain; a quarter are corners.
const POINTS: usize = 2048;

#[test]
fn every_library_function_equals_its_mirror_on_the_device() -> Result<(), Box<dyn Error>> {
    let Some(gpu) = stage::gpu("every_library_function_equals_its_mirror_on_the_device") else { return Ok(()) };
    let mut failures = Vec::new();
    let mut compared = 0;
    let mut documented = rows("Shader library against").into_iter().skip(1);
    for case in cases::all() {
        let name = format!("{}::{}", case.file, case.function);
        let renew = "renew docs/measurements/image-light.md: cargo run -p tests --bin measure -- ibl-errors mirrors";
        let printed = documented.next().unwrap_or_else(|| panic!("{name} is missing; {renew}"));
        assert_eq!(printed[0], name, "{renew}");
        match mirror::compare(&gpu, case, POINTS) {
            Ok(deviation) => {
                compared += 1;
                // Drivers round differently, so the largest error may grow by half.
                let of_bound: f64 = printed[2].trim_end_matches(" %").parse()?;
                let found = 100.0 * deviation.of_bound;
                assert!(
                    found < 1.5 * of_bound + 5.0,
                    "{name}: {found} % of its bound, and the document has {of_bound} %"
                );
            }
            Err(error) => failures.push(error.to_string()),
        }
    }
    assert!(failures.is_empty(), "{} of {} differ:\n{}", failures.len(), compared, failures.join("\n"));
    assert!(compared > 80, "only {compared} functions were compared");
    Ok(())
}

/// Negative control: each function's result is changed by 0.1 % before the comparison.
#[test]
fn a_result_that_is_off_is_found() -> Result<(), Box<dyn Error>> {
    let Some(gpu) = stage::gpu("a_result_that_is_off_is_found") else { return Ok(()) };
    for name in ["d_ggx", "v_neubelt", "irradiance_sh5"] {
        let case = cases::all().find(|case| case.function == name).ok_or(name)?;
        let inputs = case.inputs(POINTS);
        let mut results = mirror::results(&gpu, case, &inputs)?;
        assert!(case.check(&inputs, &results).is_ok(), "{name}");
        results.iter_mut().for_each(|y| *y *= 1.001);
        assert!(case.check(&inputs, &results).is_err(), "{name} times 1.001 passes");
    }
    Ok(())
}
