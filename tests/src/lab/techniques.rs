//! Techniques of the standard frame.

mod blending;
mod environment;
mod formulas;
mod lens;
mod light;
mod picture;
mod screen;
mod terms;

use super::studio::{Setup, Truth};
use super::technique::{Choice, Measured, Outcome, Subject, Technique};
use framegraph_passes::frame::tables::sections;
use framegraph_passes::gpu_scene::shadow_views::ShadowSettings;
use framegraph_passes::{FrameSettings, LightSearch, PostSettings, Quality, Settings};
use framegraph_wgpu::Gpu;

/// Returns all techniques. Half floats in shaders are included if the device supports them.
pub fn all(gpu: &Gpu) -> Vec<Technique> {
    let own = [
        light::techniques(gpu),
        environment::techniques(),
        terms::techniques(),
        screen::techniques(),
        blending::techniques(gpu),
        lens::techniques(),
    ];
    own.into_iter().flatten().chain(picture::techniques(gpu)).chain(formulas::techniques()).collect()
}

/// Returns the frame that options modify: high quality, one sample per pixel, no dithering, and no FXAA, which would
/// amplify differences at edges.
fn base(scene: &'static str) -> Setup {
    let post = PostSettings { dither: 0.0, ..PostSettings::DEFAULT };
    let settings = Settings { post, fxaa: false, shadows: Some(ShadowSettings::texels(1024)), ..Settings::default() };
    let mut light = Quality::High.light();
    light.image.cube_texels = 128;
    light.image.levels = 6;
    light.dfg.texels = 64;
    Setup { scene, ev100: 14.5, settings, light, lights: LightSearch::default(), sun: None }
}

/// Returns false, for options that presets do not distinguish.
fn nowhere(_: &FrameSettings) -> bool {
    false
}

/// Change of a frame.
enum Change {
    /// Options of the program `render`, such as `ao=gtao:slices=4`, separated by blanks.
    Options(&'static str),
    /// Function, for parts of a frame that no table has, such as the environment.
    Function(fn(&mut Setup)),
}

use Change::{Function, Options};

impl Change {
    fn apply(&self, setup: &mut Setup) {
        match self {
            Function(change) => change(setup),
            Options(text) => text.split(' ').filter(|text| !text.is_empty()).for_each(|text| set(setup, text)),
        }
    }
}

/// Sets an option of the program `render` in a frame, such as `ao=gtao`, or one setting of an effect, such as
/// `ao.radius=0.5`.
fn set(setup: &mut Setup, text: &str) {
    let (option, value) = text.split_once('=').unwrap_or((text, ""));
    let mut frame = FrameSettings { lights: setup.lights, settings: setup.settings, ..FrameSettings::DEFAULT };
    let changed = match option.split_once('.') {
        None => frame.set_option(option, value),
        Some((effect, key)) => {
            let section = sections().iter().find(|section| section.option == effect);
            let row = section.and_then(|section| section.rows.iter().find(|row| row.key == key));
            row.unwrap_or_else(|| panic!("{option} is no setting")).set(&mut frame, value)
        }
    };
    changed.unwrap_or_else(|error| panic!("{text}: {error}"));
    (setup.lights, setup.settings) = (frame.lights, frame.settings);
}

type IsIn = fn(&FrameSettings) -> bool;

/// Creates a technique whose options are compared as pictures.
fn pictures(name: &str, what: &str, truth: (&str, Truth), base: Setup, choices: &[(&str, Change, IsIn)]) -> Technique {
    let choice = |(name, change, is_in): &(&str, Change, IsIn)| {
        let mut setup = base;
        change.apply(&mut setup);
        Choice {
            name: (*name).to_owned(),
            subject: Subject::Picture,
            setup: Some(setup),
            functions: Vec::new(),
            is_in: *is_in,
        }
    };
    Technique {
        name: name.to_owned(),
        what: what.to_owned(),
        truth: truth.0.to_owned(),
        unit: "RMSE, 8-bit steps".to_owned(),
        picture: Some(truth.1),
        choices: choices.iter().map(choice).collect(),
    }
}

/// Creates a technique whose options are measured by functions.
fn formula(name: &str, what: &str, truth: &str, unit: &str, choices: Vec<Choice>) -> Technique {
    let [name, what, truth, unit] = [name, what, truth, unit].map(str::to_owned);
    Technique { name, what, truth, unit, picture: None, choices }
}

/// Creates an option that is measured by a function.
fn number(name: &str, measure: impl Fn(&Gpu) -> Outcome<Measured> + 'static) -> Choice {
    let subject = Subject::Formula(Box::new(measure));
    Choice { name: name.to_owned(), subject, setup: None, functions: Vec::new(), is_in: nowhere }
}

impl Choice {
    /// Adds a frame to time.
    fn timed(self, setup: Setup) -> Self {
        Self { setup: Some(setup), ..self }
    }

    /// Adds a function of the library whose operations are counted.
    fn counted(mut self, function: &'static str, in_half: bool) -> Self {
        self.functions.push((function, in_half));
        self
    }

    /// Adds the test for presets that use the option.
    fn found_in(self, is_in: IsIn) -> Self {
        Self { is_in, ..self }
    }
}
