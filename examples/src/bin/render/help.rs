//! Help of `render`, composed of the sections of its option modules.

use crate::{animation, budget, debug, decide, effects, grade, light, shadows};

/// Returns the text of `render --help`.
pub fn help() -> String {
    HELP.replace("ANIMATION\n", animation::HELP)
        .replace("LIGHTING\n", light::HELP)
        .replace("GRADING\n", grade::HELP)
        .replace("SHADOWS\n", shadows::HELP)
        .replace("EFFECTS\n", effects::HELP)
        .replace("FRAME\n", &decide::help())
        .replace("BUDGET\n", budget::HELP)
        .replace("DEBUGGING\n", debug::HELP)
}

const HELP: &str = "\
Renders a scene with the compiled render graph and writes the picture as PNG. It opens no window.

usage: render [SCENE] [options]

SCENE is a glTF or GLB file, or a built-in scene: spheres (default), balls, columns, glass, lamps (1000 punctual lights;
lamps:N has N), lobes, materials, optics, panes (5 crossing blended panes; panes:N has N).
Defaults of options are in parentheses.

PICTURE AND CAMERA
  --size WxH           picture size in pixels (1280x720)
  --msaa 1|4           samples per pixel (4)
  --camera CAMERA      a camera of the scene by name, `orbit` (frames the whole scene), or EX,EY,EZ:TX,TY,TZ:FOVY with eye
                       and target in meters and the vertical field of view in degrees; default: the first camera of the
                       scene, else orbit
  --camera-from-gltf   require a camera of the file: the first, or the one named by --camera
  --variant NAME       material variant of the file (KHR_materials_variants)

ANIMATION

LIGHTING

SHADING
  --quality low|high|ultra  shading quality: `low` as Filament on phones, `high` as on desktops, `ultra` with more bands of
                       irradiance and finer reflections (high)
  --shade KEY=X,...    single shading options:
                       visibility=exact|fast (specular visibility term), table=exact|fast (of the DFG lookup table; default:
                       as visibility), floor=R (minimum roughness), f90-fades=on|off,
                       compensation=on|off|image|punctual (energy compensation for multiple scattering),
                       bands=2|3|5 (spherical harmonics of irradiance), window=none|hann|sinc|laplacian:LAMBDA (of the
                       bands, reduces ringing), irradiance=harmonics|cube (cube: last level of the prefiltered
                       environment), environment-format=rg11b10|half|rgbm (of the prefiltered environment), aa=on|off|VARIANCE:THRESHOLD (specular anti-aliasing),
                       multi-bounce=on|off (of ambient occlusion), specular-occlusion=on|off,
                       micro-shadows=on|off (of the sun, from the material's occlusion), fast-coat=on|off (cheaper
                       clear-coat reflection), coat-ior-change=on|off (clear coat lowers the f0 of the base),
                       transmission-blur=distance|angle (of the background behind rough transmissive bodies; angle as in
                       Filament), light-window=gltf|filament (falloff of punctual lights at their range),
                       light-fade=off|M (distance in meters beyond which punctual lights are off)
  --precision f32|f16  precision of shading; f16 requires adapter support and raises the minimum roughness to 0.089 (f32)

POST-PROCESSING
  --compensation EV    exposure compensation (0)
  --vignette EV        darkening of the corners relative to the center (0)
  --dither X           dither amplitude: 1 is half an 8-bit step in both directions (1)
  --inline on|off      run post-processing at the end of the color pass's shader where possible (on)
  --round-hdr          with --inline, round radiance to the precision of the HDR format first; with --msaa 1 the picture
                       then equals that of --inline off bit for bit
  --split-post         run every post-processing effect as a pass of its own
  --compare-post       print the cost of post-processing inlined, in one pass, and in one pass per effect, at one and four
                       samples, instead of rendering a picture (--size 1920x1080)
  --no-fxaa            disable FXAA

GRADING

SHADOWS

EFFECTS

FRAME

BUDGET

DEBUGGING

EXECUTION
  --frames N           measured frames, after four warm-up frames (8)
  --alias heap|pool|off   memory sharing of transient textures: heap places them in one memory block (Vulkan; elsewhere as
                       pool), pool reuses textures of equal description, off disables sharing (pool)
  --threads auto|N     threads that record a frame where measurements show a gain (auto: number of cores)
  --memory BYTES       memory limit of loading: files, decoding, mip levels, upload; such as 512MiB or 2GB (half of the
                       machine's memory)
  --allow-outside      allow buffers and images outside the folder of the scene

OUTPUT
  --out FILE.png       the picture (render.png)
  --linear-out FILE.exr  exposed radiance before tone mapping, linear Rec.709, at the rendered size. It contains shading,
                       shadows, ao, ssr, glass, blending, fog, background, msaa, taa and dof. It excludes bloom, flares,
                       --compensation, vignette, edge fade, grading, tone curve, dither, fxaa and upscaling. Values above 1
                       are kept, so it conflicts with --disable hdr-target
  --plan FILE          the plan as text, with its graph in a .dot file of the same name (PICTURE.plan.txt)
  --help               print this help

The best adapter is chosen, hardware first; WGPU_BACKEND and WGPU_ADAPTER_NAME select another.
Image-based light is cached in the user's cache folder; FRAMEGRAPH_LIGHT_CACHE names another folder, or `off`.
All files are written together at the end, or none; pipes and devices are written through. SIGINT and SIGTERM stop the run at
its next step without writing files.
Exit codes: 0 success, 1 device failure, 2 invalid input or output, 128 + N stopped by signal N.";

#[cfg(test)]
mod tests {
    /// The manual lists the options that the program prints.
    #[test]
    fn the_manual_has_all_options() {
        let manual = include_str!("../../../../docs/render.md");
        let (_, after) = manual.split_once("<!-- help -->\n```text\n").expect("the manual has a block of options");
        let (block, _) = after.split_once("\n```\n<!-- end -->").expect("the block ends");
        assert!(
            block == super::help().trim_end(),
            "docs/render.md: replace the options by the output of `render --help`"
        );
    }
}
