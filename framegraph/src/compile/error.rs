//! Errors of a graph as a whole, with the names involved, the source location and a hint.

use crate::access::{AccessKind, ClearValue};
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
        Levels { mips: u8, extent: [u32; 2], /** Down to one texel. */ full: u32 }
            "{mips} levels, but {w}x{h} texels have at most {full}", "use fewer levels, or `ALL_MIPS`", [w, h] = extent;
        Layers { layers: u16, max: u32 } "{layers} layers, the device allows {max}", "{LIMIT}";
        /// Not a power of two, or more samples than the device supports.
        Samples { samples: u8, max: u8 } "{samples} samples{allowed}", "{hint}",
            (allowed, hint) = match samples.is_power_of_two() {
                true => (format!(", the device allows 1 to {max}"), LIMIT),
                false => (String::new(), "use 1, 2, 4, 8 or 16 samples"),
            };
        /// A multisampled texture with several levels or three dimensions.
        Multisampled { samples: u8, mips: u32 } "{samples} samples with {mips} levels",
            "a multisampled texture has one level and two dimensions";
        Volume { /** Of depth or stencil. */ format: Format } "{format:?} with three dimensions",
            "use a two-dimensional depth-stencil texture with layers";
        TooManySubresources { /** Up to this resource. */ parts: u64, max: u64 }
            "the resources have {parts} subresources (level, layer and plane), the maximum is {max}",
            "use fewer levels or layers";
    }
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
