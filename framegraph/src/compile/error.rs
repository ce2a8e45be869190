//! What can be wrong with a graph as a whole, said with the names involved, the place in code and what to do about it.

use crate::access::{AccessKind, ClearValue};
use crate::capped;
use crate::error::{DeclareError, Named, about};
use crate::format::Format;
use crate::graph::Tables;
use crate::id::{PassId, ResourceId};
use crate::plain::line;
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

/// Why a graph does not compile.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum CompileReason {
    /// A call on the graph itself was refused.
    Declare(DeclareError),
    /// Contents are read, modified or exported that no pass wrote before.
    ReadUnwritten {
        /// How they are used; none for an export.
        access: Option<AccessKind>,
        /// The name of a later pass that writes them, if there is one.
        later_writer: Option<String>,
    },
    /// Two passes write one version (only graphs from files can say so).
    TwoWriters {
        /// The name of the other writer.
        other: String,
    },
    /// Passes wait for each other (only graphs from files can say so).
    Cycle {
        /// The names of the passes of the cycle, in order.
        passes: Vec<String>,
    },
    /// Attachments of one pass differ in samples, or a resolve does not go from many to one.
    Samples {
        /// What was expected; 0 for several.
        expected: u8,
        /// What was found.
        found: u8,
    },
    /// Attachments of one pass differ in size or layers.
    Extent {
        /// Width, height and layers that were expected.
        expected: [u32; 3],
        /// Width, height and layers that were found.
        found: [u32; 3],
    },
    /// A clear value of another kind than what is cleared, or one that its format does not hold.
    ClearValue {
        /// The value.
        value: ClearValue,
        /// The format that it is cleared in; none for a buffer.
        format: Option<Format>,
    },
    /// A resolve between formats that do not agree.
    Format {
        /// What was expected.
        expected: Format,
        /// What was found.
        found: Format,
    },
    /// A shape that no texture or buffer can have, or that the device cannot make.
    Shape(ShapeFault),
    /// More color attachments, or bytes of them, than the device allows.
    Attachments {
        /// Color attachments of the pass.
        colors: u32,
        /// Their bytes a sample.
        bytes: u32,
        /// Color attachments that the device allows.
        max_colors: u8,
        /// Bytes a sample that the device allows.
        max_bytes: u32,
    },
    /// A level that the texture does not have at this frame size.
    OutOfRange {
        /// The level.
        mip: u8,
    },
    /// Bytes that the buffer has not at this frame size.
    NoSuchBytes {
        /// The first byte that was asked for.
        offset: u64,
        /// How many.
        bytes: u64,
        /// How many the buffer has.
        size: u64,
    },
    /// A depth attachment is read in memory by the pass that tests against it, which the device cannot do.
    SampledDepth {
        /// How it is read.
        access: AccessKind,
    },
    /// More passes than the compiler can number.
    TooManyPasses,
}

/// What is wrong with the shape of a resource. Extents are width and height in texels at the frame's size.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ShapeFault {
    /// A buffer of no byte.
    EmptyBuffer,
    /// A buffer larger than the device allows.
    LargeBuffer {
        /// Its size, in bytes.
        bytes: u64,
        /// What the device allows.
        max: u64,
    },
    /// A texture without texels, layers or samples.
    Empty {
        /// Width and height.
        extent: [u32; 2],
        /// Layers.
        layers: u16,
        /// Samples.
        samples: u8,
    },
    /// A texture wider or higher than the device allows.
    Large {
        /// Width and height.
        extent: [u32; 2],
        /// Texels a side that the device allows.
        max: u32,
    },
    /// More levels than the extent has.
    Levels {
        /// Levels that were asked for.
        mips: u8,
        /// Width and height.
        extent: [u32; 2],
        /// Levels down to one texel.
        full: u32,
    },
    /// More layers than the device allows.
    Layers {
        /// Layers that were asked for.
        layers: u16,
        /// What the device allows.
        max: u32,
    },
    /// No power of two, or more samples than the device allows.
    Samples {
        /// Samples that were asked for.
        samples: u8,
        /// What the device allows.
        max: u8,
    },
    /// A multisampled texture of several levels or three dimensions.
    Multisampled {
        /// Samples.
        samples: u8,
        /// Levels.
        mips: u32,
    },
    /// A three-dimensional texture of depth or stencil.
    Volume {
        /// The format.
        format: Format,
    },
    /// With it, all resources have more levels, layers and planes than can be followed.
    Crowd {
        /// Levels, layers and planes up to this resource.
        parts: u64,
        /// What can be followed.
        max: u64,
    },
}

