//! Import of glTF 2.0, text and binary.
//!
//! The schema is that of the `gltf-json` crate. The accessors, validation and image loading of the `gltf` crate are not
//! used, since they panic on some invalid indices. No file may make this program panic: every index is checked here,
//! and a failed check names the file, the place and the reason.
//!
//! ```text
//! bytes ─ container ─> JSON + BIN ─ uri, buffer ─> Source
//!   Source ─ views ─> compressed buffer views, decoded on all cores
//!   Source ─ node ─> nodes in world axes: meshes, lights, cameras
//!   meshes ─ draco ─> compressed primitives, decoded on all cores
//!   meshes ─ primitive (accessor, topology) ─> Mesh     material, lobes ─> Material, Texture
//!   images ─> decoded on all cores
//! ```

mod accessor;
mod buffer;
mod camera;
mod channel_pointer;
mod container;
mod document;
#[cfg(feature = "draco")]
mod draco;
mod encoding;
mod extension;
mod images;
mod instancing;
mod letter_case;
mod light;
mod limits;
mod line_material;
mod lobes;
mod material;
mod motion;
mod moves;
mod node;
mod object;
#[cfg_attr(not(feature = "draco"), allow(dead_code, reason = "then no mesh is decoded"))]
mod packed;
mod pointer;
mod primitive;
mod source;
mod spec_gloss;
mod stream;
mod switches;
mod texture;
mod topology;
mod uri;
mod variants;
#[cfg(feature = "meshopt")]
mod views;

use std::collections::BTreeMap;
use std::path::Path;

use glam::DMat4;

use self::material::Materials;
use self::motion::Placed;
use self::node::FlatNode;
use self::primitive::GeometryKey;
use self::source::{Repair, Source, Warnings};
use self::switches::Switches;
use self::variants::Variants;
use super::draw_options::DrawOptions;
use super::error::{Quantity, SceneError, one_line};
use super::instance::Instance;
use super::material::MaterialId;
use super::mesh::MeshId;
use super::options::LoadOptions;
use super::progress::{Progress, ProgressFn, Stage, report};
use super::read::{file_bytes, read_file};
use super::scene::Scene;

pub use extension::{EXTENSIONS, Extension, Support, extensions_table};
pub use limits::{MAX_COORDINATE_M, MAX_IMAGE_SIDE_TEXELS, MAX_INSTANCES};

/// Loads a glTF or GLB file with the default options.
///
/// # Errors
///
/// Returns the errors of [`load_with`].
pub fn load(path: &Path, progress: &mut ProgressFn<'_>) -> Result<Scene, SceneError> {
    load_with(path, &LoadOptions::default(), progress)
}

/// Loads a glTF or GLB file; the format is detected from the content.
///
/// Loads the default scene, otherwise the first scene, otherwise all root nodes. Textures of unused materials are not
/// decoded, and images with the same source are decoded once. The memory of the scene stays charged to
/// `options.memory`; [`Memory::free`](crate::memory::Memory::free) releases it.
///
/// # Errors
///
/// Returns a one-line error with the file and the reason. Files fail if they are unreadable or truncated, have broken
/// references, or require unsupported extensions. Values that are not finite, vectors of zero length, and undecodable
/// images fail too. Further reasons are sizes over the limits of this module, paths outside of the file's folder, and
/// an exceeded memory budget.
pub fn load_with(path: &Path, options: &LoadOptions, progress: &mut ProgressFn<'_>) -> Result<Scene, SceneError> {
    let length = file_bytes(path)?;
    let over = |budget| SceneError::Memory { file: path.into(), at: "the file".into(), budget };
    options.memory.keep(length).map_err(over)?;
    let loaded = read_file(path).and_then(|bytes| load_bytes_with(path, &bytes, options, progress));
    options.memory.free(length);
    loaded
}

