//! One torus in every supported geometry compression: pictures differ only by quantization.

use crate::stage::{Set, Shot, gpu};
use framegraph::Options;
use framegraph_passes::Settings;
use framegraph_passes::gpu_scene::view::Background;
use framegraph_scene::{Camera, Scene, import, progress};
use framegraph_wgpu::Gpu;
use std::error::Error;
use std::path::Path;
use tests::compare::compare;

fn load(name: &str) -> Result<Scene, Box<dyn Error>> {
    let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/assets/compressed"));
    Ok(import::load(&folder.join(format!("{name}.glb")), &mut progress::silent)?)
}

/// Draws a scene from a given camera. The default camera would follow the quantized bounds.
fn picture(gpu: &Gpu, mut scene: Scene, camera: &Camera) -> Result<Vec<u8>, Box<dyn Error>> {
    scene.cameras = vec![camera.clone()];
    let options = Options::for_frame(64, 64);
    let shot = Shot { size_px: [64, 64], options, ..Shot::small(Settings { shadows: None, ..Settings::default() }) };
    Ok(Set::of(gpu, scene, &shot, &Background::Environment)?.shoot(gpu, &shot)?.0)
}

/// Returns the PSNR in dB for normals tilted by at most `tilt_rad`. Light changes by at most that share of white,
/// uniformly distributed. Position errors are below 0.01 pixels, and color errors below two 8-bit steps.
fn psnr_db(tilt_rad: f64) -> f64 {
    20.0 * (12f64.sqrt() / tilt_rad).log10()
}

#[test]
fn compressed_meshes_look_like_the_uncompressed_one() -> Result<(), Box<dyn Error>> {
    let Some(gpu) = gpu("compressed_meshes_look_like_the_uncompressed_one") else { return Ok(()) };
    let raw = load("raw")?;
    let camera = raw.default_camera(1.0);
    let expected = picture(&gpu, raw.clone(), &camera)?;
    let psnr_of = |scene: Scene| -> Result<f64, Box<dyn Error>> {
        let difference = compare(&picture(&gpu, scene, &camera)?, &expected);
        Ok(difference.ok_or("the pictures differ in size")?.psnr_db)
    };
    // Errors of normals, derived from the encoders' settings as in the importer's tests.
    let fine = psnr_db(18f64.sqrt() / 1022.0);
    let bytes = psnr_db((18f64.sqrt() + 3f64.sqrt()) * 0.5 / 127.0);
    for (name, least_psnr_db) in [
        // Equal triangles in another order; drivers may differ in single pixels.
        ("draco_lossless", 60.0),
        ("meshopt_v1", 60.0),
        ("draco_edgebreaker_0", fine),
        ("draco_sequential", fine),
        ("meshopt_filters_v1", bytes),
        ("quantized", bytes),
    ] {
        let found = psnr_of(load(name)?)?;
        assert!(found >= least_psnr_db, "{name}: {found:.1} dB, less than {least_psnr_db:.1}");
    }
    // Negative controls: normals of 6 bits, and missing colors.
    let coarse = psnr_of(load("draco_coarse")?)?;
    assert!(coarse < fine, "6 bits for normals look like 10: {coarse:.1} dB");
    let mut white = raw;
    white.meshes[0].colors.clear();
    let found = psnr_of(white)?;
    assert!(found < bytes, "missing colors are not seen: {found:.1} dB");
    Ok(())
}
