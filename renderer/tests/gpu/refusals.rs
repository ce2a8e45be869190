//! Errors of rejected bind groups name the pass, group, binding and variable.

use crate::bench::{Bench, RED, SHOW, TestResult, draw_of, fill_full, on_every_device};
use framegraph::{DeclareError, Entry, Exit, Extent, Format, Intent, Texture, TextureDesc};
use framegraph_wgpu::{
    Binding, BindingReason, Cx, ExecuteError, Frame, Raster, RasterPipeline, RecordError, SamplerDesc, Shader,
    texture_2d,
};

/// Two bind groups: constants, and a texture with its sampler.
const TWO: Shader<'static> = Shader::new(
    "two groups",
    "struct Tint { color: vec4f, strength: f32 }
     @group(0) @binding(0) var<uniform> tint: Tint;
     @group(1) @binding(2) var image: texture_2d<f32>;
     @group(1) @binding(5) var linear: sampler;
     @vertex fn vs_main(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
       return vec4f(f32(i & 1) * 4.0 - 1.0, f32(i >> 1) * 4.0 - 1.0, 0.5, 1.0);
     }
     @fragment fn fs_main(@builtin(position) at: vec4f) -> @location(0) vec4f {
       return tint.color * tint.strength + textureSample(image, linear, at.xy);
     }",
);

/// A wrong binding with the expected error: group, binding, variable and reason.
type Refused = (Bind, usize, Option<u32>, Option<&'static str>, fn(&BindingReason) -> bool);

/// Creates both bind groups from correct resources.
type Bind = fn(&mut Cx<'_>, &RasterPipeline, [Binding; 3]) -> [wgpu::BindGroup; 2];

fn good(cx: &mut Cx<'_>, pipeline: &RasterPipeline, [tint, image, linear]: [Binding; 3]) -> [wgpu::BindGroup; 2] {
    [cx.bind_group(pipeline.group(0), &[(0, tint)]), cx.bind_group(pipeline.group(1), &[(2, image), (5, linear)])]
}

/// Declares a frame whose second pass uses `bind`. The first pass draws into the same target, so both are merged.
fn declare(frame: &mut Frame, bind: Bind) -> Result<Texture, DeclareError> {
    let desc = TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm);
    let (image, target) = (frame.graph_mut().texture("image", desc), frame.graph_mut().texture("target", desc));
    let image = frame.add_fn("image", |p| p.color(image, Intent::Overwrite), |_, (), cx| fill_full(cx, RED))?;
    let target = frame.add_fn("first", |p| p.color(target, Intent::Overwrite), |_, (), cx| fill_full(cx, RED))?;
    let read = |p: &mut framegraph::PassBuilder<'_>| Ok((p.sampled(image)?, p.color(target, Intent::Modify)?));
    let (_, target) = frame.add_fn("second", read, move |(image, _), (), cx| {
        let pipeline = cx.raster_pipeline(&Raster::new(TWO))?;
        let fits = [cx.uniform(&[0.5f32; 8]), cx.view(*image)?.into(), cx.sampler(SamplerDesc::LINEAR).into()];
        let [zero, one] = bind(cx, &pipeline, fits);
        let pass = cx.render_pass()?;
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &zero, &[]);
        pass.set_bind_group(1, &one, &[]);
        pass.draw(0..3, 0..1);
        Ok(())
    })?;
    let target = frame.add_fn("third", |p| p.color(target, Intent::Modify), |_, (), cx| fill_full(cx, RED))?;
    frame.graph_mut().readback(target)?;
    Ok(target)
}