impl ShapeFault {
    /// What is wrong, and what to do about it.
    fn words(self) -> (String, &'static str) {
        const SIZE: &str = "give it at least one texel, layer and sample, or one byte";
        const LIMIT: &str = "make it smaller, or choose another device";
        match self {
            Self::EmptyBuffer => ("a buffer of 0 bytes".into(), SIZE),
            Self::LargeBuffer { bytes, max } => (format!("{bytes} bytes, the device allows {max}"), LIMIT),
            Self::Empty { extent: [w, h], layers, samples } => {
                (format!("{w}x{h} texels, {layers} layers, {samples} samples"), SIZE)
            }
            Self::Large { extent: [w, h], max } => (format!("{w}x{h} texels, the device allows {max}x{max}"), LIMIT),
            Self::Levels { mips, extent: [w, h], full } => {
                (format!("{mips} levels, {w}x{h} texels have {full}"), "ask for fewer levels, or for all of them")
            }
            Self::Layers { layers, max } => (format!("{layers} layers, the device allows {max}"), LIMIT),
            Self::Samples { samples, .. } if !samples.is_power_of_two() => {
                (format!("{samples} samples"), "give it 1, 2, 4, 8 or 16 samples")
            }
            Self::Samples { samples, max } => (format!("{samples} samples, the device allows 1 to {max}"), LIMIT),
            Self::Multisampled { samples, mips } => (
                format!("{samples} samples with {mips} levels"),
                "a multisampled texture has one level and two dimensions",
            ),
            Self::Volume { format } => {
                (format!("three dimensions of {format:?}"), "give a depth-stencil texture two dimensions, with layers")
            }
            Self::Crowd { parts, max } => (
                format!("with it, all resources have {parts} levels, layers and planes; {max} can be followed"),
                "give the textures fewer levels or layers",
            ),
        }
    }
}

/// Passes of a cycle that an error names at most.
const MOST_OF_A_CYCLE: usize = 12;