/// Loads a glTF or GLB file from bytes. `path` is its name in messages; files that it refers to are relative to it.
///
/// # Errors
///
/// Returns the errors of [`load_with`].
pub fn load_bytes(path: &Path, bytes: &[u8], progress: &mut ProgressFn<'_>) -> Result<Scene, SceneError> {
    load_bytes_with(path, bytes, &LoadOptions::default(), progress)
}

/// Loads a glTF or GLB file from bytes with options.
///
/// # Errors
///
/// Returns the errors of [`load_with`].
pub fn load_bytes_with(
    path: &Path,
    bytes: &[u8],
    options: &LoadOptions,
    progress: &mut ProgressFn<'_>,
) -> Result<Scene, SceneError> {
    let parts = container::split(path, bytes)?;
    let document = document::parse(path, parts.json)?;
    let mut warnings = Warnings::new(path);
    if parts.is_unpadded {
        warnings.push("GLB container: a chunk is not padded to four bytes; the next one is read behind it");
    }
    extension::check(path, &document.root, &mut warnings)?;
    let mut source = Source::new(path, &document, options);
    source.note_file(path);
    source.buffers = buffer::load(&source, parts.blob, progress)?;
    #[cfg(feature = "meshopt")]
    {
        source.views = views::decode(&source, progress)?;
    }
    let nodes = node::flatten(&source, &mut warnings)?;
    #[cfg(feature = "draco")]
    {
        source.meshes = draco::decode(&source, &nodes, progress)?;
    }
    let source = source;
    let mut scene = Scene {
        name: path.file_stem().map_or_else(String::new, |stem| one_line(&stem.to_string_lossy())),
        ..Scene::default()
    };
    let lights = light::import(&source, &nodes, &mut scene.lights, &mut warnings)?;
    let cameras = camera::import(&source, &nodes, &mut scene.cameras, &mut warnings)?;
    let variants = Variants::read(&source, options.variant.as_deref())?;
    let mut materials = Materials::new(&source);
    let placed = import_meshes(&source, &nodes, &mut scene, (&variants, &mut materials), &mut warnings, progress)?;
    scene.variants = variants.names;
    let tables = materials.finish();
    scene.materials = tables.materials;
    scene.textures = tables.textures;
    scene.samplers = tables.samplers;
    let attached = motion::Attachments { placed, lights, cameras, materials: tables.known };
    motion::import(&source, &nodes, attached, &mut scene, &mut warnings)?;
    scene.images = images::decode(&source, &tables.images, (&scene.textures, &tables.computed), progress)?;
    for roughness in &tables.computed {
        let image = &scene.images[roughness.image.index()];
        let (bytes, at) = (image.size_bytes(), image.name.clone());
        source.keep(bytes).map_err(|budget| SceneError::Memory { file: path.into(), at, budget })?;
        scene.images.push(roughness.compute(&scene.images));
    }
    let absent = source.buffers.iter().enumerate().filter(|(_, buffer)| buffer.is_read_and_absent());
    absent.for_each(|(number, _)| warnings.count(Repair::Absent, &format!("buffer {number}"), 1));
    scene.files = source.files();
    scene.warnings = warnings.into_lines();
    source.finish();
    Ok(scene)
}

