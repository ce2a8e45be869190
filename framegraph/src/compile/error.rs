//! What can be wrong with a graph as a whole, said with the names involved, the place in code and what to do about it.

use crate::access::{AccessKind, ClearValue};
use crate::capped::Errors;
use crate::error::{DeclareError, Named, named};
use crate::faults::{errors, faults, show};
use crate::format::Format;
use crate::graph::Tables;
use crate::id::{PassId, ResourceId};
use std::fmt;
use std::panic::Location;

/// One error of a graph.
#[derive(Clone, PartialEq, Eq)]
pub struct CompileError {
    /// What is wrong.
    pub reason: CompileReason,
    /// The pass concerned, where there is one.
    pub pass: Option<Named<PassId>>,
    /// The resource concerned, where there is one.
    pub resource: Option<Named<ResourceId>>,
    /// Where the pass was declared.
    pub location: Option<&'static Location<'static>>,
}

impl CompileError {
    /// An error about a pass and a resource, or none of these.
    #[cold]
    pub(super) fn new(graph: &Tables, reason: CompileReason, pass: PassId, resource: ResourceId) -> Self {
        let location = pass.some().map(|p| graph.passes[p.index()].location);
        Self { reason, pass: graph.named_pass(pass), resource: graph.named_resource(resource), location }
    }
}

faults! {
    /// Why a graph does not compile.
    CompileReason {
        /// A call on the graph itself was refused.
        Declare(error: DeclareError) => (error.to_string(), String::new());
        /// Contents are read, modified or exported that no pass wrote before.
        ReadUnwritten {
            /// How they are used; none for an export.
            access: Option<AccessKind>,
            /// A later pass that writes them, if there is one.
            later_writer: Option<String>
        } "used as `{used}`, but {nobody}", "{hint}",
            used = access.map_or("export", AccessKind::word),
            (nobody, hint) = match later_writer {
                None => (
                    "nobody writes all of it before".into(),
                    "clear or overwrite it in an earlier pass, or import it with contents",
                ),
                Some(pass) => (format!("`{pass}`, which writes it, is declared later"), "declare the writer first"),
            };
        /// Only graphs from files can say so.
        TwoWriters { other: String } "`{other}` writes the same version",
            "let the second pass modify the version that the first one wrote";
        /// Only graphs from files can say so.
        Cycle { /** In order. */ passes: Vec<String> } "passes wait for each other: {ring}",
            "let one of them read a history or another texture, or take an `after` away that is not needed",
            ring = ring(passes);
        /// Attachments of one pass differ in samples, or a resolve does not go from many to one.
        Samples { /** 0 for several. */ expected: u8, found: u8 } "{found} {expected_so}", "{hint}",
            (expected_so, hint) = match expected {
                0 => (
                    "sample is resolved, where several are needed".into(),
                    "give the attachment that is resolved 2, 4, 8 or 16 samples, or leave the resolve out",
                ),
                _ => (
                    format!("samples where {expected} are needed"),
                    "give all attachments of a pass the same samples, and what is resolved into one",
                ),
            };
        /// Attachments of one pass differ in width, height or layers.
        Extent { expected: [u32; 3], found: [u32; 3] }
            "{x}x{y} with {m} layers, where the other attachments have {w}x{h} with {l}",
            "give all attachments of a pass the same size and layers",
            [w, h, l] = expected, [x, y, m] = found;
        /// A resolve between formats that do not agree.
        Format { expected: Format, found: Format } "format {found:?} where {expected:?} is needed",
            "give the target of a resolve the format of its samples, of depth with stencil that of the depth plane";
        /// A clear value of another kind than what is cleared, or one that its format does not hold.
        ClearValue { value: ClearValue, /** None for a buffer. */ format: Option<Format> }
            "cleared to {shown}, which {what} does not hold", "{hint}",
            shown = match value {
                ClearValue::DepthStencil(depth, stencil) => format!("depth {depth} and stencil {stencil}"),
                ClearValue::Color(color) => format!("color {color:?}"),
                ClearValue::Zero => "zero".into(),
            },
            what = format.map_or("a buffer".into(), |format| format!("{format:?}")),
            hint = match format {
                None => "clear a buffer to zero",
                Some(format) if format.is_depth_stencil() => {
                    "clear it to a depth from 0 to 1 and a stencil from 0 to 255, or to zero"
                }
                Some(_) => "clear it to a color whose channels its format holds, without NaN, or to zero",
            };
        /// A shape that no texture or buffer can have, or that the device cannot make.
        Shape(fault: ShapeFault) => fault.words();
        Attachments { colors: u32, /** A sample. */ bytes: u32, max_colors: u8, max_bytes: u32 }
            "{colors} color attachments of {bytes} bytes a sample, the device allows {max_colors} of {max_bytes}",
            "split the pass, or pack outputs into fewer or smaller attachments";
        OutOfRange { mip: u8 } "level {mip} is asked of a texture that has fewer at this frame size",
            "ask for levels and layers that there are";
        NoSuchBytes { offset: u64, bytes: u64, size: u64 }
            "{bytes} bytes from {offset} on are asked of a buffer that has {size} at this frame size",
            "ask for bytes that there are: work them out from the frame's size when it is declared";
        SampledDepth { access: AccessKind }
            "used as `{access}` and as depth attachment at once, which the device cannot do",
            "copy it before, or read it in a pass of its own";
        TooManyPasses "the graph has more passes than can be numbered", "split the graph";
    }
}

