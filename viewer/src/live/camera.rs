//! Interactive camera: orbits around a target or flies through the scene.

use framegraph_scene::{Camera, Projection, Scene};
use glam::{DQuat, DVec2, DVec3};
use std::f64::consts::{FRAC_PI_2, PI};

/// Radians per point of a drag.
const TURN: f64 = 0.006;
/// Minimum angle between the view direction and the vertical, in radians.
const POLE: f64 = 0.02;

/// Interaction mode of the camera.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mode {
    /// Orbits around the target.
    #[default]
    Orbit,
    /// Looks around from its position and moves with keys.
    Fly,
}

/// Camera input of one frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Moves {
    /// Rotation in pointer points, right and down.
    pub turn: DVec2,
    /// Pan relative to the panel height, right and down.
    pub shift: DVec2,
    /// Zoom in, in wheel steps.
    pub nearer: f64,
    /// Flight to the right, up and forward, in seconds.
    pub fly_s: DVec3,
}

/// Interactive, upright camera.
#[derive(Clone, Debug, PartialEq)]
pub struct Rig {
    /// Interaction mode.
    pub mode: Mode,
    /// Position in meters.
    eye: DVec3,
    /// Yaw to the left about the vertical, from −z, and pitch upward, in radians.
    heading: [f64; 2],
    /// Distance to the orbit target in meters.
    distance_m: f64,
    /// Flight speed in meters per second.
    pub speed_m: f64,
    projection: Projection,
    /// Initial camera.
    home: Camera,
}

impl Rig {
    /// Starts with the default camera of the scene, and targets the center of the scene.
    pub fn new(scene: &Scene, width_over_height: f64) -> Self {
        let mut home = scene.default_camera(width_over_height);
        home.projection = home.projection.unstretched(width_over_height);
        let bounds = scene.bounds_above_ground();
        let size_m = bounds.half_extent().length();
        let size_m = if size_m.is_finite() && size_m > 0.0 { size_m } else { 1.0 };
        let ahead = (bounds.center() - home.eye).dot(home.forward());
        let distance_m = if ahead > 0.05 * size_m && ahead.is_finite() { ahead } else { size_m };
        let mut rig = Self {
            mode: Mode::default(),
            eye: home.eye,
            heading: [0.0; 2],
            distance_m,
            speed_m: 0.5 * size_m,
            projection: home.projection,
            home,
        };
        rig.go_home();
        rig
    }

    /// Returns to the initial camera.
    pub fn go_home(&mut self) {
        self.eye = self.home.eye;
        let f = self.home.forward();
        self.heading = [(-f.x).atan2(-f.z), f.y.clamp(-1.0, 1.0).asin()];
    }

    /// Adopts a camera of the scene.
    pub fn take(&mut self, camera: &Camera) {
        (self.home, self.projection) = (camera.clone(), camera.projection);
        self.go_home();
    }

    fn rotation(&self) -> DQuat {
        DQuat::from_rotation_y(self.heading[0]) * DQuat::from_rotation_x(self.heading[1])
    }

    /// Returns the orbit target in meters.
    pub fn target(&self) -> DVec3 {
        self.eye + self.rotation() * DVec3::NEG_Z * self.distance_m
    }

