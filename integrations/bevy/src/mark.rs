//! Plugin that marks frames and outputs in the trace of a device.

use crate::trace::{FRAME_MARK, OUTPUT_MARK};
use bevy_app::{App, Plugin};
use bevy_core_pipeline::{Core3d, Core3dSystems};
use bevy_ecs::prelude::*;
use bevy_render::renderer::{RenderDevice, ViewQuery};
use bevy_render::view::ViewTarget;
use bevy_render::{Render, RenderApp, RenderSystems};

/// Marks frames and outputs of cameras in the trace of a device that [`Device::open`](crate::Device::open) opened. Frame
/// 0 is the first that Bevy renders. It must be added after `RenderPlugin`.
///
/// [`Report::of_trace`](crate::Report::of_trace) reads the trace.
#[derive(Clone, Copy, Debug, Default)]
pub struct ReportPlugin;

impl Plugin for ReportPlugin {
    fn build(&self, _app: &mut App) {}

    fn finish(&self, app: &mut App) {
        let Some(render) = app.get_sub_app_mut(RenderApp) else { return };
        render.add_systems(Render, mark_frame.in_set(RenderSystems::ExtractCommands));
        render.add_systems(Core3d, mark_output.after(Core3dSystems::PostProcess));
    }
}

/// Creates a buffer whose label is the mark, because a trace records labels.
fn mark_frame(device: Res<RenderDevice>, mut frame: Local<u32>) {
    let label = format!("{FRAME_MARK}{}", *frame);
    *frame += 1;
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(&label),
        size: 4,
        usage: wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
}

fn mark_output(view: ViewQuery<&ViewTarget>) {
    let target = view.into_inner();
    if let Some(output) = target.out_texture() {
        let desc = wgpu::TextureViewDescriptor { label: Some(OUTPUT_MARK), ..Default::default() };
        output.texture().create_view(&desc);
    }
}
