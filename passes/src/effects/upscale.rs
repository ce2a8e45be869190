//! Upscaling: a frame that is drawn smaller than it is shown, made as large as it is shown.
//!
//! The view's pictures are of a share of the output's width and height ([`Upscale::extent`]); all stages draw so many texels, and
//! the last makes the picture larger: bilinearly, or along its edges and then sharpened (FSR 1.0). The share may change from frame
//! to frame: histories are read by coordinate and go on.

mod dynamic;
mod settings;
pub mod sharpen;

pub use dynamic::DynamicResolution;
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

/// Format of pictures between post-processing and upscaling: encoded codes, which are filtered as they are.
const ENCODED: Format = Format::Rgba8Unorm;

/// Makes a picture larger. Needs no more of the world than [`Programs`].
#[derive(Clone, Copy, Debug)]
pub struct Enlarge {
    /// The picture, sRGB encoded in a linear format.
    pub picture: Texture,
    /// How.
    pub filter: UpscaleFilter,
    /// Size of a new picture.
    pub extent: Extent,
    /// Where the result goes; into an sRGB format it is decoded. A new one is encoded as the picture is.
    pub into: Target,
}

/// What the pass reads and wrote.
#[derive(Clone, Copy, Debug)]
pub struct EnlargeIo {
    picture: View,
    /// The larger picture.
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

/// Where a stage before puts its picture: encoded and of the view's size where upscaling comes, else in the stage's target.
pub(crate) fn encoded_target<W: ?Sized + 'static>(
    frame: &mut Frame<W>,
    handles: &Handles,
    upscale: Option<Upscale>,
) -> Target {
    match upscale {
        Some(_) => frame.graph_mut().texture("encoded", TextureDesc::new(handles.extent(), ENCODED)).into(),
        None => handles.target(),
    }
}

/// Declares upscaling of [`Slot::PICTURE`], encoded, to the frame's size, and sharpening where it is asked for.
///
/// # Errors
/// What a pass refuses.
pub fn enlarge<W>(frame: &mut Frame<W>, handles: &mut Handles, settings: &Upscale) -> Result<(), StageError>
where
    W: AsRef<Programs> + ?Sized + 'static,
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
