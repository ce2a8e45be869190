//! Detection of one opaque instance that covers the whole picture and hides everything behind it.
//!
//! The triangles of one instance are subtracted from the picture one after another. The parts of each remaining
//! polygon outside the triangle stay. Triangles of one mesh share edges, which devices rasterize without gaps.
//! Instances that cover the picture only together are not detected.

use super::visibility::{Visibility, fit_camera};
use crate::gpu_scene::view::ViewSettings;
use framegraph_scene::{Aabb, AlphaMode, Instance, Mesh};
use glam::{DMat4, DVec2, DVec4};

/// Maximum number of triangles of a tested mesh.
const MAX_TRIANGLES: usize = 4096;
/// Maximum number of remaining parts. With more, the background counts as visible.
const MAX_PARTS: usize = 256;
/// Minimum area of a remaining part, of the 4 of the picture in clip space. Smaller parts are rounding errors of
/// edges.
const LEAST_AREA: f64 = 1e-12;

type Polygon = Vec<DVec2>;

/// Returns the name of the instance that covers each view's picture; `None` if a view may show the background.
pub(super) fn covers<'a>(seen: &Visibility<'a>, views: &[ViewSettings]) -> Option<&'a str> {
    let mut name = None;
    for (view, lists) in views.iter().zip(&seen.lists) {
        let found = lists.opaque.iter().map(|i| &seen.scene.instances[*i as usize]).find(|instance| {
            let material = &seen.scene.materials[instance.material.index()];
            material.alpha == AlphaMode::Opaque
                && material.stencil.is_none()
                && instance_covers(instance, &seen.scene.meshes[instance.mesh.index()], material.double_sided, view)
        });
        name = Some(found?.name.as_str());
    }
    name
}

fn instance_covers(instance: &Instance, mesh: &Mesh, double_sided: bool, view: &ViewSettings) -> bool {
    if mesh.triangle_count() > MAX_TRIANGLES {
        return false;
    }
    let camera = fit_camera(view);
    let clip_from_model = view.camera.clip_from_view(camera.width_over_height)
        * DMat4::from_quat(view.camera.world_from_view.inverse())
        * DMat4::from_translation(-view.camera.eye)
        * instance.world_from_model;
    // One more pixel on each side, since TAA jitters by fractions of a pixel.
    let [x, y] = view.size_px.map(|side| 1.0 + 2.0 / f64::from(side.max(1)));
    if !box_covers(&mesh.bounds, &clip_from_model, DVec2::new(x, y)) {
        return false;
    }
    let mut left: Vec<Polygon> = vec![[(-x, -y), (x, -y), (x, y), (-x, y)].map(DVec2::from).to_vec()];
    let front = if instance.is_mirrored() { -1.0 } else { 1.0 };
    for triangle in mesh.triangles() {
        let corners = triangle.map(|i| clip_from_model * mesh.positions[i].as_dvec3().extend(1.0));
        let mut drawn = project(&corners);
        let turn = front * area(&drawn);
        if turn.abs() < LEAST_AREA || (turn < 0.0 && !double_sided) {
            continue;
        }
        if area(&drawn) < 0.0 {
            drawn.reverse();
        }
        left = left.iter().flat_map(|part| outside(part, &drawn)).collect();
        if left.len() > MAX_PARTS {
            return false;
        }
    }
    left.is_empty()
}

/// Returns true if the box of a mesh may cover the picture: it contains the eye, or the rectangle around its corners
/// contains the picture.
fn box_covers(bounds: &Aabb, clip_from_model: &DMat4, picture: DVec2) -> bool {
    let corners = bounds.corners().map(|corner| *clip_from_model * corner.extend(1.0));
    if corners.iter().any(|corner| corner.w <= 0.0) {
        return true;
    }
    let flat = corners.map(|corner| DVec2::new(corner.x, corner.y) / corner.w);
    let (low, high) = flat.iter().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(l, h), p| (l.min(*p), h.max(*p)));
    low.cmple(-picture).all() && high.cmpge(picture).all()
}

/// Returns the part of a triangle between near and far plane, in clip space divided by w.
fn project(corners: &[DVec4; 3]) -> Polygon {
    // In front of the near plane z > w; beyond the far plane z < 0. Points on a plane are cut off, to be conservative.
    let inside = |plane: DVec4, p: &DVec4| plane.dot(*p) - 1e-9 * p.w.abs();
    let mut polygon = corners.to_vec();
    for plane in [DVec4::new(0.0, 0.0, -1.0, 1.0), DVec4::Z] {
        let mut clipped = Vec::with_capacity(polygon.len() + 1);
        for (i, a) in polygon.iter().enumerate() {
            let b = polygon[(i + 1) % polygon.len()];
            let (at_a, at_b) = (inside(plane, a), inside(plane, &b));
            if at_a > 0.0 {
                clipped.push(*a);
            }
            if (at_a > 0.0) != (at_b > 0.0) {
                clipped.push(*a + (b - *a) * (at_a / (at_a - at_b)));
            }
        }
        polygon = clipped;
    }
    polygon.iter().filter(|p| p.w > 0.0).map(|p| DVec2::new(p.x, p.y) / p.w).collect()
}

