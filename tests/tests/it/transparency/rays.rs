//! Unlit pictures of triangles, by rays that collect every surface. Uses no rasterizer and no blending.

use framegraph_scene::{AlphaMode, Scene};
use glam::{DVec2, DVec3, Vec3};

/// A surface hit by a ray: distance, color and alpha.
type Hit = (f64, DVec3, f64);

/// Sample positions within a pixel, as in Vulkan's standard pattern.
const FOUR: [DVec2; 4] =
    [DVec2::new(0.375, 0.125), DVec2::new(0.875, 0.375), DVec2::new(0.125, 0.625), DVec2::new(0.625, 0.875)];

/// Returns the radiance of every pixel over black, with one or four samples per pixel.
pub fn picture(scene: &Scene, size_px: [u32; 2], samples: u8) -> Vec<Vec3> {
    let [width, height] = size_px;
    let camera = &scene.cameras[0];
    let clip_from_world = camera.clip_from_view(f64::from(width) / f64::from(height)) * camera.view_from_world();
    let world_from_clip = clip_from_world.inverse();
    let triangles = triangles(scene);
    let places = if samples == 4 { &FOUR[..] } else { &[DVec2::splat(0.5)][..] };
    let of_pixel = |x: u32, y: u32| {
        let sum: DVec3 = places
            .iter()
            .map(|place| {
                let at =
                    (DVec2::new(f64::from(x), f64::from(y)) + *place) / DVec2::new(f64::from(width), f64::from(height));
                let ndc = DVec3::new(2.0 * at.x - 1.0, 1.0 - 2.0 * at.y, 0.5);
                let toward = world_from_clip.project_point3(ndc) - camera.eye;
                seen(&triangles, camera.eye, toward.normalize())
            })
            .sum();
        (sum / places.len() as f64).as_vec3()
    };
    (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| of_pixel(x, y)).collect()
}

/// Returns the radiance of every pixel through a lens of this radius, focused at a distance in meters: the mean of
/// `count` rays from positions on the lens.
pub fn through_lens(scene: &Scene, size_px: [u32; 2], (focus_m, radius_m): (f64, f64), count: u32) -> Vec<Vec3> {
    let [width, height] = size_px;
    let camera = &scene.cameras[0];
    let world_from_clip =
        (camera.clip_from_view(f64::from(width) / f64::from(height)) * camera.view_from_world()).inverse();
    let (triangles, forward) = (triangles(scene), camera.forward());
    let (right, up) = forward.any_orthonormal_pair();
    let of_pixel = |x: u32, y: u32| {
        let at = (DVec2::new(f64::from(x), f64::from(y)) + 0.5) / DVec2::new(f64::from(width), f64::from(height));
        let ndc = DVec3::new(2.0 * at.x - 1.0, 1.0 - 2.0 * at.y, 0.5);
        let toward = world_from_clip.project_point3(ndc) - camera.eye;
        let sharp = camera.eye + toward * (focus_m / toward.dot(forward));
        let sum: DVec3 = (0..count)
            .map(|i| {
                // A sunflower pattern over the lens.
                let share = ((f64::from(i) + 0.5) / f64::from(count)).sqrt();
                let place = DVec2::from_angle(f64::from(i) * 2.399_963_2) * (radius_m * share);
                let eye = camera.eye + right * place.x + up * place.y;
                seen(&triangles, eye, (sharp - eye).normalize())
            })
            .sum();
        (sum / f64::from(count)).as_vec3()
    };
    (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| of_pixel(x, y)).collect()
}

type Triangle = ([DVec3; 3], DVec3, f64);

fn triangles(scene: &Scene) -> Vec<Triangle> {
    let of = |instance: &framegraph_scene::Instance| {
        let (mesh, material) = (&scene.meshes[instance.mesh.index()], &scene.materials[instance.material.index()]);
        let alpha = if material.alpha == AlphaMode::Opaque { 1.0 } else { f64::from(material.base_color.w) };
        let color = material.base_color.truncate().as_dvec3();
        let corner = |i: usize| instance.world_from_model.transform_point3(mesh.positions[i].as_dvec3());
        // Each face has one color.
        let paint = |i: usize| mesh.colors.get(i).map_or(DVec3::ONE, |color| color.truncate().as_dvec3());
        let triangle = |corners: [usize; 3]| (corners.map(corner), color * paint(corners[0]), alpha);
        mesh.triangles().map(triangle).collect::<Vec<_>>()
    };
    scene.instances.iter().flat_map(of).collect()
}

/// Composites all layers along a ray over black.
fn seen(triangles: &[Triangle], eye: DVec3, toward: DVec3) -> DVec3 {
    let mut hits: Vec<Hit> = triangles.iter().filter_map(|triangle| hit(triangle, eye, toward)).collect();
    hits.sort_by(|a, b| b.0.total_cmp(&a.0));
    hits.iter().fold(DVec3::ZERO, |behind, (_, color, alpha)| behind.lerp(*color, *alpha))
}

/// Intersects a ray with a triangle from both sides (Möller and Trumbore 1997).
fn hit(([a, b, c], color, alpha): &Triangle, eye: DVec3, toward: DVec3) -> Option<Hit> {
    let (ab, ac) = (*b - *a, *c - *a);
    let p = toward.cross(ac);
    let det = ab.dot(p);
    if det.abs() < 1e-12 {
        return None;
    }
    let from = eye - *a;
    let u = from.dot(p) / det;
    let q = from.cross(ab);
    let v = toward.dot(q) / det;
    let t = ac.dot(q) / det;
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 0.0).then_some((t, *color, *alpha))
}
