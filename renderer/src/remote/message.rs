//! Messages of the protocol.

use framegraph::{Aspect, Caps, Format, Options};
use serde::{Deserialize, Serialize};

/// Message of an engine.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum FromEngine {
    /// First message of an accepted connection.
    Welcome {
        /// Name of the engine.
        engine: String,
    },
    /// First message of a refused connection, or last message before the engine closes it.
    Refused {
        /// Reason.
        reason: String,
    },
    /// The running plan, after each change.
    Plan(Box<RemotePlan>),
    /// Times of a frame.
    Times(FrameSample),
    /// Answer to a [`TextureRequest`].
    Texture(RemoteTexture),
}

/// Message of a viewer.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum FromViewer {
    /// Requests a texture. A newer request replaces one that is not yet answered.
    Texture(TextureRequest),
}

/// Running plan with everything that a viewer needs to compile other plans of the frame.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RemotePlan {
    /// Number of the compilation ([`framegraph::Plan::compilation`]).
    pub compilation: u64,
    /// JSON form of the plan ([`framegraph::dump::json`]).
    pub json: String,
    /// Declared graph as a file ([`framegraph::file::to_ron`]).
    pub graph: String,
    /// Capabilities of the device.
    pub caps: Caps,
    /// Options of the compiler.
    pub options: Options,
    /// Source location of each pass, in the order of declaration.
    pub declared_at: Vec<String>,
}

/// Times of one frame in milliseconds: the most recent measurements when the frame ended.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FrameSample {
    /// Number of the frame since the server was started.
    pub frame: u64,
    /// Number of the compilation of the frame's plan.
    pub compilation: u64,
    /// CPU time of the frame from resource creation until submission.
    pub cpu_ms: Option<f64>,
    /// GPU time of the frame.
    pub gpu_ms: Option<f64>,
    /// Times of each step of the plan.
    pub steps: Vec<StepSample>,
}

/// Most recent times of one step in milliseconds; `None` if not measured.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StepSample {
    /// CPU time of recording.
    pub cpu_ms: Option<f64>,
    /// GPU time.
    pub gpu_ms: Option<f64>,
}

/// Part of a texture to read.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct TextureRequest {
    /// Number that the answer repeats.
    pub number: u32,
    /// Texture, version, mip level and layer in the text form of [`Request`](crate::inspect::Request).
    pub text: String,
    /// Plane of a depth-stencil texture.
    pub aspect: Aspect,
    /// Sample of a multisampled texture; `None` for the average.
    pub sample: Option<u8>,
}

/// Answer to a [`TextureRequest`].
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct RemoteTexture {
    /// Number of the request.
    pub number: u32,
    /// Title such as `hdr@color, level 2`; the reason if the texture cannot be read.
    pub title: Result<String, String>,
    /// Format of the texture.
    pub format: Format,
    /// Plane of a depth-stencil texture; `All` for color.
    pub aspect: Aspect,
    /// Width and height in texels.
    pub size: [u32; 2],
    /// Four channels per texel, 32 bits each, little-endian ([`Texels::bits`](crate::inspect::Texels::bits)).
    pub bits: Vec<u8>,
}

impl RemoteTexture {
    /// Returns an answer that reports an error.
    pub(super) fn failed(number: u32, reason: String) -> Self {
        let (format, aspect) = (Format::Rgba8Unorm, Aspect::All);
        Self { number, title: Err(reason), format, aspect, size: [0; 2], bits: Vec::new() }
    }

    /// Returns the texels; `None` if their number does not match the size.
    pub fn texels(&self) -> Option<crate::inspect::Texels> {
        let Self { format, aspect, size, .. } = *self;
        let count = u64::from(size[0]).checked_mul(u64::from(size[1]))?.checked_mul(16)?;
        let words = self.bits.as_chunks::<4>().0.iter().map(|bytes| u32::from_le_bytes(*bytes)).collect::<Vec<_>>();
        let bits = words.as_chunks::<4>().0.to_vec();
        let fits = count == self.bits.len() as u64 && count > 0;
        fits.then_some(crate::inspect::Texels { format, aspect, size, bits })
    }
}
