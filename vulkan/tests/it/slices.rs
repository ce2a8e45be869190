//! Slices of three-dimensional textures, and cubes.

#![allow(unsafe_code, reason = "Vulkan has no safe calls")]

use crate::bench::{TestResult, device, planned};
use framegraph::{Alias, ClearValue, Dimension, Extent, Format, Graph, Intent, Options, TextureDesc};
use framegraph_vulkan::ash::vk;
use framegraph_vulkan::testing::Kit;
use framegraph_vulkan::{Executor, Imports, ViewShape};

const SIDE: u32 = 8;
const SLICES: u32 = 6;
const TEXELS: usize = (SIDE * SIDE) as usize;

/// A pass that draws into slice 3 of a volume keeps the other slices.
#[test]
fn attached_slices_keep_the_others() -> TestResult {
    let Some(device) = device("attached_slices_keep_the_others") else { return Ok(()) };
    for alias in [Alias::Heap, Alias::Off] {
        let mut graph = Graph::new();
        let desc = TextureDesc::new(Extent::absolute(SIDE, SIDE), Format::Rgba8Unorm).layers(SLICES as u16);
        let volume = graph.texture("volume", TextureDesc { dimension: Dimension::D3, ..desc });
        let result = graph.buffer("result", u64::from(SIDE * SIDE * SLICES * 4));
        let white = Intent::Clear(ClearValue::Color([1.0; 4]));
        let volume = graph.add_fn("fill", |pass| pass.copy_target(volume, white))?;
        let volume = graph.add_fn("draw", |pass| pass.color(volume.layer(3), Intent::Modify))?;
        let (from, to) = graph.add_fn("copy", |pass| {
            Ok((pass.copy_source(volume)?, pass.copy_target_buffer(result, Intent::Overwrite)?))
        })?;
        graph.export_buffer(to)?;
        let options = Options { alias, ..Options::for_frame(SIDE, SIDE) };
        let plan = planned(&device, &graph, &options, |_| {})?;
        let (mut executor, mut kit) = (Executor::new(device.gpu())?, Kit::new(device.gpu()));
        executor.execute(&plan, Imports::new(), |cx| {
            let (raw, commands) = (cx.device().clone(), cx.commands());
            let extent = vk::Extent2D { width: SIDE / 2, height: SIDE };
            let aspect_mask = vk::ImageAspectFlags::COLOR;
            match cx.pass_name() {
                "draw" => {
                    let attachment = vk::ClearAttachment { aspect_mask, ..Default::default() };
                    let rect = vk::Rect2D { extent, ..Default::default() };
                    let rect = vk::ClearRect { rect, base_array_layer: 0, layer_count: 1 };
                    // SAFETY: the commands are in the render pass of the slice, which contains the rectangle.
                    unsafe { raw.cmd_clear_attachments(commands, &[attachment], &[rect]) };
                }
                "copy" => {
                    let (from, to) = (cx.texture(from)?, cx.target_buffer(to)?);
                    let layers = vk::ImageSubresourceLayers { aspect_mask, layer_count: 1, ..Default::default() };
                    let image_extent = vk::Extent3D { width: SIDE, height: SIDE, depth: SLICES };
                    let region = vk::BufferImageCopy { image_subresource: layers, image_extent, ..Default::default() };
                    // SAFETY: the pass declares both; the buffer has the bytes of the volume.
                    unsafe { raw.cmd_copy_image_to_buffer(commands, from.image, from.layout, to.buffer, &[region]) };
                }
                _ => {}
            }
            Ok(())
        })?;
        executor.wait()?;
        let id = graph.find_resource("result").ok_or("the buffer has a name")?;
        let buffer = executor.exported(id).ok_or("the buffer is exported")?.buffer;
        let bytes = kit.read_buffer(buffer, u64::from(SIDE * SIDE * SLICES * 4))?;
        for (at, texel) in bytes.chunks_exact(4).enumerate() {
            let drawn = at / TEXELS == 3 && at as u32 % SIDE < SIDE / 2;
            let expected = if drawn { [0; 4] } else { [255; 4] };
            assert_eq!(texel, expected, "{alias:?}: slice {}, texel {}", at / TEXELS, at % TEXELS);
        }
        assert_eq!(device.messages(), [""; 0], "{alias:?}");
    }
    Ok(())
}

/// Textures of six square layers can be bound as cubes.
#[test]
fn layers_are_bound_as_cubes() -> TestResult {
    let Some(device) = device("layers_are_bound_as_cubes") else { return Ok(()) };
    let mut graph = Graph::new();
    let desc = TextureDesc::new(Extent::absolute(SIDE, SIDE), Format::Rgba8Unorm).layers(6);
    let cube = graph.texture("cube", desc);
    let clear = Intent::Clear(ClearValue::Color([1.0; 4]));
    let cube = graph.add_fn("fill", |pass| pass.copy_target(cube, clear))?;
    let cube = graph.add_fn("use", |pass| {
        pass.side_effect();
        pass.sampled(cube)
    })?;
    let plan = planned(&device, &graph, &Options::for_frame(SIDE, SIDE), |_| {})?;
    let (mut executor, mut bound) = (Executor::new(device.gpu())?, 0);
    executor.execute(&plan, Imports::new(), |cx| {
        if cx.pass_name() == "use" {
            let access = cx.plan().graph().access_of(cube).ok_or("the pass samples the cube")?;
            let shape = ViewShape { kind: Some(vk::ImageViewType::CUBE), ..ViewShape::default() };
            bound += usize::from(cx.bind(access, shape)?.view != vk::ImageView::null());
        }
        Ok(())
    })?;
    executor.wait()?;
    assert_eq!((bound, device.messages()), (1, Vec::new()));
    Ok(())
}
