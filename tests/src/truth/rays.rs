//! What rays meet in a scene: every triangle of every group that a ray's path comes near, in f64.

use framegraph_scene::{Aabb, Scene};
use glam::DVec3;

/// The triangles of a scene, in the world, in groups of neighbors with a box about each.
#[derive(Clone, Debug)]
pub struct Triangles {
    groups: Vec<(Aabb, Vec<[DVec3; 3]>)>,
}

/// Triangles of a group at most.
const GROUP: usize = 64;

/// Where a ray first meets a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// The place, in meters.
    pub point: DVec3,
    /// Unit normal of the triangle, on the side that the ray came from.
    pub normal: DVec3,
}

impl Triangles {
    /// All triangles, whatever they are made of.
    #[must_use]
    pub fn of(scene: &Scene) -> Self {
        let mut groups = Vec::new();
        for instance in &scene.instances {
            let mesh = &scene.meshes[instance.mesh.index()];
            let at = |i: &u32| instance.world_from_model.transform_point3(mesh.positions[*i as usize].as_dvec3());
            group(mesh.indices.chunks_exact(3).map(|t| [at(&t[0]), at(&t[1]), at(&t[2])]).collect(), &mut groups);
        }
        Self { groups }
    }

    /// The first triangle that a ray from `from` along the unit vector `along` meets.
    #[must_use]
    pub fn first(&self, from: DVec3, along: DVec3) -> Option<Hit> {
        let mut nearest = f64::INFINITY;
        let mut normal = DVec3::ZERO;
        for triangle in self.near(from, along) {
            if let Some(distance) = meets(triangle, from, along).filter(|d| *d < nearest) {
                nearest = distance;
                normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]).normalize();
            }
        }
        let normal = if normal.dot(along) > 0.0 { -normal } else { normal };
        nearest.is_finite().then(|| Hit { point: from + along * nearest, normal })
    }

    /// Whether nothing lies between two points but within `slack` meters of the first.
    #[must_use]
    pub fn is_open(&self, from: DVec3, to: DVec3, slack: f64) -> bool {
        let way = (to - from).length();
        let along = (to - from) / way;
        !self.near(from, along).any(|t| meets(t, from, along).is_some_and(|d| d > slack && d < way))
    }

    fn near(&self, from: DVec3, along: DVec3) -> impl Iterator<Item = &[DVec3; 3]> {
        self.groups.iter().filter(move |(bounds, _)| passes(bounds, from, along)).flat_map(|(_, own)| own)
    }
}

/// Halves triangles along the longest side of their box until few are left together.
fn group(mut triangles: Vec<[DVec3; 3]>, groups: &mut Vec<(Aabb, Vec<[DVec3; 3]>)>) {
    let corners = triangles.iter().flatten();
    let bounds = corners.fold(Aabb::EMPTY, |all, at| all.union(Aabb { min: *at, max: *at }));
    if triangles.len() <= GROUP {
        groups.push((bounds, triangles));
        return;
    }
    let size = bounds.half_extent();
    let axis = (0..3).max_by(|a, b| size[*a].total_cmp(&size[*b])).unwrap_or(0);
    let along = |[a, b, c]: &[DVec3; 3]| a[axis] + b[axis] + c[axis];
    triangles.sort_by(|a, b| along(a).total_cmp(&along(b)));
    let rest = triangles.split_off(triangles.len() / 2);
    group(triangles, groups);
    group(rest, groups);
}

/// Whether a ray passes through a box (Kay and Kajiya 1986). It is most of what rays take, and tests are built without
/// optimization, where each operator of a vector and each `min` is a call.
fn passes(bounds: &Aabb, from: DVec3, along: DVec3) -> bool {
    let (mut enter, mut leave) = (-1e-9_f64, f64::INFINITY);
    let (least, most) = (bounds.min.to_array(), bounds.max.to_array());
    let (from, along) = (from.to_array(), along.to_array());
    let mut axis = 0;
    while axis < 3 {
        let (low, high) = (least[axis] - 1e-9 - from[axis], most[axis] + 1e-9 - from[axis]);
        let way = along[axis];
        if way == 0.0 {
            if low > 0.0 || high < 0.0 {
                return false;
            }
        } else {
            let (near, far) = if way > 0.0 { (low / way, high / way) } else { (high / way, low / way) };
            if near > enter {
                enter = near;
            }
            if far < leave {
                leave = far;
            }
        }
        axis += 1;
    }
    enter <= leave
}

/// Distance along a ray to a triangle, above 0 (Möller and Trumbore 1997).
fn meets(&[a, b, c]: &[DVec3; 3], from: DVec3, along: DVec3) -> Option<f64> {
    let (ab, ac) = (b - a, c - a);
    let across = along.cross(ac);
    let det = ab.dot(across);
    if det == 0.0 {
        return None;
    }
    let to = (from - a) / det;
    let u = to.dot(across);
    let q = to.cross(ab);
    let v = along.dot(q);
    let distance = ac.dot(q);
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && distance > 0.0).then_some(distance)
}

#[cfg(test)]
mod tests {
    use super::*;
    use framegraph_scene::geometry::cuboid;
    use framegraph_scene::{Material, Scene};
    use glam::{DMat4, Vec3};

    #[test]
    fn a_box_is_met_on_its_near_side() {
        let mut scene = Scene::default();
        let material = scene.add_material(Material::default());
        let mesh = scene.add_mesh(cuboid(Vec3::ONE));
        scene.add_instance("box", mesh, material, DMat4::from_translation(DVec3::new(0.0, 0.0, -5.0)));
        let triangles = Triangles::of(&scene);
        let hit = triangles.first(DVec3::new(0.3, 0.2, 0.0), DVec3::NEG_Z).expect("the box is ahead");
        assert!((hit.point - DVec3::new(0.3, 0.2, -4.0)).length() < 1e-12 && hit.normal == DVec3::Z, "{hit:?}");
        assert_eq!(triangles.first(DVec3::new(1.1, 0.0, 0.0), DVec3::NEG_Z), None);
        let (here, beyond) = (DVec3::ZERO, DVec3::new(0.0, 0.0, -9.0));
        assert!(!triangles.is_open(here, beyond, 0.0) && triangles.is_open(here, DVec3::new(0.0, 0.0, -3.9), 0.0));
    }
}
