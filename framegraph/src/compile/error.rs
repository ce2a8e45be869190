//! Errors of a graph as a whole, with the names involved, the source location and a hint.

use crate::access::{AccessKind, ClearValue};
use crate::caps::FormatCaps;
use crate::enum_names::enum_names;
use crate::error::{DeclareError, Named, named};
use crate::error_list::Errors;
use crate::error_macros::{error_enum, impl_error, show};
use crate::format::Format;
use crate::graph::Tables;
use crate::id::{PassId, ResourceId};
use std::fmt;
use std::panic::Location;

/// One error of a graph.
#[derive(Clone, PartialEq, Eq)]
pub struct CompileError {
    /// The error.
    pub reason: CompileReason,
    /// The pass concerned, if any.
    pub pass: Option<Named<PassId>>,
    /// The resource concerned, if any.
    pub resource: Option<Named<ResourceId>>,
    /// Source location of the pass.
    pub location: Option<&'static Location<'static>>,
}

impl CompileError {
    /// Creates an error about a pass and a resource; each may be none.
    #[cold]
    pub(super) fn new(graph: &Tables, reason: CompileReason, pass: PassId, resource: ResourceId) -> Self {
        let location = pass.some().map(|p| graph.passes[p.index()].location);
        Self { reason, pass: graph.named_pass(pass), resource: graph.named_resource(resource), location }
    }
}

