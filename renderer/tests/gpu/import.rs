//! Imports: textures and buffers of the caller, drawn into, read, and rejected if they do not match.

use crate::bench::{Bench, GREEN, RED, SHOW, TestResult, draw_of, fill_corner, fill_full, on_every_device};
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
fn surface_textures_are_released_after_an_error() -> TestResult {
    let gpu = Gpu::noop()?;
    let mut bench = Bench::new(&gpu, 8, 8);
    let desc = TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm);
    let handles = bench.declare(|frame| {
        let imports = ["a", "b"].map(|name| frame.graph_mut().import_texture(name, desc, Entry::Defined, Exit::Keep));
        for import in imports {
            frame.add_fn("over", |p| p.color(import, Intent::Modify), |_, (), cx| fill_corner(cx, GREEN))?;
        }
        Ok::<_, framegraph::DeclareError>(imports)
    })?;
    let image = texture(&gpu, 8, TextureFormat::Rgba8Unorm, USES);
    for handle in handles {
        bench.imports.surface(handle, &image);
    }
    let error = bench.execute().map_err(|error| error.to_string()).err().unwrap_or_default();
    assert!(error.contains("`a`") && error.contains("`b`"), "one texture is behind two written imports: {error}");
    for handle in handles {
        assert_eq!(bench.executor.texture(&bench.plan, handle), None);
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

/// One texture behind two imports is refused if a pass writes one of them, unless the graph declares that they may alias.
#[test]
fn a_texture_behind_two_imports_is_refused_unless_they_may_alias() -> TestResult {
    let gpu = Gpu::noop()?;
    let desc = TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm);
    let image = |bench: &mut Bench, writes: bool, aliases: bool| {
        bench.declare(|frame| {
            let graph = frame.graph_mut();
            let read = graph.import_texture("read", desc, Entry::Defined, Exit::Keep);
            let other = graph.import_texture("other", desc, Entry::Defined, Exit::Keep);
            if aliases {
                graph.may_alias(read, other)?;
            }
            let target = graph.texture("target", desc);
            let declared = |p: &mut framegraph::PassBuilder<'_>| {
                p.sampled(read)?;
                p.sampled(other)?;
                p.color(target, Intent::Overwrite)
            };
            let target = frame.add_fn("look", declared, |_, (), cx| fill_full(cx, RED))?;
            frame.graph_mut().readback(target)?;
            if writes {
                frame.add_fn("draw", |p| p.color(other, Intent::Overwrite), |_, (), cx| fill_full(cx, RED))?;
            }
            Ok((read, other))
        })
    };
    for (writes, aliases, refused) in [(true, false, true), (true, true, false), (false, false, false)] {
        let mut bench = Bench::new(&gpu, 8, 8);
        let (read, other) = image(&mut bench, writes, aliases)?;
        let usage = TextureUsages::TEXTURE_BINDING | TextureUsages::RENDER_ATTACHMENT;
        let shared = texture(&gpu, 8, TextureFormat::Rgba8Unorm, usage);
        bench.imports.texture(read, &shared).texture(other, &shared);
        let done = bench.executor.execute(&bench.plan, &bench.frame, &(), &bench.imports).map(drop);
        let told = done.map_err(|error| error.to_string()).err().unwrap_or_default();
        let named = "the imports `read` and `other` are bound to one texture; declare `Graph::may_alias`";
        assert_eq!(told.contains(named), refused, "writes: {writes}, aliases: {aliases}: {told}");
        assert!(refused || told.is_empty(), "{told}");
    }
    Ok(())
}

/// One buffer behind two imports is refused like a texture.
#[test]
fn a_buffer_behind_two_imports_is_refused_unless_they_may_alias() -> TestResult {
    let gpu = Gpu::noop()?;
    let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
    let shared = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("shared"),
        size: 64,
        usage,
        mapped_at_creation: false,
    });
    for aliases in [false, true] {
        let mut bench = Bench::new(&gpu, 8, 8);
        let (read, other) = bench.declare(|frame| {
            let graph = frame.graph_mut();
            let [read, other] = ["read", "other"].map(|n| graph.import_buffer(n, 64, Entry::Defined, Exit::Keep));
            if aliases {
                graph.may_alias_buffer(read, other)?;
            }
            let declared = |p: &mut framegraph::PassBuilder<'_>| {
                p.side_effect();
                p.kind(framegraph::PassKind::Compute)?;
                p.uniform(read).map(drop)
            };
            frame.add_fn("look", declared, |_, (), _| Ok(()))?;
            frame.add_fn("copy", |p| p.copy_target_buffer(other, Intent::Overwrite), |_, _, _| Ok(()))?;
            Ok((read, other))
        })?;
        bench.imports.buffer(read, &shared).buffer(other, &shared);
        let done = bench.executor.execute(&bench.plan, &bench.frame, &(), &bench.imports).map(drop);
        let told = done.map_err(|error| error.to_string()).err().unwrap_or_default();
        let named = "the imports `read` and `other` are bound to one buffer; declare `Graph::may_alias_buffer`";
        assert!(if aliases { told.is_empty() } else { told.contains(named) }, "{told}");
    }
    Ok(())
}
