//! Cost of shaders in SPIR-V instructions, with and without loops counted at run time, and of the color pass by
//! feature. Both tables are in `docs/measurements/performance.md`.

use crate::variants;
use framegraph_shaders::{Feature, Features, Module, resolve};
use naga::back::{pipeline_constants, spv};
use naga::proc::{BoundsCheckPolicies, BoundsCheckPolicy};
use naga::valid::{Capabilities, ValidationFlags, Validator};

const DOCUMENT: &str = include_str!("../../../docs/measurements/performance.md");

/// Instructions within functions, and how many of them read textures.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Operations {
    instructions: usize,
    texture_reads: usize,
}

impl Operations {
    /// Counts the instructions of a module from the first `OpFunction` on, without names and block or function ends.
    fn of(words: &[u32]) -> Self {
        const FUNCTION: u32 = 54;
        /// `OpFunction`, its parameters and end; labels and the merges before branches.
        const STRUCTURE: [u32; 6] = [FUNCTION, 55, 56, 246, 247, 248];
        /// From `OpImageSampleImplicitLod` to `OpImageRead`.
        const READS: std::ops::RangeInclusive<u32> = 87..=98;
        let (mut found, mut within, mut rest) = (Self::default(), false, &words[5..]);
        while let [first, ..] = rest {
            let (code, length) = (first & 0xffff, (first >> 16) as usize);
            within |= code == FUNCTION;
            found.instructions += usize::from(within && !STRUCTURE.contains(&code));
            found.texture_reads += usize::from(within && READS.contains(&code));
            rest = &rest[length..];
        }
        found
    }
}

/// Counts all entry points of a text with their callees, including the checks of wgpu.
fn operations(pass: &Module<'_>, features: &Features, loops_counted: bool) -> Operations {
    let shader = resolve(pass, features, &[]).expect("a variant");
    let module = naga::front::wgsl::parse_str(&shader.wgsl).expect("a module");
    let half = if features.contains(Feature::HALF) { Capabilities::SHADER_FLOAT16 } else { Capabilities::empty() };
    let needed = half | Capabilities::MULTISAMPLED_SHADING;
    let info = Validator::new(ValidationFlags::all(), needed).validate(&module).expect("a valid module");
    let index = BoundsCheckPolicy::Restrict;
    let options = spv::Options {
        force_loop_bounding: loops_counted,
        bounds_check_policies: BoundsCheckPolicies { index, ..BoundsCheckPolicies::default() },
        ..spv::Options::default()
    };
    let of_entry = |entry: &naga::EntryPoint| {
        let (stage, name) = (entry.stage, entry.name.clone());
        let fixed = pipeline_constants::process_overrides(&module, &info, Some((stage, &name)), &Default::default());
        let (module, info) = fixed.expect("constants have defaults");
        let pipeline = spv::PipelineOptions { shader_stage: stage, entry_point: name };
        Operations::of(&spv::write_vec(&module, &info, &options, Some(&pipeline)).expect("SPIR-V"))
    };
    // Blended surfaces in any order are shaded by further entry points, each as `fs_main`.
    let apart =
        |entry: &&naga::EntryPoint| !["fs_weighted", "fs_absorbance", "fs_moments"].contains(&entry.name.as_str());
    module.entry_points.iter().filter(apart).map(of_entry).fold(Operations::default(), |sum, own| Operations {
        instructions: sum.instructions + own.instructions,
        texture_reads: sum.texture_reads + own.texture_reads,
    })
}

#[allow(clippy::print_stdout, reason = "shown with --nocapture")]
fn compare(table: &str, expected: &[String]) {
    println!("{}", expected.join("\n"));
    let (_, after) = DOCUMENT.split_once(&format!("<!-- table: {table} -->")).expect("the document has the table");
    let (rows, _) = after.split_once("<!-- end -->").expect("the table ends");
    let rows: Vec<_> = rows.lines().filter(|line| line.starts_with("| ")).skip(1).collect();
    let rows: Vec<_> = rows.into_iter().filter(|row| !row.starts_with("| ---")).collect();
    assert_eq!(rows, expected, "table `{table}` of docs/measurements/performance.md");
}

/// The plainest variant of each standard shader.
#[test]
fn the_document_has_what_counting_loops_takes() {
    let row = |pass: &Module<'static>| {
        let [counted, free] = [true, false].map(|counted| operations(pass, &Features::NONE, counted).instructions);
        assert!(counted >= free, "{}", pass.name());
        let share = 100.0 * (counted - free) as f64 / counted as f64;
        (counted > free).then(|| format!("| `{}` | {counted} | {free} | {share:.1} % |", pass.name()))
    };
    let rows: Vec<String> = framegraph_shaders::library::passes().filter_map(|pass| row(&pass)).collect();
    assert!(rows.len() > 5, "{rows:?}");
    compare("loop counters", &rows);
}

/// The color pass: what a frame does not call for is not in its text.
#[test]
fn the_document_has_what_features_take() {
    let color = variants::pass("color");
    let cells = |name: &str, features: &Features| {
        let Operations { instructions, texture_reads } = operations(&color, features, false);
        (instructions, format!("| {name} | {instructions} | {texture_reads} |"))
    };
    let own = variants::features_of(&color);
    let all: Features = own.iter().copied().filter(|feature| *feature != Feature::HALF).collect();
    let (none, first) = cells("none", &Features::NONE);
    let alone = own.iter().map(|feature| cells(&format!("`{}`", feature.name()), &Features::NONE.with(*feature)));
    let (most, last) = cells("all but `HALF`", &all);
    assert!(most > 2 * none, "{most} instructions with all features, {none} without");
    let rows: Vec<String> = std::iter::once(first).chain(alone.map(|(_, row)| row)).chain([last]).collect();
    compare("features of the color pass", &rows);
}
