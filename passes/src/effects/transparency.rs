//! Order-independent transparency.
//!
//! Sorting by object is wrong for intersecting surfaces, and for a surface in front of itself. [`Transparency`] lists
//! techniques that need no sorting:
//!
//! ```text
//! weighted: color (opaque) ─> weighted (sums) ──────────────────────────┐
//! moments:  color (opaque) ─> absorbance ─> shade (sums) ───────────────┼─> blended (over the radiance) ─> post
//! peeled:   color (opaque) ─> depth 1, layer 1 ─> depth 2, layer 2 ─> … ┘
//! ```
//!
//! Transmissive surfaces are drawn earlier, in their own passes ([`transmission`](crate::effects::transmission)).
//! Blended surfaces cover farther ones and are hidden by nearer ones, as with sorting. With several samples per texel,
//! sums are kept per sample.

mod composite;
mod moments;
mod peeling;
mod settings;
mod sorted;
mod surfaces;
mod weighted;

pub use composite::{BlendedComposite, BlendedCompositeIo, BlendedSums};
pub use moments::{Absorbance, AbsorbanceIo, AbsorbanceSums, MomentShade, MomentShadeIo};
pub use peeling::{PeelDepth, PeelDepthIo, PeelLayer, PeelLayerIo};
pub use settings::{MAX_PEEL_LAYERS, MomentPrecision, MomentTransparency, Transparency};
pub(crate) use sorted::draw_sorted;
pub use surfaces::BlendedSurfaces;
pub use weighted::{Weighted, WeightedIo};