error_enum! {
    /// Reason why a graph does not compile.
    CompileReason {
        /// A method of the graph reported an error.
        Declare(error: DeclareError) => (error.to_string(), String::new());
        /// Contents are read, modified or exported, but no earlier pass wrote them.
        ReadUnwritten {
            /// Kind of the use; `None` for an export.
            access: Option<AccessKind>,
            /// A later pass that writes the contents, if any.
            later_writer: Option<String>
        } "used as `{used}`, but {missing}", "{hint}",
            used = access.map_or("export", AccessKind::word),
            (missing, hint) = match later_writer {
                None => (
                    "no earlier pass writes all of it".into(),
                    "clear or overwrite it in an earlier pass, or import it with defined contents",
                ),
                Some(pass) => (format!("its writer `{pass}` is declared later"), "declare the writer first"),
            };
        /// Occurs only in graphs from files.
        TwoWriters { other: String } "`{other}` writes the same version",
            "let the second pass modify the version written by the first";
        /// Occurs only in graphs from files.
        Cycle { /** In order. */ passes: Vec<String> } "passes depend on each other: {ring}",
            "let one of them read a history or another texture, or remove an unnecessary `after`",
            ring = ring(passes);
        /// Attachments of a pass differ in sample count, or a resolve is not from multisampled to single-sampled.
        Samples { /** 0 for several. */ expected: u8, found: u8 } "{found} {expected_so}", "{hint}",
            (expected_so, hint) = match expected {
                0 => (
                    "sample in the source of a resolve, several are required".into(),
                    "give the resolved attachment 2, 4, 8 or 16 samples, or remove the resolve",
                ),
                _ => (
                    format!("samples, {expected} required"),
                    "give all attachments of a pass the same sample count, and resolve targets one sample",
                ),
            };
        /// Attachments of a pass differ in width, height or layer count.
        Extent { expected: [u32; 3], found: [u32; 3] }
            "{x}x{y} with {m} layers, but the other attachments have {w}x{h} with {l} layers",
            "give all attachments of a pass the same size and layer count",
            [w, h, l] = expected, [x, y, m] = found;
        /// Source and target of a resolve have incompatible formats.
        Format { expected: Format, found: Format } "format {found:?}, {expected:?} required",
            "give the resolve target the format of its source; for depth with stencil, the format of the depth plane";
        /// The format cannot represent the clear value.
        ClearValue { value: ClearValue, /** None for a buffer. */ format: Option<Format> }
            "cleared to {shown}, which {what} cannot represent", "{hint}",
            shown = match value {
                ClearValue::DepthStencil(depth, stencil) => format!("depth {depth} and stencil {stencil}"),
                ClearValue::Color(color) => format!("color {color:?}"),
                ClearValue::Zero => "zero".into(),
            },
            what = format.map_or("a buffer".into(), |format| format!("{format:?}")),
            hint = match format {
                None => "clear buffers to zero",
                Some(format) if format.is_depth_stencil() => {
                    "clear it to a depth from 0 to 1 and a stencil from 0 to 255, or to zero"
                }
                Some(_) => "clear it to a color in the range of its format, without NaN, or to zero",
            };
        /// The descriptor is invalid, or exceeds the limits of the device.
        Shape(fault: ShapeReason) => fault.words();
        Attachments { colors: u32, /** A sample. */ bytes: u32, max_colors: u8, max_bytes: u32 }
            "{colors} color attachments with {bytes} bytes per sample, the device allows {max_colors} with {max_bytes}",
            "split the pass, or pack outputs into fewer or smaller attachments";
        OutOfRange { mip: u8 } "level {mip} does not exist at this frame size",
            "use levels and layers that exist";
        NoSuchBytes { offset: u64, bytes: u64, size: u64 }
            "{bytes} bytes at offset {offset} exceed the buffer, which has {size} at this frame size",
            "compute the range from the frame size when declaring the graph";
        SampledDepth { access: AccessKind }
            "used as `{access}` and as depth attachment at the same time, which the device does not support",
            "copy it first, or read it in another pass";
        /// The device cannot write one plane of a depth-stencil texture while a shader reads the other.
        Planes { access: AccessKind }
            "one plane is used as `{access}` while the pass writes the other, which the device does not support",
            "test it with `depth_read_only`, copy the plane that is read, or use two textures";
        /// The device does not support a format for an access.
        FormatUse { access: AccessKind, format: Format, /** What the device supports. */ uses: FormatCaps, /** Similar format with that use. */ instead: Option<Format> }
            "the device does not support {format:?} as `{access}`, {only}", "use {other}",
            only = match uses.names().next() {
                None => "nor for anything else".to_owned(),
                Some(_) => format!("only for {}", uses.names().collect::<Vec<_>>().join(", ")),
            },
            other = instead.map_or("another format, or another device".to_owned(), |format| format!("{format:?}"));
        /// A view in the sRGB twin of the format.
        SrgbView { view: Format } "viewed as {view:?}, but the device has no views in another format",
            "declare the texture in the format of the view";
        MultisampledStorage { access: AccessKind, samples: u8 }
            "{samples} samples are used as `{access}`, but the device has storage textures of one sample only",
            "resolve it first, and use the resolved texture";
        AttachedLayers { layers: u32, max: u32 }
            "{layers} layers are attached at once, the device allows {max}",
            "attach one layer per pass: `texture.layer(n)`, in a file `layer: n`";
        /// A raster pass without attachments.
        NoAttachment "the raster pass has no attachment, which the device requires",
            "attach a texture, or make it a compute pass";
        RasterStorage { access: AccessKind } "a raster pass uses it as `{access}`, which the device does not support",
            "write it in a compute pass";
        /// Too many resources for the shader stages of a pass.
        Bindings { kind: BindingClass, count: u32, max: u32, /** Counts only those that the pass writes. */ written: bool }
            "the pass {uses} {count} {kind}, the device allows {max} in its shader stages", "{hint}",
            uses = if *written { "writes" } else { "uses" },
            hint = match kind {
                BindingClass::SampledTextures => "split the pass, or combine textures as layers of one texture",
                BindingClass::StorageTextures => "split the pass, or combine textures as layers of one texture",
                _ => "split the pass, or combine buffers",
            };
        BindingBytes { access: AccessKind, bytes: u64, max: u64 }
            "{bytes} bytes are bound as `{access}`, the device allows {max}",
            "declare a range: `buffer.bytes(offset, size)`, in a file `bytes: (offset, size)`{storage}",
            storage = if *access == AccessKind::Uniform { ", or use a storage buffer" } else { "" };
        BindingOffset { access: AccessKind, offset: u64, alignment: u64 }
            "bytes from offset {offset} are used as `{access}`, the device requires a multiple of {alignment}",
            "start the range at {before} or {after}",
            before = offset / alignment * alignment, after = offset.next_multiple_of(*alignment);
        BindingSize { access: AccessKind, bytes: u64, alignment: u64 }
            "{bytes} bytes are used as `{access}`, the device requires a multiple of {alignment}", "use {up} bytes",
            up = bytes.next_multiple_of(*alignment);
        /// A clear outside of a render pass that the device cannot do.
        ClearUnsupported { access: AccessKind, /** None for a buffer. */ format: Option<Format> }
            "`{access}` clears {what} outside of a render pass, which the device does not support", "{hint}",
            what = format.map_or("a buffer range that is not aligned to 4 bytes".to_owned(), |f| format!("{f:?}")),
            hint = match format {
                None => "use a range with offset and size in multiples of 4",
                Some(_) => "overwrite it, or use a renderable format",
            };
        Aliased "two imported textures may alias, but the device needs the layout of each texture",
            "declare one import for the texture, and use its handle in all passes";
        TooManyPasses "the graph has too many passes", "split the graph";
    }
}

