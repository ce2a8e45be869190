//! References: another renderer's pictures of fully stated scenes, which ours must match within a tolerance; and tests
//! of the harness.

use crate::stage::gpu;
use framegraph_passes::Quality;
use std::error::Error;
use std::path::{Path, PathBuf};
use tests::files::references;
use tests::reference::document::Document;
use tests::reference::examine::{How, Outcome, Verdict, between_qualities, examine, render};
use tests::reference::metrics::Metrics;
use tests::reference::picture::Picture;
use tests::reference::report as told;
use tests::reference::studio::Shade;

type TestResult = Result<(), Box<dyn Error>>;

/// Examines statements of a folder, and compares with the table that `command` prints.
#[allow(clippy::print_stdout, reason = "shown with --nocapture")]
fn examined(test: &str, (command, folder): Table<'_>, ids: &[&str]) -> Result<Option<Vec<Outcome>>, Box<dyn Error>> {
    let Some(gpu) = gpu(test) else { return Ok(None) };
    let one = |id: &&str| examine(&gpu, &folder.join(format!("{id}.json")), How::default());
    let outcomes = ids.iter().map(one).collect::<Result<Vec<_>, _>>()?;
    print!("{}", told::table(&outcomes));
    documented(command, &outcomes);
    Ok(Some(outcomes))
}

/// A table of the document: the command that prints it, and the folder of its references.
type Table<'a> = (&'a str, &'a Path);

const DOCUMENT: &str = include_str!("../../../docs/measurements/references.md");

/// Returns the cells of a scene's row in the table that a command prints.
fn row(command: &str, id: &str) -> Vec<&'static str> {
    let (_, after) = DOCUMENT.split_once(&format!("<!-- table: {command} -->")).expect("the document has the table");
    let (table, _) = after.split_once("<!-- end -->").expect("the table ends");
    let row = table.lines().find(|line| line.starts_with(&format!("| {id} "))).unwrap_or_else(|| panic!("{id}"));
    row.trim_matches('|').split('|').map(str::trim).collect()
}

/// Checks that the document has the same verdict and numbers.
fn documented(command: &str, outcomes: &[Outcome]) {
    for Outcome { id, verdict, metrics, .. } in outcomes {
        let cells = row(command, id);
        assert_eq!(cells[1], told::word(verdict), "{id}");
        match metrics {
            Some(metrics) => printed(&cells, metrics),
            // A chart without a picture.
            None => assert!(cells[2..].iter().all(|cell| *cell == "-"), "{id}: {cells:?}"),
        }
    }
}

/// Compares each number of a row, within the rounding of other drivers at edges and in filters. The bounds are a decibel, a
/// tenth of FLIP and of the errors, and a tenth of the shares of pixels or one in 2000. Above 55 dB only single 8-bit steps
/// differ, and the processor decides some of them: one driver on two machines gave FLIP 0.00219 and 0.00259 for the same
/// picture. PSNR counts as 55 dB there, and FLIP may differ by 5e-4, a sixth of that of random steps at 62 dB.
fn printed(cells: &[&str], found: &Metrics) {
    let number = |cell: &str| cell.trim_end_matches(" %").parse().unwrap_or_else(|error| panic!("{cell}: {error}"));
    let printed: Vec<f64> = cells[2..].iter().map(|cell| number(cell)).collect();
    let [p50, p95, p99] = found.relative;
    assert!((printed[0].min(55.0) - found.psnr_db.min(55.0)).abs() < 1.0, "{cells:?}: {found:?}");
    let near = |at: usize, found: f64, least: f64| (printed[at] - found).abs() <= 0.1 * printed[at] + least;
    let shares = near(2, 100.0 * found.off_2, 0.05) && near(3, 100.0 * found.off_8, 0.05);
    let errors = near(4, p50, 2e-4) && near(5, p95, 2e-4) && near(6, p99, 2e-4);
    let flip_slack = if printed[0].min(found.psnr_db) > 55.0 { 5e-4 } else { 5e-5 };
    assert!(near(1, found.flip, flip_slack) && shares && errors, "{cells:?}: {found:?}");
}

/// References that state a rule.
const RULED: [&str; 5] =
    ["01_furnace_metal_f0_1", "02_grid_sun_noshadow", "04_grid_ibl_gray", "06_ramp_filmic", "07_edges_fxaa"];

/// The rules come with the references, and each rejects light that is a tenth too bright.
#[test]
fn references_pass_by_their_own_rules() -> TestResult {
    let test = "references_pass_by_their_own_rules";
    pass(examined(test, ("reference", &references()), &RULED)?);
    Ok(())
}

