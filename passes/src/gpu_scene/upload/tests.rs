//! Uploads on a device that validates and does nothing, and read back on one that works.

use std::ops::ControlFlow;

use super::material::material_uniforms;
use framegraph_scene::Stage;
use framegraph_shaders::layout::MaterialUniforms;
use framegraph_shaders::layout::{TRAIT_DOUBLE_SIDED, TRAIT_EMITS, TRAIT_PLAIN_UV, VertexAttributes, VertexPosition};
use glam::{DVec3, Vec3};

use super::textures::check_format;
use super::*;
use crate::adapter::working;
use crate::gpu_scene::indirect::LEAST_BATCHES;
use framegraph_scene::environment::{Environment, Sky};
use framegraph_scene::error::SceneError;
use framegraph_scene::progress::silent;
use framegraph_scene::{
    Image, Material, MaterialId, Memory, MeshId, Sampler, Scene, Texture, TextureRole, TextureSlot, UvTransform,
    builtin,
};
use framegraph_wgpu::{Binding, Gpu, read_buffer, read_texture};

fn noop() -> Gpu {
    Gpu::noop().expect("the adapter that does nothing is always there")
}

#[test]
fn built_in_scenes_upload_without_complaint() {
    let gpu = noop();
    for name in builtin::NAMES {
        let scene = builtin(name).expect(name);
        let uploaded = GpuScene::upload(&gpu, &scene, &mut silent).expect(name);
        assert!(uploaded.warnings.is_empty());
        let vertices: u64 = scene.meshes.iter().map(|m| m.vertex_count() as u64).sum();
        assert_eq!(uploaded.positions.size(), vertices * 12);
        assert_eq!(uploaded.attributes.size(), vertices * size_of::<VertexAttributes>() as u64);
        let mut first = [0; 2];
        for (i, mesh) in scene.meshes.iter().enumerate() {
            let range = uploaded.mesh(MeshId::new(i), 0);
            assert_eq!(range.short, mesh.vertex_count() <= 65_536);
            let first = &mut first[usize::from(range.short)];
            assert_eq!(range.first_index, *first);
            assert_eq!(range.indices().len(), mesh.indices.len());
            *first += range.index_count;
        }
        for i in 0..scene.materials.len() {
            let material = MaterialId::new(i);
            let binding = |index: usize| uploaded.material_binding(material, index);
            for (index, name) in MATERIAL_BINDINGS.iter().enumerate() {
                let kind = match binding(index) {
                    Some(Binding::Buffer { bytes: Some(_), .. }) => "material",
                    Some(Binding::View(_)) => "_texture",
                    Some(Binding::Sampler(_)) => "_sampler",
                    // Few instances have no use for an array of materials.
                    Some(Binding::Buffer { bytes: None, .. }) => "materials",
                    None if scene.instances.len() < LEAST_BATCHES => "materials",
                    None => "missing",
                };
                assert!(name.ends_with(kind), "{name} is bound to {kind}");
            }
            assert!(binding(MATERIAL_BINDINGS.len()).is_none());
            assert_eq!(uploaded.lobes(material), scene.materials[i].lobes());
            for (slot, texture) in scene.materials[i].slots().iter().enumerate() {
                assert_eq!(uploaded.traits(material) & 1 << slot != 0, texture.is_some(), "{name}, slot {slot}");
            }
            assert_eq!(uploaded.material_name(material), scene.materials[i].name);
        }
        // Vertices, indices and materials at least; images with a third more for their levels.
        assert!(uploaded.size_bytes > vertices * 60, "{name}");
    }
}

/// The bits by which a shader knows what textures there are have the order of what is bound.
#[test]
fn slots_of_textures_are_numbered_as_they_are_bound() {
    let text = framegraph_shaders::library::text("interface/material.wgsl").expect("an embedded file");
    let count = framegraph_scene::material::SLOT_COUNT;
    let textures = MATERIAL_BINDINGS.iter().filter_map(|name| name.strip_suffix("_texture"));
    let slots: Vec<_> = textures.enumerate().collect();
    assert_eq!(slots.len(), count);
    for (slot, name) in slots {
        let constant = format!("const SLOT_{}: u32 = {slot}u;", name.to_uppercase());
        assert!(text.contains(&constant), "`{constant}` is not in it");
    }
}

