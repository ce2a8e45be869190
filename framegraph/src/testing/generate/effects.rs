//! Effects of several passes and attachments that belong together: multisample resolves, and scenes that are graded.

use super::FRAME;
use super::accesses::{Draft, What, shape};
use super::passes::{attach, filter, others, some_target};
use super::world::World;
use crate::access::{AccessKind, Range};
use crate::format::Format;
use crate::resource::{Dimension, TextureDesc};

/// A pass that draws a new texture, perhaps through a multisampled one, and a point-wise pass behind it: what inlining is
/// made for. Now and then something stands against it.
pub(super) fn scene_and_grade(world: &mut World<'_, '_>, index: u32) {
    let format = world.entropy.pick(&[Format::Rgba16Float, Format::Rgba8Unorm]);
    let desc = TextureDesc::new(crate::resource::Extent::FRAME, format);
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

/// Adds a resolve target for some multisampled color attachments.
pub(super) fn resolve_all(world: &mut World<'_, '_>, draft: &mut Draft) {
    for index in 0..draft.accesses.len() {
        let color = draft.accesses[index];
        let What::Texture(texture, range) = color.what else {
            continue;
        };
        let desc = world.textures[texture].desc;
        let resolvable = desc.samples > 1 && desc.format.is_resolvable();
        if color.kind != AccessKind::Color || !(resolvable || world.slips()) {
            continue;
        }
        let (extent, layers, _) = shape(world, texture, range);
        let old = world.textures.iter().position(|t| {
            t.desc.format == desc.format
                && t.desc.samples == 1
                && t.desc.mips == 1
                && t.desc.extent.resolve(FRAME) == extent
                && t.desc.layers == layers as u16
                && t.desc.dimension == Dimension::D2
        });
        let target = match old {
            Some(old) if world.entropy.one_in(3) => old,
            _ => world.texture(desc.samples(1).layers(layers as u16)),
        };
        let what = What::Texture(target, Range::ALL);
        if draft.admits(world, what, true) {
            draft.write(what, AccessKind::Resolve, crate::access::Intent::Overwrite);
            let last = draft.accesses.len() - 1;
            draft.accesses[last].averages = index;
        }
    }
}
