//! Real files. A test whose file is missing reports that it is skipped.

use glam::DVec3;

use crate::camera::CameraChoice;
use crate::import::{load, load_with};
use crate::progress::silent;
use crate::test_files::file;
use crate::texture::TextureRole;
use crate::{DrawLists, LoadOptions, Mesh, geometry};

#[test]
fn flight_helmet_comes_in_whole() {
    let Some(path) = file("assets/models/FlightHelmet/FlightHelmet.gltf") else {
        return;
    };
    let scene = load(&path, &mut silent).expect("a good file");
    assert_eq!(scene.check(), Ok(()));
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
    assert_eq!(scene.name, "FlightHelmet");
    let counts = (scene.instances.len(), scene.meshes.len(), scene.materials.len());
    assert_eq!(counts, (6, 6, 6));
    assert_eq!(scene.images.len(), 15);
    for material in &scene.materials {
        assert!(material.base_color_texture.is_some(), "{}", material.name);
        assert!(material.normal_texture.is_some(), "{}", material.name);
        // One image for occlusion, roughness and metallic: one texture, not two.
        let occlusion = material.occlusion_texture.map(|s| s.texture);
        assert_eq!(occlusion, material.metallic_roughness_texture.map(|s| s.texture));
    }
    let colors = scene.textures.iter().filter(|t| t.role == TextureRole::Color).count();
    assert_eq!((scene.textures.len(), colors), (15, 5));
    // The helmet and its stand are 70 cm high.
    let bounds = scene.bounds();
    assert!((bounds.max.y - 0.716).abs() < 1e-3 && bounds.min.y.abs() < 1e-3);
    let camera = CameraChoice::Orbit.resolve(&scene, 1.5).expect("orbit always resolves");
    let lists = DrawLists::for_camera(&scene, &camera, 1.5);
    assert_eq!((lists.opaque.len() + lists.blend.len(), lists.culled), (6, 0));
    assert!(camera.eye.distance(DVec3::ZERO) < 3.0);
}

/// Row of `docs/measurements/performance.md`: shaded vertices per triangle, in file order and as drawn.
#[test]
fn flight_helmet_is_ordered_for_drawing() {
    let Some(path) = file("assets/models/FlightHelmet/FlightHelmet.gltf") else {
        return;
    };
    let load = |keep_order| {
        let options = LoadOptions { keep_order, ..LoadOptions::default() };
        load_with(&path, &options, &mut silent).expect("a good file").meshes
    };
    let sum = |meshes: &[Mesh], of: fn(&Mesh) -> usize| meshes.iter().map(of).sum::<usize>();
    let (kept, ordered) = (load(true), load(false));
    let triangles = sum(&kept, Mesh::triangle_count);
    assert_eq!(triangles, sum(&ordered, Mesh::triangle_count));
    let [before, after] = [&kept, &ordered].map(|meshes| sum(meshes, geometry::shaded_vertices) as f64);
    let [before, after] = [before, after].map(|shaded| shaded / triangles as f64);
    let row = format!("| FlightHelmet | {triangles} | {before:.3} | {after:.3} |");
    println!("{row}");
    assert!(
        include_str!("../../../../docs/measurements/performance.md").contains(&row),
        "docs/measurements/performance.md has no {row}"
    );
}

/// Compares the file's tangents with generated ones. They come from another implementation of the algorithm, so nearly
/// all agree in direction and handedness. A wrong sign of v would flip all.
#[test]
fn generated_tangents_agree_with_the_files() {
    let Some(path) = file("assets/models/FlightHelmet/FlightHelmet.gltf") else {
        return;
    };
    let scene = load(&path, &mut silent).expect("a good file");
    let (mut alike, mut same_hand, mut all) = (0_u32, 0_u32, 0_u32);
    for original in &scene.meshes {
        let mut mesh = original.clone();
        mesh.tangents.clear();
        geometry::generate_tangents(&mut mesh, 0);
        // Generation may split vertices, but keeps the corner order.
        for (new, old) in mesh.indices.iter().zip(&original.indices) {
            let (new, old) = (mesh.tangents[*new as usize], original.tangents[*old as usize]);
            all += 1;
            alike += u32::from(new.truncate().dot(old.truncate()) > 0.9);
            same_hand += u32::from(new.w == old.w);
        }
    }
    assert!(all > 100_000);
    assert!(f64::from(alike) > 0.95 * f64::from(all), "{alike} of {all} alike");
    assert!(f64::from(same_hand) > 0.99 * f64::from(all), "{same_hand} of {all}");
}

/// Models compressed by others. Their accessors state the bounds before quantization. Decoded bounds agree within half
/// a step of 14 bits, the default of the program that wrote the files.
#[cfg(feature = "draco")]
#[test]
fn models_under_draco_come_in_whole() {
    let suzi_max = DVec3::new(0.9297301173210144, 0.6682535409927368, 0.5761584639549255);
    let bunny_max = DVec3::new(0.9172143340110779, 0.9398829340934753, 0.6988642811775208);
    for (name, triangles, vertices, max) in [("suzi", 14842, 7503, suzi_max), ("bunny", 5648, 2826, bunny_max)] {
        let Some(path) = file(&format!("assets/models/{name}.glb")) else {
            continue;
        };
        let Ok(scene) = load(&path, &mut silent) else { panic!("{name} is refused") };
        assert_eq!(scene.check(), Ok(()));
        let [mesh] = &scene.meshes[..] else { panic!("{name} has {} meshes", scene.meshes.len()) };
        assert_eq!((mesh.triangle_count(), mesh.positions.len(), mesh.normals.len()), (triangles, vertices, vertices));
        let off = (scene.bounds().max - max).abs().max_element();
        assert!(off <= 2.0 * max.max_element() / f64::from((1 << 14) - 1) / 2.0, "{name} is {off} m off");
    }
}

#[test]
fn reference_scenes_come_in_and_share_geometry() {
    let Some(grid) = file("references/filament/assets/grid.glb") else {
        return;
    };
    let scene = load(&grid, &mut silent).expect("a good file");
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
    // A ground and 14 spheres of one geometry.
    let counts = (scene.instances.len(), scene.meshes.len(), scene.materials.len());
    assert_eq!(counts, (15, 2, 15));
    if let Some(ramp) = file("references/filament/assets/ramp.glb") {
        let scene = load(&ramp, &mut silent).expect("a good file");
        assert!(scene.materials[0].unlit && scene.materials[0].double_sided);
        let brightest = scene.meshes[0].colors.iter().map(|c| c.max_element());
        assert!(brightest.fold(0.0, f32::max) > 1.0, "the ramp is HDR");
    }
    for name in ["furnace", "edges"] {
        if let Some(path) = file(&format!("references/filament/assets/{name}.glb")) {
            let scene = load(&path, &mut silent).expect("a good file");
            assert!(scene.warnings.is_empty(), "{name}: {:?}", scene.warnings);
        }
    }
}
