//! The ambient occlusion pass in f64, texel by texel, as a reference for `shaders/wgsl/pass/occlusion.wgsl`.

use super::Stage;
use framegraph_passes::effects::depth::structure::{Resolution, structure_levels};
use framegraph_passes::effects::occlusion::{ConeTrace, Gtao, Method, Occluders, OcclusionSettings};
use framegraph_shader_mirrors::cone_trace::cone_slice;
use framegraph_shader_mirrors::depth_normal::continues_ahead_inside;
use framegraph_shader_mirrors::depth_pyramid::{finer_texel, finest_texel, pyramid_level};
use framegraph_shader_mirrors::dither::interleaved_gradient_noise;
use framegraph_shader_mirrors::gtao::{
    acos_held, sector_bits, slice_arc, slice_bent, slice_offset, slice_share, slice_turn, slice_whole,
};
use framegraph_shader_mirrors::numerics::normalize_or;
use framegraph_shader_mirrors::sao::{sao_obscurance, sao_tap_distance, sao_term};
use framegraph_shader_mirrors::unproject::{Projection, ndc_from_view, view_position, view_z};
use glam::{DVec2, DVec3, DVec4};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// A stage with its mip levels of depth, and settings.
#[derive(Debug)]
pub struct Mirror<'a> {
    settings: &'a OcclusionSettings,
    levels: Vec<([i32; 2], Vec<f64>)>,
    projection: Projection,
    toward_sun: Option<DVec3>,
}

impl<'a> Mirror<'a> {
    /// Creates the mirror of a stage.
    pub fn new(stage: &Stage, settings: &'a OcclusionSettings) -> Self {
        let size = stage.size_px.map(|side| side as i32);
        let mut levels = vec![(size, stage.depth.iter().map(|depth| f64::from(*depth)).collect::<Vec<_>>())];
        for _ in 1..structure_levels(stage.size_px, Resolution::Full) {
            let ([width, height], finer) = &levels[levels.len() - 1];
            let own = [(width / 2).max(1), (height / 2).max(1)];
            let texel = |x: i32, y: i32| {
                let [fx, fy] = finer_texel([x, y]);
                finer[(fy.min(height - 1) * width + fx.min(width - 1)) as usize]
            };
            let texels = (0..own[1]).flat_map(|y| (0..own[0]).map(move |x| (x, y))).map(|(x, y)| texel(x, y)).collect();
            levels.push((own, texels));
        }
        let m = stage.clip_from_view();
        let row = |of: usize| DVec4::new(m.x_axis[of], m.y_axis[of], m.z_axis[of], m.w_axis[of]);
        let [x, y, z, w] = [0, 1, 2, 3].map(row);
        let projection = Projection {
            depth: DVec4::new(z.z, z.w, w.z, w.w),
            scale: DVec2::new(x.x, y.y),
            slide: DVec2::new(x.z, y.z),
            offset: DVec2::new(x.w, y.w),
        };
        Self { settings, levels, projection, toward_sun: stage.toward_sun.map(DVec3::normalize) }
    }

    /// Returns visibility and the mean open direction in view space, for all texels.
    pub fn texels(&self) -> Vec<[f64; 4]> {
        let [width, height] = self.levels[0].0;
        (0..height).flat_map(|y| (0..width).map(move |x| [x, y])).map(|texel| self.texel(texel)).collect()
    }

    fn size(&self) -> DVec2 {
        let [width, height] = self.levels[0].0.map(f64::from);
        DVec2::new(width, height)
    }

    fn load(&self, [x, y]: [i32; 2], level: usize) -> f64 {
        let ([width, height], texels) = &self.levels[level];
        texels[(y.clamp(0, height - 1) * width + x.clamp(0, width - 1)) as usize]
    }

    fn position_at(&self, texels: DVec2, depth: f64) -> DVec3 {
        let uv = texels / self.size();
        view_position(DVec2::new(2.0 * uv.x - 1.0, 1.0 - 2.0 * uv.y), depth, self.projection)
    }

