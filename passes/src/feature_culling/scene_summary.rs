//! Camera-independent properties of a scene's surfaces, computed once after loading.
//!
//! Textures multiply factors by values from 0 to 1, so a factor is an upper bound of the product, and there is no
//! lower bound. All properties are conservative: an unknown value keeps most effects.

use framegraph_scene::{Instance, Lobe, Lobes, Material, Mesh, Scene};
use glam::{DMat3, DVec3, Vec3};

/// More tests of a vertex against a triangle than this are not made: the mesh counts as not convex.
const MAX_TESTS: usize = 1 << 22;

/// Camera-independent properties of a scene's surfaces.
#[derive(Clone, Debug)]
pub struct SceneSummary {
    pub(super) shapes: Vec<Shape>,
    pub(super) surfaces: Vec<Surface>,
}

impl SceneSummary {
    /// Summarizes all meshes and materials of a scene. Images are not read and may have been freed.
    #[must_use]
    pub fn new(scene: &Scene) -> Self {
        let moves = |mesh: usize| scene.motion.bodies.iter().any(|body| body.mesh.index() == mesh);
        let shape = |(number, mesh): (usize, &Mesh)| {
            if moves(number) { Shape::UNKNOWN } else { Shape::of(mesh) }
        };
        let surfaces = scene.materials.iter().map(Surface::of);
        Self { shapes: scene.meshes.iter().enumerate().map(shape).collect(), surfaces: surfaces.collect() }
    }

    /// The shape of an instance.
    pub(super) fn shape(&self, instance: &Instance) -> &Shape {
        &self.shapes[instance.mesh.index()]
    }

    /// The surface of an instance.
    pub(super) fn surface(&self, instance: &Instance) -> &Surface {
        &self.surfaces[instance.material.index()]
    }
}

/// A mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Shape {
    /// All normals are within an angle of this cosine about an axis; none where they are within no half space.
    pub facing: Option<(DVec3, f64)>,
    /// Upper bound of the curvature along edges and lines, in 1/m of the mesh: 0 if every triangle has one normal.
    pub turn_per_m: f64,
    /// True if no part of the mesh can hide another.
    pub convex: bool,
    /// Colors of vertices may be beyond 1.
    pub colored: bool,
}

impl Shape {
    /// Properties of a mesh that may be deformed.
    const UNKNOWN: Self = Self { facing: None, turn_per_m: f64::INFINITY, convex: false, colored: true };

    fn of(mesh: &Mesh) -> Self {
        Self {
            facing: facing(&mesh.normals),
            turn_per_m: turn_per_m(mesh),
            convex: is_convex(mesh),
            colored: !mesh.colors.is_empty(),
        }
    }
}

/// Properties of a material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Surface {
    pub unlit: bool,
    pub lobes: Lobes,
    /// Reflectance at normal incidence, at most.
    pub most_f0: f32,
    /// Perceptual roughness, at least.
    pub least_roughness: f32,
    /// Light bends normals away from those of the mesh.
    pub mapped_normals: bool,
    /// Back faces are shaded too.
    pub double_sided: bool,
    /// It has a texture of ambient occlusion.
    pub occlusion_map: bool,
    /// It has a texture of emission that nothing can shine through.
    pub dark_emission: bool,
    /// It emits light.
    pub emits: bool,
}

impl Surface {
    fn of(material: &Material) -> Self {
        let specular = material.specular.map_or(1.0, |s| s.factor.max(0.0) * s.color.max_element().max(0.0));
        let dielectric = (material.dielectric_f0() * specular).min(1.0);
        let textured = material.metallic_roughness_texture.is_some();
        Self {
            // A shadow catcher shows no light, but where there is none.
            unlit: material.unlit && !material.catches_shadows(),
            lobes: material.lobes(),
            // A film may reflect all of a color.
            most_f0: if material.metallic > 0.0 || material.iridescence.is_some() { 1.0 } else { dielectric },
            least_roughness: if textured || !material.roughness.is_finite() { 0.0 } else { material.roughness },
            mapped_normals: material.normal_texture.is_some()
                || material.clear_coat.is_some_and(|coat| coat.normal_texture.is_some()),
            double_sided: material.double_sided,
            occlusion_map: material.occlusion_texture.is_some(),
            dark_emission: material.emissive_texture.is_some() && material.emissive == Vec3::ZERO,
            emits: material.emissive != Vec3::ZERO,
        }
    }

    /// Returns true if light from behind is scattered through the surface.
    pub fn is_translucent(&self) -> bool {
        let scatters = [Lobe::DiffuseTransmission, Lobe::Subsurface, Lobe::ClothSubsurface];
        scatters.into_iter().any(|lobe| self.lobes.contains(lobe))
    }

    /// Returns true if the material is refractive, and therefore writes no depth for screen-space effects.
    pub fn transmits(&self) -> bool {
        self.lobes.contains(Lobe::Transmission)
    }
}

/// Returns the uniform scale of an instance from mesh units to meters; `None` if the scale is not uniform.
pub(super) fn even_scale(instance: &Instance) -> Option<f64> {
    let linear = DMat3::from_mat4(instance.world_from_model);
    let columns = [linear.x_axis, linear.y_axis, linear.z_axis];
    let length = columns[0].length();
    let even = columns.iter().all(|c| (c.length() - length).abs() <= 1e-4 * length);
    let across = (0..3).all(|i| columns[i].dot(columns[(i + 1) % 3]).abs() <= 1e-4 * length * length);
    (even && across && length > 0.0).then_some(length)
}

