//! Images for the imports of a plan, cleared to zero, and buffers filled with [`WORD`].

#![allow(unsafe_code, reason = "imports are promises about handles")]

use super::kit::Kit;
use crate::convert::{layout, planes};
use crate::driver::{Dependencies, ImageBarrier, Object, Scope, Thing};
use crate::error::Error;
use crate::imports::Imports;
use crate::shape::Shape;
use ash::vk;
use framegraph::{Aspect, Entry, Kind, Placement, Plan, ResourceId, State, Usage};

/// Value of the words of imported buffers, which makes them valid indirect arguments.
pub const WORD: u32 = 3;

/// Creates an image or a buffer for each import that the plan uses. They live until [`Kit::reset`].
///
/// # Errors
/// Fails if the device does not support an import.
pub fn imports(kit: &mut Kit, plan: &Plan) -> Result<Imports, Error> {
    let mut made = Imports::new();
    let graph = plan.graph();
    for (id, row) in graph.resource_ids().zip(plan.resources()) {
        if row.placement == Placement::External && !row.first.is_none() {
            import(kit, plan, id, &mut made)?;
        }
    }
    Ok(made)
}

/// Binds the same images and buffers for another frame.
///
/// # Safety
/// The images are in the layouts that `imports` promises, and no kit or executor has destroyed them.
#[must_use]
pub unsafe fn imports_again(imports: &Imports) -> Imports {
    Imports { rows: imports.rows.clone(), ..Imports::new() }
}

fn import(kit: &mut Kit, plan: &Plan, id: ResourceId, made: &mut Imports) -> Result<(), Error> {
    let graph = plan.graph();
    let mut shape = Shape::of(plan, id, &[]);
    shape.usage = shape.usage.union(Usage::COPY_SOURCE).union(Usage::COPY_TARGET).union(Usage::SAMPLED);
    // The owner of an import with a state uses it in this state.
    let state = match graph.resources()[id.index()].kind {
        Kind::Imported { entry: Entry::Left { state, .. }, .. } => state,
        Kind::Imported { entry: Entry::Undefined, .. } => State::Undefined,
        _ => State::Sampled,
    };
    shape.usage = shape.usage.union(match state {
        State::ColorAttachment | State::DepthAttachment | State::DepthReadOnly => Usage::ATTACHMENT,
        _ => Usage::NONE,
    });
    let Some(desc) = shape.desc.texture().copied() else {
        let info = shape.buffer_info().ok_or(Error::NotPrepared)?;
        let buffer = kit.gpu.shared.driver.buffer(&info)?;
        kit.objects.push(Object::Buffer(buffer));
        place(kit, Thing::Buffer(buffer))?;
        // SAFETY: `once` waits for the GPU; the buffer is new, has the usage, and lives until `reset`, which waits.
        kit.once(|driver, commands| unsafe { driver.raw.cmd_fill_buffer(commands, buffer, 0, vk::WHOLE_SIZE, WORD) })?;
        // SAFETY: the buffer belongs to the device, has the size and usage of the plan, and the GPU has finished with it.
        unsafe { made.buffer(id, buffer) };
        return Ok(());
    };
    let info = shape.image_info().ok_or(Error::NotPrepared)?;
    if !kit.gpu.supports(&info) {
        let resource = graph.resource_name(id).to_owned();
        return Err(Error::Format { resource, format: format!("{:?}", desc.format) });
    }
    let image = kit.gpu.shared.driver.image(&info)?;
    kit.objects.push(Object::Image(image));
    kit.gpu.shared.driver.name(Thing::Image(image), graph.resource_name(id));
    place(kit, Thing::Image(image))?;
    let range = |number: Option<u32>| vk::ImageSubresourceRange {
        aspect_mask: number.map_or(planes(desc.format, Aspect::All), |n| crate::convert::plane(desc.format, n)),
        level_count: vk::REMAINING_MIP_LEVELS,
        layer_count: vk::REMAINING_ARRAY_LAYERS,
        ..Default::default()
    };
    let barrier = |range, layouts| Dependencies {
        images: vec![ImageBarrier { scope: Scope::ALL, image, range, layouts }],
        ..Dependencies::default()
    };
    let target = vk::ImageLayout::TRANSFER_DST_OPTIMAL;
    kit.once(|driver, commands| {
        driver.barriers(commands, &barrier(range(None), [vk::ImageLayout::UNDEFINED, target]));
        driver.clear_image(commands, image, target, range(None), vk::ClearValue::default());
        for number in (0..desc.format.planes()).filter(|_| state != State::Undefined) {
            let layouts = [target, layout(state, desc.format, number)];
            driver.barriers(commands, &barrier(range(Some(number)), layouts));
        }
    })?;
    // SAFETY: the image belongs to the device, has the shape and usage of the plan, is in the layout of its state, and
    // lives until `reset`.
    unsafe { made.image(id, image, layout(state, desc.format, 0)) };
    Ok(())
}

/// Allocates and binds memory.
fn place(kit: &mut Kit, thing: Thing) -> Result<(), Error> {
    let driver = &kit.gpu.shared.driver;
    let needs = driver.requirements(thing);
    let unwanted = vk::MemoryPropertyFlags::LAZILY_ALLOCATED | vk::MemoryPropertyFlags::PROTECTED;
    let kind = driver.memory_type(needs.memory_type_bits, vk::MemoryPropertyFlags::DEVICE_LOCAL, unwanted);
    let memory =
        driver.allocate(needs.size, kind.ok_or_else(|| Error::MemoryType { resource: "an import".into() })?)?;
    kit.objects.push(Object::Memory(memory));
    driver.bind(thing, memory, 0)
}