    fn position(&self, [x, y]: [i32; 2], depth: f64) -> DVec3 {
        self.position_at(DVec2::new(x.into(), y.into()) + 0.5, depth)
    }

    fn texel(&self, texel: [i32; 2]) -> [f64; 4] {
        let depth = self.load(texel, 0);
        if depth == 0.0 {
            return [1.0, 0.0, 0.0, 0.0];
        }
        let (origin, pixel) = (self.position(texel, depth), DVec2::new(texel[0].into(), texel[1].into()) + 0.5);
        let normal = self.normal(texel, depth, origin);
        let (mut share, bent, squared) = match self.settings.method {
            Method::Sao { taps, turns } => {
                let (share, bent) = self.scalable(pixel, origin, normal, f64::from(taps), f64::from(turns));
                (share, bent, 2.0)
            }
            Method::Gtao(gtao) => {
                let (share, bent) = self.horizons(texel, origin, normal, &gtao);
                (share, bent, 1.0)
            }
        };
        if let (Some(cone), Some(to_light)) = (&self.settings.cone, self.toward_sun) {
            share = share.max(self.cone(pixel, origin, normal, cone, to_light));
        }
        let bent = normalize_or(bent, normal);
        let visibility = (1.0 - share).clamp(0.0, 1.0).powf(f64::from(self.settings.power) * squared);
        [visibility, bent.x, bent.y, bent.z]
    }

    fn normal(&self, texel: [i32; 2], depth: f64, origin: DVec3) -> DVec3 {
        let along = |axis: [i32; 2]| {
            let at = |steps: i32| [texel[0] + steps * axis[0], texel[1] + steps * axis[1]];
            let stored = |steps: i32| self.load(at(steps), 0);
            let toward = |steps: i32| self.position(at(steps), stored(steps).max(1e-30)) - origin;
            if !self.settings.fine_normals {
                return toward(1);
            }
            let last = self.levels[0].0.map(|side| side - 1);
            let (back, ahead) = ([stored(-2), stored(-1)], [stored(1), stored(2)]);
            if continues_ahead_inside(texel, axis, last, back, depth, ahead) { toward(1) } else { -toward(-1) }
        };
        normalize_or(along([0, 1]).cross(along([1, 0])), DVec3::Z)
    }

    /// Returns the position at texel coordinates; `None` without a surface.
    fn tap(&self, at: DVec2, away: f64) -> Option<DVec3> {
        let level = pyramid_level(away, self.levels.len() as i32 - 1);
        let [width, height] = self.levels[level as usize].0;
        let coarse = (at / f64::from(1 << level)).floor();
        let coarse = [(coarse.x as i32).clamp(0, width - 1), (coarse.y as i32).clamp(0, height - 1)];
        let depth = self.load(coarse, level as usize);
        if depth == 0.0 {
            return None;
        }
        let exact = self.settings.exact_taps;
        Some(if exact { self.position(finest_texel(coarse, level), depth) } else { self.position_at(at, depth) })
    }

    fn radius_texels(&self, origin: DVec3) -> f64 {
        let p = &self.projection;
        let per_m = 0.5 * (p.scale * self.size()).min_element();
        let w = (p.depth.z * origin.z + p.depth.w).max(1e-6);
        (per_m * f64::from(self.settings.radius_m) / w).min(0.25 * self.size().y)
    }