impl CompileReason {
    /// What is wrong, without names; and what to do about it, empty when the sentence says so already.
    fn words(&self) -> (String, &'static str) {
        let word = |access: &Option<AccessKind>| access.map_or("export", AccessKind::word);
        match self {
            Self::Declare(error) => (error.to_string(), ""),
            Self::ReadUnwritten { access, later_writer: None } => (
                format!("used as `{}`, but nobody writes all of it before", word(access)),
                "clear or overwrite it in an earlier pass, or import it with contents",
            ),
            Self::ReadUnwritten { access, later_writer: Some(pass) } => (
                format!("used as `{}`, but `{pass}`, which writes it, is declared later", word(access)),
                "declare the writer first",
            ),
            Self::TwoWriters { other } => (
                format!("`{other}` writes the same version"),
                "let the second pass modify the version that the first one wrote",
            ),
            Self::Cycle { passes } => (
                {
                    let shown = passes.iter().take(MOST_OF_A_CYCLE).map(|p| format!("`{p}`")).collect::<Vec<_>>();
                    let more = passes.len() - shown.len();
                    let more = if more == 0 { String::new() } else { format!(" and {more} more") };
                    format!("passes wait for each other: {}{more}", shown.join(" -> "))
                },
                "let one of them read a history or another texture, or take an `after` away that is not needed",
            ),
            Self::Samples { expected, found } => (
                match expected {
                    0 => format!("{found} sample is resolved, where several are needed"),
                    _ => format!("{found} samples where {expected} are needed"),
                },
                match expected {
                    0 => "give the attachment that is resolved 2, 4, 8 or 16 samples, or leave the resolve out",
                    _ => "give all attachments of a pass the same samples, and what is resolved into one",
                },
            ),
            Self::Extent { expected: [w, h, l], found: [x, y, m] } => (
                format!("{x}x{y} with {m} layers, where the other attachments have {w}x{h} with {l}"),
                "give all attachments of a pass the same size and layers",
            ),
            Self::Format { expected, found } => (
                format!("format {found:?} where {expected:?} is needed"),
                "give the target of a resolve the format of its samples, of depth with stencil that of the depth plane",
            ),
            Self::ClearValue { value, format } => {
                let value = match value {
                    ClearValue::DepthStencil(depth, stencil) => format!("depth {depth} and stencil {stencil}"),
                    ClearValue::Color(color) => format!("color {color:?}"),
                    ClearValue::Zero => "zero".into(),
                };
                let what = format.map_or("a buffer".into(), |format| format!("{format:?}"));
                let hint = match format {
                    None => "clear a buffer to zero",
                    Some(format) if format.is_depth_stencil() => {
                        "clear it to a depth from 0 to 1 and a stencil from 0 to 255, or to zero"
                    }
                    Some(_) => "clear it to a color whose channels its format holds, without NaN, or to zero",
                };
                (format!("cleared to {value}, which {what} does not hold"), hint)
            }
            Self::Shape(fault) => fault.words(),
            Self::Attachments { colors, bytes, max_colors, max_bytes } => (
                format!(
                    "{colors} color attachments of {bytes} bytes a sample, the device allows {max_colors} of {max_bytes}"
                ),
                "split the pass, or pack outputs into fewer or smaller attachments",
            ),
            Self::OutOfRange { mip } => (
                format!("level {mip} is asked of a texture that has fewer at this frame size"),
                "ask for levels and layers that there are",
            ),
            Self::NoSuchBytes { offset, bytes, size } => (
                format!("{bytes} bytes from {offset} on are asked of a buffer that has {size} at this frame size"),
                "ask for bytes that there are",
            ),
            Self::SampledDepth { access } => (
                format!("used as `{}` and as depth attachment at once, which the device cannot do", access.word()),
                "copy it before, or read it in a pass of its own",
            ),
            Self::TooManyPasses => ("the graph has more passes than can be numbered".into(), "split the graph"),
        }
    }

    /// What is wrong, without names.
    pub fn sentence(&self) -> String {
        self.words().0
    }

    /// What to do about it; empty when the sentence says so already.
    pub fn hint(&self) -> &'static str {
        self.words().1
    }
}

impl fmt::Display for CompileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { reason, pass, resource, location } = self;
        let whom = about(pass.as_ref().map(|p| p.name.as_str()), resource.as_ref().map(|r| r.name.as_str()));
        let (sentence, hint) = reason.words();
        let place = location.map(|l| format!(" (at {}:{})", l.file(), l.line())).unwrap_or_default();
        let hint = if hint.is_empty() { String::new() } else { format!("; {hint}") };
        f.write_str(&line(&format!("{whom}{sentence}{place}{hint}")))
    }
}

/// The errors of a graph, in the order of the passes: the first hundred, and how many more there are.
#[derive(Clone, Default, PartialEq, Eq)]
pub struct CompileErrors {
    /// The first hundred at most.
    pub listed: Vec<CompileError>,
    /// How many there are beside these.
    pub more: usize,
}

impl fmt::Debug for CompileErrors {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl fmt::Display for CompileErrors {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&capped::lines(&self.listed, self.more))
    }
}

impl fmt::Debug for CompileError {
    /// The sentence, since that is what an `unwrap` shows.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl std::error::Error for CompileError {}
impl std::error::Error for CompileErrors {}