#[test]
fn rejected_bind_groups_name_pass_group_binding_and_variable() -> TestResult {
    let refused: [Refused; 8] = [
        (
            |cx, pipeline, [_, image, linear]| {
                let short = cx.uniform(&[0.5f32; 5]);
                good(cx, pipeline, [short, image, linear])
            },
            0,
            Some(0),
            Some("tint"),
            |reason| *reason == BindingReason::TooSmall { given: 20, needed: 32 },
        ),
        (
            |cx, pipeline, [tint, image, linear]| good(cx, pipeline, [tint, linear, image]),
            1,
            Some(2),
            Some("image"),
            |reason| matches!(reason, BindingReason::Refused(_)),
        ),
        (
            |cx, pipeline, [tint, image, _]| {
                let linear = cx.sampler(SamplerDesc::SHADOW).into();
                good(cx, pipeline, [tint, image, linear])
            },
            1,
            Some(5),
            Some("linear"),
            |reason| matches!(reason, BindingReason::Refused(_)),
        ),
        (
            |cx, pipeline, [tint, image, _]| {
                let zero = cx.bind_group(pipeline.group(0), &[(0, tint)]);
                [zero, cx.bind_group(pipeline.group(1), &[(2, image)])]
            },
            1,
            Some(5),
            Some("linear"),
            |reason| *reason == BindingReason::Missing,
        ),
        (
            |cx, pipeline, [tint, image, linear]| {
                let zero = cx.bind_group(pipeline.group(0), &[(0, tint)]);
                [zero, cx.bind_group(pipeline.group(1), &[(2, image), (5, linear.clone()), (7, linear)])]
            },
            1,
            Some(7),
            None,
            |reason| *reason == BindingReason::Unused,
        ),
        (
            |cx, pipeline, [tint, image, linear]| {
                let zero = cx.bind_group(pipeline.group(0), &[(0, tint)]);
                [zero, cx.bind_group(pipeline.group(1), &[(2, image), (6, linear)])]
            },
            1,
            Some(6),
            None,
            |reason| *reason == BindingReason::Unused,
        ),
        (
            |cx, pipeline, [tint, image, linear]| {
                let zero = cx.bind_group(pipeline.group(0), &[(0, tint)]);
                [zero, cx.bind_group(pipeline.group(2), &[(2, image), (5, linear)])]
            },
            2,
            None,
            None,
            |reason| *reason == BindingReason::NoGroup { groups: 2 },
        ),
        (
            |cx, pipeline, fits| {
                cx.bind_group(pipeline.group(9), &[]);
                good(cx, pipeline, fits)
            },
            9,
            None,
            None,
            |reason| *reason == BindingReason::NoGroup { groups: 2 },
        ),
    ];
    on_every_device("rejected_bind_groups_name_pass_group_binding_and_variable", |gpu, drawn| {
        let mut bench = Bench::new(gpu, 8, 8);
        for (case, (bind, group, binding, variable, is)) in refused.into_iter().enumerate() {
            // Executed twice, since rejected bind groups are not cached.
            for _ in 0..2 {
                bench.declare(|f| declare(f, bind))?;
                let report = bench.executor.execute(&bench.plan, &bench.frame, &(), &bench.imports);
                let Err(ExecuteError::Record { pass, error: RecordError::Binding(error) }) = &report else {
                    return Err(format!("case {case}: {report:?}").into());
                };
                assert_eq!((pass.name.as_str(), error.shader.as_str()), ("second", "two groups"), "case {case}");
                let found = (error.group, error.binding, error.variable.as_deref());
                assert!(found == (group, binding, variable) && is(&error.reason), "case {case}: {error}");
            }
            let target = bench.run(|f| declare(f, good))?;
            if drawn {
                assert!(
                    bench.pixels(target)?.bytes.chunks_exact(4).all(|t| t == [255, 0, 0, 255]),
                    "after case {case}"
                );
            }
        }
        Ok(())
    })
}

/// Three passes of one step. wgpu reports only the step; its first pass is valid.
#[test]
fn the_rejected_pass_of_a_merged_step_is_named() -> TestResult {
    let wrong: [(Bind, &str); 2] = [
        // Bind groups are swapped.
        (
            |cx, pipeline, fits| {
                let [zero, one] = good(cx, pipeline, fits);
                [one, zero]
            },
            "bind group",
        ),
        // A buffer that exceeds every limit.
        (
            |cx, pipeline, fits| {
                let (label, usage) = (Some("huge"), wgpu::BufferUsages::VERTEX);
                let huge = wgpu::BufferDescriptor { label, size: 1 << 60, usage, mapped_at_creation: false };
                drop(cx.gpu().device.create_buffer(&huge));
                good(cx, pipeline, fits)
            },
            "huge",
        ),
    ];
    on_every_device("the_rejected_pass_of_a_merged_step_is_named", |gpu, drawn| {
        let mut bench = Bench::new(gpu, 8, 8);
        for (bind, reason) in wrong {
            bench.declare(|f| declare(f, bind))?;
            assert_eq!(bench.plan.counts().steps, 2, "the three passes are one step");
            let report = bench.executor.execute(&bench.plan, &bench.frame, &(), &bench.imports);
            let Err(ExecuteError::Refused { pass, message }) = &report else {
                return Err(format!("{report:?}").into());
            };
            assert!(pass.name == "second" && message.contains(reason), "{report:?}");
            let target = bench.run(|f| declare(f, good))?;
            if drawn {
                assert!(bench.pixels(target)?.bytes.chunks_exact(4).all(|t| t == [255, 0, 0, 255]));
            }
        }
        Ok(())
    })
}

