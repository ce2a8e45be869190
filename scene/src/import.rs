//! Import of glTF 2.0, text and binary.
//!
//! The `gltf-json` crate supplies the schema. The accessors, validation and image loading of the `gltf` crate over it are
//! not used: they unwrap indices that a file may get wrong (its validation indexes out of range for a bad POSITION), and a
//! file must never make this program panic. Here every index is looked up with a check, and a failed check names the file,
//! the place and the reason.
//!
//! ```text
//! bytes ─ container ─> JSON + BIN ─ uri, buffer ─> Source
//!   Source ─ node ─> nodes in world axes: meshes, lights, cameras
//!   meshes ─ primitive (accessor, topology) ─> Mesh     material, lobes ─> Material, Texture
//!   images ─> decoded on all cores
//! ```

mod accessor;
mod buffer;
mod camera;
mod container;
mod encoding;
mod extension;
mod images;
mod light;
mod limits;
mod lobes;
mod material;
mod motion;
mod moves;
mod node;
mod object;
mod primitive;
mod source;
mod stream;
mod texture;
mod topology;
mod uri;

use std::collections::BTreeMap;
use std::path::Path;

use gltf_json::Root;

use self::material::Materials;
use self::node::FlatNode;
use self::primitive::GeometryKey;
use self::source::{Source, Warnings};
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

/// [`load_with`] the default options.
///
/// # Errors
///
/// As there.
pub fn load(path: &Path, progress: &mut ProgressFn<'_>) -> Result<Scene, SceneError> {
    load_with(path, &LoadOptions::default(), progress)
}

/// Loads a glTF or GLB file; which of the two is told from the content.
///
/// Draws the default scene, or the first, or every root node. Textures of materials that nothing
/// uses are not decoded, and images with the same source are decoded once. What the scene takes stays taken of
/// `options.memory`; [`Memory::free`](crate::memory::Memory::free) gives it back.
///
/// # Errors
///
/// One line that names the file and the reason: unreadable or truncated files, broken references,
/// required extensions that are not supported, non-finite or zero-length vectors, images that do not
/// decode, sizes over the limits of this module, paths that lead out of the file's folder, too little memory.
pub fn load_with(path: &Path, options: &LoadOptions, progress: &mut ProgressFn<'_>) -> Result<Scene, SceneError> {
    let length = file_bytes(path)?;
    let over = |budget| SceneError::Memory { file: path.into(), at: "the file".into(), budget };
    options.memory.keep(length).map_err(over)?;
    let loaded = read_file(path).and_then(|bytes| load_bytes_with(path, &bytes, options, progress));
    options.memory.free(length);
    loaded
}

/// Loads a glTF or GLB file that is in memory. `path` names it in messages, and the files it refers
/// to are looked up beside it.
///
/// # Errors
///
/// As [`load`].
pub fn load_bytes(path: &Path, bytes: &[u8], progress: &mut ProgressFn<'_>) -> Result<Scene, SceneError> {
    load_bytes_with(path, bytes, &LoadOptions::default(), progress)
}

/// [`load_bytes`] with options.
///
/// # Errors
///
/// As [`load_with`].
pub fn load_bytes_with(
    path: &Path,
    bytes: &[u8],
    options: &LoadOptions,
    progress: &mut ProgressFn<'_>,
) -> Result<Scene, SceneError> {
    let (json, blob) = container::split(path, bytes)?;
    let root: Root =
        gltf_json::deserialize::from_slice(json).map_err(|e| SceneError::malformed(path, "JSON", e.to_string()))?;
    let mut warnings = Warnings::new(path);
    extension::check(path, &root, &mut warnings)?;
    let mut source = Source::new(path, &root, options);
    source.note_file(path);
    source.buffers = buffer::load(&source, blob, progress)?;
    let source = source;

    let nodes = node::flatten(&source)?;
    let mut scene = Scene {
        name: path.file_stem().map_or_else(String::new, |stem| one_line(&stem.to_string_lossy())),
        ..Scene::default()
    };
    light::import(&source, &nodes, &mut scene.lights, &mut warnings)?;
    camera::import(&source, &nodes, &mut scene.cameras, &mut warnings)?;
    let mut materials = Materials::new(&source);
    let instance_nodes = import_meshes(&source, &nodes, &mut scene, &mut materials, &mut warnings, progress)?;
    motion::import(&source, &nodes, instance_nodes, &mut scene, &mut warnings)?;
    let tables = materials.finish();
    scene.materials = tables.materials;
    scene.textures = tables.textures;
    scene.samplers = tables.samplers;
    scene.images = images::decode(&source, &tables.images, progress)?;
    scene.files = source.files();
    scene.warnings = warnings.into_lines();
    source.finish();
    Ok(scene)
}

/// Turns each (node, primitive) into an instance; equal geometry is built once. Returns the node of each instance.
fn import_meshes(
    source: &Source<'_>,
    nodes: &[FlatNode],
    scene: &mut Scene,
    materials: &mut Materials<'_>,
    warnings: &mut Warnings,
    progress: &mut ProgressFn<'_>,
) -> Result<Vec<usize>, SceneError> {
    let mut instance_nodes = Vec::new();
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
        for (i, primitive) in mesh.primitives.iter().enumerate() {
            let at = format!("mesh {mesh_index} primitive {i}");
            let material = materials.import(primitive.material, &at, warnings)?;
            let surface = materials.get(material);
            let key = GeometryKey::new(primitive, surface, node.index, node.skin.is_some());
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
                place(source, node, mesh_id, material, scene)?;
                instance_nodes.push(*place_of_node);
            }
            done += 1;
            report(progress, source.file, Progress { stage: Stage::Geometry, done, total, item: &node.name })?;
        }
    }
    if scene.instances.is_empty() {
        warnings.push("the scene draws no triangles");
    }
    Ok(instance_nodes)
}

fn place(
    source: &Source<'_>,
    node: &FlatNode,
    mesh: MeshId,
    material: MaterialId,
    scene: &mut Scene,
) -> Result<(), SceneError> {
    let bounds = &scene.meshes[mesh.index()].bounds;
    let instance = Instance::new(&node.name, mesh, material, node.world_from_node, bounds);
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
