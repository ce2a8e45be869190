//! The frame: declaration, recording, and a reference on the CPU.

use framegraph::{
    Alias, ClearValue, Counts, Extent, Format, Graph, Intent, Options, Plan, Scratch, Texture, TextureDesc, View,
};
use framegraph_queues::{QueueId, schedule};
use framegraph_vulkan::ash::vk;
use framegraph_vulkan::testing::{Bound, DepthTest, Dispatch, Draw, Kit, Part, TestDevice};
use framegraph_vulkan::{Cx, Executor, ExecutorOptions, Gpu, Imports, MemoryReport, RecordError};

/// Width and height in texels.
pub const SIZE: [u32; 2] = [64, 48];

/// Costs for which ambient occlusion moves to the second queue.
const COSTS_US: [f64; 4] = [50.0, 200.0, 200.0, 300.0];

/// Cost of a frame, and the difference of its picture from the reference.
pub struct Report {
    pub counts: Counts,
    /// Counts of the plan, which those of the frame must equal.
    pub planned: Counts,
    /// Steps on the second queue.
    pub moved: usize,
    /// Subpasses of the step that draws the picture.
    pub subpasses: u32,
    pub memory: MemoryReport,
    /// Largest difference of a channel, in 8-bit steps.
    pub difference: u8,
    /// The picture, four bytes per texel.
    #[allow(dead_code, reason = "only tests compare it with other pictures")]
    pub pixels: Vec<u8>,
    /// Median time of a frame on one queue and on two, and the simulator's figures for measured costs; in microseconds.
    pub times_us: [[f64; 2]; 2],
}

/// Handles of the frame.
struct Frame {
    depth_read: View,
    ao: Texture,
    ao_read: View,
    shadow_read: View,
    hdr_read: View,
    picture: Texture,
}

fn declare(graph: &mut Graph, samples: u8) -> Result<Frame, Box<dyn std::error::Error>> {
    let texture = |format| TextureDesc::new(Extent::FRAME, format);
    let small = TextureDesc::new(Extent::absolute(16, 16), Format::R32Float);
    let depth = graph.texture("depth", texture(Format::Depth32Float));
    let depth = graph.add_fn("depth", |p| p.depth(depth, Intent::Clear(ClearValue::FAR_REVERSED)))?;
    let ao = graph.texture("ao", texture(Format::R32Float));
    let (depth_read, ao) = graph.add_fn("ao", |p| Ok((p.sampled(depth)?, p.storage_write(ao, Intent::Overwrite)?)))?;
    let shadow = graph.texture("shadow", small);
    let shadow = graph.add_fn("shadow", |p| p.color(shadow, Intent::Overwrite))?;
    let hdr = graph.texture("hdr", texture(Format::Rgba16Float).samples(samples));
    let (ao_read, shadow_read, hdr) = graph.add_fn("color", |p| {
        Ok((p.sampled(ao)?, p.sampled(shadow)?, p.color(hdr, Intent::Clear(ClearValue::BLACK))?))
    })?;
    let picture = graph.texture("picture", texture(Format::Rgba8Unorm));
    let (hdr_read, picture) = graph.add_fn("grade", |p| {
        let read = p.same_pixel(hdr)?;
        if samples == 1 {
            return Ok((read, p.color(picture, Intent::Overwrite)?));
        }
        let ldr = p.texture("ldr", texture(Format::Rgba8Unorm).samples(samples));
        let ldr = p.color(ldr, Intent::Overwrite)?;
        Ok((read, p.resolve(ldr, picture)?))
    })?;
    graph.readback(picture)?;
    Ok(Frame { depth_read, ao, ao_read, shadow_read, hdr_read, picture })
}

const VERTICES: &str = "
@vertex fn vs_main(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
  return vec4f(f32(i & 1u) * REACH - 1.0, f32(i >> 1u) * REACH - 1.0, 0.5, 1.0);
}
";

pub const DEPTH: &str = "
@fragment fn fs_main(@builtin(position) at: vec4f) -> @builtin(frag_depth) f32 { return 0.25 + floor(at.x / 8.0) / 32.0; }
";

pub const AO: &str = "
@group(0) @binding(0) var depth: texture_depth_2d;
@group(0) @binding(1) var ao: texture_storage_2d<r32float, write>;
@compute @workgroup_size(8, 8) fn main(@builtin(global_invocation_id) id: vec3u) {
  let next = min(id.xy + vec2u(1u, 0u), textureDimensions(depth) - 1u);
  let step = textureLoad(depth, next, 0) - textureLoad(depth, id.xy, 0);
  textureStore(ao, id.xy, vec4f(1.0 - 16.0 * step));
}
";

