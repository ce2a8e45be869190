//! Combinations of passes that belong together: multisample resolves, and scenes with color grading.

use super::accesses::Draft;
use super::passes::{attach, filter, others, resolve_all, some_target};
use super::world::World;
use framegraph::access::Range;
use framegraph::format::Format;
use framegraph::resource::TextureDesc;

/// Declares a pass that draws a new texture, possibly multisampled, and a point-wise pass after it. Sometimes an
/// obstacle prevents inlining.
pub(super) fn scene_and_grade(world: &mut World<'_, '_>, index: u32) {
    let format = world.entropy.pick(&[Format::Rgba16Float, Format::Rgba8Unorm]);
    let desc = TextureDesc::new(framegraph::resource::Extent::FRAME, format);
    let samples = if world.profile.plain { 1 } else { world.entropy.pick(&[1, 1, 4]) };
    let mut scene =
        Draft { takes_epilogue: !world.entropy.one_in(8), blends: world.entropy.one_in(8), ..Draft::default() };
    let target = world.texture(desc.samples(samples));
    let mut wanted = None;
    attach(world, &mut scene, target, Range::ALL, &mut wanted);
    if samples > 1 {
        resolve_all(world, &mut scene);
    }
    if world.entropy.one_in(3) {
        let (depth, range) = some_target(world, wanted);
        attach(world, &mut scene, depth, range, &mut wanted);
    }
    if world.entropy.one_in(3) {
        others(world, &mut scene);
    }
    scene.declare(world, &format!("scene{index}"));
    for _ in 0..world.entropy.below(3) {
        let mut grade = Draft::default();
        filter(world, &mut grade);
        grade.pointwise |= !world.entropy.one_in(4);
        grade.never_merge = world.entropy.one_in(16);
        let name = world.name("grade");
        grade.declare(world, &name);
    }
}
