//! Ray tracing in f64: tests every triangle of every group whose box the ray hits.

use glam::DVec3;

/// Triangles in spatial groups with bounding boxes.
#[derive(Clone, Debug)]
pub struct Triangles {
    groups: Vec<Group>,
}

#[derive(Clone, Debug)]
struct Group {
    min: DVec3,
    max: DVec3,
    triangles: Vec<[DVec3; 3]>,
}

/// Maximum number of triangles in a group.
const GROUP: usize = 64;

/// First intersection of a ray with a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Position, in m.
    pub point: DVec3,
    /// Unit normal of the triangle, on the side of the ray's origin.
    pub normal: DVec3,
}

impl Triangles {
    /// Groups the triangles of meshes.
    pub fn of(meshes: impl Iterator<Item = Vec<[DVec3; 3]>>) -> Self {
        let mut groups = Vec::new();
        for triangles in meshes {
            group(triangles, &mut groups);
        }
        Self { groups }
    }

    /// Returns the first intersection of a ray from `from` along the unit vector `along`.
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

    /// Returns true if there is no triangle between two points, ignoring `slack` meters at the first.
    #[must_use]
    pub fn is_open(&self, from: DVec3, to: DVec3, slack: f64) -> bool {
        let way = (to - from).length();
        let along = (to - from) / way;
        !self.near(from, along).any(|t| meets(t, from, along).is_some_and(|d| d > slack && d < way))
    }

    fn near(&self, from: DVec3, along: DVec3) -> impl Iterator<Item = &[DVec3; 3]> {
        self.groups.iter().filter(move |group| group.is_near(from, along)).flat_map(|group| &group.triangles)
    }
}

/// Splits triangles along the longest side of their box until the groups are small.
fn group(mut triangles: Vec<[DVec3; 3]>, groups: &mut Vec<Group>) {
    let corners = || triangles.iter().flatten();
    let min = corners().fold(DVec3::INFINITY, |least, at| least.min(*at));
    let max = corners().fold(DVec3::NEG_INFINITY, |most, at| most.max(*at));
    if triangles.len() <= GROUP {
        groups.push(Group { min, max, triangles });
        return;
    }
    let size = max - min;
    let axis = (0..3).max_by(|a, b| size[*a].total_cmp(&size[*b])).unwrap_or(0);
    let along = |[a, b, c]: &[DVec3; 3]| a[axis] + b[axis] + c[axis];
    triangles.sort_by(|a, b| along(a).total_cmp(&along(b)));
    let rest = triangles.split_off(triangles.len() / 2);
    group(triangles, groups);
    group(rest, groups);
}

impl Group {
    /// Returns true if a ray hits the box (Kay and Kajiya 1986), the most frequent operation.
    fn is_near(&self, from: DVec3, along: DVec3) -> bool {
        let (mut enter, mut leave) = (-1e-9_f64, f64::INFINITY);
        for axis in 0..3 {
            let (low, high) = (self.min[axis] - 1e-9 - from[axis], self.max[axis] + 1e-9 - from[axis]);
            let way = along[axis];
            if way == 0.0 {
                if low > 0.0 || high < 0.0 {
                    return false;
                }
                continue;
            }
            let (near, far) = if way > 0.0 { (low / way, high / way) } else { (high / way, low / way) };
            enter = enter.max(near);
            leave = leave.min(far);
        }
        enter <= leave
    }
}

/// Returns the distance along a ray to a triangle, above 0 (Möller and Trumbore 1997).
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

    #[test]
    fn a_box_is_met_on_its_near_side() {
        // Two triangles for each side of a box of 2 m, 4 to 6 m ahead.
        let sides = (0..3).flat_map(|axis| [-1.0, 1.0].map(|side| (axis, side))).flat_map(|(axis, side)| {
            let mut normal = DVec3::ZERO;
            normal[axis] = side;
            let (u, v) = normal.any_orthonormal_pair();
            let at = |s: f64, t: f64| normal + s * u + t * v - 5.0 * DVec3::Z;
            [[at(-1.0, -1.0), at(1.0, -1.0), at(1.0, 1.0)], [at(-1.0, -1.0), at(1.0, 1.0), at(-1.0, 1.0)]]
        });
        let triangles = Triangles::of(std::iter::once(sides.collect()));
        let hit = triangles.first(DVec3::new(0.3, 0.2, 0.0), DVec3::NEG_Z).expect("the box is ahead");
        assert!((hit.point - DVec3::new(0.3, 0.2, -4.0)).length() < 1e-12 && hit.normal == DVec3::Z, "{hit:?}");
        assert_eq!(triangles.first(DVec3::new(1.1, 0.0, 0.0), DVec3::NEG_Z), None);
        let (here, beyond) = (DVec3::ZERO, DVec3::new(0.0, 0.0, -9.0));
        assert!(!triangles.is_open(here, beyond, 0.0) && triangles.is_open(here, DVec3::new(0.0, 0.0, -3.9), 0.0));
    }
}
