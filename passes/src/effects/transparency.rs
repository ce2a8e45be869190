//! Blended surfaces in the right order, whatever the order of the draws.
//!
//! Sorting by object is wrong where surfaces cross, and where a surface lies in front of itself. [`Transparency`] has the
//! techniques that do without it:
//!
//! ```text
//! weighted: color (opaque) ─> weighted (sums) ──────────────────────────┐
//! moments:  color (opaque) ─> absorbance ─> shade (sums) ───────────────┼─> blended (over the radiance) ─> post
//! peeled:   color (opaque) ─> depth 1, layer 1 ─> depth 2, layer 2 ─> … ┘
//! ```
//!
//! Surfaces that transmit are drawn before, in their own passes ([`transmission`](crate::effects::transmission)): blended surfaces lie
//! over them where they are nearer, and are hidden by them where they are farther, as with sorted surfaces.
//! With several samples a texel, sums are kept for each sample.

mod composite;
mod keys;
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
