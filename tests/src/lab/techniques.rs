//! The choices of the standard frame, as techniques of the lab.

mod blending;
mod formulas;
mod lens;
mod light;
mod picture;
mod screen;
mod terms;

use super::studio::{Setup, Truth};
use super::technique::{Choice, Measured, Outcome, Subject, Technique};
use framegraph_passes::shadow::ShadowSettings;
use framegraph_passes::{FrameSettings, LightSearch, PostSettings, Quality, Settings};
use framegraph_wgpu::Gpu;

/// All of them. Half floats in shaders are measured where the device has them.
pub fn all(gpu: &Gpu) -> Vec<Technique> {
    let own = [
        light::techniques(gpu),
        terms::techniques(),
        screen::techniques(),
        blending::techniques(gpu),
        lens::techniques(),
    ];
    own.into_iter().flatten().chain(picture::techniques(gpu)).chain(formulas::techniques()).collect()
}

/// The frame that choices vary: high quality, one sample, no dither and no edge filter, which would make an edge more or less
/// of a code of difference.
fn base(scene: &'static str) -> Setup {
    let post = PostSettings { dither: 0.0, ..PostSettings::DEFAULT };
    let settings = Settings { post, fxaa: false, shadows: Some(ShadowSettings::texels(1024)), ..Settings::default() };
    let mut light = Quality::High.light();
    light.image.cube_texels = 128;
    light.image.levels = 6;
    light.dfg.texels = 64;
    Setup { scene, ev100: 14.5, settings, light, lights: LightSearch::default(), sun: None }
}

/// For choices that no preset is told by.
fn nowhere(_: &FrameSettings) -> bool {
    false
}

type Change = fn(&mut Setup);
type IsIn = fn(&FrameSettings) -> bool;

/// A technique whose options are frames, compared as pictures.
fn pictures(name: &str, what: &str, truth: (&str, Truth), base: Setup, choices: &[(&str, Change, IsIn)]) -> Technique {
    let choice = |(name, change, is_in): &(&str, Change, IsIn)| {
        let mut setup = base;
        change(&mut setup);
        Choice {
            name: (*name).to_owned(),
            subject: Subject::Picture,
            setup: Some(setup),
            function: None,
            is_in: *is_in,
        }
    };
    Technique {
        name: name.to_owned(),
        what: what.to_owned(),
        truth: truth.0.to_owned(),
        unit: "RMSE in codes".to_owned(),
        picture: Some(truth.1),
        choices: choices.iter().map(choice).collect(),
    }
}

/// A technique whose options have numbers of their own.
fn formula(name: &str, what: &str, truth: &str, unit: &str, choices: Vec<Choice>) -> Technique {
    let [name, what, truth, unit] = [name, what, truth, unit].map(str::to_owned);
    Technique { name, what, truth, unit, picture: None, choices }
}

/// One of them.
fn number(name: &str, measure: impl Fn(&Gpu) -> Outcome<Measured> + 'static) -> Choice {
    let subject = Subject::Formula(Box::new(measure));
    Choice { name: name.to_owned(), subject, setup: None, function: None, is_in: nowhere }
}

impl Choice {
    /// With a frame that is timed.
    fn timed(self, setup: Setup) -> Self {
        Self { setup: Some(setup), ..self }
    }

    /// With a function of the library whose operations are counted.
    fn counted(self, function: &'static str, in_half: bool) -> Self {
        Self { function: Some((function, in_half)), ..self }
    }

    /// With the presets that have it.
    fn found_in(self, is_in: IsIn) -> Self {
        Self { is_in, ..self }
    }
}
