//! Benchmark of frustum culling of many boxes.

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
    program::line("| boxes | order | seen | one by one in f64, ms | arrays, ms | on two threads, ms | speed-up |");
    program::line("| --- | --- | --- | --- | --- | --- | --- |");
    let counts = [10_000, 100_000, 1_000_000];
    for (count, order) in counts.into_iter().flat_map(|count| [(count, "by place"), (count, "random")]) {
        let workload = Workload::alike(count);
        let side = (count as f64).cbrt().ceil() as usize;
        let bounds = |i: usize| {
            let at = DVec3::from([i % side, i / side % side, i / (side * side)].map(|x| x as f64));
            Aabb { min: at, max: at + 0.2 }
        };
        let mut boxes: Vec<Aabb> = (0..count).map(bounds).collect();
        if order == "random" {
            shuffle(&mut boxes);
        }
        let arrays = BoxArrays::new(&boxes);
        // From the center of the boxes, where most are invisible.
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
        let cell = |(median, least): (f64, f64)| format!("{median:.3} ({least:.3})");
        // Uses the fastest run, which other programs disturb least.
        program::line(format_args!(
            "| {count} | {order} | {} | {} | {} | {} | {:.2} |",
            found.len(),
            cell(exact),
            cell(one),
            cell(two),
            one.1 / two.1
        ));
    }
    program::line("");
}

/// Shuffles boxes, reproducibly.
fn shuffle(boxes: &mut [Aabb]) {
    let mut state = 1_u64;
    for last in (1..boxes.len()).rev() {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        boxes.swap(last, (state >> 33) as usize % (last + 1));
    }
}