/// Checks that all passed, and that each rejects the same picture made a tenth brighter.
fn pass(outcomes: Option<Vec<Outcome>>) {
    for Outcome { id, verdict, control, .. } in outcomes.into_iter().flatten() {
        assert_eq!((verdict, control), (Verdict::Passed, Some(true)), "{id}");
    }
}

/// References of whole frames that use only implemented features.
const FRAMES: [&str; 17] = [
    "01b_furnace_dielectric_f05_gold",
    "03_grid_sun_shadow_pcf",
    "05a_columns_ibl_ao_off",
    "05b_columns_ibl_ao_on",
    "06_ramp_aces",
    "06g_grade_contrast_1_4",
    "06g_grade_curves",
    "06g_grade_smh",
    "06g_grade_wb_0_3_m0_2",
    "11_shadow_clay_none",
    "11_shadow_clay_pcf",
    "11_shadow_clay_vsm",
    "12_grid_bloom_ldr",
    "12_grid_nobloom_ldr",
    "13_grid_fog_linear",
    "14_columns_vignette_ldr",
    "15_grid_sun_msaa4_ldr",
];

#[test]
fn whole_frames_that_are_built_pass() -> TestResult {
    let folder = references().with_file_name("filament_frame");
    let table = ("reference tests/references/filament_frame", folder.as_path());
    pass(examined("whole_frames_that_are_built_pass", table, &test_report::share(FRAMES))?);
    Ok(())
}

/// The low preset has its own DFG table and also passes the rules.
#[test]
fn the_low_preset_passes_too() -> TestResult {
    let test = "the_low_preset_passes_too";
    let (folder, Some(gpu)) = (references(), gpu(test)) else { return Ok(()) };
    let how = How { shade: Shade::Preset(Quality::Low), ..How::default() };
    for id in RULED {
        let outcome = examine(&gpu, &folder.join(format!("{id}.json")), how)?;
        assert_eq!((&outcome.verdict, outcome.control), (&Verdict::Passed, Some(true)), "{id}: {:?}", outcome.metrics);
        documented("reference --quality low", &[outcome]);
    }
    // These two scenes are unlit.
    for id in ["06_ramp_input_linear", "07_edges_none"] {
        assert_eq!(row("reference --quality low", id), row("reference", id));
    }
    Ok(())
}

/// The difference of a lit and an unlit scene between presets matches the document.
#[test]
fn presets_are_as_far_apart_as_the_document_says() -> TestResult {
    let test = "presets_are_as_far_apart_as_the_document_says";
    let (folder, Some(gpu)) = (references(), gpu(test)) else { return Ok(()) };
    for (id, word) in [("04_grid_ibl_gray", "moves"), ("06_ramp_filmic", "same")] {
        let found = between_qualities(&gpu, &folder.join(format!("{id}.json")), How::default())?;
        let (_, metrics) = found.ok_or("all of it is built")?;
        let cells = row("reference --compare-quality", id);
        assert_eq!(cells[1], word);
        printed(&cells, &metrics);
    }
    Ok(())
}

/// Two references state no rule.
#[test]
fn the_chart_is_exact_and_edges_are_where_they_are() -> TestResult {
    let ids = ["06_ramp_input_linear", "07_edges_none"];
    let test = "the_chart_is_exact_and_edges_are_where_they_are";
    let Some(outcomes) = examined(test, ("reference", &references()), &ids)? else { return Ok(()) };
    let chart = outcomes[0].chart.ok_or("a chart")?;
    // Half floats round vertex colors and radiance by 1/2048 each; the reference rounds too.
    let worst = chart.worst_relative.ok_or("of light")?;
    assert!(worst < 1.5 / 1024.0, "{worst}");
    // The reference's rasterizer snaps vertices to 1/16 pixel, so pixels whose center is within 1/32 pixel of an edge
    // may differ. Its color table maps white to 253.
    let edges = outcomes[1].metrics.ok_or("a picture")?;
    assert!(edges.off_2 < 0.001, "{edges:?}");
    Ok(())
}

/// The references state metrics between the picture of edges and the same without FXAA, computed independently.
#[test]
fn metrics_are_those_of_the_references() -> TestResult {
    let read = |name: &str| Picture::read(&references().join(name));
    let metrics = Metrics::of(&read("07_edges_none.png")?, &read("07_edges_fxaa.png")?).ok_or("one size")?;
    assert!((metrics.psnr_db - 33.77).abs() < 0.005 && (metrics.flip - 0.01095).abs() < 5e-6, "{metrics:?}");
    Ok(())
}

