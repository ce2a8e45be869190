//! Cube maps of radiance: six faces, looked up by direction as in graphics APIs.
//!
//! Faces are seen from inside and mirrored: on +x, u points toward −z and v toward −y, as in cube map lookups.
//! Environments are stored as equirectangular maps, so cube maps are resampled.

use glam::{DVec2, DVec3};

use super::equirect::{EquirectMap, direction_from_equirect_uv};

/// A cube map of `size`² texels per face, faces in the order +x −x +y −y +z −z.
pub(super) struct Cube<'a> {
    pub size: u32,
    pub texels: &'a [[f32; 4]],
}

/// Returns the direction, not normalized, of a point on a face. u points right and v down, both in −1…1 on the face;
/// values beyond continue its plane.
fn direction(face: usize, DVec2 { x: u, y: v }: DVec2) -> DVec3 {
    match face {
        0 => DVec3::new(1.0, -v, -u),
        1 => DVec3::new(-1.0, -v, u),
        2 => DVec3::new(u, 1.0, v),
        3 => DVec3::new(u, -1.0, -v),
        4 => DVec3::new(u, -v, 1.0),
        _ => DVec3::new(-u, -v, -1.0),
    }
}

/// Returns the face in a direction, and the point on it.
fn face(d: DVec3) -> (usize, DVec2) {
    let size = d.abs();
    let (face, along, across) = if size.x >= size.y && size.x >= size.z {
        if d.x > 0.0 { (0, size.x, [-d.z, -d.y]) } else { (1, size.x, [d.z, -d.y]) }
    } else if size.y >= size.z {
        if d.y > 0.0 { (2, size.y, [d.x, d.z]) } else { (3, size.y, [d.x, -d.z]) }
    } else if d.z > 0.0 {
        (4, size.z, [d.x, -d.y])
    } else {
        (5, size.z, [-d.x, -d.y])
    };
    (face, DVec2::from(across) / along)
}

impl Cube<'_> {
    /// Returns the bytes of the map that [`panorama`](Self::panorama) creates from a cube map of this size.
    pub fn panorama_bytes(size: u32) -> u64 {
        16 * 8 * u64::from(size).pow(2)
    }

    /// Resamples the cube map to an equirectangular map. Texels at the horizon are as wide as those of the cube map;
    /// each averages four samples.
    pub fn panorama(&self) -> EquirectMap {
        let (width, height) = (4 * self.size, 2 * self.size);
        let mut texels = Vec::with_capacity(width as usize * height as usize);
        for y in 0..height {
            for x in 0..width {
                let mut sum = DVec3::ZERO;
                for [dx, dy] in [[0.25, 0.25], [0.75, 0.25], [0.25, 0.75], [0.75, 0.75]] {
                    let at = DVec2::new(f64::from(x) + dx, f64::from(y) + dy);
                    let uv = at / DVec2::new(f64::from(width), f64::from(height));
                    sum += self.radiance(direction_from_equirect_uv(uv));
                }
                let [r, g, b] = (sum * 0.25).as_vec3().to_array();
                texels.push([r, g, b, 1.0]);
            }
        }
        EquirectMap::new(width, height, texels)
    }

    /// Returns the bilinearly filtered radiance in a direction, continued across face edges.
    fn radiance(&self, toward: DVec3) -> DVec3 {
        let (face, uv) = face(toward);
        let at = (uv + 1.0) * (0.5 * f64::from(self.size)) - 0.5;
        let (low, share) = (at.floor(), at - at.floor());
        let corner = |dx: f64, dy: f64| self.texel(face, low + DVec2::new(dx, dy));
        let top = corner(0.0, 0.0).lerp(corner(1.0, 0.0), share.x);
        top.lerp(corner(0.0, 1.0).lerp(corner(1.0, 1.0), share.x), share.y)
    }

    /// Returns a texel by column and row, which may be one beyond the face.
    fn texel(&self, on: usize, at: DVec2) -> DVec3 {
        let size = f64::from(self.size);
        let (mut on, mut at) = (on, at);
        if at.min_element() < 0.0 || at.max_element() >= size {
            let (beyond, uv) = face(direction(on, (at + 0.5) * (2.0 / size) - 1.0));
            (on, at) = (beyond, ((uv + 1.0) * (0.5 * size)).floor());
        }
        let [x, y] = at.clamp(DVec2::ZERO, DVec2::splat(size - 1.0)).to_array().map(|c| c as usize);
        let size = self.size as usize;
        let [r, g, b, _] = self.texels[(on * size + y) * size + x].map(f64::from);
        DVec3::new(r, g, b)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faces_lie_where_graphics_interfaces_have_them() {
        for i in 0..6 {
            for uv in [DVec2::ZERO, DVec2::new(0.3, -0.8), DVec2::new(-0.9, 0.5)] {
                let (found, back) = face(direction(i, uv));
                assert_eq!(found, i);
                assert!((back - uv).length() < 1e-12, "{i} {uv}: {back}");
            }
        }
        // The table of the OpenGL specification, "Cube Map Texture Selection": s and t for each major axis.
        let (sixth, half) = (DVec3::new(0.5, 0.25, 0.125), DVec3::new(0.125, 0.25, 0.5));
        assert_eq!(face(sixth), (0, DVec2::new(-0.25, -0.5)));
        assert_eq!(face(-sixth), (1, DVec2::new(-0.25, 0.5)));
        assert_eq!(face(half), (4, DVec2::new(0.25, -0.5)));
        assert_eq!(face(-half), (5, DVec2::new(0.25, 0.5)));
        let up = DVec3::new(0.25, 0.5, 0.125);
        assert_eq!(face(up), (2, DVec2::new(0.5, 0.25)));
        assert_eq!(face(-up), (3, DVec2::new(-0.5, 0.25)));
    }
}