pub const SHADOW: &str = "
@fragment fn fs_main(@builtin(position) at: vec4f) -> @location(0) vec4f { return vec4f(0.5 + floor(at.y) / 32.0); }
";

pub const COLOR: &str = "
@group(0) @binding(0) var ao: texture_2d<f32>;
@group(0) @binding(1) var shadow: texture_2d<f32>;
@fragment fn fs_main(@builtin(position) at: vec4f) -> @location(0) vec4f {
  let texel = vec2u(at.xy);
  let lit = textureLoad(ao, texel, 0).x * textureLoad(shadow, texel / 4u, 0).x;
  return vec4f(lit * f32(texel.x) / 16.0, lit * f32(texel.y) / 16.0, 0.5, 1.0);
}
";

/// Reads the pixel, or the sample of it, that the color pass wrote in the same render pass.
const GRADE: &str = "
@group(0) @binding(0) var hdr: TEXTURE<f32>;
@fragment fn fs_main(ARGUMENT) -> @location(0) vec4f {
  let color = textureLoad(hdr, vec2i(0), SAMPLE).xyz;
  return vec4f(color / (1.0 + color), 1.0);
}
";

fn record(kit: &mut Kit, frame: &Frame, samples: u8, cx: &mut Cx<'_>) -> Result<(), RecordError> {
    let whole = |text: &str| VERTICES.replace("REACH", "4.0") + text;
    match cx.pass_name() {
        "depth" => {
            let depth = DepthTest { write: true, ..DepthTest::NONE };
            kit.draw(cx, &Draw { depth, ..Draw::new(&whole(DEPTH), &[]) })
        }
        "ao" => {
            let bindings = [Bound::Texture(cx.texture(frame.depth_read)?), Bound::Storage(cx.target(frame.ao)?)];
            let groups = [SIZE[0] / 8, SIZE[1] / 8, 1];
            kit.dispatch(cx, &Dispatch { wgsl: AO, bindings: &bindings, groups, indirect: None })
        }
        "shadow" => kit.draw(cx, &Draw::new(&whole(SHADOW), &[])),
        "color" => {
            let bindings = [Bound::Texture(cx.texture(frame.ao_read)?), Bound::Texture(cx.texture(frame.shadow_read)?)];
            // Half of the picture, so that its edge shows the samples.
            kit.draw(cx, &Draw::new(&(VERTICES.replace("REACH", "2.0") + COLOR), &bindings))
        }
        _ => {
            let bindings = [Bound::Texture(cx.texture(frame.hdr_read)?)];
            let (texture, argument, sample) = match samples {
                1 => ("texture_2d", "", "0"),
                _ => ("texture_multisampled_2d", "@builtin(sample_index) index: u32", "i32(index)"),
            };
            let text = GRADE.replace("TEXTURE", texture).replace("ARGUMENT", argument).replace("SAMPLE", sample);
            kit.draw(cx, &Draw::new(&whole(&text), &bindings))
        }
    }
}

