//! Mutants of resources, slots and memory statistics.

use super::mutator::{Edit, Mutator};
use framegraph::access::Usage;
use framegraph::format::Format;
use framegraph::id::{SlotId, StepId};
use framegraph::plan::{Memory, Placement, Slot};
use framegraph::resource::{BufferDesc, BufferSize, Desc, Dimension, Extent, TextureDesc};

/// Returns the set with one usage added or removed.
fn flipped(usage: Usage, bit: Usage) -> Usage {
    if usage.contains(bit) { usage.without(bit) } else { usage.union(bit) }
}

/// Visits mutants of `resources`.
pub(super) fn resources(m: &mut Mutator<'_>) {
    let plan = m.plan;
    for (row, planned) in plan.resources().iter().enumerate() {
        for step in plan.step_ids().chain([StepId::NONE]) {
            if step != planned.first {
                m.with("resource.first", row, |p| p.resources[row].first = step);
            }
            if step != planned.last {
                m.with("resource.last", row, |p| p.resources[row].last = step);
            }
        }
        for &(bit, _) in Usage::NAMES {
            m.with("resource.usage", row, |p| {
                p.resources[row].usage = flipped(planned.usage, bit);
            });
        }
        for format in [None, Some(Format::R8Unorm), Some(Format::Rgba16Float)] {
            if format != planned.format {
                m.with("resource.format", row, |p| p.resources[row].format = format);
            }
        }
        m.with("resource.srgb_views", row, |p| p.resources[row].srgb_views ^= true);
        for bytes in [planned.bytes.wrapping_add(1), planned.bytes.wrapping_sub(1), 0] {
            m.with("resource.bytes", row, |p| p.resources[row].bytes = bytes);
        }
        for placement in placements(plan.slots().len(), planned.placement) {
            m.with("resource.placement", row, |p| p.resources[row].placement = placement);
        }
        if let Placement::Heap { offset } = planned.placement {
            let texture = plan.graph().resources()[row].desc.texture().is_some();
            let alignment =
                if texture { plan.caps().texture_alignment_bytes } else { plan.caps().buffer_alignment_bytes };
            let offsets = [Some(0), Some(offset + 1), Some(offset + alignment), offset.checked_sub(alignment)];
            for other in offsets.into_iter().flatten().filter(|o| *o != offset) {
                m.with("resource.offset", row, |p| {
                    p.resources[row].placement = Placement::Heap { offset: other };
                });
            }
        }
    }
}

/// Returns all other placements.
fn placements(slots: usize, now: Placement) -> Vec<Placement> {
    let mut all =
        vec![Placement::Unused, Placement::Memoryless, Placement::Inlined, Placement::External, Placement::Own];
    all.extend((0..slots).map(|s| Placement::Slot(SlotId::at(s))));
    if !matches!(now, Placement::Heap { .. }) {
        all.push(Placement::Heap { offset: 0 });
    }
    all.retain(|p| *p != now);
    all
}

/// Visits mutants of `slots`.
pub(super) fn slots(m: &mut Mutator<'_>) {
    let plan = m.plan;
    for (row, slot) in plan.slots().iter().enumerate() {
        for desc in shapes(&slot.desc) {
            m.with("slot.desc", row, |p| p.slots[row].desc = desc);
        }
        for &(bit, _) in Usage::NAMES {
            m.with("slot.usage", row, |p| p.slots[row].usage = flipped(slot.usage, bit));
        }
        m.with("slot.srgb_views", row, |p| p.slots[row].srgb_views ^= true);
        for bytes in [slot.bytes.wrapping_add(1), slot.bytes.wrapping_sub(1)] {
            m.with("slot.bytes", row, |p| p.slots[row].bytes = bytes);
        }
        m.with("slot missing", row, |p| {
            p.slots.remove(row);
        });
    }
    m.with("slot added", plan.slots().len(), |p| {
        p.slots.push(Slot {
            desc: Desc::Buffer(BufferDesc { size: BufferSize::Bytes(1) }),
            usage: Usage::STORAGE,
            srgb_views: false,
            bytes: 1,
        });
    });
}

/// Returns the descriptor with single changes.
fn shapes(desc: &Desc) -> Vec<Desc> {
    let texture = match desc {
        Desc::Buffer(buffer) => {
            let bytes = buffer.bytes([1, 1]) + 1;
            return vec![Desc::Buffer(BufferDesc { size: BufferSize::Bytes(bytes) })];
        }
        Desc::Texture(texture) => *texture,
    };
    let [width, height] = texture.extent.texels([1, 1]);
    let other = if texture.dimension == Dimension::D2 { Dimension::D3 } else { Dimension::D2 };
    let format = if texture.format == Format::R8Unorm { Format::R8Snorm } else { Format::R8Unorm };
    let changed = [
        texture.extent(Extent::absolute(width + 1, height)),
        texture.extent(Extent::absolute(width, height + 1)),
        texture.extent(Extent::FRAME),
        texture.format(format),
        texture.mips(texture.mips + 1),
        texture.samples(texture.samples * 2),
        texture.layers(texture.layers + 1),
        TextureDesc { dimension: other, ..texture },
    ];
    changed.map(Desc::Texture).to_vec()
}

/// Visits mutants of the memory statistics.
pub(super) fn memory(m: &mut Mutator<'_>) {
    for (field, edit) in MEMORY_EDITS {
        m.with(field, 0, |p| edit(p.memory));
    }
    let plan = m.plan;
    for step in plan.step_ids().chain([StepId::NONE]) {
        if step != plan.memory().peak {
            m.with("memory.peak", 0, |p| p.memory.peak = step);
        }
    }
}

const MEMORY_EDITS: [Edit<Memory>; 11] = [
    ("memory.unaliased", |s| s.unaliased_bytes = s.unaliased_bytes.wrapping_add(1)),
    ("memory.unaliased", |s| s.unaliased_bytes = s.unaliased_bytes.wrapping_sub(1)),
    ("memory.bytes", |s| s.bytes = s.bytes.wrapping_add(1)),
    ("memory.bytes", |s| s.bytes = s.bytes.wrapping_sub(1)),
    ("memory.lower_bound", |s| s.lower_bound_bytes = s.lower_bound_bytes.wrapping_add(1)),
    ("memory.lower_bound", |s| s.lower_bound_bytes = s.lower_bound_bytes.wrapping_sub(1)),
    ("memory.optimal", |s| s.optimal ^= true),
    ("memory.avoided", |s| s.avoided_bytes = s.avoided_bytes.wrapping_add(1)),
    ("memory.avoided", |s| s.avoided_bytes = s.avoided_bytes.wrapping_sub(1)),
    ("memory.own", |s| s.own_bytes = s.own_bytes.wrapping_add(1)),
    ("memory.own", |s| s.own_bytes = s.own_bytes.wrapping_sub(1)),
];