/// A material that is written anew is drawn as what it has become; its textures stay.
#[test]
fn a_written_material_has_other_traits() {
    let (gpu, scene) = (noop(), with_image(1, 1, [255; 4]));
    let mut uploaded = GpuScene::upload(&gpu, &scene, &mut silent).expect("nothing to refuse");
    let id = MaterialId::new(0);
    let traits = |bits: &[u32]| 1 << 3 | bits.iter().map(|bit| 1 << bit).sum::<u32>();
    assert_eq!(uploaded.traits(id), traits(&[TRAIT_PLAIN_UV]));
    let glowing = Material { emissive: Vec3::X, double_sided: true, ..scene.materials[0].clone() };
    let without = Material { occlusion_texture: None, ..glowing };
    uploaded.write_material(&gpu, id, &without).expect("it has the same lobes");
    assert_eq!(uploaded.traits(id), traits(&[TRAIT_EMITS, TRAIT_DOUBLE_SIDED]));
}

/// Each material lies at its number times the distance from one to the next, and in the table one after another.
#[test]
fn a_material_is_written_where_its_number_says() {
    let Some(gpu) = working("a_material_is_written_where_its_number_says") else { return };
    let mut scene = builtin("spheres").expect("built in");
    let first = scene.instances[0].clone();
    scene.instances.resize(LEAST_BATCHES, first);
    let mut uploaded = GpuScene::upload(&gpu, &scene, &mut silent).expect("nothing to refuse");
    let table = uploaded.material_table.clone().expect("as many instances as a table is made for");
    let buffers = [(uploaded.materials.clone(), uploaded.material_stride_bytes as usize), (table, 0)];
    let size = size_of::<MaterialUniforms>();
    let held = |(buffer, stride): &(wgpu::Buffer, usize)| {
        let bytes = read_buffer(&gpu, buffer, buffer.size()).expect("the buffer can be copied");
        let at = |number: usize| number * (*stride).max(size);
        (0..scene.materials.len()).map(|number| bytes[at(number)..at(number) + size].to_vec()).collect::<Vec<_>>()
    };
    let number = 2;
    let glowing = Material { emissive: Vec3::new(1.0, 2.0, 3.0), ..scene.materials[number].clone() };
    let before = buffers.each_ref().map(held);
    assert_eq!(before[0], before[1]);
    uploaded.write_material(&gpu, MaterialId::new(number), &glowing).expect("it has the same lobes");
    let mut expected = before[0].clone();
    expected[number] = bytemuck::bytes_of(&material_uniforms(&glowing)).to_vec();
    assert_eq!(buffers.each_ref().map(held), [expected.clone(), expected]);
}

/// Each mesh and each picture is told of when it is done.
#[test]
fn progress_is_told_of_every_mesh_and_picture() {
    let scene = with_image(4, 4, [1; 4]);
    let mut told = Vec::new();
    let mut tell = |p: framegraph_scene::Progress<'_>| {
        told.push((p.stage, p.done, p.total));
        ControlFlow::Continue(())
    };
    GpuScene::upload(&noop(), &scene, &mut tell).expect("nothing to refuse");
    let all = |stage, total| (1..=total).map(move |done| (stage, done, total));
    let expected = all(Stage::Vertices, scene.meshes.len()).chain(all(Stage::Upload, scene.images.len()));
    assert_eq!(told, expected.collect::<Vec<_>>());
}

#[test]
fn an_empty_scene_uploads() {
    let scene = Scene::default();
    let uploaded = GpuScene::upload(&noop(), &scene, &mut silent).expect("nothing to refuse");
    assert!(uploaded.positions.size() > 0);
}