    fn scalable(&self, pixel: DVec2, origin: DVec3, normal: DVec3, taps: f64, turns: f64) -> (f64, DVec3) {
        let (radius_m, per_tap) = (f64::from(self.settings.radius_m), 1.0 / (taps - 0.5));
        let noise = interleaved_gradient_noise(pixel, 0);
        let bias_m = f64::from(self.settings.bias) * origin.z.abs();
        let min_sin2 = f64::from(self.settings.min_horizon_rad).sin().powi(2);
        let (mut sum, mut bent) = (0.0, normal);
        for index in 0..taps as u32 {
            let turned = TAU * 2.4 * noise + TAU * turns * per_tap * f64::from(index);
            let away = sao_tap_distance(index.into(), noise, per_tap) * self.radius_texels(origin);
            let away = away.max(1.0);
            let Some(found) = self.tap(pixel + away * DVec2::from_angle(turned), away) else { continue };
            let v = found - origin;
            let term = sao_term(v, normal, radius_m, bias_m, min_sin2);
            sum += term;
            if self.settings.has_bent_normals() && term <= 0.0 {
                let rise = v.dot(normal);
                let rest = (radius_m * radius_m - (v.length_squared() - rise * rise)).max(0.0);
                bent += normalize_or(v + normal * (rest.sqrt() - rise), normal);
            }
        }
        (sao_obscurance(sum / taps, self.settings.intensity.into()), bent)
    }

    fn horizons(&self, texel: [i32; 2], origin: DVec3, normal: DVec3, gtao: &Gtao) -> (f64, DVec3) {
        let disc = self.radius_texels(origin).max(1.0);
        let view = if self.projection.depth.z == 0.0 { DVec3::Z } else { normalize_or(-origin, normal) };
        let (mut light, mut whole, mut bent) = (0.0, 0.0, DVec3::ZERO);
        for slice in 0..gtao.slices {
            let turn = PI * (f64::from(slice) + slice_turn(texel)) / f64::from(gtao.slices);
            let across = DVec2::from_angle(turn).extend(0.0);
            let along = normalize_or(across - across.dot(view) * view, DVec3::X);
            let laid = DVec2::new(normal.dot(along), normal.dot(view));
            let n = acos_held(laid.y / laid.length().max(1e-6)) * if laid.x >= 0.0 { 1.0 } else { -1.0 };
            let angle = |v: DVec3| {
                let unsigned = acos_held(v.dot(view) / v.length_squared().max(1e-20).sqrt());
                if v.dot(along) >= 0.0 { unsigned } else { -unsigned }
            };
            let [low, high, closed] = self.slice(texel, origin, normal, gtao, (across, n, view, disc), &angle);
            whole += laid.length() * slice_whole(n);
            light += laid.length()
                * if matches!(gtao.occluders, Occluders::Thick(_)) {
                    slice_whole(n) * (32.0 - closed) / 32.0
                } else {
                    slice_arc(low, n) + slice_arc(high, n)
                };
            if self.settings.has_bent_normals() {
                let mean = slice_bent(low, high, n);
                bent += laid.length() * (mean.x * along + mean.y * view);
            }
        }
        let visible = (light / whole.max(1e-6)).clamp(0.0, 1.0);
        ((f64::from(self.settings.intensity) * (1.0 - visible)).clamp(0.0, 1.0), bent)
    }