/// Draws the frame and compares it with the reference.
pub fn run(device: &TestDevice, samples: u8) -> Result<Report, Box<dyn std::error::Error>> {
    let (gpu, mut graph, mut plan) = (device.gpu(), Graph::new(), Plan::new());
    let frame = declare(&mut graph, samples)?;
    let mut caps = gpu.caps();
    // Without lazily allocated memory, transient attachments have memory of their own.
    caps.memoryless = true;
    let options = Options { alias: Alias::Off, ..Options::for_frame(SIZE[0], SIZE[1]) };
    gpu.compile(&graph, &caps, &options, &mut Scratch::new(), &mut plan)?;
    let found = schedule(&plan, &gpu.queue_layout(), &COSTS_US)?;
    let memory = gpu.share_memory(&plan, &found)?;
    let (mut executor, mut kit) = (Executor::new(gpu)?, Kit::new(gpu));
    executor.prepare(&plan, Some((&found, Some(&memory))))?;
    let mut subpasses = 0;
    for _ in 0..2 {
        executor.execute(&plan, Imports::new(), |cx| {
            subpasses = cx.subpass() + 1;
            record(&mut kit, &frame, samples, cx)
        })?;
    }
    executor.wait()?;
    let id = graph.resource_of(frame.picture).ok_or("the picture belongs to the graph")?;
    let image = executor.exported(id).ok_or("the picture is exported")?.image;
    let layout = executor.layout(id, image, 0, 0, 0);
    let (aspect, extent) = (vk::ImageAspectFlags::COLOR, SIZE);
    let pixels = kit.read_image(&Part { image, layout, aspect, mip: 0, layer: 0, extent, texel_bytes: 4 })?;
    let expected = reference(samples);
    if pixels.len() != expected.len() {
        return Err(format!("the picture has {} bytes instead of {}", pixels.len(), expected.len()).into());
    }
    let times_us = times(gpu, &plan, (&frame, samples))?;
    let differences = pixels.iter().zip(&expected).map(|(a, b)| a.abs_diff(*b));
    Ok(Report {
        counts: executor.executed(),
        planned: plan.counts(),
        moved: found.lanes.iter().filter(|lane| **lane != QueueId::MAIN).count(),
        subpasses,
        memory: executor.memory(),
        difference: differences.max().unwrap_or(u8::MAX),
        pixels,
        times_us,
    })
}

/// Returns the median time of frames on one queue and on two, whose order alternates; and the simulator's times, for
/// the medians of the steps. In microseconds.
fn times(gpu: &Gpu, plan: &Plan, (frame, samples): (&Frame, u8)) -> Result<[[f64; 2]; 2], Box<dyn std::error::Error>> {
    const FRAMES: usize = 15;
    let options = ExecutorOptions { timing: true, ..ExecutorOptions::default() };
    let steps = plan.steps().len();
    let found = schedule(plan, &gpu.queue_layout(), &COSTS_US)?;
    let (mut frames, mut of_steps) = ([Vec::new(), Vec::new()], vec![Vec::new(); steps]);
    let mut executors = [Executor::with(gpu, options)?, Executor::with(gpu, options)?];
    let mut kits = [Kit::new(gpu), Kit::new(gpu)];
    executors[0].prepare(plan, None)?;
    executors[1].prepare(plan, Some((&found, None)))?;
    for _ in 0..FRAMES {
        for queues in 0..2 {
            let start = std::time::Instant::now();
            executors[queues].execute(plan, Imports::new(), |cx| record(&mut kits[queues], frame, samples, cx))?;
            executors[queues].wait()?;
            frames[queues].push(start.elapsed().as_secs_f64() * 1e6);
        }
        for (all, time) in of_steps.iter_mut().zip(executors[0].step_times_us()) {
            all.extend(*time);
        }
    }
    let costs: Vec<f64> = of_steps.into_iter().map(median).collect();
    let planned = schedule(plan, &gpu.queue_layout(), &costs)?;
    Ok([frames.map(median), [planned.alone_us, planned.total_us]])
}

/// Returns the median; 0 without values.
fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}

/// Draws the picture on the CPU: every sample is shaded, graded and averaged.
fn reference(samples: u8) -> Vec<u8> {
    // Standard sample locations (Vulkan 1.3, 26.4).
    let places: &[[f32; 2]] = match samples {
        1 => &[[0.5, 0.5]],
        _ => &[[0.375, 0.125], [0.875, 0.375], [0.125, 0.625], [0.625, 0.875]],
    };
    let [width, height] = SIZE;
    let depth = |x: u32| 0.25 + (x / 8) as f32 / 32.0;
    let mut bytes = Vec::new();
    for (y, x) in (0..height).flat_map(|y| (0..width).map(move |x| (y, x))) {
        let ao = 1.0 - 16.0 * (depth((x + 1).min(width - 1)) - depth(x));
        let lit = ao * (0.5 + (y / 4) as f32 / 32.0);
        let shaded = [lit * x as f32 / 16.0, lit * y as f32 / 16.0, 0.5];
        let mut sum = [0.0; 3];
        for [dx, dy] in places {
            let inside = (x as f32 + dx) / width as f32 + (y as f32 + dy) / (height as f32) < 1.0;
            let color = if inside { shaded } else { [0.0; 3] };
            (0..3).for_each(|c| sum[c] += color[c] / (1.0 + color[c]) / places.len() as f32);
        }
        bytes.extend(sum.map(|value| (value * 255.0).round() as u8));
        bytes.push(255);
    }
    bytes
}