/// Returns twice the signed area, positive if counter-clockwise.
fn area(polygon: &[DVec2]) -> f64 {
    polygon.iter().enumerate().map(|(i, a)| a.perp_dot(polygon[(i + 1) % polygon.len()])).sum()
}

/// Returns the parts of a convex polygon outside another, counter-clockwise one.
fn outside(part: &Polygon, of: &Polygon) -> Vec<Polygon> {
    let (mut parts, mut rest) = (Vec::new(), part.clone());
    for (i, a) in of.iter().enumerate() {
        let edge = of[(i + 1) % of.len()] - *a;
        let side = |p: &DVec2| edge.perp_dot(*p - *a);
        let beyond = half(&rest, |p| -side(p));
        if area(&beyond).abs() > LEAST_AREA {
            parts.push(beyond);
        }
        rest = half(&rest, side);
        if rest.len() < 3 {
            break;
        }
    }
    parts
}

/// Returns the part of a convex polygon where `side` is at least 0.
fn half(polygon: &[DVec2], side: impl Fn(&DVec2) -> f64) -> Polygon {
    let mut kept = Vec::with_capacity(polygon.len() + 1);
    for (i, a) in polygon.iter().enumerate() {
        let b = polygon[(i + 1) % polygon.len()];
        let (at_a, at_b) = (side(a), side(&b));
        if at_a >= 0.0 {
            kept.push(*a);
        }
        if (at_a > 0.0 && at_b < 0.0) || (at_a < 0.0 && at_b > 0.0) {
            kept.push(*a + (b - *a) * (at_a / (at_a - at_b)));
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::LightSearch;
    use crate::feature_culling::scene_summary::SceneSummary;
    use framegraph_scene::{Camera, Material, Projection, Scene, geometry};
    use glam::{DVec3, Vec2, Vec3};

    fn view(eye: DVec3, target: DVec3) -> ViewSettings {
        let projection = Projection::perspective(1.0, 0.1);
        ViewSettings {
            camera: Camera::look_at(eye, target, DVec3::Y, projection).expect("a camera"),
            size_px: [64, 48],
            ev100: 0.0,
            environment_intensity: 1.0,
            shadows: None,
            lights: LightSearch::All,
            lod_error_px: 0.0,
            visible_layers: 1,
        }
    }

    fn covered(scene: &Scene, view: &ViewSettings) -> bool {
        let (survey, views) = (SceneSummary::new(scene), std::slice::from_ref(view));
        covers(&Visibility::new(scene, &survey, views), views).is_some()
    }

    fn scene(mesh: Mesh, material: Material) -> Scene {
        let mut scene = Scene::default();
        let (mesh, material) = (scene.add_mesh(mesh), scene.add_material(material));
        scene.add_instance("it", mesh, material, DMat4::IDENTITY);
        scene
    }

    #[test]
    fn a_wall_covers_the_picture_from_before_it_and_near() {
        let wall = |double_sided| {
            let material = Material { double_sided, ..Material::dielectric("wall", Vec3::ONE, 0.5) };
            scene(geometry::plane(Vec2::splat(10.0), 3, Vec2::ONE), material)
        };
        let (above, below) = (DVec3::new(0.1, 3.0, 0.2), DVec3::new(0.1, -3.0, 0.2));
        assert!(covered(&wall(false), &view(above, DVec3::ZERO)));
        assert!(!covered(&wall(false), &view(above * 5.0, DVec3::ZERO)), "from farther away its edges are seen");
        assert!(!covered(&wall(false), &view(below, DVec3::ZERO)), "its back is not drawn");
        assert!(covered(&wall(true), &view(below, DVec3::ZERO)));
        assert!(!covered(&wall(false), &view(above, DVec3::new(3.0, 3.0, 0.0))), "the horizon is seen");
        let mut lines = wall(true);
        lines.meshes[0].topology = framegraph_scene::Topology::Lines;
        assert!(!covered(&lines, &view(above, DVec3::ZERO)), "lines have no area");
        let mut glass = wall(true);
        glass.materials[0].alpha = AlphaMode::Blend;
        assert!(!covered(&glass, &view(above, DVec3::ZERO)));
    }

    /// A closed room covers the picture; a room with a missing triangle does not.
    #[test]
    fn a_room_covers_the_picture_and_a_hole_does_not() {
        let double_sided = Material { double_sided: true, ..Material::dielectric("room", Vec3::ONE, 0.5) };
        let mut room = scene(geometry::cuboid(Vec3::new(4.0, 3.0, 5.0)), double_sided);
        let inside = |at: DVec3| view(DVec3::new(0.5, 0.2, 1.0), at);
        for at in [DVec3::X * 4.0, DVec3::NEG_Z * 4.0, DVec3::new(3.0, 2.5, -4.0), DVec3::new(0.6, -3.0, 1.1)] {
            assert!(covered(&room, &inside(at)), "{at}");
        }
        let [whole, gone] = [36, 33];
        assert_eq!(room.meshes[0].indices.len(), whole);
        room.meshes[0].indices.truncate(gone);
        let open = [DVec3::X, DVec3::Y, DVec3::Z].into_iter().flat_map(|axis| [axis, -axis]);
        let seen = open.map(|axis| covered(&room, &inside(axis * 4.0 + DVec3::splat(0.01)))).filter(|c| !c).count();
        assert!(seen > 0, "the hole is on one of the sides");
    }
}