error_enum! {
    /// Reason why a descriptor is invalid. Extents are width and height in texels at the current frame size; `max` is
    /// the limit of the device.
    #[derive(Copy)]
    ShapeReason {
        EmptyBuffer "the buffer has 0 bytes", "{NOTHING}";
        LargeBuffer { bytes: u64, max: u64 } "{bytes} bytes, the device allows {max}", "{LIMIT}";
        /// A texture without texels, layers or samples.
        Empty { extent: [u32; 2], layers: u16, samples: u8 }
            "{w}x{h} texels, {layers} layers, {samples} samples", "{NOTHING}", [w, h] = extent;
        Large { extent: [u32; 2], max: u32 } "{w}x{h} texels, the device allows {max}x{max}", "{LIMIT}", [w, h] = extent;
        /// A three-dimensional texture.
        LargeVolume { extent: [u32; 3], max: u32 } "{w}x{h}x{d} texels, the device allows {max}x{max}x{max}", "{LIMIT}",
            [w, h, d] = extent;
        /// A block-compressed texture that ends within a block.
        PartialBlocks { extent: [u32; 2], format: Format, block: [u32; 2] }
            "{w}x{h} texels of {format:?}, which the device divides into blocks of {x}x{y}",
            "use a width and height in multiples of the block", [w, h] = extent, [x, y] = block;
        Levels { mips: u8, extent: [u32; 2], /** Down to one texel. */ full: u32 }
            "{mips} levels, but {w}x{h} texels have at most {full}",
            "use fewer levels, or `TextureDesc::ALL_MIPS` for all (in a file `mips: \"all\"`)", [w, h] = extent;
        Layers { layers: u16, max: u32 } "{layers} layers, the device allows {max}", "{LIMIT}";
        /// Not a power of two, or a sample count that the device does not support for the format.
        Samples { samples: u8, format: Format, uses: FormatCaps, /** For all formats. */ max: u8 }
            "{samples} samples of {format:?}, the device allows {allowed}", "use {allowed}{other}",
            allowed = uses.sample_counts(*max).map(|count| count.to_string()).collect::<Vec<_>>().join(" or "),
            other = if uses.is_multisampled() { "" } else { ", or another format" };
        /// A multisampled texture with several layers.
        MultisampledLayers { samples: u8, layers: u16 }
            "{samples} samples with {layers} layers, but the device has no multisampled arrays",
            "use a texture for each layer, or one sample";
        /// A multisampled texture with several levels or three dimensions.
        Multisampled { samples: u8, mips: u32 } "{samples} samples with {mips} levels",
            "a multisampled texture has one level and two dimensions";
        /// A depth-stencil format, or one that the device does not support with three dimensions.
        Volume { format: Format } "{format:?} with three dimensions",
            "use a two-dimensional texture with layers, or another format";
        TooManySubresources { /** Up to this resource. */ parts: u64, max: u64 }
            "the resources have {parts} subresources (level, layer and plane), the maximum is {max}",
            "use fewer levels or layers";
    }
}

/// Resources that a shader binds, counted for the limits of a stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BindingClass {
    /// Textures that are sampled.
    SampledTextures,
    /// Storage textures.
    StorageTextures,
    /// Storage buffers.
    StorageBuffers,
    /// Uniform buffers.
    UniformBuffers,
}

enum_names! {
    BindingClass:
    SampledTextures "sampled textures", StorageTextures "storage textures", StorageBuffers "storage buffers",
    UniformBuffers "uniform buffers"
}

const NOTHING: &str = "use at least one texel, layer and sample, or one byte";
const LIMIT: &str = "make it smaller, or use another device";

/// Maximum number of passes of a cycle that an error lists.
const MAX_LISTED_PASSES: usize = 12;

/// Lists the first passes of a cycle.
fn ring(passes: &[String]) -> String {
    let shown: Vec<_> = passes.iter().take(MAX_LISTED_PASSES).map(|pass| format!("`{pass}`")).collect();
    let more = passes.len() - shown.len();
    let more = if more == 0 { String::new() } else { format!(" and {more} more") };
    format!("{}{more}", shown.join(" -> "))
}

impl fmt::Display for CompileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { reason, pass, resource, location } = self;
        show(f, "", (named(pass), named(resource)), reason.words(), *location)
    }
}

impl_error!(CompileError);

/// The errors of a graph, ordered by pass: the first hundred, and the number of further errors.
pub type CompileErrors = Errors<CompileError>;
