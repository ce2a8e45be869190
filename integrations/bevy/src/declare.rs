//! From an observed frame to a graph.

use crate::observed::{Binding, Effect, Load, Observed, ObservedAttachment, ObservedPass, Slot, Used, Work};
use framegraph::{
    AccessKind, Buffer, DeclareError, Entry, Exit, Extent, Graph, Intent, PassBuilder, PassId, PassKind, ResourceId,
    Texture, TextureDesc,
};

/// Names of Bevy's passes whose fragments read the main texture only at their own pixel. A trace cannot tell.
pub const POINTWISE: &[&str] = &["tonemapping", "upscaling"];

/// A declared frame. Rows of `passes` are parallel to the observed passes.
#[derive(Debug)]
pub struct Declared {
    /// The graph.
    pub graph: Graph,
    /// Each pass's id; `None` if it has no effect or is left out.
    pub passes: Vec<Option<PassId>>,
    /// Each observed texture's resource; `None` if no pass uses it.
    pub textures: Vec<Option<ResourceId>>,
    /// Sentences about passes that the graph lacks.
    pub left_out: Vec<String>,
}

/// Declares the frame. Passes whose name starts with one of `pointwise` read full-size textures at the same pixel.
pub fn declare(frame: &Observed, pointwise: &[&str]) -> Declared {
    let size = frame.frame_size();
    let mut graph = Graph::new();
    let mut handles = Handles {
        textures: frame.textures.iter().map(|_| None).collect(),
        buffers: frame.buffers.iter().map(|_| None).collect(),
    };
    for (index, texture) in frame.textures.iter().enumerate().filter(|(index, _)| frame.uses(*index)) {
        let extent = texture.desc.extent;
        let extent = if extent.texels([1, 1]) == size { Extent::FRAME } else { extent };
        let desc = TextureDesc { extent, ..texture.desc };
        handles.textures[index] = Some(match (texture.entry, texture.exit) {
            (Entry::Undefined, Exit::Discard) => graph.texture(&texture.name, desc),
            (entry, exit) => graph.import_texture(&texture.name, desc, entry, exit),
        });
    }
    let in_use =
        |index: usize| frame.passes.iter().flat_map(|pass| &pass.uses).any(|own| own.of == Used::Buffer(index));
    for (index, buffer) in frame.buffers.iter().enumerate().filter(|(index, _)| in_use(*index)) {
        handles.buffers[index] = Some(graph.import_buffer(&buffer.name, buffer.bytes, Entry::Defined, Exit::Keep));
    }
    let textures = handles.textures.iter().map(|texture| graph.resource_of((*texture)?)).collect();
    let mut declared = Declared { graph, passes: Vec::new(), textures, left_out: frame.left_out.clone() };
    for pass in &frame.passes {
        let same_pixel = pointwise.iter().any(|name| pass.name.starts_with(name));
        let added = declared.graph.add_fn(&pass.name, |builder| {
            let mut next = handles.clone();
            next.declare(frame, pass, same_pixel, builder)?;
            Ok(next)
        });
        let writes =
            pass.attachments.iter().any(|own| own.written) || pass.uses.iter().any(|u| u.effect != Effect::Read);
        match added {
            Ok(next) => {
                handles = next;
                declared.passes.push(declared.graph.pass_ids().next_back().filter(|_| writes));
            }
            Err(error) => {
                declared.left_out.push(format!("pass `{}`: {error}", pass.name));
                declared.passes.push(None);
            }
        }
    }
    declared
}

/// Newest versions of the used textures and buffers.
#[derive(Clone)]
struct Handles {
    textures: Vec<Option<Texture>>,
    buffers: Vec<Option<Buffer>>,
}