/// A card 2 m wide that faces +z.
const CARD: &str = r#"{
  "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
  "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1}, "material": 0}]}],
  "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.25, 0.125, 1], "metallicFactor": 0}}],
  "accessors": [
    {"bufferView": 0, "componentType": 5126, "count": 6, "type": "VEC3", "min": [-1, -1, 0], "max": [1, 1, 0]},
    {"bufferView": 1, "componentType": 5126, "count": 6, "type": "VEC3"}
  ],
  "bufferViews": [{"buffer": 0, "byteLength": 72}, {"buffer": 0, "byteOffset": 72, "byteLength": 72}],
  "buffers": [{"uri": "card.bin", "byteLength": 144}]
}"#;

/// Seen through an off-center window: the card fills its right half.
const STATEMENT: &str = r#"{
  "id": "card", "scene": {
    "assets": ["card.gltf"], "resolution": [64, 32], "exposure": {"direct": 0.5}, "clear_color": [0.25, 0.5, 2, 1],
    "camera": {"type": "ortho", "ortho": [-3, 1, -1, 1], "eye": [0, 0, 5], "center": [0, 0, 0], "up": [0, 1, 0],
      "near": 0.1, "far": 10},
    "lights": [{"type": "DIRECTIONAL", "color": [1, 1, 0.5], "intensity": 12, "direction": [0, 0, -2], "cast_shadows": false}],
    "view": {"post_processing": false}, "output": "linear"
  },
  "objects": [{"shape": "sphere", "center": [-2, 0, 0]}],
  "files": {"exr": "card.exr"}, "suggested_pass": "psnr_srgb>=60, flip<=0.001, rel_p99<=0.001"
}"#;

fn folder(test: &str) -> Result<PathBuf, Box<dyn Error>> {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(test);
    if folder.exists() {
        std::fs::remove_dir_all(&folder)?;
    }
    std::fs::create_dir_all(&folder)?;
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, -1.0], [1.0, 1.0], [-1.0, 1.0_f32]];
    let positions = corners.iter().flat_map(|[x, y]| [*x, *y, 0.0]);
    let normals = corners.iter().flat_map(|_| [0.0, 0.0, 1.0]);
    let bytes: Vec<u8> = positions.chain(normals).flat_map(f32::to_le_bytes).collect();
    std::fs::write(folder.join("card.bin"), bytes)?;
    std::fs::write(folder.join("card.gltf"), CARD)?;
    std::fs::write(folder.join("card.json"), STATEMENT)?;
    Ok(folder)
}

#[test]
fn a_statement_means_what_it_says_and_a_perturbed_picture_fails() -> TestResult {
    let test = "a_statement_means_what_it_says_and_a_perturbed_picture_fails";
    let Some(gpu) = gpu(test) else { return Ok(()) };
    let folder = folder(test)?;
    let file = folder.join("card.json");
    let ours = render(&gpu, &Document::read(&file)?, &file, How::default())?;
    let at = |x: f64| ours.linear[ours.at([x, 0.5])];
    assert_eq!(at(0.2), [0.25, 0.5, 2.0], "the background is exposed already");
    // Lambert with at most a tenth of highlight: 12 lux at an exposure of 0.5, and half of the light's blue.
    let lambert = [0.5, 0.25, 0.0625].map(|albedo| albedo * 6.0 / std::f32::consts::PI);
    for (found, expected) in at(0.8).iter().zip(lambert) {
        assert!((expected..1.1 * expected + 0.03).contains(found), "{:?}, Lambert alone {lambert:?}", at(0.8));
    }

    ours.write_exr(&folder.join("card.exr"))?;
    let out = folder.join("out");
    std::fs::create_dir(&out)?;
    let how = How { out: Some(&out), ..How::default() };
    let same = examine(&gpu, &file, how)?;
    assert_eq!((&same.verdict, same.control), (&Verdict::Passed, Some(true)));
    assert!(["card.png", "card.exr", "card.difference.png"].iter().all(|name| out.join(name).is_file()));
    let perturb = |change: fn(usize, [f32; 3]) -> [f32; 3]| {
        let linear = ours.linear.iter().enumerate().map(|(i, rgb)| change(i, *rgb)).collect();
        Picture::from_linear(ours.size_px, linear)
    };
    for wrong in [
        perturb(|_, rgb| rgb.map(|c| c * 1.01)),
        perturb(|i, [r, g, b]| if i % 64 < 8 { [b, g, r] } else { [r, g, b] }),
        perturb(|i, rgb| if i % 50 == 0 { [0.0; 3] } else { rgb }),
    ] {
        wrong.write_exr(&folder.join("card.exr"))?;
        let outcome = examine(&gpu, &file, How::default())?;
        assert!(matches!(&outcome.verdict, Verdict::Failed(why) if !why.is_empty()), "{:?}", outcome.metrics);
    }
    // Sphere centers are read where the camera sees them: here in the background.
    for (rule, passes) in [("every sphere centre 0.25 +-2", true), ("every sphere centre 0.25 +-0.1", false)] {
        std::fs::write(&file, STATEMENT.replace("psnr_srgb>=60, flip<=0.001, rel_p99<=0.001", rule))?;
        let verdict = examine(&gpu, &file, How::default())?.verdict;
        assert_eq!(verdict == Verdict::Passed, passes, "{rule}: {verdict:?}");
    }
    Ok(())
}

