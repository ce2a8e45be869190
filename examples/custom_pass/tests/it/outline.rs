//! Outlines appear exactly where the CPU finds edges in ids and depth.

use super::{BOTH, GLOW, LINES, NEITHER, TestResult, app, picture, with_engine};
use custom_pass::app::App;
use framegraph_wgpu::Pixels;
use framegraph_wgpu::inspect::Inspector;

const SIZE: [u32; 2] = [160, 90];
const WHITE: [u8; 4] = [255; 4];

/// Returns one channel of every texel of a texture in the current frame.
fn look(app: &App, request: &str, channel: usize) -> Result<Vec<f32>, Box<dyn std::error::Error>> {
    let mut inspector = Inspector::new(app.frames.executor().gpu());
    let seen = inspector.inspect(
        app.frames.executor(),
        app.frames.plan(),
        app.frames.frame(),
        &app.engine,
        app.frames.imports(),
        &request.parse()?,
    )?;
    Ok(seen.texels.numbers().into_iter().map(|texel| texel[channel]).collect())
}

/// Marks texels with a farther texel of another object at most two steps away along an axis.
fn edges(ids: &[f32], depths: &[f32], [width, height]: [u32; 2]) -> Vec<bool> {
    let (width, height) = (i64::from(width), i64::from(height));
    let index = |x: i64, y: i64| (y.clamp(0, height - 1) * width + x.clamp(0, width - 1)) as usize;
    let number = |at: usize| (ids[at] * 255.0).round() as u32;
    let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    let is_edge = |(x, y)| {
        let own = index(x, y);
        let around = [(1, 0), (-1, 0), (0, 1), (0, -1), (2, 0), (-2, 0), (0, 2), (0, -2)];
        around.into_iter().map(|(dx, dy)| index(x + dx, y + dy)).any(|other| {
            // Depth is reversed: farther is smaller.
            number(other) != number(own) && depths[other] < depths[own]
        })
    };
    places.map(is_edge).collect()
}

/// Counts edge texels without the line color, and other texels that changed.
fn misplaced(outlined: &Pixels, plain: &Pixels, edges: &[bool]) -> usize {
    let texels = outlined.bytes.chunks_exact(4).zip(plain.bytes.chunks_exact(4)).zip(edges);
    texels.filter(|((after, before), edge)| *after != if **edge { WHITE.as_slice() } else { before }).count()
}

#[test]
fn lines_are_where_objects_end() -> TestResult {
    with_engine("lines_are_where_objects_end", |engine| {
        let image = engine.picture(SIZE);
        let mut app = app(engine, BOTH)?;
        for (drawn, without) in [(BOTH, GLOW), (LINES, NEITHER)] {
            for time_s in [0.0, 1.3, 4.0] {
                app.settings = without;
                let plain = picture(&mut app, time_s, &image)?;
                app.settings = drawn;
                let outlined = picture(&mut app, time_s, &image)?;
                let (ids, depths) = (look(&app, "ids@scene", 3)?, look(&app, "depth@scene", 0)?);
                let edges = edges(&ids, &depths, SIZE);
                let count = edges.iter().filter(|edge| **edge).count();
                assert!((300..3000).contains(&count), "{count} texels of lines around five objects");
                assert_eq!(misplaced(&outlined, &plain, &edges), 0, "{drawn:?} at {time_s} s");
                // Negative control: with one edge less, one texel is wrong.
                let first = edges.iter().position(|edge| *edge).ok_or("no edge")?;
                let one_less: Vec<_> = edges.iter().enumerate().map(|(at, edge)| *edge && at != first).collect();
                assert_eq!(misplaced(&outlined, &plain, &one_less), 1);
            }
        }
        Ok(())
    })
}

#[test]
fn every_object_is_seen() -> TestResult {
    with_engine("every_object_is_seen", |engine| {
        let image = engine.picture(SIZE);
        let mut app = app(engine, BOTH)?;
        picture(&mut app, 0.0, &image)?;
        let ids = look(&app, "ids@scene", 3)?;
        for number in 0..=5 {
            let count = ids.iter().filter(|id| (**id * 255.0).round() as u32 == number).count();
            assert!(count > 50, "{count} texels of object {number}");
        }
        let lit = look(&app, "color@scene", 0)?;
        assert!(lit.iter().all(|v| v.is_finite() && *v > 0.0), "light everywhere");
        assert!(lit.iter().any(|v| *v > 5.0), "and an emitter");
        Ok(())
    })
}
