//! Imports: textures and buffers of the caller, drawn into, read, and rejected if they do not match.

use crate::bench::{Bench, GREEN, SHOW, TestResult, draw_of, fill_corner, on_every_device};
use framegraph::{Entry, Exit, Extent, Format, Intent, TextureDesc};
use framegraph_wgpu::{Gpu, Raster, read_texture, texture_2d};
use wgpu::{TextureFormat, TextureUsages};

fn texture(gpu: &Gpu, side: u32, format: TextureFormat, usage: TextureUsages) -> wgpu::Texture {
    gpu.device.create_texture(&texture_2d("mine", [side, side], format, usage))
}

fn declare(frame: &mut framegraph_wgpu::Frame) -> Result<framegraph::Texture, framegraph::DeclareError> {
    let desc = TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm);
    let mine = frame.graph_mut().import_texture("mine", desc, Entry::Defined, Exit::Keep);
    frame.add_fn("over", |p| p.color(mine, Intent::Modify), |_, (), cx| fill_corner(cx, GREEN))
}

const USES: TextureUsages =
    TextureUsages::RENDER_ATTACHMENT.union(TextureUsages::COPY_SRC).union(TextureUsages::COPY_DST);

#[test]
fn an_import_keeps_its_contents() -> TestResult {
    on_every_device("an_import_keeps_its_contents", |gpu, drawn| {
        let mine = texture(gpu, 8, TextureFormat::Rgba8Unorm, USES);
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(32), rows_per_image: None };
        gpu.queue.write_texture(mine.as_image_copy(), &[77; 256], layout, mine.size());
        let mut bench = Bench::new(gpu, 8, 8);
        let handle = bench.declare(declare)?;
        bench.imports.texture(handle, &mine);
        bench.execute()?;
        assert_eq!(bench.executor.executed().unresolves, 1, "the contents on entry are loaded");
        if drawn {
            let pixels = read_texture(gpu, &mine)?;
            assert_eq!(
                (pixels.at(0, 7), pixels.at(7, 0)),
                (Some([0, 255, 0, 255].as_slice()), Some([77; 4].as_slice()))
            );
        }
        Ok(())
    })
}

/// With one plan, attachments and sampled textures change with the imports of each frame.
#[test]
fn imports_change_from_frame_to_frame() -> TestResult {
    on_every_device("imports_change_from_frame_to_frame", |gpu, drawn| {
        let both = USES | TextureUsages::TEXTURE_BINDING;
        let (mine, theirs) = ([(); 2].map(|()| texture(gpu, 8, TextureFormat::Rgba8Unorm, both)), [10, 200]);
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(32), rows_per_image: None };
        for (texture, value) in mine.iter().zip(theirs) {
            gpu.queue.write_texture(texture.as_image_copy(), &[value; 256], layout, texture.size());
        }
        let mut bench = Bench::new(gpu, 8, 8);
        let desc = TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm);
        let (source, target) = bench.declare(|frame| {
            let source = frame.graph_mut().import_texture("source", desc, Entry::Defined, Exit::Keep);
            let target = frame.graph_mut().import_texture("target", desc, Entry::Undefined, Exit::Keep);
            let declare =
                |p: &mut framegraph::PassBuilder<'_>| Ok((p.sampled(source)?, p.color(target, Intent::Overwrite)?));
            frame.add_fn("show", declare, |(view, _), (), cx| draw_of(cx, &Raster::new(SHOW), *view))?;
            Ok((source, target))
        })?;
        for frame in 0..8 {
            // Each import is used twice in a row, so that some frames find everything unchanged.
            let from = frame / 2 % 2;
            let into = texture(gpu, 8, TextureFormat::Rgba8Unorm, both);
            bench.imports.clear();
            bench.imports.texture(source, &mine[from]);
            match frame {
                5.. => bench.imports.surface(target, &into),
                _ => bench.imports.texture(target, &into),
            };
            bench.execute()?;
            if drawn {
                let at = read_texture(gpu, &into)?.at(3, 4).map(<[u8]>::to_vec);
                assert_eq!(at, Some(vec![theirs[from]; 4]), "frame {frame}");
            }
        }
        Ok(())
    })
}

#[test]
fn surface_textures_are_not_cached() -> TestResult {
    let gpu = Gpu::noop()?;
    let mut bench = Bench::new(&gpu, 8, 8);
    for frame in 1..=3 {
        let handle = bench.declare(declare)?;
        let image = texture(&gpu, 8, TextureFormat::Rgba8Unorm, USES);
        bench.imports.clear();
        bench.imports.surface(handle, &image);
        bench.execute()?;
        assert_eq!(bench.executor.texture(&bench.plan, handle), None);
        assert_eq!(bench.executor.objects().views, frame, "each frame makes the view of its own image");
    }
    Ok(())
}

#[test]
fn a_mismatched_import_is_an_error() -> TestResult {
    let gpu = Gpu::noop()?;
    let mut bench = Bench::new(&gpu, 8, 8);
    let handle = bench.declare(declare)?;
    let message = |bench: &mut Bench| bench.execute().map_err(|e| e.to_string()).err().unwrap_or_default();
    let missing = message(&mut bench);
    assert!(missing.contains("`mine`") && missing.contains("Imports::texture"), "{missing}");
    let wrong = [
        (texture(&gpu, 9, TextureFormat::Rgba8Unorm, USES), ["8×8", "9×9"]),
        (texture(&gpu, 8, TextureFormat::Bgra8Unorm, USES), ["Rgba8Unorm", "Bgra8Unorm"]),
        (texture(&gpu, 8, TextureFormat::Rgba8Unorm, TextureUsages::COPY_SRC), ["RENDER_ATTACHMENT", "COPY_SRC"]),
    ];
    for (texture, words) in wrong {
        bench.imports.clear();
        bench.imports.texture(handle, &texture);
        let message = message(&mut bench);
        assert!(message.contains("`mine`") && words.iter().all(|w| message.contains(w)), "{message}");
    }
    bench.imports.clear();
    bench.imports.texture_named("mine", &texture(&gpu, 8, TextureFormat::Rgba8Unorm, USES));
    bench.execute()
}
