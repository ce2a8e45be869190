//! Random graphs for tests, fuzzing and benchmarks.
//!
//! [`graph`] turns [`Entropy`], a seed or the bytes of a fuzzer, into a graph of raster, compute and copy passes. It
//! uses few shapes and formats, and passes tend to continue with the attachments of the previous pass. Merging,
//! aliasing and inlining are therefore frequent.
//!
//! Graphs contain mip levels, array layers, planes, three-dimensional textures, multisampling with resolves, imports,
//! histories, buffers, exports, readbacks, side effects and all pass flags.
//!
//! Graphs are valid for a frame of [`FRAME`] texels on every preset of [`Caps`] after [`capable`], unless the profile requests
//! [sloppy](Profile::sloppy) ones. Sloppy graphs violate rules now and then; the compiler must report errors or produce
//! a correct plan.
//!
//! ```
//! use framegraph_check::generate::{self, Entropy, Profile};
//! use framegraph::{Caps, Plan, Scratch, compile};
//! use framegraph_check::check;
//!
//! let graph = generate::graph(&mut Entropy::seeded(7), &Profile::default());
//! let mut plan = Plan::new();
//! compile(&graph, &Caps::tiler(), &generate::options_of(0), &mut Scratch::new(), &mut plan)?;
//! assert_eq!(check::check(&plan), Ok(()));
//! # Ok::<(), framegraph::CompileErrors>(())
//! ```

mod accesses;
mod effects;
mod passes;
mod profile;
mod world;

pub use framegraph_pack::entropy::Entropy;
pub use profile::{FRAME, Profile};

use accesses::Draft;
use framegraph::access::AccessKind;
use framegraph::caps::{Caps, FormatCaps, FormatTable};
use framegraph::format::Format;
use framegraph::graph::Graph;
use framegraph::internals;
use framegraph::options::{Alias, Effort, Options, Order};
use framegraph::resolve::{ResolveMode, ResolveModes};
use world::World;

/// Returns a random graph.
pub fn graph(entropy: &mut Entropy<'_>, profile: &Profile) -> Graph {
    let mut world = World::new(entropy, *profile);
    world.import_and_declare();
    let wanted = 1 + world.entropy.below(u32::from(profile.max_passes.max(1)));
    for index in 0..wanted {
        pass(&mut world, index);
    }
    world.finish()
}

/// Declares one random pass.
fn pass(world: &mut World<'_, '_>, index: u32) {
    let mut draft = Draft::default();
    if world.entropy.one_in(8) {
        return effects::scene_and_grade(world, index);
    }
    let prefix = match world.entropy.below(16) {
        0..7 => {
            passes::draw(world, &mut draft);
            "draw"
        }
        7..12 => {
            passes::filter(world, &mut draft);
            "filter"
        }
        12..14 => {
            passes::compute(world, &mut draft);
            "compute"
        }
        _ => {
            passes::copy(world, &mut draft);
            "copy"
        }
    };
    draft.side_effect = world.entropy.one_in(12);
    draft.never_merge = world.entropy.one_in(16);
    draft.first_slot = if world.entropy.one_in(8) { 1 + world.entropy.below(3) as u8 } else { 0 };
    draft.declare(world, &format!("{prefix}{index}"));
}

/// Returns a random variation of a preset. It may not support every valid graph, because its limits can be lower.
pub fn caps(entropy: &mut Entropy<'_>) -> Caps {
    let mut caps = capable(match entropy.below(3) {
        0 => Caps::wgpu(),
        1 => Caps::tiler(),
        _ => Caps::desktop(),
    });
    let flags = [
        &mut caps.memoryless,
        &mut caps.memoryless_layers,
        &mut caps.memoryless_saves,
        &mut caps.merge_attachments,
        &mut caps.same_pixel,
        &mut caps.slot_mapping,
        &mut caps.inline,
        &mut caps.sample_read_only_depth,
        &mut caps.separate_planes,
        &mut caps.placed,
        &mut caps.separate_heaps,
        &mut caps.explicit_barriers,
    ];
    for flag in flags {
        *flag ^= entropy.one_in(4);
    }
    let some = |entropy: &mut Entropy<'_>| {
        let modes = ResolveMode::ALL.into_iter().filter(|_| entropy.one_in(2));
        ResolveModes::of(&modes.collect::<Vec<_>>())
    };
    if entropy.one_in(3) {
        (caps.color_resolves, caps.depth_resolves) = (some(entropy), some(entropy));
    }
    if entropy.one_in(4) {
        for format in Format::ALL.into_iter().filter(|f| f.is_resolvable() && entropy.one_in(3)) {
            caps.formats = caps.formats.without(format, FormatCaps::RESOLVABLE);
        }
    }
    if entropy.one_in(4) {
        caps.max_color_attachments = entropy.pick(&[2, 4]);
    }
    if entropy.one_in(3) {
        caps.tile_bytes_per_pixel = entropy.pick(&[0, 24, 64, 128]);
    }
    if entropy.one_in(3) {
        caps.texture_alignment_bytes = entropy.pick(&[1, 256, 4096, 65536]);
        caps.buffer_alignment_bytes = entropy.pick(&[1, 4, 256]);
    }
    caps
}

/// Returns the device with all formats, layers, bindings and clears that generated graphs use.
pub fn capable(caps: Caps) -> Caps {
    Caps {
        formats: FormatTable::desktop(),
        max_attached_layers: 2048,
        max_sampled_textures: 64,
        max_storage_textures: 16,
        clears_to_zero: true,
        clears_to_value: true,
        empty_raster: true,
        storage_alignment_bytes: 4,
        uniform_alignment_bytes: 4,
        ..caps
    }
}

/// Returns the graph with every same-pixel read replaced by a sampled one.
#[must_use]
pub fn sampling(graph: &Graph) -> Graph {
    let mut graph = graph.clone();
    for access in internals::accesses(&mut graph).iter_mut().filter(|a| a.kind == AccessKind::SamePixel) {
        access.kind = AccessKind::Sampled;
    }
    graph
}

/// Number of combinations of options of [`options_of`].
pub const OPTIONS: u32 = 2 * 2 * 2 * 2 * 2 * 3 * 2;

/// Returns a combination of options, by its number below [`OPTIONS`]: culling, merging, inlining, memoryless
/// attachments, order, aliasing, effort. Number 0 is the default except for the frame size and the budget. Larger
/// numbers wrap around.
pub fn options_of(number: u32) -> Options {
    let bit = |n: u32| number >> n & 1 == 0;
    Options {
        frame: FRAME,
        cull: bit(0),
        merge: bit(1),
        inline: bit(2),
        memoryless: bit(3),
        order: if bit(4) { Order::Declared } else { Order::Optimized },
        alias: [Alias::Pool, Alias::Heap, Alias::Off][(number / 32) as usize % 3],
        effort: [Effort::Exact, Effort::Greedy][(number / 96) as usize % 2],
        budget_steps: 2000,
    }
}
