//! Files referenced by a scene, their memory use, and device limits.

use crate::outputs::textured;
use crate::support::{CORNERS, TRIANGLE, UP, folder, refusal, refused, triangle, undrawn};
use std::fs;

#[test]
fn a_file_is_named_with_the_scene_that_asks_for_it() {
    let folder = folder("asked");
    textured(&folder);
    fs::remove_file(folder.join("t.png")).expect("the folder is ours");
    let line = refused(&folder, &["t.gltf"]);
    assert!(line.contains("t.gltf: image 0 \"wood\": t.png: cannot be read"), "{line}");
    triangle(&folder, &TRIANGLE.replace("t.bin", "gone.bin"), CORNERS, UP);
    let line = refused(&folder, &["t.gltf"]);
    assert!(line.contains("t.gltf: buffer 0: gone.bin: cannot be read"), "{line}");
}

#[test]
fn files_of_a_scene_stay_in_its_folder() {
    let folder = folder("outside");
    fs::create_dir(folder.join("scene")).expect("the folder is ours");
    triangle(&folder.join("scene"), &TRIANGLE.replace("t.bin", "../t.bin"), CORNERS, UP);
    fs::rename(folder.join("scene/t.bin"), folder.join("t.bin")).expect("the folder is ours");
    let line = refused(&folder, &["scene/t.gltf"]);
    assert!(line.contains("leads out of the scene's folder") && line.contains("--allow-outside"), "{line}");
    let allowed = undrawn(&folder, &["scene/t.gltf", "--allow-outside", "--frames", "1"]).output();
    assert!(allowed.is_ok_and(|output| output.status.success()));
}

/// Opening a pipe without a writer would block forever, so only regular files are opened.
#[cfg(unix)]
#[test]
fn nothing_but_regular_files_is_opened() {
    let folder = folder("pipes");
    textured(&folder);
    for name in ["t.bin", "t.png", "map.hdr", "scene.gltf", "own.ron", "own.json", "own.cube"] {
        let _ = fs::remove_file(folder.join(name));
        let made = std::process::Command::new("mkfifo").arg(folder.join(name)).status();
        assert!(made.is_ok_and(|status| status.success()));
    }
    for args in [
        &["t.gltf"][..],
        &["scene.gltf"],
        &["--environment", "map.hdr"],
        &["--environment", "/proc/kmsg"],
        &["--settings", "own.ron"],
        &["--what-if", "own.ron"],
        &["--preset", "low", "--record", "own.json"],
        &["--record", "own.json", "--budget-ms", "9"],
        &["--look", "own.cube", "--grade-by", "table"],
        &["--dirt", "t.png", "--bloom", "on"],
    ] {
        let line = refused(&folder, args);
        assert!(line.contains("not a regular file") || line.contains("/proc/kmsg"), "{args:?}: {line}");
    }
}

#[test]
fn an_image_over_the_budget_is_named() {
    let folder = folder("budget");
    textured(&folder);
    let large = image::GrayImage::from_pixel(1024, 512, image::Luma([9]));
    large.save(folder.join("t.png")).expect("the folder can be written");
    let line = refused(&folder, &["t.gltf", "--memory", "1MiB"]);
    for words in ["t.png: image 0 \"wood\", 1024×512: 2.0 MiB of memory are needed", "of the 1.0 MiB", "--memory"] {
        assert!(line.contains(words), "{line}");
    }
    // The decoded image fits, but not together with its mip levels for the upload.
    let line = refusal(&folder, &mut undrawn(&folder, &["t.gltf", "--memory", "4MiB"]));
    assert!(line.contains("t.png: mip levels and upload, 1024×512"), "{line}");
    let enough = undrawn(&folder, &["t.gltf", "--memory", "10MiB", "--frames", "1"]).output();
    assert!(enough.is_ok_and(|output| output.status.success()));
}

#[test]
fn what_a_material_asks_too_much_is_the_scenes_fault() {
    let folder = folder("lobes");
    textured(&folder);
    let lobes = r#"{"name": "opal", "extensions": {
        "KHR_materials_clearcoat": {"clearcoatFactor": 1}, "KHR_materials_sheen": {"sheenColorFactor": [1, 1, 1]},
        "KHR_materials_specular": {"specularFactor": 0.5}, "KHR_materials_transmission": {"transmissionFactor": 0.5},
        "KHR_materials_anisotropy": {"anisotropyStrength": 0.5}}"#;
    let plain = fs::read_to_string(folder.join("t.gltf")).expect("it was written");
    let text = plain.replace(r#""materials": [{"#, &format!(r#""materials": [{lobes}, "#));
    triangle(&folder, &text, CORNERS, UP);
    let line = refusal(&folder, &mut undrawn(&folder, &["t.gltf"]));
    assert!(line.contains("material \"opal\" combines") && line.contains("the device allows"), "{line}");
    // A material without a texture binds none.
    let text = plain.replace(r#""materials": [{"#, &format!(r#""materials": [{lobes}}}, {{"#));
    triangle(&folder, &text, CORNERS, UP);
    let allowed = undrawn(&folder, &["t.gltf", "--frames", "1"]).output();
    assert!(allowed.is_ok_and(|output| output.status.success()));
}

#[test]
fn a_backend_that_there_is_not_is_named() {
    let folder = folder("backend");
    for word in ["vulcan", "noop,direct3d"] {
        let line = refusal(&folder, undrawn(&folder, &[]).env("WGPU_BACKEND", word));
        let last = word.rsplit(',').next().unwrap_or(word);
        assert!(line.contains("WGPU_BACKEND") && line.contains(last) && line.contains("vulkan"), "{line}");
    }
}

#[test]
fn a_camera_out_of_range_is_named_with_its_rule() {
    let folder = folder("camera");
    let camera = r#""cameras": [{"type": "perspective", "perspective": {"yfov": 0, "znear": 0.1}}], "accessors""#;
    let text = TRIANGLE.replace("\"accessors\"", camera).replace("{\"mesh\": 0}", "{\"mesh\": 0, \"camera\": 0}");
    triangle(&folder, &text, CORNERS, UP);
    let line = refused(&folder, &["t.gltf"]);
    assert!(line.contains("its yfov is 0; it must be above 0 and below π"), "{line}");
}
