//! Cost of post-processing: inlined, in one full-screen pass, and in one pass per effect.

use crate::args::Args;
use crate::kept_shadows::{OwnResources, declare};
use crate::load;
use crate::run::{Failure, Frames, WARM_UP, device, executed, input, open, settings};
use crate::table::{aligned, mebibytes, milliseconds};
use framegraph::{AccessKind, Join, Options, Plan, Scratch, compile};
use framegraph_passes::gpu_scene::upload::block_formats;
use framegraph_passes::grading::Look;
use framegraph_passes::{CameraView, Facts, FrameIndex, PostSettings, Settings, World};
use framegraph_scene::BlockFormats;
use framegraph_shaders::layout::Grading;
use framegraph_wgpu::Frame;
use framegraph_wgpu::{Executor, Imports};

/// Variants to compare: name, inlined where possible, one pass per effect.
const VARIANTS: [(&str, bool, bool); 3] = [
    ("inlined", true, false),
    ("fused: one full-screen pass", false, false),
    ("unfused: one pass per effect", false, true),
];

/// Variant at one sample count.
struct Variant {
    name: &'static str,
    samples: u8,
    frame: Frame<World>,
    plan: Plan,
    executor: Executor,
}

/// Measures all variants alternately under equal conditions and prints one table.
///
/// # Errors
/// An input or device failure with a one-line message.
pub fn compare_post(args: &Args) -> Result<(), Failure> {
    let gpu = open();
    let options = args.load_options(gpu.as_ref().map_or(BlockFormats::default(), block_formats));
    let mut loaded = load::load(args, &options).map_err(input)?;
    args.animation.apply(&mut loaded.scene, 0.0).map_err(input)?;
    let colors = load::colors(args).map_err(input)?;
    let seen = load::view(args, &loaded).map_err(input)?;
    let gpu = gpu?;
    program::line(format_args!("adapter: {}", gpu.describe()));
    args.frame.settings.shading.precision.check(&gpu).map_err(|error| input(format!("--{error}")))?;
    let lighting = load::light(&gpu, args, &loaded).map_err(input)?;
    let moment = CameraView::new(&loaded.scene, &lighting.image, &loaded.background, &seen);
    // Enable every effect, so that each becomes a pass in the last variant.
    let asked = settings(args, &loaded, &seen);
    let every = PostSettings {
        vignette_ev: asked.post.vignette_ev.max(0.5),
        look: Look { grading: Grading { contrast: 1.1, ..asked.post.look.grading }, ..asked.post.look },
        ..asked.post
    };
    if asked.blended || asked.scene_levels > 0 {
        return Err(input(format!(
            "--compare-post: the scene `{}` has blended or transmissive materials, so nothing is inlined; choose \
             another scene",
            args.scene
        )));
    }
    let mut world = load::upload(&gpu, &mut loaded, &options, lighting, moment)?;
    world.grading.set_colors(colors);
    let mut variants = Vec::new();
    for samples in [1, 4] {
        for (name, inline, split_post) in VARIANTS {
            let settings = Settings { samples, split_post, post: every, ..asked };
            let (frame, ..) = declare(&settings, &Facts::default(), false, OwnResources::default())?;
            let mut plan = Plan::new();
            let options = Options { inline, ..Options::for_frame(args.size_px[0], args.size_px[1]) };
            compile(frame.graph(), &gpu.caps(), &options, &mut Scratch::new(), &mut plan).map_err(input)?;
            let mut executor = Executor::new(&gpu);
            executor.set_timing(true);
            variants.push(Variant { name, samples, frame, plan, executor });
        }
    }
    let rounds = WARM_UP + args.frames;
    let mut shown = Frames::new(rounds);
    for round in 0..rounds {
        world.frame_index = FrameIndex(round);
        for Variant { frame, plan, executor, .. } in &mut variants {
            executor.execute(plan, frame, &world, &Imports::new()).map_err(executed)?;
            gpu.wait().map_err(device)?;
        }
        shown.next()?;
    }
    for variant in &mut variants {
        variant.executor.catch_up().map_err(device)?;
    }
    program::print(table(&variants));
    Ok(())
}

fn table(variants: &[Variant]) -> String {
    let head = ["post-processing", "samples", "steps", "loads", "stores", "loaded", "stored", "fetched", "GPU ms"];
    let mut rows = vec![head.map(String::from)];
    rows.extend(variants.iter().map(|Variant { name, samples, plan, executor, .. }| {
        let (counts, traffic) = (plan.counts(), plan.traffic(plan.frame()));
        [
            (*name).to_owned(),
            samples.to_string(),
            counts.steps.to_string(),
            counts.unresolves.to_string(),
            counts.resolves.to_string(),
            mebibytes(traffic.loaded_bytes),
            mebibytes(traffic.stored_bytes),
            mebibytes(fetched_bytes(plan)),
            milliseconds(executor.timing().frame().gpu),
        ]
    }));
    aligned(&rows, 1)
}

/// Bytes of same-pixel reads from memory, which merging or inlining would avoid.
fn fetched_bytes(plan: &Plan) -> u64 {
    let graph = plan.graph();
    let apart = plan.step_passes().iter().filter(|member| !matches!(member.join, Join::Inlined | Join::SamePixel));
    let reads = apart.flat_map(|member| graph.accesses_of(member.pass)).filter(|a| a.kind == AccessKind::SamePixel);
    let bytes = reads.filter_map(|access| {
        let texture = graph.resources()[access.resource.index()].desc.texture()?;
        let [width, height] = texture.mip_extent(plan.frame(), access.range.mip.into());
        let texel_bytes = plan.format(access.resource)?.texel_bytes(framegraph::Aspect::All);
        Some(u64::from(width) * u64::from(height) * u64::from(texel_bytes))
    });
    bytes.sum()
}
