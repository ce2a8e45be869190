//! Which of many boxes a camera may see.

use super::median_of;
use super::workload::Workload;
use framegraph_scene::{Aabb, BoxArrays, Frustum};
use framegraph_wgpu::Workers;
use glam::DVec3;
use std::hint::black_box;
use std::time::Instant;

/// Prints the table.
pub fn print() {
    program::line("### Culling\n");
    program::line("| boxes | seen | one by one in f64, ms | arrays, ms | on two threads, ms |");
    program::line("| --- | --- | --- | --- | --- |");
    for count in [10_000, 100_000, 1_000_000] {
        let workload = Workload::alike(count);
        let side = (count as f64).cbrt().ceil() as usize;
        let bounds = |i: usize| {
            let at = DVec3::from([i % side, i / side % side, i / (side * side)].map(|x| x as f64));
            Aabb { min: at, max: at + 0.2 }
        };
        let boxes: Vec<Aabb> = (0..count).map(bounds).collect();
        let arrays = BoxArrays::new(&boxes);
        // From amid them: most are not seen.
        let mut camera = workload.camera(0);
        camera.eye = DVec3::splat(0.5 * side as f64);
        let frustum = Frustum::of_camera(&camera, 16.0 / 9.0);
        let (mut found, runs) = (Vec::new(), 31);
        let exact = median_of(runs, || {
            let start = Instant::now();
            found.clear();
            found.extend((0..count as u32).filter(|i| frustum.may_see(&boxes[*i as usize])));
            black_box(&found);
            1e3 * start.elapsed().as_secs_f64()
        });
        let workers = Workers::with_threads(2).ok();
        let mut on = |pool| {
            median_of(runs, || {
                let start = Instant::now();
                found.clear();
                arrays.reaching(camera.eye, frustum.planes(), pool, &mut found);
                black_box(&found);
                1e3 * start.elapsed().as_secs_f64()
            })
        };
        let (one, two) = (on(None), on(workers.as_ref().and_then(Workers::pool)));
        let cell = |(median, least): (f64, f64)| format!("{median:.2} ({least:.2})");
        program::line(format_args!("| {count} | {} | {} | {} | {} |", found.len(), cell(exact), cell(one), cell(two)));
    }
    program::line("");
}