fn with_image(width: u32, height: u32, texel: [u8; 4]) -> Scene {
    let mut scene = builtin("spheres").expect("built in");
    let image = Image::from_rgba8("dir/wide.png", width, height, texel.repeat((width * height) as usize));
    let texture = scene.add_texture(image, TextureRole::Linear, Sampler::default());
    scene.materials[0].occlusion_texture = Some(TextureSlot { texture, uv_set: 0, transform: UvTransform::default() });
    scene
}

#[test]
fn what_exceeds_the_device_is_named() {
    let gpu = noop();
    let limit = gpu.device.limits().max_texture_dimension_2d;
    let scene = with_image(limit + 1, 1, [1; 4]);
    let error = GpuScene::upload(&gpu, &scene, &mut silent).expect_err("too wide").to_string();
    let expected = format!("dir/wide.png: side in texels is {}, over the limit of {limit}", limit + 1);
    assert_eq!(error, expected);
    let mut wide = Environment::uniform(DVec3::ONE).expect("a plain radiance");
    wide.name = "wide.hdr".into();
    wide.map = framegraph_scene::environment::EquirectMap::from_fn(limit + 1, 1, |_| DVec3::ONE);
    let error = GpuEnvironment::upload(&gpu, &wide, &mut silent).expect_err("too wide");
    assert!(error.to_string().contains("wide.hdr: side in texels"), "{error}");
}

/// The noop device is software, whose memory is the machine's: textures count as well.
#[test]
fn texels_go_as_they_are_uploaded_and_the_budget_knows() {
    let mut scene = with_image(64, 64, [1; 4]);
    let texture = *scene.textures.last().expect("it was added");
    scene.textures.push(Texture { role: TextureRole::Color, ..texture });
    // The built-in scene has a picture of its own, of the same size.
    let image_bytes = scene.images.iter().map(|image| image.size_bytes()).sum();
    assert_eq!((scene.images.len(), image_bytes), (2, 2 * 64 * 64 * 4));
    let upload = |memory: &Memory, scene: &mut Scene| GpuScene::upload_freeing(&noop(), scene, memory, &mut silent);
    let memory = Memory::new(1 << 20);
    memory.keep(image_bytes).expect("what import has taken");
    let whole = GpuScene::upload(&noop(), &scene, &mut silent).expect("nothing to refuse");
    let mut freed = scene.clone();
    let uploaded = upload(&memory, &mut freed).expect("there is enough");
    assert_eq!(uploaded.size_bytes, whole.size_bytes);
    assert!(freed.images.iter().all(|image| image.levels.is_empty() && image.width == 64));
    assert_eq!(freed.images[1].name, "dir/wide.png");
    // Three textures with all their levels are what is taken now.
    let textures = 3 * (1..=7).map(|level| (128_u64 >> level).pow(2) * 4).sum::<u64>();
    assert_eq!(memory.lend(u64::MAX).map(drop).map_err(|short| short.left_bytes), Err((1 << 20) - textures));
    // Of one picture: its levels and a copy of all that waits for the device, beside a texture that is the machine's memory too.
    let mut one = scene.clone();
    one.textures.truncate(1);
    one.images.truncate(1);
    one.materials.iter_mut().for_each(|material| material.occlusion_texture = None);
    let bytes = 64 * 64 * 4;
    let least = bytes / 3 + 2 * (bytes * 4 / 3);
    upload(&Memory::new(least), &mut one.clone()).expect("there is enough");
    upload(&Memory::new(least - 1), &mut one).expect_err("a byte is missing");
    let error = upload(&Memory::new(30_000), &mut scene).expect_err("no room for levels").to_string();
    assert!(error.contains(": mip levels and upload, 64×64"), "{error}");
}

