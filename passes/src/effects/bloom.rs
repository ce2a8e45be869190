//! Bloom and lens flare: light that a lens scatters from bright parts of the picture.
//!
//! ```text
//! hdr ─> bloom_first ─> bloom_down 1 ─> bloom_down 2 ─> … ─> bloom_up … ─> bloom_up 0 ─┐
//!  │          └─> flare ─> flare_blur (across) ─> flare_blur (down) ───────────────────┼─> post
//!  └───────────────────────────────────────────────────────────────────────────────────┘
//! ```
//!
//! The first pass selects bright parts and discards NaN and infinity. Each further pass halves the size, and on the way
//! back all levels are summed. Post-processing adds the sum to the radiance at other pixels too, so it is not inlined
//! into the color pass. Filters and order are Filament's; `docs/design/lens.md` has the errors.

mod chain;
mod flare;
mod pass;
mod settings;

pub use chain::BloomChain;
pub use flare::{Flare, FlareBlur, FlareBlurIo, FlareIo};
pub use pass::{BloomDown, BloomFirst, BloomIo, BloomMix, BloomUp, BloomUpIo};
pub use settings::{Blend, BloomQuality, BloomSettings, FlareSettings, FlareSpan, Threshold};

use crate::effects::occlusion::Axis;
use crate::gpu_scene::view::Views;
use crate::program::Programs;
use crate::stages::{Handles, Slot, StageError};
use framegraph_wgpu::Frame;

/// Declares bloom for a picture of `size_texels`, with lens flare if enabled; sets [`Slot::BLOOM`] and [`Slot::FLARE`].
///
/// # Errors
/// Returns the error of a refused pass.
pub fn bloom<W>(
    frame: &mut Frame<W>,
    handles: &mut Handles,
    settings: &BloomSettings,
    size_texels: [u32; 2],
) -> Result<(), StageError>
where
    W: AsRef<Programs> + AsRef<Views> + ?Sized,
{
    let (view, hdr) = (handles.view(), handles.get(Slot::HDR)?);
    let chain = BloomChain::new(settings, size_texels);
    frame.scope("bloom", |frame| {
        let mut source = hdr;
        for (index, size) in chain.halves.iter().enumerate() {
            let pass = BloomFirst { source, size: *size, levels: 1, settings: *settings, sifts: index == 0 };
            source = frame.add("half", pass)?.glow;
        }
        let sifts = chain.halves.is_empty();
        let pass = BloomFirst { source, size: chain.size, levels: chain.levels, settings: *settings, sifts };
        let mut glow = frame.add("first", pass)?.glow;
        for level in 1..chain.levels {
            let odd = chain.level_size(level - 1).iter().any(|side| side % 2 == 1);
            glow = frame.add("down", BloomDown { glow, level, odd })?.glow;
        }
        if let Some(flare) = settings.flare.filter(FlareSettings::is_seen) {
            let span = FlareSpan::new(&flare, size_texels, settings.multiple_px);
            let made = frame.add("flare", Flare { glow, size: chain.size, settings: flare, span })?.flare;
            let across = FlareBlur { view, flare: made, axis: Axis::Across, rays: false, span };
            let across = frame.add("flare_blur", across)?.blurred;
            let down = FlareBlur { view, flare: across, axis: Axis::Down, rays: flare.starburst, span };
            handles.set(Slot::FLARE, frame.add("flare_blur", down)?.blurred);
        }
        let mut sum = None;
        for level in (0..chain.levels - 1).rev() {
            let (size, levels, narrow) = (chain.size, chain.levels - 1, settings.narrow);
            sum = Some(frame.add("up", BloomUp { glow, sum, level, levels, size, narrow })?.sum);
        }
        handles.set(Slot::BLOOM, sum.unwrap_or(glow));
        Ok(())
    })
}