/// Converts each (node, primitive) to an instance, or to one for each transform of EXT_mesh_gpu_instancing. Equal
/// geometry is built once.
fn import_meshes(
    source: &Source<'_>,
    nodes: &[FlatNode],
    scene: &mut Scene,
    (variants, materials): (&Variants, &mut Materials<'_>),
    warnings: &mut Warnings,
    progress: &mut ProgressFn<'_>,
) -> Result<Placed, SceneError> {
    let mut placed = Placed::default();
    let mut built: BTreeMap<GeometryKey, Option<MeshId>> = BTreeMap::new();
    let drawn: Vec<(usize, &FlatNode, usize)> =
        nodes.iter().enumerate().filter_map(|(place, node)| Some((place, node, node.mesh?))).collect();
    let count = |(_, _, mesh): &(usize, &FlatNode, usize)| {
        source.root.meshes.get(*mesh).map_or(1, |mesh| mesh.primitives.len())
    };
    let (mut done, total) = (0, drawn.iter().map(count).sum());
    for (place_of_node, node, mesh_index) in &drawn {
        let mesh = source
            .root
            .meshes
            .get(*mesh_index)
            .ok_or_else(|| source.malformed(&node.at, source::beyond("mesh", *mesh_index, &source.root.meshes)))?;
        let mut places = instancing::read(source, node.index, &node.at)?;
        if places.is_some() && node.skin.is_some() {
            warnings.push(format!("{}: EXT_mesh_gpu_instancing of a skinned mesh is ignored", node.at));
            places = None;
        }
        let places = places.unwrap_or_else(|| vec![DMat4::IDENTITY]);
        let pointer = format!("/nodes/{}", node.index);
        let draw = Switches::of(source.document, &pointer, &node.at, warnings).draw_options();
        for (i, primitive) in mesh.primitives.iter().enumerate() {
            let at = format!("mesh {mesh_index} primitive {i}");
            let material = materials.import(variants.material(source, &at, primitive)?, &at, warnings)?;
            let material = materials.for_primitive(material, primitive);
            let surface = materials.get(material);
            let key = GeometryKey::new(primitive, i, surface, node.index, node.skin.is_some());
            let mesh_id = match built.get(&key) {
                Some(id) => *id,
                None => {
                    let name = mesh.name.as_deref().unwrap_or_default();
                    let mesh = primitive::build(source, &key, &at, name, warnings)?;
                    let id = mesh.map(|mesh| {
                        scene.meshes.push(mesh);
                        MeshId::new(scene.meshes.len() - 1)
                    });
                    built.insert(key, id);
                    id
                }
            };
            if let Some(mesh_id) = mesh_id {
                warn_of_missing_uv(scene, mesh_id, surface, &at, warnings);
                for node_from_model in &places {
                    place(source, (node, draw), mesh_id, material, *node_from_model, scene)?;
                    placed.nodes.push(*place_of_node);
                    placed.node_from_model.push(*node_from_model);
                }
            }
            done += 1;
            report(progress, source.file, Progress { stage: Stage::Geometry, done, total, item: &node.name })?;
        }
    }
    if scene.instances.is_empty() {
        warnings.push("the scene draws nothing: no visible node of it has triangles, lines or points");
    }
    Ok(placed)
}

fn place(
    source: &Source<'_>,
    (node, draw): (&FlatNode, DrawOptions),
    mesh: MeshId,
    material: MaterialId,
    node_from_model: DMat4,
    scene: &mut Scene,
) -> Result<(), SceneError> {
    let bounds = &scene.meshes[mesh.index()].bounds;
    let world_from_model = node.world_from_node * node_from_model;
    let instance = Instance { draw, ..Instance::new(&node.name, mesh, material, world_from_model, bounds) };
    let reach = instance.bounds.min.abs().max(instance.bounds.max.abs());
    let reach = reach.max_element();
    if reach > MAX_COORDINATE_M || reach.is_nan() {
        return Err(source.malformed(
            &node.at,
            format!("its mesh reaches {reach:.3e} m from the origin, over {MAX_COORDINATE_M:e} m"),
        ));
    }
    if scene.instances.len() >= MAX_INSTANCES {
        let count = scene.instances.len() as u64 + 1;
        return Err(source.too_large(Quantity::Instances, count, MAX_INSTANCES as u64));
    }
    scene.instances.push(instance);
    Ok(())
}

fn warn_of_missing_uv(
    scene: &Scene,
    mesh: MeshId,
    surface: &super::material::Material,
    at: &str,
    warnings: &mut Warnings,
) {
    let mesh = &scene.meshes[mesh.index()];
    for slot in surface.slots().into_iter().flatten() {
        if mesh.uv(slot.uv_set).is_empty() {
            warnings.push(format!(
                "{at}: its material samples TEXCOORD_{}, which the primitive lacks; (0, 0) is used",
                slot.uv_set
            ));
        }
    }
}

#[cfg(test)]
mod tests;
