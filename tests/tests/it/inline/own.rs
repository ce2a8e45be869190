//! Point-wise passes of an application, inlined together with those of the standard frame.

use super::{TestResult, differing, rounding_of};
use crate::stage::{Set, Shot, gpu};
use framegraph::{DeclareError, Extent, Format, Intent, Pass, PassBuilder, Target, Texture, TextureDesc, View};
use framegraph_passes::effects::color::Color;
use framegraph_passes::effects::depth::prepass::Prepass;
use framegraph_passes::effects::post::Post;
use framegraph_passes::effects::post::pixel_effects;
use framegraph_passes::gpu_scene::view::Background;
use framegraph_passes::program::full_screen::FullScreen;
use framegraph_passes::program::{Interface, ProgramDesc, Programs};
use framegraph_passes::{Settings, World};
use framegraph_shaders::{Module, library};
use framegraph_wgpu::Effect;
use framegraph_wgpu::{Cx, Epilogue, RecordError, Rounding, SettingName, StoreRounding};
use framegraph_wgpu::{Frame, Record};

static POST: Module<'static> = library::pass("pass/post.wgsl").unwrap();

/// An effect that lifts black and turns everything brown, unlike any scene.
const SEPIA: Effect = Effect {
    name: "sepia",
    wgsl: "import package::lib::luminance::luminance;\n\
           override SEPIA_LIFT: f32 = 0.0;\n\
           fn sepia(color: vec4<f32>, pixel: vec2<f32>) -> vec4<f32> {\n    \
               let grey = luminance(color.rgb) + SEPIA_LIFT;\n    \
               return vec4<f32>(grey * vec3<f32>(1.0, 0.8, 0.5), color.a);\n}\n",
};

/// Description of the effect that a pass provides for inlining.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Says {
    /// The complete effect.
    All,
    /// An effect that does nothing, as a negative control.
    Nothing,
    /// No description.
    No,
}

struct Sepia {
    hdr: Texture,
    says: Says,
    stored: Option<StoreRounding>,
}

impl Sepia {
    fn effects(&self) -> Epilogue {
        Epilogue { effects: vec![SEPIA], constants: vec![(SettingName::new("SEPIA_LIFT"), 0.25)], bindings: Vec::new() }
    }
}

impl Pass for Sepia {
    type Io = (View, Texture);

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<Self::Io, DeclareError> {
        pass.pointwise();
        let hdr = pass.same_pixel(self.hdr)?;
        let brown = pass.texture("brown", TextureDesc::new(Extent::FRAME, Format::Rgba16Float));
        Ok((hdr, pass.color(brown, Intent::Overwrite)?))
    }
}

/// Resources that the pass provides to its shader.
static INTERFACE: Interface = Interface { groups: &[&["hdr"]], constants: &[] };

impl<W: AsRef<Programs>> Record<W> for Sepia {
    fn record(&self, (hdr, _): &Self::Io, world: &W, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        let epilogue = self.effects();
        let program = ProgramDesc { epilogue: &epilogue, ..ProgramDesc::new(&POST, &INTERFACE) };
        let draw = FullScreen::new(program, &[]);
        FullScreen { constants: &[0.25], groups: &[&[Some(cx.view(*hdr)?.into())]], ..draw }.draw(world.as_ref(), cx)
    }

    fn epilogue(&self, _: &Self::Io, _: &W, _: &mut Cx<'_>) -> Result<Option<Epilogue>, RecordError> {
        let mut all = Epilogue::default();
        if let Some(stored) = self.stored {
            let zero = f64::from(u8::from(stored.rgba16float == Rounding::TowardZero));
            all.effects.push(pixel_effects::STORE_RGBA16FLOAT);
            all.constants.push((SettingName::new("RGBA16FLOAT_TOWARD_ZERO"), zero));
        }
        match self.says {
            Says::All => all.append(&self.effects())?,
            Says::Nothing => {}
            Says::No => return Ok(None),
        }
        Ok(Some(all))
    }
}

/// Declares prepass, color, sepia and post-processing.
fn declared(settings: &Settings, says: Says) -> Result<(Frame<World>, Texture), DeclareError> {
    let Settings { samples, stored, .. } = *settings;
    let mut frame = Frame::new();
    let depth = frame.add("prepass", Prepass { samples, ..Prepass::default() })?;
    let color = Color { samples, ..Color::new(depth) };
    let hdr = frame.add("color", color)?.hdr;
    let hdr = frame.add("sepia", Sepia { hdr, says, stored })?.1;
    let post =
        Post { hdr, bloom: None, into: Target::New, settings: settings.post, only: None, for_fxaa: false, stored };
    let output = frame.add("post", post)?.ldr;
    frame.graph_mut().readback(output)?;
    Ok((frame, output))
}

#[test]
fn a_pass_of_ones_own_is_inlined_like_any_other() -> TestResult {
    let Some(gpu) = gpu("a_pass_of_ones_own_is_inlined_like_any_other") else { return Ok(()) };
    let settings = Settings { shadows: None, stored: Some(rounding_of(&gpu)?), ..Settings::default() };
    let shot = Shot::small(settings);
    let set = Set::new(&gpu, "spheres", &shot, &Background::None)?;
    let render = |says, inline| {
        let (frame, output) = declared(&settings, says)?;
        set.render(&gpu, &frame, output, &framegraph::Options { inline, ..shot.options })
    };
    let ((inlined, plan), (expected, two)) = (render(Says::All, true)?, render(Says::All, false)?);
    assert_eq!((plan.counts().inlined, plan.counts().steps), (2, 1));
    assert_eq!((two.counts().inlined, two.counts().steps), (0, 3));
    assert_eq!(differing(&inlined, &expected), 0);
    // The clear value also went through the effect, so the background is not black.
    assert!(inlined.chunks_exact(4).all(|texel| texel[0] > 50), "a texel is as dark as the clear value");

    // Negative control: a missing effect changes every texel.
    let (forgetful, _) = render(Says::Nothing, true)?;
    assert_eq!(differing(&forgetful, &expected), forgetful.len() / 4);
    Ok(())
}

#[test]
fn a_pass_that_does_not_say_what_it_does_is_an_error_with_its_name() -> TestResult {
    let Some(gpu) = gpu("a_pass_that_does_not_say_what_it_does_is_an_error_with_its_name") else { return Ok(()) };
    let settings = Settings { shadows: None, ..Settings::default() };
    let shot = Shot::small(settings);
    let set = Set::new(&gpu, "spheres", &shot, &Background::None)?;
    let (frame, output) = declared(&settings, Says::No)?;
    let told = set.render(&gpu, &frame, output, &shot.options).map(|_| ()).map_err(|e| e.to_string());
    let told = told.err().unwrap_or_default();
    assert!(told.contains("`color`") && told.contains("`sepia`") && told.contains("Record::epilogue"), "{told}");
    Ok(())
}
