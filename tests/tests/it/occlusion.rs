//! Ambient occlusion: loads and stores of frames with it, and its error in scenes with known results.

mod hard;
mod shaded;

use crate::stage::{self, gpu, precisions};
use framegraph::{Caps, Counts, Options, Target, TextureDesc};
use framegraph_passes::SettingsTable;
use framegraph_passes::effects::depth::structure::{Resolution, structure};
use framegraph_passes::effects::occlusion::OcclusionSettings;
use framegraph_passes::stages::Handles;
use framegraph_passes::{Precision, Settings, World, standard};
use framegraph_scene::Projection;
use framegraph_wgpu::Frame;
use glam::DVec3;
use std::error::Error;
use std::path::Path;
use tests::measure::columns::Columns;
use tests::measure::occlusion::mirror::Mirror;
use tests::measure::occlusion::{
    Stage, column, corner, corner_columns, corner_error, corner_stage, ground, mean_and_deviation,
};
use truth::occlusion as truth;

type TestResult = Result<(), Box<dyn Error>>;

/// Default radius, in m.
const RADIUS_M: f64 = 0.3;

fn settings(text: &str) -> Result<OcclusionSettings, Box<dyn Error>> {
    OcclusionSettings::from_text(text)?.ok_or_else(|| format!("{text}: it is off").into())
}

/// Returns the minimum and mean visibility of surfaces.
fn least_and_mean(stage: &Stage, visibility: &[f32]) -> [f64; 2] {
    let covered = visibility.iter().zip(&stage.depth).filter(|(_, depth)| **depth > 0.0);
    let covered: Vec<f64> = covered.map(|(visibility, _)| f64::from(*visibility)).collect();
    [covered.iter().copied().fold(f64::INFINITY, f64::min), mean_and_deviation(&covered)[0]]
}

/// Filament's frame with separate grading, FXAA and SAO, without shadows and with five levels of structure, has 3 loads
/// and 14 stores. The loads are the structure's depth, read-only in the three passes of SAO; 3 of the stores are flags
/// of these loads.
///
/// step              attachment         load       store
/// prepass           depth              clear      STORE
/// structure         level 0            don't care STORE   (a copy of the depth, or half of it)
/// structure_level   levels 1 to 4      don't care STORE, each
/// occlusion         occlusion          don't care STORE
/// occlusion_blur    occlusion_blurred  don't care STORE, twice
/// color             ldr                clear      STORE
///                   depth              LOAD       discard
/// fxaa              output             don't care STORE
///
/// With four samples the structure is drawn, and the color pass tests its own depth: no load, and a store less.
#[test]
fn counts_are_less_than_filaments() {
    let options = Options::for_frame(1920, 1088);
    for (samples, resolution) in
        [(1, Resolution::Full), (1, Resolution::Half), (4, Resolution::Full), (4, Resolution::Half)]
    {
        let occlusion = Some(OcclusionSettings { resolution, ..OcclusionSettings::SAO });
        let frame = Settings { samples, shadows: None, occlusion, structure_levels: 5, ..Settings::DEFAULT };
        let plan = stage::plan(&frame, &Caps::wgpu(), &options);
        let shared = u32::from(samples == 1);
        let expected = Counts {
            unresolves: shared,
            resolves: 10 + shared,
            clears: 3 - shared,
            discards: 2 - shared,
            multisample_resolves: 1 - shared,
            memoryless: 2 - 2 * shared,
            inlined: 1,
            steps: 10 + shared,
            render_passes: 10 + shared,
            passes: 11 + shared,
            culled: 0,
        };
        assert_eq!(plan.counts(), expected, "{samples} samples, {resolution:?}");
        // A separate post-processing pass, as in Filament, stores one more picture.
        let apart = stage::plan(&frame, &Caps::wgpu(), &Options { inline: false, ..options }).counts();
        assert_eq!((apart.unresolves, apart.resolves), (shared, 11 + shared));
        // Without the flags of read-only depth.
        assert!(apart.unresolves + apart.resolves < 3 + 14 - 3, "{apart:?}");
    }
}

