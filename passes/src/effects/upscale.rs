//! Upscaling: renders a frame at a lower resolution and enlarges the picture for display.
//!
//! The view's pictures have a percentage of the output's width and height ([`Upscale::extent`]). The last stage
//! enlarges the picture: bilinearly, or along edges with sharpening (FSR 1.0). The percentage may change every frame;
//! histories are read by texture coordinate and stay valid.

mod settings;
pub mod sharpen;

pub use settings::{Upscale, UpscaleFilter};

use crate::effects::upscale::sharpen::Sharpen;
use crate::program::full_screen::FullScreen;
use crate::program::{Interface, ProgramDesc, Programs};
use crate::stages::{Handles, Slot, StageError};
use framegraph::{DeclareError, Extent, Format, Intent, Pass, PassBuilder, Target, Texture, TextureDesc, View};
use framegraph_shaders::{Module, library};
use framegraph_wgpu::{Cx, Frame, Record, RecordError, SamplerDesc};

static SHADER: Module<'static> = library::pass("pass/upscale.wgsl").unwrap();

static INTERFACE: Interface = Interface { groups: &[&["picture", "picture_sampler"]], constants: &["DECODE"] };

/// Format of pictures between post-processing and upscaling: sRGB encoded, and filtered without decoding.
const ENCODED: Format = Format::Rgba8Unorm;

/// Enlarges a picture. Uses [`Programs`] of the world.
#[derive(Clone, Copy, Debug)]
pub struct Enlarge {
    /// Picture, sRGB encoded in a linear format.
    pub picture: Texture,
    /// Upscaling filter.
    pub filter: UpscaleFilter,
    /// Size of a new target.
    pub extent: Extent,
    /// Target. Colors are decoded for sRGB formats; a new texture is encoded like the picture.
    pub into: Target,
}

/// Handles of the pass.
#[derive(Clone, Copy, Debug)]
pub struct EnlargeIo {
    picture: View,
    /// The enlarged picture.
    pub output: Texture,
}

impl Pass for Enlarge {
    type Io = EnlargeIo;

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<EnlargeIo, DeclareError> {
        let picture = pass.sampled(self.picture)?;
        let into = pass.target(self.into, "upscaled", TextureDesc::new(self.extent, ENCODED));
        Ok(EnlargeIo { picture, output: pass.color(into, Intent::Overwrite)? })
    }
}

impl<W: AsRef<Programs> + ?Sized> Record<W> for Enlarge {
    fn record(&self, io: &EnlargeIo, world: &W, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        let decode = cx.targets().colors[0].is_some_and(Format::is_srgb);
        let provided = [cx.view(io.picture)?.into(), cx.sampler(SamplerDesc::LINEAR).into()].map(Some);
        let fragment = match self.filter {
            UpscaleFilter::Bilinear => "fs_bilinear",
            UpscaleFilter::Fsr => "fs_edges",
        };
        let program = ProgramDesc { fragment: Some(fragment), ..ProgramDesc::new(&SHADER, &INTERFACE) };
        let draw = FullScreen::new(program, &[]);
        FullScreen { constants: &[f64::from(decode)], groups: &[&provided], ..draw }.draw(world.as_ref(), cx)
    }
}

/// Returns the target for a stage before upscaling: encoded and of the view's size if upscaling follows, otherwise
/// [`Handles::target`].
pub(crate) fn encoded_target<W: ?Sized>(frame: &mut Frame<W>, handles: &Handles, upscale: Option<Upscale>) -> Target {
    match upscale {
        Some(_) => frame.graph_mut().texture("encoded", TextureDesc::new(handles.extent(), ENCODED)).into(),
        None => handles.target(),
    }
}

/// Declares upscaling of the encoded [`Slot::PICTURE`] to the frame's size, and sharpening if enabled.
///
/// # Errors
/// Returns the error of a refused pass.
pub fn enlarge<W>(frame: &mut Frame<W>, handles: &mut Handles, settings: &Upscale) -> Result<(), StageError>
where
    W: AsRef<Programs> + ?Sized,
{
    let Upscale { filter, sharpness, .. } = *settings;
    let sharpens = sharpness > 0.0;
    let into = if sharpens { Target::New } else { handles.target() };
    let pass = Enlarge { picture: handles.get(Slot::PICTURE)?, filter, extent: Extent::FRAME, into };
    let mut picture = frame.add("upscale", pass)?.output;
    if sharpens {
        let pass = Sharpen { picture, into: handles.target(), sharpness };
        picture = frame.add("upscale_sharpen", pass)?.sharp;
    }
    handles.set(Slot::PICTURE, picture);
    Ok(())
}
