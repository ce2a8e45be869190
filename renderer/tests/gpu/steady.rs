//! Steady frames create no objects; resizes and toggles neither leak nor show stale images.

use crate::bench::{Bench, SHOW, TestResult, draw_of, fill_corner, fill_full, on_every_device};
use framegraph::{ClearValue, DeclareError, Extent, Format, Intent, Texture, TextureDesc};
use framegraph_wgpu::Frame;
use framegraph_wgpu::Raster;

/// Declares a chain of `length` full-screen passes after a draw; `red` differs between frames.
fn chain(frame: &mut Frame, length: u32, red: f32) -> Result<Texture, DeclareError> {
    let desc = TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm);
    let first = frame.graph_mut().texture("first", desc);
    let clear = Intent::Clear(ClearValue::Color([red.into(), 0.0, 0.0, 1.0]));
    let mut texture =
        frame.add_fn("draw", |p| p.color(first, clear), |_, (), cx| fill_corner(cx, [0.0, 1.0, 0.0, 1.0]))?;
    for _ in 0..length {
        let target = frame.graph_mut().texture("link", desc);
        let source = texture;
        let declare =
            |p: &mut framegraph::PassBuilder<'_>| Ok((p.sampled(source)?, p.color(target, Intent::Overwrite)?));
        let (_, linked) = frame.add_fn("link", declare, |(view, _), (), cx| draw_of(cx, &Raster::new(SHOW), *view))?;
        texture = linked;
    }
    frame.graph_mut().readback(texture)?;
    Ok(texture)
}

#[test]
fn a_steady_frame_creates_no_objects() -> TestResult {
    on_every_device("a_steady_frame_creates_no_objects", |gpu, _| {
        let mut bench = Bench::new(gpu, 32, 32);
        bench.run(|f| chain(f, 6, 0.5))?;
        let made = bench.executor.objects();
        assert_eq!((made.textures, made.pipelines), (3, 2), "two textures take turns, one is exported");
        for _ in 0..40 {
            bench.run(|f| chain(f, 6, 0.5))?;
        }
        assert_eq!(bench.executor.objects(), made);
        assert_eq!(bench.executor.texture_pool().objects, 3);
        Ok(())
    })
}

#[test]
fn resizes_and_toggles_show_the_correct_image() -> TestResult {
    on_every_device("resizes_and_toggles_show_the_correct_image", |gpu, drawn| {
        let mut bench = Bench::new(gpu, 32, 32);
        let frames =
            [([32, 32], 3), ([33, 17], 3), ([1, 1], 3), ([32, 32], 0), ([32, 32], 3), ([31, 32], 1), ([32, 32], 3)];
        for (index, ([width, height], length)) in frames.into_iter().enumerate() {
            bench.options.frame = [width, height];
            let red = index as f32 / 8.0;
            let out = bench.run(|f| chain(f, length, red))?;
            if drawn {
                let pixels = bench.pixels(out)?;
                assert_eq!(pixels.texels, [width, height]);
                let top_right = pixels.at(width - 1, 0).map(<[u8]>::to_vec);
                let cleared = vec![(red * 255.0).round() as u8, 0, 0, 255];
                assert!(
                    width == 1 || top_right.as_ref() == Some(&cleared),
                    "frame {index}: {top_right:?}, not {cleared:?}"
                );
            }
        }
        let made = bench.executor.objects().textures;
        bench.options.frame = [33, 17];
        bench.run(|f| chain(f, 3, 0.0))?;
        assert_eq!(bench.executor.objects().textures, made, "the old size is still there");
        for _ in 0..32 {
            bench.options.frame = [8, 8];
            bench.run(|f| chain(f, 3, 0.0))?;
        }
        assert_eq!(bench.executor.texture_pool().objects, 3, "unused textures are dropped");
        Ok(())
    })
}

/// Each frame of a resize has another size. Without a budget, textures of the last 30 sizes would be kept.
#[test]
fn a_resize_stays_within_the_pool_budget() -> TestResult {
    on_every_device("a_resize_stays_within_the_pool_budget", |gpu, _| {
        let mut bench = Bench::new(gpu, 64, 64);
        let budget = u64::from(framegraph_wgpu::ExecutorOptions::default().pool_budget);
        for width in 64..104 {
            bench.options.frame = [width, 64];
            bench.run(|f| chain(f, 3, 0.5))?;
            let pool = bench.executor.texture_pool();
            let memory = bench.plan.memory();
            // Pools and plan count the same bytes; nothing here is memoryless.
            assert_eq!(pool.used_bytes, memory.bytes + memory.own_bytes, "{width}");
            assert!(
                pool.bytes <= budget * pool.used_bytes && pool.budget_bytes == budget * pool.used_bytes,
                "{pool:?}"
            );
            assert!(width < 66 || pool.objects == 9, "three sizes of three textures: {pool:?}");
        }
        let made = bench.executor.objects().textures;
        bench.options.frame = [102, 64];
        bench.run(|f| chain(f, 3, 0.5))?;
        assert_eq!(bench.executor.objects().textures, made, "a step back finds what was there");
        let (held, used) = (bench.executor.texture_pool().bytes, bench.executor.texture_pool().used_bytes);
        assert_eq!(bench.executor.trim(), held - used);
        assert_eq!(bench.executor.texture_pool().objects, 3);
        bench.run(|f| chain(f, 3, 0.5))?;
        assert_eq!(bench.executor.objects().textures, made, "what the last frame used stays");
        Ok(())
    })
}

#[test]
fn pooling_does_not_change_the_image() -> TestResult {
    on_every_device("pooling_does_not_change_the_image", |gpu, drawn| {
        let mut pooled = Bench::new(gpu, 16, 16);
        let mut apart = Bench::new(gpu, 16, 16);
        apart.options = apart.options.immediate();
        for frame in 0..10u8 {
            let size = if frame < 5 { [16, 16] } else { [23, 9] };
            let mut pictures = Vec::new();
            for bench in [&mut pooled, &mut apart] {
                bench.options.frame = size;
                let out = bench.run(|f| chain(f, 4, f32::from(frame) / 10.0))?;
                if drawn {
                    pictures.push(bench.pixels(out)?);
                }
            }
            assert!(pictures.windows(2).all(|p| p[0] == p[1]), "frame {frame}");
        }
        Ok(())
    })
}

#[test]
fn unused_accesses_are_reported() -> TestResult {
    on_every_device("unused_accesses_are_reported", |gpu, _| {
        let mut bench = Bench::new(gpu, 8, 8);
        bench.run(|frame| {
            let desc = TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm);
            let (a, b) = (frame.graph_mut().texture("a", desc), frame.graph_mut().texture("b", desc));
            let a = frame.add_fn("a", |p| p.color(a, Intent::Overwrite), |_, (), cx| fill_full(cx, [1.0; 4]))?;
            let declare = |p: &mut framegraph::PassBuilder<'_>| Ok((p.sampled(a)?, p.color(b, Intent::Overwrite)?));
            let (_, b) = frame.add_fn("forgetful", declare, |_, (), cx| fill_full(cx, [1.0; 4]))?;
            frame.graph_mut().export(b)?;
            Ok(())
        })?;
        let unused: Vec<_> = bench.executor.unused_accesses(&bench.plan).collect();
        let names: Vec<_> = unused
            .iter()
            .map(|u| (bench.plan.graph().pass_name(u.pass), bench.plan.graph().resource_name(u.resource)))
            .collect();
        assert_eq!(names, [("forgetful", "a")]);
        Ok(())
    })
}