/// The depth structure is drawn only if a pass reads it.
#[test]
fn an_unread_structure_is_culled() -> TestResult {
    let mut frame = Frame::<World>::new();
    let mut handles = Handles::default();
    let first = structure(&mut frame, &mut handles, Resolution::Half, 3)?;
    assert_eq!(structure(&mut frame, &mut handles, Resolution::Half, 1)?, first, "declared once");
    let target =
        frame.graph_mut().texture("out", TextureDesc::new(framegraph::Extent::FRAME, framegraph::Format::Rgba8Unorm));
    let io = standard(&mut frame, &Settings { shadows: None, ..Settings::DEFAULT }, Target::from(target))?;
    frame.graph_mut().readback(io.output)?;
    let mut plan = framegraph::Plan::new();
    let options = Options::for_frame(256, 256);
    framegraph::compile(frame.graph(), &Caps::wgpu(), &options, &mut framegraph::Scratch::new(), &mut plan)?;
    assert_eq!((plan.counts().culled, plan.counts().resolves), (3, 2));
    Ok(())
}

/// Ground without occluders has a visibility of at least 0.98 at any tilt; Filament has 0.85. Negative control:
/// Filament's sample positions, which cause the darkening.
#[test]
fn open_ground_stays_open() -> TestResult {
    let test = "open_ground_stays_open";
    let Some(gpu) = gpu(test) else { return Ok(()) };
    for tilt in [0.0, -45.0, 80.0] {
        // A view so close that the radius covers all levels of the pyramid.
        let stage = Stage::new(Projection::perspective(0.8, 0.01), [256, 192], ground(1.0, tilt))?;
        for precision in precisions(test, &gpu) {
            for text in ["sao:quality=high", "gtao", "gtao:occluders=0.5", "gtao:bent-normals=on,cone=on"] {
                let made = stage.visibility(&gpu, &settings(text)?, precision)?;
                let [least, mean] = least_and_mean(&stage, &made);
                assert!(least >= 0.98, "{text} at {tilt}° in {precision:?}: {least}, {mean} in the mean");
            }
        }
        if tilt != 0.0 {
            let filaments = settings("sao:quality=high,place=filament")?;
            let [_, mean] = least_and_mean(&stage, &stage.visibility(&gpu, &filaments, Precision::Full)?);
            assert!(mean < 0.9, "{tilt}°: {mean}");
        }
    }
    Ok(())
}

/// Two perpendicular planes: the error of GTAO is within 0.05. SAO estimates another quantity, and is compared with its
/// known limit.
#[test]
fn the_corner_is_near_its_truth() -> TestResult {
    let Some(gpu) = gpu("the_corner_is_near_its_truth") else { return Ok(()) };
    let stage = corner_stage(256)?;
    for (text, most) in [("gtao", 0.05), ("gtao:occluders=0.5", 0.05), ("gtao:slices=4,steps=8", 0.04)] {
        let rms = corner_error(&stage, &stage.visibility(&gpu, &settings(text)?, Precision::Full)?, RADIUS_M);
        assert!(rms < most, "{text}: {rms}");
    }
    let made = stage.visibility(&gpu, &settings("sao:quality=ultra,blur=off,bias=0")?, Precision::Full)?;
    let error = corner_error(&stage, &made, RADIUS_M);
    assert!((0.06..0.12).contains(&error), "the model's error: {error}");
    // Computed independently from another eye; within 0.04, since the closest column is a third of a centimeter wide.
    for (distance_m, known) in [(0.05, 0.490), (0.1, 0.692), (0.15, 0.826), (0.2, 0.918)] {
        let columns = corner_columns(&stage, 1.0);
        let nearest = columns.iter().min_by(|a, b| (a.1 - distance_m).abs().total_cmp(&(b.1 - distance_m).abs()));
        let (x, _) = nearest.ok_or("a column")?;
        let [mean, _] = mean_and_deviation(&column(&stage, &made, *x));
        assert!(
            (mean - known).abs() < 0.04,
            "{distance_m} m: {mean}, not {known}, truth {}",
            truth::corner(distance_m, RADIUS_M)
        );
    }
    Ok(())
}