    /// Moves the camera and returns whether it moved.
    pub fn act(&mut self, moves: &Moves) -> bool {
        if *moves == Moves::default() {
            return false;
        }
        let before = self.clone();
        let target = self.target();
        self.heading[0] = (self.heading[0] - moves.turn.x * TURN).rem_euclid(2.0 * PI);
        let limit = FRAC_PI_2 - POLE;
        self.heading[1] = (self.heading[1] - moves.turn.y * TURN).clamp(-limit, limit);
        let rotation = self.rotation();
        if self.mode == Mode::Orbit {
            let factor = 0.85_f64.powf(moves.nearer);
            self.distance_m = (self.distance_m * factor).clamp(1e-4, 1e9);
            self.eye = target - rotation * DVec3::NEG_Z * self.distance_m;
        } else {
            self.eye += rotation * DVec3::NEG_Z * moves.nearer * 0.2 * self.speed_m;
        }
        let seen_m = match self.projection {
            Projection::Perspective { fov_y_rad, .. } => 2.0 * (0.5 * fov_y_rad).tan() * self.distance_m,
            Projection::Orthographic { half_height_m, .. } => 2.0 * half_height_m,
        };
        self.eye += rotation * DVec3::new(-moves.shift.x, moves.shift.y, 0.0) * seen_m;
        let DVec3 { x, y, z } = moves.fly_s * self.speed_m;
        self.eye += rotation * DVec3::new(x, 0.0, -z) + DVec3::Y * y;
        if !self.eye.is_finite() {
            *self = before;
            return false;
        }
        *self != before
    }

    /// Returns the camera, with another vertical field of view in radians if specified.
    pub fn camera(&self, fov_y_rad: Option<f64>) -> Camera {
        let mut projection = self.projection;
        if let (Projection::Perspective { fov_y_rad: own, .. }, Some(asked)) = (&mut projection, fov_y_rad) {
            *own = asked.clamp(0.01, 3.1);
        }
        Camera { name: "viewer".into(), eye: self.eye, world_from_view: self.rotation(), projection }
    }

    /// Returns its own vertical field of view in radians; `None` for an orthographic projection.
    pub fn fov_y_rad(&self) -> Option<f64> {
        match self.projection {
            Projection::Perspective { fov_y_rad, .. } => Some(fov_y_rad),
            Projection::Orthographic { .. } => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rig() -> Rig {
        Rig::new(&framegraph_scene::builtin("spheres").expect("a scene"), 1.5)
    }

    #[test]
    fn it_begins_as_the_scene_says_but_upright() {
        let scene = framegraph_scene::builtin("spheres").expect("a scene");
        let (rig, own) = (rig(), scene.default_camera(1.5));
        let made = rig.camera(None);
        assert_eq!(made.eye, own.eye);
        assert!(made.forward().abs_diff_eq(own.forward(), 1e-9), "{} {}", made.forward(), own.forward());
        assert!((made.world_from_view * DVec3::X).y.abs() < 1e-12);
    }

    #[test]
    fn orbiting_keeps_the_place_and_the_distance() {
        let mut rig = rig();
        let (target, eye) = (rig.target(), rig.eye);
        assert!(rig.act(&Moves { turn: DVec2::new(200.0, -90.0), ..Moves::default() }));
        assert!(rig.target().abs_diff_eq(target, 1e-9) && rig.eye.distance(eye) > 0.1);
        assert!((rig.eye.distance(target) - eye.distance(target)).abs() < 1e-9);
        rig.act(&Moves { nearer: 3.0, ..Moves::default() });
        assert!(rig.eye.distance(target) < 0.65 * eye.distance(target) && rig.target().abs_diff_eq(target, 1e-9));
        // The camera cannot pass the pole.
        rig.act(&Moves { turn: DVec2::new(0.0, 1e6), ..Moves::default() });
        assert!(rig.camera(None).forward().y < -0.99 && rig.camera(None).forward().is_finite());
        rig.go_home();
        assert_eq!(rig.eye, eye);
    }

    #[test]
    fn flying_looks_around_and_moves() {
        let mut rig = rig();
        rig.mode = Mode::Fly;
        let eye = rig.eye;
        rig.act(&Moves { turn: DVec2::new(50.0, 0.0), ..Moves::default() });
        assert_eq!(rig.eye, eye);
        let forward = rig.camera(None).forward();
        rig.act(&Moves { fly_s: DVec3::new(0.0, 0.0, 2.0), ..Moves::default() });
        assert!((rig.eye - eye).abs_diff_eq(2.0 * rig.speed_m * forward, 1e-9));
        assert!(!rig.act(&Moves::default()) && !rig.act(&Moves { nearer: f64::NAN, ..Moves::default() }));
    }
}
