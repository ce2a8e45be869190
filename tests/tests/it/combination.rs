//! Combinations of effects that once crashed a driver, each drawn in a child process.

use crate::stage::gpu;
use framegraph_passes::gpu_scene::shadow_views::{ShadowFilter, ShadowSettings};
use framegraph_passes::{FogSettings, Settings};
use framegraph_wgpu::FrameLoop;
use std::error::Error;
use std::process::Command;
use tests::stage::Stage;

type TestResult = Result<(), Box<dyn Error>>;

/// Environment variable that is set in the child process.
const CHILD: &str = "FRAMEGRAPH_COMBINATION";
const NAME: &str = "combination::fog_froxels_and_one_cascade_are_drawn";

/// Fog, froxels and a single shadow map of the sun together crashed Mesa's software driver.
/// `shaders/tests/all/branches.rs` explains the reason and checks all shaders.
#[test]
fn fog_froxels_and_one_cascade_are_drawn() -> TestResult {
    let Some(gpu) = gpu(NAME) else { return Ok(()) };
    if std::env::var_os(CHILD).is_none() {
        let child = Command::new(std::env::current_exe()?).args(["--exact", NAME]).env(CHILD, "1").output()?;
        let said = String::from_utf8_lossy(&child.stdout);
        assert!(child.status.success() && said.contains("1 passed"), "{}: {said}", child.status);
        return Ok(());
    }
    let mut stage = Stage::new(&gpu, "lamps:9")?;
    let mut frames = FrameLoop::new(&gpu);
    for (number, filter) in (0..).zip([ShadowFilter::Pcf, ShadowFilter::Pcss, ShadowFilter::Vsm]) {
        let shadows = Some(ShadowSettings { filter, cascades: 1, ..ShadowSettings::texels(128) });
        let settings = Settings { shadows, fog: Some(FogSettings::DEFAULT), ..Settings::DEFAULT };
        stage.draw(&mut frames, &settings, [64, 48], number)?;
    }
    gpu.wait()?;
    Ok(())
}
