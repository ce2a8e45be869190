//! Exact reflections of a picture in a floor and balls, by elementary geometry.

use glam::{DVec2, DVec3};

/// A camera: eye, target and field of view.
#[derive(Clone, Copy, Debug)]
pub struct Lens {
    /// Position of the eye, in m.
    pub eye: DVec3,
    /// Point in the center of the picture, in m.
    pub target: DVec3,
    /// Vertical field of view, in radians.
    pub fov_y_rad: f64,
    /// Width divided by height of the picture.
    pub aspect: f64,
}

/// Objects of the room.
#[derive(Clone, Debug)]
pub struct Room {
    /// Height of the infinite floor, in m.
    pub floor_m: f64,
    /// Center and radius of each ball, in m.
    pub balls: Vec<(DVec3, f64)>,
}

/// A point on a surface.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    /// Position, in m.
    pub at: DVec3,
    /// Unit normal.
    pub normal: DVec3,
    /// True for the floor.
    pub on_floor: bool,
}

/// Reflection at a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mirrored {
    /// Nothing within the range.
    Nothing,
    /// A point that the picture does not show: it is hidden, faces away, or is outside of the border.
    Unseen,
    /// A point that the picture shows at these texture coordinates.
    Seen(DVec2),
}

impl Lens {
    fn axes(&self) -> [DVec3; 3] {
        let ahead = (self.target - self.eye).normalize();
        let right = ahead.cross(DVec3::Y).normalize();
        [right, right.cross(ahead), ahead]
    }

    /// Returns the unit direction through texture coordinates; (0, 0) is the top left.
    pub fn along(&self, uv: DVec2) -> DVec3 {
        let [right, up, ahead] = self.axes();
        let tangent = (0.5 * self.fov_y_rad).tan();
        let (x, y) = ((2.0 * uv.x - 1.0) * tangent * self.aspect, (1.0 - 2.0 * uv.y) * tangent);
        (ahead + right * x + up * y).normalize()
    }

    /// Returns the texture coordinates of a point; `None` behind the eye.
    pub fn uv(&self, at: DVec3) -> Option<DVec2> {
        let [right, up, ahead] = self.axes();
        let (way, tangent) = (at - self.eye, (0.5 * self.fov_y_rad).tan());
        let depth = way.dot(ahead);
        let (x, y) = (way.dot(right) / (depth * tangent * self.aspect), way.dot(up) / (depth * tangent));
        (depth > 0.0).then(|| DVec2::new(0.5 + 0.5 * x, 0.5 - 0.5 * y))
    }
}

impl Room {
    /// Returns the first intersection of a ray and its distance in m. Intersections closer than 0.1 mm count as the
    /// start.
    pub fn first(&self, start: DVec3, along: DVec3) -> Option<(f64, Place)> {
        let mut best: Option<(f64, Place)> = None;
        let mut offer = |way: f64, normal_at: &dyn Fn(DVec3) -> DVec3, on_floor| {
            if way > 1e-4 && best.is_none_or(|(nearest, _)| way < nearest) {
                let at = start + along * way;
                best = Some((way, Place { at, normal: normal_at(at), on_floor }));
            }
        };
        if along.y < 0.0 {
            offer((self.floor_m - start.y) / along.y, &|_| DVec3::Y, true);
        }
        for (middle, radius) in &self.balls {
            let to = *middle - start;
            let half = to.dot(along);
            let under = half * half - to.length_squared() + radius * radius;
            if under > 0.0 {
                offer(half - under.sqrt(), &|at| (at - *middle).normalize(), false);
            }
        }
        best
    }

    /// Returns the mirror's position at a pixel of `lens`, and its reflection in a picture taken by `earlier`. Returns
    /// `None` if the pixel shows nothing.
    pub fn mirrored(&self, lens: &Lens, uv: DVec2, reach_m: f64, earlier: &Lens) -> Option<(Place, Mirrored)> {
        let along = lens.along(uv);
        let (_, place) = self.first(lens.eye, along)?;
        let mirrored = along - place.normal * (2.0 * along.dot(place.normal));
        let Some((_, shown)) = self.first(place.at, mirrored).filter(|(way, _)| *way < reach_m) else {
            return Some((place, Mirrored::Nothing));
        };
        let open = |from: &Lens| {
            let way = shown.at - from.eye;
            let found = from.uv(shown.at).filter(|uv| uv.cmpgt(DVec2::ZERO).all() && uv.cmplt(DVec2::ONE).all());
            let first = self.first(from.eye, way.normalize()).map(|(nearest, _)| nearest);
            found.filter(|_| first.is_some_and(|nearest| (nearest - way.length()).abs() < 1e-6))
        };
        Some((
            place,
            match (open(lens), open(earlier)) {
                (Some(_), Some(at)) => Mirrored::Seen(at),
                _ => Mirrored::Unseen,
            },
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LENS: Lens =
        Lens { eye: DVec3::new(0.0, 1.0, 2.0), target: DVec3::new(0.0, 0.0, 0.0), fov_y_rad: 1.0, aspect: 1.5 };

    #[test]
    fn directions_and_coordinates_are_each_others_inverse() {
        for uv in [DVec2::new(0.5, 0.5), DVec2::new(0.1, 0.9), DVec2::new(1.2, 0.3)] {
            let there = LENS.eye + LENS.along(uv) * 3.0;
            assert!(LENS.uv(there).is_some_and(|found| (found - uv).length() < 1e-12), "{uv}");
        }
        assert_eq!(LENS.uv(LENS.eye * 2.0), None, "behind the eye");
    }

    /// A flat mirror shows an object at its mirror image.
    #[test]
    fn floors_show_mirror_images() -> Result<(), &'static str> {
        let room = Room { floor_m: 0.0, balls: vec![(DVec3::new(0.0, 0.5, 0.0), 0.3)] };
        // The point of the ball nearest to the eye, slightly lower.
        let shown = DVec3::new(0.0, 0.5, 0.0) + DVec3::new(0.0, -0.1, 1.0).normalize() * 0.3;
        let image = LENS.uv(shown * DVec3::new(1.0, -1.0, 1.0)).ok_or("before the eye")?;
        let (place, found) = room.mirrored(&LENS, image, 10.0, &LENS).ok_or("the floor")?;
        assert!(place.on_floor);
        let Mirrored::Seen(at) = found else { return Err("it is seen") };
        assert!((at - LENS.uv(shown).ok_or("before the eye")?).length() < 1e-9, "{at}");
        let (_, short) = room.mirrored(&LENS, image, 0.1, &LENS).ok_or("the floor")?;
        assert_eq!(short, Mirrored::Nothing);
        Ok(())
    }
}