/// The scene of columns compared with path tracing: a root mean square error of at most 0.05. Filament has 0.057 after
/// division by its offset, and about 0.17 with it.
#[test]
fn columns_are_near_what_rays_find() -> TestResult {
    let Some(gpu) = gpu("columns_are_near_what_rays_find") else { return Ok(()) };
    let columns = Columns::open(Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/references/filament_frame")))?;
    for text in ["sao:quality=ultra", "gtao"] {
        let off = columns.off(&gpu, settings(text)?)?;
        assert!(off.rms < 0.04 && off.bias.abs() < 0.01, "{text}: {off:?}");
    }
    let filaments = columns.off(&gpu, settings("sao:quality=ultra,place=filament,normals=coarse")?)?;
    assert!(filaments.rms > 0.1, "{filaments:?}");
    // Shading at half resolution: the color pass selects texels by depth.
    let half = columns.off_as_shaded(&gpu, settings("gtao:resolution=half")?)?;
    assert!(half.rms < 0.05, "{half:?}");
    Ok(())
}

/// On the floor of a corner, the bent normal leans away from the wall as in the sum over directions.
#[test]
fn bent_normals_lean_away_from_walls() -> TestResult {
    let Some(gpu) = gpu("bent_normals_lean_away_from_walls") else { return Ok(()) };
    let stage = corner_stage(256)?;
    // Right side of the corner: its normal, and the direction to the edge along it.
    let (normal, to_edge) = (DVec3::new(-1.0, 0.0, 1.0).normalize(), DVec3::new(-1.0, 0.0, -1.0).normalize());
    let bent = settings("gtao:slices=8,steps=16,bent-normals=on,blur=off")?;
    let (texels, _) = stage.occlusion(&gpu, &bent, Precision::Full, 1)?;
    for distance_m in [0.05, 0.1, 0.2] {
        let columns = corner_columns(&stage, 1.0).into_iter().filter(|(x, _)| *x >= stage.size_px[0] / 2);
        let nearest = columns.min_by(|a, b| (a.1 - distance_m).abs().total_cmp(&(b.1 - distance_m).abs()));
        let (x, distance_m) = nearest.ok_or("a column")?;
        let rows = 64..192;
        let sum: DVec3 = rows
            .map(|y| {
                let [_, x, y, z] = texels[(y * 256 + x) as usize];
                DVec3::new(x.into(), y.into(), z.into())
            })
            .sum();
        let found = sum.normalize();
        let lean = truth::corner_lean(distance_m, RADIUS_M);
        let expected = (normal * lean.cos() - to_edge * lean.sin()).normalize();
        let apart = found.dot(expected).clamp(-1.0, 1.0).acos().to_degrees();
        assert!(apart < 6.0, "{distance_m} m: {found} for {expected}, {apart}° apart");
        assert!(lean.to_degrees() > 6.0 || distance_m > 0.15, "the lean is more than the error: {lean}");
    }
    Ok(())
}

/// Texels match the f64 mirror, for a ball before a corner without surroundings, near and far, in both projections.
/// Exceptions are texels in which rounding selects another texel, or another end of the 32 sectors.
#[test]
fn texels_are_those_of_the_mirror() -> TestResult {
    let Some(gpu) = gpu("texels_are_those_of_the_mirror") else { return Ok(()) };
    let wall = corner(3.0);
    let scene = move |start: DVec3, direction: DVec3| {
        let from = start - DVec3::new(0.25, -0.1, -2.6);
        let (b, c) = (from.dot(direction), from.length_squared() - 0.3 * 0.3);
        let root = b * b - direction.length_squared() * c;
        let ball = (root > 0.0).then(|| (-b - root.sqrt()) / direction.length_squared());
        let behind = wall(start, direction).filter(|way| (start + *way * direction).y < 0.55);
        ball.into_iter().chain(behind).reduce(f64::min)
    };
    let perspective = Projection::perspective(0.6, 0.1);
    let parallel = Projection::Orthographic { half_width_m: None, half_height_m: 0.8, near_m: 0.1, far_m: 10.0 };
    for projection in [perspective, parallel] {
        for (text, toward_sun) in [
            ("sao:radius=0.6,bent-normals=on,blur=off", DVec3::ZERO),
            ("sao:radius=0.2,quality=ultra,normals=coarse,place=filament,blur=off", DVec3::ZERO),
            ("gtao:radius=0.6,bent-normals=on,blur=off", DVec3::ZERO),
            ("gtao:radius=0.5,slices=4,steps=3,occluders=fading,blur=off", DVec3::ZERO),
            ("gtao:radius=0.6,occluders=0.2,blur=off", DVec3::ZERO),
            ("gtao:radius=0.0001,cone=on,blur=off", DVec3::new(-1.0, 0.3, 0.4)),
            ("gtao:radius=0.0001,cone=on,blur=off", DVec3::new(0.8, 0.1, -0.7)),
        ] {
            let mut settings = settings(text)?;
            if let Some(cone) = &mut settings.cone {
                (cone.reach_m, cone.rays, cone.steps, cone.slope_bias_m) = (0.8, 2, 6, 0.05);
            }
            let toward_sun = Some(toward_sun).filter(|sun| *sun != DVec3::ZERO);
            let stage = Stage { toward_sun, ..Stage::new(projection, [60, 44], &scene)? };
            let (found, _) = stage.occlusion(&gpu, &settings, Precision::Full, 1)?;
            let expected = Mirror::new(&stage, &settings).texels();
            let channels = if settings.has_bent_normals() { 4 } else { 1 };
            // Eight bits of visibility, half floats of directions.
            let within = if channels == 4 { 2e-3 } else { 0.6 / 255.0 };
            let off = |(found, expected): (&[f32; 4], &[f64; 4])| {
                (0..channels).map(|c| (f64::from(found[c]) - expected[c]).abs()).fold(0.0, f64::max)
            };
            let off: Vec<f64> = found.iter().zip(&expected).map(off).collect();
            let others = off.iter().filter(|off| **off > within).count();
            let occluded = expected.iter().filter(|texel| texel[0] < 0.9).count();
            assert!(occluded * 20 > off.len(), "{text}: {occluded} texels are occluded");
            println!(
                "{text}: {others} others, {occluded} occluded, worst {:?}",
                off.iter().copied().fold(0.0, f64::max)
            );
            assert!(others * 50 <= off.len(), "{text}: {others} of {} texels are others", off.len());
        }
    }
    Ok(())
}

/// The foot of a wall is shadowed from a sun behind it, within the cone's range. A sun that shines into the corner
/// casts no such shadow.
#[test]
fn cones_find_what_stands_before_the_sun() -> TestResult {
    let Some(gpu) = gpu("cones_find_what_stands_before_the_sun") else { return Ok(()) };
    // A tiny radius leaves only the cone's occlusion.
    let traced = settings("gtao:radius=0.0001,cone=on,blur=off")?;
    let shadowed = |toward_sun| {
        let stage = Stage { toward_sun: Some(toward_sun), ..corner_stage(256)? };
        let (texels, _) = stage.occlusion(&gpu, &traced, Precision::Full, 1)?;
        let visibility: Vec<f32> = texels.iter().map(|texel| texel[0]).collect();
        let columns = corner_columns(&stage, 1.0).into_iter().filter(|(x, _)| *x > stage.size_px[0] / 2 + 2);
        let mean = |range: std::ops::Range<f64>| {
            let of = columns.clone().filter(|(_, distance_m)| range.contains(distance_m));
            let values: Vec<f64> = of.flat_map(|(x, _)| column(&stage, &visibility, x)).collect();
            mean_and_deviation(&values)[0]
        };
        Ok::<_, Box<dyn Error>>([mean(0.02..0.1), mean(0.45..0.6)])
    };
    // Toward the edge, slightly out of the right side's plane: the left side occludes it.
    let before = shadowed(DVec3::new(-1.0, 0.0, -0.6))?;
    assert!(before[0] < 0.7 && before[1] > 0.95, "{before:?}");
    let open = shadowed(DVec3::new(0.0, 0.3, 1.0))?;
    assert!(open.iter().all(|visibility| *visibility > 0.97), "{open:?}");
    Ok(())
}

/// Ground at a grazing angle is blurred vertically too, although depth changes between rows by more than the blur's
/// threshold. Along rows, less than 1/25 of the noise remains.
#[test]
fn grazing_ground_is_smoothed_as_far_as_a_wall() -> TestResult {
    let Some(gpu) = gpu("grazing_ground_is_smoothed_as_far_as_a_wall") else { return Ok(()) };
    let floor = ground(3.0, 80.0);
    let wall = ground(3.05, 0.0);
    let scene = move |start, direction| Some(floor(start, direction)?.min(wall(start, direction)?));
    let stage = Stage::new(Projection::perspective(0.2, 0.1), [256, 128], scene)?;
    let noise = |text: &str| {
        let made = stage.visibility(&gpu, &settings(text)?, Precision::Full)?;
        // The rows of the floor nearest to the wall.
        let row = |y: usize| made[y * 256 + 32..y * 256 + 224].iter().map(|v| f64::from(*v)).collect::<Vec<_>>();
        let rows: Vec<f64> = (66..74).map(|y| mean_and_deviation(&row(y))[1]).collect();
        Ok::<_, Box<dyn Error>>(mean_and_deviation(&rows)[0])
    };
    let (raw, smooth) = (noise("sao:blur=off")?, noise("sao:quality=low,blur=high")?);
    assert!(raw > 0.03, "there is noise to smooth: {raw}");
    // Without following the slope, 1/19 remains.
    assert!(smooth < raw / 25.0, "{smooth} of {raw}");
    Ok(())
}