fn facing(normals: &[Vec3]) -> Option<(DVec3, f64)> {
    let axis = normals.iter().map(|n| n.as_dvec3()).sum::<DVec3>().try_normalize()?;
    let cosine = normals.iter().map(|n| n.as_dvec3().dot(axis)).fold(1.0, f64::min);
    (cosine > 0.0).then_some((axis, cosine))
}

fn turn_per_m(mesh: &Mesh) -> f64 {
    let mut most = 0.0_f64;
    // Points, and lines without normals, have no normals that turn.
    let (corners, lit) = (mesh.topology.corners(), !mesh.normals.is_empty());
    for primitive in mesh.indices.chunks_exact(corners).filter(|_| corners > 1 && lit) {
        for edge in 0..corners {
            let [from, to] = [edge, (edge + 1) % corners].map(|corner| primitive[corner] as usize);
            let turn = f64::from((mesh.normals[to] - mesh.normals[from]).length());
            let length = f64::from((mesh.positions[to] - mesh.positions[from]).length());
            // Without length there is no triangle to see.
            if turn > 0.0 && length > 0.0 {
                most = most.max(turn / length);
            }
        }
    }
    most
}

/// True if no vertex lies before any triangle's plane. Lines and points have no planes, and count as not convex.
fn is_convex(mesh: &Mesh) -> bool {
    if !mesh.has_area() || mesh.vertex_count() * mesh.triangle_count() > MAX_TESTS || mesh.positions.is_empty() {
        return false;
    }
    let at = |i: usize| mesh.positions[i].as_dvec3();
    let slack = 1e-5 * mesh.bounds.radius();
    mesh.triangles().all(|[a, b, c]| match (at(b) - at(a)).cross(at(c) - at(a)).try_normalize() {
        Some(normal) => mesh.positions.iter().all(|p| normal.dot(p.as_dvec3() - at(a)) <= slack),
        None => true,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use framegraph_scene::geometry;
    use framegraph_scene::{MaterialId, MeshId, Topology};
    use glam::DMat4;

    #[test]
    fn shapes_are_known_by_their_normals_and_planes() {
        let ball = Shape::of(&geometry::sphere(0.5, 32, 16));
        assert!(ball.convex && ball.facing.is_none());
        // A ball of half a meter turns normals by 1 over a way of 0.5 m; chords are a little shorter.
        assert!((ball.turn_per_m - 2.0).abs() < 0.05, "{}", ball.turn_per_m);
        let block = Shape::of(&geometry::cuboid(Vec3::ONE));
        assert!(block.convex && block.turn_per_m == 0.0 && block.facing.is_none());
        let ground = Shape::of(&geometry::plane(glam::Vec2::ONE, 1, glam::Vec2::ONE));
        assert!(ground.facing.is_some_and(|(axis, cosine)| axis == DVec3::Y && cosine > 1.0 - 1e-9));
        let lines = Mesh { topology: Topology::Lines, ..geometry::sphere(0.5, 32, 16) };
        let bare = Mesh { topology: Topology::Points, normals: Vec::new(), ..lines.clone() };
        let [lines, bare] = [Shape::of(&lines), Shape::of(&bare)];
        assert!(!lines.convex && (lines.turn_per_m - 2.0).abs() < 0.05 && lines.facing.is_none(), "{lines:?}");
        assert!(!bare.convex && bare.turn_per_m == 0.0 && bare.facing.is_none(), "{bare:?}");
        let mut two = geometry::cuboid(Vec3::ONE);
        two.positions[0] *= 0.1;
        assert!(!Shape::of(&two).convex, "a corner is pushed in");
    }

    #[test]
    fn textures_bound_from_above_alone() {
        let slot = framegraph_scene::TextureSlot {
            texture: framegraph_scene::TextureId::new(0),
            uv_set: 0,
            transform: framegraph_scene::UvTransform::default(),
        };
        let plain = Material::dielectric("plain", Vec3::ONE, 0.7);
        let surface = Surface::of(&plain);
        assert_eq!((surface.least_roughness, surface.most_f0), (0.7, plain.dielectric_f0()));
        let textured = Surface::of(&Material { metallic_roughness_texture: Some(slot), ..plain.clone() });
        assert_eq!(textured.least_roughness, 0.0);
        let film = Some(framegraph_scene::Iridescence::default());
        assert_eq!(Surface::of(&Material { iridescence: film, ..plain.clone() }).most_f0, 1.0);
        assert_eq!(Surface::of(&Material { metallic: 0.01, ..plain }).most_f0, 1.0);
    }

    #[test]
    fn placements_that_stretch_have_no_scale() {
        let mesh = geometry::cuboid(Vec3::ONE);
        let placed = |m: DMat4| Instance::new("", MeshId::new(0), MaterialId::new(0), m, &mesh.bounds);
        assert_eq!(even_scale(&placed(DMat4::from_scale(DVec3::splat(2.0)))), Some(2.0));
        assert_eq!(even_scale(&placed(DMat4::from_scale(DVec3::new(1.0, 1.0, 2.0)))), None);
    }
}