    /// Computes both horizons of a slice, and the number of occluded sectors out of 32.
    fn slice(
        &self,
        texel: [i32; 2],
        origin: DVec3,
        normal: DVec3,
        gtao: &Gtao,
        (across, n, view, disc): (DVec3, f64, DVec3, f64),
        angle: &dyn Fn(DVec3) -> f64,
    ) -> [f64; 3] {
        let (radius_m, jitter) = (f64::from(self.settings.radius_m), slice_offset(texel));
        let min_sin2 = f64::from(self.settings.min_horizon_rad).sin().powi(2);
        let (mut low, mut high, mut closed) = (n - FRAC_PI_2, n + FRAC_PI_2, 0_u32);
        // Merges a sample's angle into the current horizon; both are unsigned.
        let lowered = |horizon: f64, found: f64, v: DVec3| match gtao.occluders {
            Occluders::Fading => {
                let (before, found) = (horizon.cos(), found.cos());
                let fade = (2.0 * v.length_squared() / (radius_m * radius_m)).clamp(0.0, 1.0);
                let mix = |a: f64, b: f64, t: f64| a + (b - a) * t;
                acos_held(if found > before { mix(found, before, fade) } else { mix(before, found, 0.004) })
            }
            Occluders::Solid | Occluders::Thick(_) => horizon.min(found),
        };
        for step in 0..gtao.steps {
            let share = (f64::from(step) + jitter) / f64::from(gtao.steps);
            let away = (share.powf(gtao.step_power.into()) * disc).max(1.0 + f64::from(step));
            for side in [-1.0, 1.0] {
                let middle = DVec2::new(texel[0].into(), texel[1].into()) + 0.5;
                let Some(found) = self.tap(middle + side * away * DVec2::new(across.x, -across.y), away) else {
                    continue;
                };
                let v = found - origin;
                let rise = v.dot(normal);
                let within = v.length_squared() < radius_m * radius_m;
                let over = rise > f64::from(self.settings.bias) * origin.z.abs();
                if !within || !over || rise * rise < v.length_squared() * min_sin2 {
                    continue;
                }
                let front = angle(v);
                if let Occluders::Thick(thick_m) = gtao.occluders {
                    let central = self.projection.depth.z != 0.0;
                    let away = if central { normalize_or(found, -view) } else { -view };
                    let [a, b] = [front, angle(v + f64::from(thick_m) * away)].map(|angle| slice_share(angle, n));
                    closed |= sector_bits(a.min(b), a.max(b), jitter);
                } else if front >= 0.0 {
                    high = lowered(high, front, v);
                } else {
                    low = -lowered(-low, -front, v);
                }
            }
        }
        [low, high, closed.count_ones().into()]
    }

    fn cone(&self, pixel: DVec2, origin: DVec3, normal: DVec3, cone: &ConeTrace, to_light: DVec3) -> f64 {
        let p = &self.projection;
        let reach_m = f64::from(cone.reach_m);
        let (facing, end) = (normal.dot(to_light), origin + reach_m * to_light);
        if facing < 0.0 || p.depth.z * end.z + p.depth.w <= 1e-4 {
            return 0.0;
        }
        let ndc = ndc_from_view(end, *p);
        let way = DVec2::new(0.5 + 0.5 * ndc.x, 0.5 - 0.5 * ndc.y) * self.size() - pixel;
        let aside = normalize_or(DVec3::new(way.y, -way.x, 0.0), DVec3::ZERO).truncate();
        let bias_m = (1.0 - facing).clamp(0.0, 1.0) * f64::from(cone.slope_bias_m) + f64::from(cone.bias_m);
        let tangent = (0.5 * f64::from(cone.angle_rad)).tan();
        let ray = |ray: u32| {
            let place = pixel * f64::from(ray);
            let across = 2.0 * interleaved_gradient_noise(place, 0) - 1.0;
            let start = interleaved_gradient_noise(place * DVec2::new(3.0, 11.0), 0);
            let filled = |step: u32| {
                let t = (f64::from(step) + start) / f64::from(cone.steps);
                let at = (pixel + way * t + aside * across * tangent * t * way.length()).floor();
                let depth = self.load([at.x as i32, at.y as i32], 0);
                if depth <= 0.0 {
                    return 0.0;
                }
                let mix = |a: f64, b: f64| a + (b - a) * t;
                let central = p.depth.z != 0.0;
                let on_axis = if central { 1.0 / mix(1.0 / origin.z, 1.0 / end.z) } else { mix(origin.z, end.z) };
                let scene_m = -view_z(depth, p.depth);
                cone_slice(-on_axis, scene_m, tangent * reach_m * t, across, bias_m, cone.contact_m.into())
            };
            (0..cone.steps).map(filled).fold(0.0, f64::max)
        };
        let sum: f64 = (1..=cone.rays).map(ray).sum();
        sum / f64::from(cone.rays) * f64::from(cone.intensity)
    }
}