#[test]
fn what_cannot_be_compared_is_said() -> TestResult {
    let Some(gpu) = gpu("what_cannot_be_compared_is_said") else { return Ok(()) };
    let folder = folder("what_cannot_be_compared_is_said")?;
    let file = folder.join("card.json");
    let picture = |size_px: [u32; 2], value: f32| {
        Picture::from_linear(size_px, vec![[value; 3]; size_px[0] as usize * size_px[1] as usize])
    };
    let examined = |text: &str| {
        std::fs::write(&file, text).map_err(|e| e.to_string())?;
        examine(&gpu, &file, How::default()).map_err(|e| e.to_string())
    };
    let error = |text: &str| examined(text).err().unwrap_or_default();
    assert!(error(STATEMENT).contains("card.exr"), "a missing picture");
    picture([8, 8], 1.0).write_exr(&folder.join("card.exr"))?;
    assert!(error(STATEMENT).contains("the picture is 8×8, and scene.resolution 64×32"));
    picture([64, 32], f32::NAN).write_exr(&folder.join("card.exr"))?;
    assert!(error(STATEMENT).contains("2048 texels are not finite"));
    picture([64, 32], 1.0).write_exr(&folder.join("card.exr"))?;
    assert!(error(&STATEMENT.replace("card.gltf", "gone.gltf")).contains("gone.gltf"));
    assert!(error(&STATEMENT.replace("\"direct\": 0.5", "\"direct\": 0")).contains("scene.exposure.direct"));
    assert!(error(&STATEMENT.replace("[-3, 1, -1, 1]", "[1, -3, -1, 1]")).contains("scene.camera.ortho"));
    for (right, wrong, named) in [
        ("[0, 0, -2]", "[0, 0, 0]", "scene.lights[0].direction"),
        ("\"intensity\": 12", "\"intensity\": -12", "scene.lights[0].intensity"),
        ("[1, 1, 0.5]", "[1, -1, 0.5]", "scene.lights[0].color"),
        ("[0.25, 0.5, 2, 1]", "[0.25, -0.5, 2, 1]", "scene.clear_color"),
        ("\"up\": [0, 1, 0]", "\"up\": [0, 0, 0]", "scene.camera.up"),
        ("\"near\": 0.1", "\"near\": 11", "scene.camera.near"),
    ] {
        assert!(STATEMENT.contains(right), "{right}");
        assert!(error(&STATEMENT.replace(right, wrong)).contains(named), "{named}");
    }
    let kept = r#"{"entry": "card.gltf", "source": "here", "sha256": "00"}"#;
    assert!(error(&STATEMENT.replace("\"card.gltf\"", kept)).contains("--assets"));
    let skipped =
        examined(&STATEMENT.replace("\"view\": {", "\"view\": {\"taa\": {\"enabled\": true, \"upscaling\": true}, "))?;
    assert_eq!(skipped.verdict, Verdict::Skipped(vec!["scene.view.taa.upscaling".into()]));
    let unjudged = examined(&STATEMENT.replace("psnr_srgb>=60", "good looks"))?;
    assert!(matches!(&unjudged.verdict, Verdict::Unjudged(why) if why.contains("good looks")));
    let text = told::json(&[skipped, unjudged], &["card.json: id: missing".into()]);
    assert!(text.contains("\"verdict\": \"skipped\"") && text.contains("\"psnr_srgb\""), "{text}");
    assert!(text.contains("\"verdict\": \"error\"") && text.contains("card.json: id: missing"), "{text}");
    Ok(())
}