#[test]
fn blocks_that_the_device_does_not_sample_are_refused() {
    use framegraph_scene::{BlockFormats, ImageFormat};
    use wgpu::Features;
    let image = |format| Image { name: "a.ktx2".into(), format, ..Image::default() };
    for (format, feature, name) in [
        (ImageFormat::Bc7, Features::TEXTURE_COMPRESSION_BC, "BC7"),
        (ImageFormat::Etc2Rgba8, Features::TEXTURE_COMPRESSION_ETC2, "ETC2 RGBA8"),
        (ImageFormat::Astc4x4, Features::TEXTURE_COMPRESSION_ASTC, "ASTC 4×4"),
    ] {
        assert!(check_format(feature, &image(format)).is_ok());
        let error = check_format(Features::all() - feature, &image(format)).expect_err("it is missing").to_string();
        let hint = "load the scene with the `block_formats` of the device";
        assert_eq!(error, format!("a.ktx2: this device does not sample {name}; {hint}"));
    }
    assert!(check_format(Features::empty(), &image(ImageFormat::Rgba8)).is_ok());
    // The noop device has every feature.
    assert_eq!(block_formats(&noop()), BlockFormats { bc7: true, etc2: true, astc: true });
}

#[test]
fn an_upload_can_be_stopped() {
    let scene = with_image(4, 4, [1; 4]);
    let mut stop = |_: framegraph_scene::Progress<'_>| ControlFlow::Break(());
    let error = GpuScene::upload(&noop(), &scene, &mut stop).expect_err("it was stopped");
    assert!(matches!(error, UploadError::Scene(SceneError::Interrupted { .. })), "{error}");
}

#[test]
fn colors_that_the_format_cuts_are_warned_of() {
    let mut scene = builtin("spheres").expect("built in");
    let mesh = &mut scene.meshes[0];
    mesh.colors = vec![glam::Vec4::splat(1e5); mesh.vertex_count()];
    let uploaded = GpuScene::upload(&noop(), &scene, &mut silent).expect("nothing to refuse");
    assert!(uploaded.warnings[0].contains("clamped"), "{:?}", uploaded.warnings);
}

/// What was written is what the device holds: vertices, indices, and every texel of a level.
#[test]
fn buffers_and_textures_hold_what_was_sent() {
    let Some(gpu) = working("buffers_and_textures_hold_what_was_sent") else { return };
    let mut scene = with_image(5, 3, [10, 20, 30, 40]);
    scene.materials.push(Material::default());
    let uploaded = GpuScene::upload(&gpu, &scene, &mut silent).expect("a small scene");
    let bytes = read_buffer(&gpu, &uploaded.positions, uploaded.positions.size()).expect("the buffer can be copied");
    let positions: Vec<VertexPosition> = bytemuck::pod_collect_to_vec(&bytes);
    let sent = scene.meshes.iter().flat_map(|m| &m.positions);
    assert!(positions.iter().zip(sent).all(|(a, b)| a.position == b.to_array()));
    let bytes = read_buffer(&gpu, &uploaded.indices, uploaded.indices.size()).expect("the buffer can be copied");
    let indices: Vec<u16> = bytemuck::pod_collect_to_vec(&bytes);
    assert!(
        uploaded.short_indices_at == 0
            && indices[..6].iter().zip(&scene.meshes[0].indices).all(|(a, b)| u32::from(*a) == *b)
    );

    let occlusion = MATERIAL_BINDINGS.iter().position(|name| *name == "occlusion_texture").expect("it is listed");
    let Some(Binding::View(occlusion)) = uploaded.material_binding(MaterialId::new(0), occlusion) else {
        panic!("it is a texture");
    };
    let texture = occlusion.texture();
    assert_eq!((texture.width(), texture.height(), texture.mip_level_count()), (5, 3, 3));
    let pixels = read_texture(&gpu, texture).expect("the texture can be copied");
    assert_eq!(pixels.bytes, [10, 20, 30, 40].repeat(15));

    let sky = Sky::default().environment(64).expect("the default sky");
    let sky = GpuEnvironment::upload(&gpu, &sky, &mut silent).expect("a small map");
    assert_eq!((sky.size_texels, sky.level_count), ([64, 32], 7));
}