/// An import with sRGB views must be created with both formats, which only wgpu can check.
#[test]
fn an_unsupported_view_of_an_import_is_named() -> TestResult {
    on_every_device("an_unsupported_view_of_an_import_is_named", |gpu, _| {
        let mut bench = Bench::new(gpu, 8, 8);
        for (formats, refused) in [(&[][..], true), (&[wgpu::TextureFormat::Rgba8UnormSrgb][..], false)] {
            let image = gpu.device.create_texture(&wgpu::TextureDescriptor {
                view_formats: formats,
                ..texture_2d("image", [8, 8], wgpu::TextureFormat::Rgba8Unorm, wgpu::TextureUsages::TEXTURE_BINDING)
            });
            let desc = TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm);
            bench.declare(|frame| {
                let import = frame.graph_mut().import_texture("image", desc, Entry::Defined, Exit::Discard);
                let out = frame.graph_mut().texture("out", desc);
                let read = |p: &mut framegraph::PassBuilder<'_>| {
                    Ok((p.sampled(import.viewed_as(Format::Rgba8UnormSrgb))?, p.color(out, Intent::Overwrite)?))
                };
                let (_, out) = frame.add_fn("look", read, |(view, _), (), cx| {
                    cx.view(*view)?;
                    fill_full(cx, RED)
                })?;
                frame.graph_mut().export(out)
            })?;
            bench.imports.clear();
            bench.imports.texture_named("image", &image);
            let report = bench.executor.execute(&bench.plan, &bench.frame, &(), &bench.imports).map(|_| ());
            let named = match &report {
                Err(ExecuteError::Record { pass, error: RecordError::View { resource, message } }) => {
                    pass.name == "look" && resource.name == "image" && message.contains("Rgba8UnormSrgb")
                }
                _ => false,
            };
            assert!(if refused { named } else { report.is_ok() }, "{report:?}");
        }
        Ok(())
    })
}

/// Submissions with destroyed or mapped imports name the import. Otherwise the error says that the frame is valid.
#[test]
fn a_rejected_submission_names_the_import() -> TestResult {
    on_every_device("a_rejected_submission_names_the_import", |gpu, _| {
        let buffer = |usage| {
            let size = wgpu::BufferDescriptor { label: Some("theirs"), size: 64, usage, mapped_at_creation: false };
            gpu.device.create_buffer(&size)
        };
        let image = || {
            gpu.device.create_texture(&texture_2d(
                "theirs",
                [4, 4],
                wgpu::TextureFormat::Rgba8Unorm,
                wgpu::TextureUsages::TEXTURE_BINDING,
            ))
        };
        let uses = wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ;
        // The resource that breaks the submission, and the one that the error names.
        for (spoilt, named) in [("image", Some("image")), ("buffer", Some("buffer")), ("behind", None), ("none", None)]
        {
            let mut bench = Bench::new(gpu, 4, 4);
            let (shown, filled) = (image(), buffer(uses));
            let (from, into, target) = bench.declare(|frame| {
                let desc = TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm);
                let from = frame.graph_mut().import_texture("image", desc, Entry::Defined, Exit::Discard);
                let into = frame.graph_mut().import_buffer("buffer", 64, Entry::Undefined, Exit::Keep);
                let target = frame.graph_mut().texture("target", desc);
                let read =
                    |p: &mut framegraph::PassBuilder<'_>| Ok((p.sampled(from)?, p.color(target, Intent::Overwrite)?));
                let (_, target) =
                    frame.add_fn("show", read, |(view, _), (), cx| draw_of(cx, &Raster::new(SHOW), *view))?;
                let clear = |p: &mut framegraph::PassBuilder<'_>| p.copy_target_buffer(into, Intent::Overwrite);
                frame.add_fn("clear", clear, |into, (), cx| {
                    let bound = cx.buffer_of(*into)?;
                    cx.encoder()?.clear_buffer(&bound.buffer, 0, None);
                    Ok(())
                })?;
                frame.graph_mut().export(target)?;
                Ok((from, into, target))
            })?;
            bench.imports.texture(from, &shown).buffer(into, &filled);
            let queue = gpu.queue.clone();
            let report = bench.executor.execute_with(&bench.plan, &bench.frame, &(), &bench.imports, |commands| {
                let mut behind =
                    gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("mine") });
                match spoilt {
                    "image" => shown.destroy(),
                    "buffer" => filled.map_async(wgpu::MapMode::Read, .., |_| ()),
                    "behind" => {
                        let gone = buffer(wgpu::BufferUsages::COPY_DST);
                        behind.clear_buffer(&gone, 0, None);
                        gone.destroy();
                    }
                    _ => {}
                }
                commands.submit(&queue, [], [behind.finish()])
            });
            match (report, named) {
                (Ok(_), None) if spoilt == "none" => {}
                (Err(ExecuteError::Submission { import, .. }), of) => {
                    assert_eq!(import.as_ref().map(|import| import.name.as_str()), of, "{spoilt}");
                }
                (report, _) => panic!("{spoilt}: {report:?}"),
            }
            assert_eq!(bench.executor.texture(&bench.plan, target).is_some(), spoilt == "none");
        }
        Ok(())
    })
}