faults! {
    /// What is wrong with the shape of a resource. Extents are width and height in texels at the frame's size; `max` is what
    /// the device allows.
    #[derive(Copy)]
    ShapeFault {
        EmptyBuffer "a buffer of 0 bytes", "{NOTHING}";
        LargeBuffer { bytes: u64, max: u64 } "{bytes} bytes, the device allows {max}", "{LIMIT}";
        /// A texture without texels, layers or samples.
        Empty { extent: [u32; 2], layers: u16, samples: u8 }
            "{w}x{h} texels, {layers} layers, {samples} samples", "{NOTHING}", [w, h] = extent;
        Large { extent: [u32; 2], max: u32 } "{w}x{h} texels, the device allows {max}x{max}", "{LIMIT}", [w, h] = extent;
        Levels { mips: u8, extent: [u32; 2], /** Down to one texel. */ full: u32 }
            "{mips} levels, {w}x{h} texels have {full}", "ask for fewer levels, or for all of them", [w, h] = extent;
        Layers { layers: u16, max: u32 } "{layers} layers, the device allows {max}", "{LIMIT}";
        /// No power of two, or more samples than the device allows.
        Samples { samples: u8, max: u8 } "{samples} samples{allowed}", "{hint}",
            (allowed, hint) = match samples.is_power_of_two() {
                true => (format!(", the device allows 1 to {max}"), LIMIT),
                false => (String::new(), "give it 1, 2, 4, 8 or 16 samples"),
            };
        /// A multisampled texture of several levels or three dimensions.
        Multisampled { samples: u8, mips: u32 } "{samples} samples with {mips} levels",
            "a multisampled texture has one level and two dimensions";
        Volume { /** Of depth or stencil. */ format: Format } "three dimensions of {format:?}",
            "give a depth-stencil texture two dimensions, with layers";
        Crowd { /** Up to this resource. */ parts: u64, max: u64 }
            "with it, all resources have {parts} levels, layers and planes; {max} can be followed",
            "give the textures fewer levels or layers";
    }
}

const NOTHING: &str = "give it at least one texel, layer and sample, or one byte";
const LIMIT: &str = "make it smaller, or choose another device";

/// Passes of a cycle that an error names at most.
const MOST_OF_A_CYCLE: usize = 12;

/// The passes of a cycle, the first ones by name.
fn ring(passes: &[String]) -> String {
    let shown: Vec<_> = passes.iter().take(MOST_OF_A_CYCLE).map(|pass| format!("`{pass}`")).collect();
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

errors!(CompileError);

/// The errors of a graph, in the order of the passes: the first hundred, and how many more there are.
pub type CompileErrors = Errors<CompileError>;
