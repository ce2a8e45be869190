//! Cases of the differential test: graphs with one extreme each.

use framegraph::{ClearValue, DeclareError, Entry, Exit, Extent, Format, Intent, PassBuilder, TextureDesc};
use framegraph_wgpu::Frame;

/// Side of most textures, in texels. A multiple of every compression block.
pub const SIDE: u32 = 8;

/// Declares a case. A fault of the declaration has nothing to do with the device.
type Declare = Box<dyn Fn(&mut Frame) -> Result<(), DeclareError> + Send + Sync>;

/// One graph with one extreme.
pub struct Case {
    /// Kind of the extreme, for the report.
    pub kind: &'static str,
    /// The extreme itself.
    pub name: String,
    pub declare: Declare,
}

impl Case {
    pub fn new(
        kind: &'static str,
        name: String,
        declare: impl Fn(&mut Frame) -> Result<(), DeclareError> + Send + Sync + 'static,
    ) -> Self {
        Self { kind, name, declare: Box::new(declare) }
    }
}

/// Returns a texture of [`SIDE`] texels.
pub fn small(format: Format) -> TextureDesc {
    TextureDesc::new(Extent::absolute(SIDE, SIDE), format)
}

/// Attaches a plain target, so that the pass may be a raster pass.
pub fn target(pass: &mut PassBuilder<'_>) -> Result<(), DeclareError> {
    let out = pass.texture("out", small(Format::Rgba8Unorm));
    pass.color(out, Intent::Overwrite).map(drop)
}

/// An access to a texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Use {
    Color,
    Depth,
    DepthReadOnly,
    Resolve,
    SamePixel,
    Sampled,
    StorageRead,
    StorageWrite,
    StorageModify,
    StorageClear,
    StorageFill,
    CopySource,
    CopyTarget,
    CopyClear,
}

impl Use {
    pub const ALL: [Self; 14] = [
        Self::Color,
        Self::Depth,
        Self::DepthReadOnly,
        Self::Resolve,
        Self::SamePixel,
        Self::Sampled,
        Self::StorageRead,
        Self::StorageWrite,
        Self::StorageModify,
        Self::StorageClear,
        Self::StorageFill,
        Self::CopySource,
        Self::CopyTarget,
        Self::CopyClear,
    ];
}

/// Returns the sRGB twin of a format, in either direction.
pub fn twin(format: Format) -> Option<Format> {
    let other = |f: &Format| *f != format && f.without_srgb() == format.without_srgb();
    Format::ALL.into_iter().find(other)
}

/// Declares one access to a texture. The pass has a side effect, and its contents come from an import if they are read.
pub fn access(frame: &mut Frame, desc: TextureDesc, view: Option<Format>, wanted: Use) -> Result<(), DeclareError> {
    let graph = frame.graph_mut();
    let import = |graph: &mut framegraph::Graph| graph.import_texture("t", desc, Entry::Defined, Exit::Discard);
    let reads = matches!(
        wanted,
        Use::DepthReadOnly | Use::SamePixel | Use::Sampled | Use::StorageRead | Use::StorageModify | Use::CopySource
    );
    let texture = if reads { import(graph) } else { graph.texture("t", desc) };
    let part = match view {
        Some(view) => texture.viewed_as(view),
        None => texture.into(),
    };
    let opaque = if desc.format.is_depth_stencil() { ClearValue::FAR } else { ClearValue::Color([1.0; 4]) };
    graph
        .add_fn("case", |pass| {
            pass.side_effect();
            match wanted {
                Use::Color => pass.color(part, Intent::Overwrite).map(drop),
                Use::Depth => pass.depth(part, Intent::Overwrite).map(drop),
                Use::DepthReadOnly => pass.depth_read_only(part).map(drop),
                Use::Resolve => {
                    let samples = pass.texture("samples", desc.samples(4));
                    let drawn = match (view, desc.format.is_depth_stencil()) {
                        (_, true) => pass.depth(samples, Intent::Overwrite)?,
                        (Some(view), _) => pass.color(samples.viewed_as(view), Intent::Overwrite)?,
                        (None, _) => pass.color(samples, Intent::Overwrite)?,
                    };
                    match desc.format.is_depth_stencil() {
                        true => pass.resolve_as(framegraph::ResolveMode::Sample0, drawn, part).map(drop),
                        false => pass.resolve(drawn, part).map(drop),
                    }
                }
                Use::SamePixel => pass.same_pixel(part).map(drop).and_then(|()| target(pass)),
                Use::Sampled => pass.sampled(part).map(drop).and_then(|()| target(pass)),
                Use::StorageRead => pass.storage_read(part).map(drop),
                Use::StorageWrite => pass.storage_write(part, Intent::Overwrite).map(drop),
                Use::StorageModify => pass.storage_write(part, Intent::Modify).map(drop),
                Use::StorageClear => pass.storage_write(part, Intent::Clear(ClearValue::Zero)).map(drop),
                Use::StorageFill => pass.storage_write(part, Intent::Clear(opaque)).map(drop),
                Use::CopySource => pass.copy_source(part).map(drop),
                Use::CopyTarget => pass.copy_target(part, Intent::Overwrite).map(drop),
                Use::CopyClear => pass.copy_target(part, Intent::Clear(ClearValue::Zero)).map(drop),
            }
        })
        .map(drop)
}