impl Handles {
    fn declare(
        &mut self,
        frame: &Observed,
        pass: &ObservedPass,
        same_pixel: bool,
        builder: &mut PassBuilder<'_>,
    ) -> Result<(), DeclareError> {
        builder.kind(match pass.work {
            Work::Raster => PassKind::Raster,
            Work::Compute => PassKind::Compute,
            Work::Copy | Work::Upload => PassKind::Copy,
        })?;
        let attached = |texture: usize| pass.attachments.iter().any(|own| own.region.texture == texture);
        for own in pass.uses.iter().filter(|own| own.effect == Effect::Read) {
            match own.of {
                Used::Texture(region) => {
                    let Some(texture) = self.textures[region.texture] else { continue };
                    let desc = &frame.textures[region.texture].desc;
                    let at_pixel = same_pixel
                        && desc.extent.texels([1, 1]) == frame.frame_size()
                        && desc.mips == 1
                        && !desc.format.is_depth_stencil()
                        && !attached(region.texture);
                    let part = texture.range(region.range(desc));
                    match own.binding {
                        Binding::Copy => builder.copy_source(part)?,
                        Binding::Storage => builder.storage_read(part)?,
                        _ if at_pixel => builder.same_pixel(part)?,
                        _ => builder.sampled(part)?,
                    };
                }
                Used::Buffer(index) => {
                    let Some(buffer) = self.buffers[index] else { continue };
                    let kind = match own.binding {
                        Binding::Uniform => AccessKind::Uniform,
                        Binding::Indirect => AccessKind::Indirect,
                        Binding::Copy => AccessKind::CopySource,
                        _ => AccessKind::StorageRead,
                    };
                    // WebGPU's rule allows one kind per buffer and pass if the pass writes it.
                    if !pass.uses.iter().any(|other| other.of == own.of && other.effect != Effect::Read) {
                        builder.read_buffer(buffer, kind)?;
                    }
                }
            }
        }
        self.attachments(frame, pass, builder)?;
        for own in pass.uses.iter().filter(|own| own.effect != Effect::Read) {
            let intent = if own.effect == Effect::Overwrite { Intent::Overwrite } else { Intent::Modify };
            match own.of {
                Used::Texture(region) => {
                    let Some(texture) = self.textures[region.texture] else { continue };
                    let part = texture.range(region.range(&frame.textures[region.texture].desc));
                    self.textures[region.texture] = Some(match own.binding {
                        Binding::Copy => builder.copy_target(part, intent)?,
                        _ => builder.storage_write(part, intent)?,
                    });
                }
                Used::Buffer(index) => {
                    let Some(buffer) = self.buffers[index] else { continue };
                    let copies = own.binding == Binding::Copy;
                    let kind = if copies { AccessKind::CopyTarget } else { AccessKind::StorageWrite };
                    self.buffers[index] = Some(builder.write_buffer(buffer, kind, intent)?);
                }
            }
        }
        Ok(())
    }

    fn attachments(
        &mut self,
        frame: &Observed,
        pass: &ObservedPass,
        builder: &mut PassBuilder<'_>,
    ) -> Result<(), DeclareError> {
        let mut colors = [None; 8];
        for own in &pass.attachments {
            let ObservedAttachment { region, slot, load, written, .. } = *own;
            let Some(texture) = self.textures[region.texture] else { continue };
            let part = texture.range(region.range(&frame.textures[region.texture].desc));
            let intent = match load {
                Load::Clear(value) => Intent::Clear(value),
                Load::DontCare => Intent::Overwrite,
                Load::Load if pass.full_screen => Intent::Overwrite,
                Load::Load => Intent::Modify,
            };
            let newest = match slot {
                // A pass without draws that keeps the contents writes nothing.
                Slot::Color(_) if !written => continue,
                Slot::Color(slot) => {
                    let newest = builder.color_at(slot, part, intent)?;
                    colors[usize::from(slot % 8)] = Some(newest);
                    newest
                }
                Slot::Depth if !written => {
                    if pass.draws > 0 {
                        builder.depth_read_only(part)?;
                    }
                    continue;
                }
                Slot::Depth => builder.depth(part, if load == Load::Load { Intent::Modify } else { intent })?,
                Slot::Resolve(slot) => match colors[usize::from(slot % 8)] {
                    Some(samples) => builder.resolve(samples, part)?,
                    None => continue,
                },
            };
            self.textures[region.texture] = Some(newest);
        }
        Ok(())
    }
}
