//! Where mirrors show what the picture shows: a floor and balls, by the formulas of school geometry.

use glam::{DVec2, DVec3};

/// A camera: an eye, where it looks, and half the tangents of its field of view.
#[derive(Clone, Copy, Debug)]
pub struct Lens {
    /// Where the eye is, in m.
    pub eye: DVec3,
    /// What is in the middle of the picture.
    pub target: DVec3,
    /// Vertical field of view in radians.
    pub fov_y_rad: f64,
    /// Width over height of the picture.
    pub aspect: f64,
}

/// What there is.
#[derive(Clone, Debug)]
pub struct Room {
    /// Height of the floor, which has no end, in m.
    pub floor_m: f64,
    /// Middle and radius of each ball, in m.
    pub balls: Vec<(DVec3, f64)>,
}

/// A place on a surface.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    /// Where, in m.
    pub at: DVec3,
    /// Unit normal.
    pub normal: DVec3,
    /// It is on the floor.
    pub on_floor: bool,
}

/// What a pixel's mirrored ray comes to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mirrored {
    /// Nothing within its reach.
    Nothing,
    /// Something that the picture does not show: it is hidden, turned away, or beyond the border.
    Unseen,
    /// What the picture shows at these texture coordinates.
    Seen(DVec2),
}

impl Lens {
    fn axes(&self) -> [DVec3; 3] {
        let ahead = (self.target - self.eye).normalize();
        let right = ahead.cross(DVec3::Y).normalize();
        [right, right.cross(ahead), ahead]
    }

    /// Unit direction through texture coordinates, (0, 0) at the top left.
    pub fn along(&self, uv: DVec2) -> DVec3 {
        let [right, up, ahead] = self.axes();
        let tangent = (0.5 * self.fov_y_rad).tan();
        let (x, y) = ((2.0 * uv.x - 1.0) * tangent * self.aspect, (1.0 - 2.0 * uv.y) * tangent);
        (ahead + right * x + up * y).normalize()
    }

    /// Texture coordinates of a place; none behind the eye.
    pub fn uv(&self, at: DVec3) -> Option<DVec2> {
        let [right, up, ahead] = self.axes();
        let (way, tangent) = (at - self.eye, (0.5 * self.fov_y_rad).tan());
        let depth = way.dot(ahead);
        let (x, y) = (way.dot(right) / (depth * tangent * self.aspect), way.dot(up) / (depth * tangent));
        (depth > 0.0).then(|| DVec2::new(0.5 + 0.5 * x, 0.5 - 0.5 * y))
    }
}

impl Room {
    /// What a ray first meets, and after how many meters; what is nearer than a tenth of a millimeter is where it starts.
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

    /// What the mirror at a pixel of `lens` shows, at the place that is returned with it, of a picture that was taken by
    /// `earlier`; none where the pixel shows nothing.
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

    /// In a flat mirror a thing stands as far behind the mirror as it is before it: its image is where its mirror image would
    /// be seen.
    #[test]
    fn floors_show_mirror_images() -> Result<(), &'static str> {
        let room = Room { floor_m: 0.0, balls: vec![(DVec3::new(0.0, 0.5, 0.0), 0.3)] };
        // The point of the ball nearest to the eye and a little lower.
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
