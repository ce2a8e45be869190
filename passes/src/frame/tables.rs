//! All tables of settings, as one list of sections for files, documents and panels.

use crate::effects::bloom::BloomSettings;
use crate::effects::dof::DofSettings;
use crate::effects::fog::FogSettings;
use crate::effects::occlusion::OcclusionSettings;
use crate::effects::post::PostSettings;
use crate::effects::reflection::ReflectionSettings;
use crate::effects::taa::TaaSettings;
use crate::effects::transparency::Transparency;
use crate::effects::upscale::Upscale;
use crate::frame::Settings;
use crate::frame::frame_settings::FrameSettings;
use crate::gpu_scene::punctual::LightSearch;
use crate::gpu_scene::shadow_views::ShadowSettings;
use crate::grading::Look;
use crate::light::shading::Shading;
use crate::settings::field::Field;
use crate::settings::key_value::OptionError;
use crate::settings::table::{SettingsTable, with_field};
use framegraph_shaders::layout::EdgeFade;
use std::sync::LazyLock;

/// Settings of an effect, for any type of settings.
pub struct Section {
    /// Option of `render`, such as `ao`; empty if several options set the fields.
    pub option: &'static str,
    /// Path in settings files, such as `settings.occlusion`; empty for the frame.
    pub path: &'static str,
    /// Noun phrase that describes the effect.
    pub about: &'static str,
    /// Names of the methods of the effect.
    pub methods: Vec<&'static str>,
    /// Fields of the effect.
    pub rows: Vec<Row>,
    choose: Choose,
}

type Choose = Box<dyn Fn(&mut FrameSettings, &str) + Send + Sync>;
type SetRow = Box<dyn Fn(&mut FrameSettings, &str) -> Result<(), OptionError> + Send + Sync>;
type CheckRow = Box<dyn Fn(&FrameSettings) -> Option<(String, String)> + Send + Sync>;

/// Field of an effect, for any type of settings.
pub struct Row {
    /// Key in options.
    pub key: &'static str,
    /// Path in settings files, such as `settings.occlusion.radius_m`; empty for presets.
    pub path: String,
    /// Effect of the setting.
    pub about: &'static str,
    /// Description of the accepted values, in the syntax of options.
    pub takes: String,
    /// Value by default, in the syntax of options.
    pub default: String,
    /// Texts of values that exclude each other, one for each variant; none for numbers and switches.
    pub alternatives: Vec<String>,
    /// Range of a number as stored.
    pub range: Option<[f64; 2]>,
    /// Default frame with the effect and the field.
    pub frame: FrameSettings,
    set: SetRow,
    check: CheckRow,
}

impl Section {
    /// Enables the effect with the defaults of a method.
    pub fn choose(&self, frame: &mut FrameSettings, method: &str) {
        (self.choose)(frame, method);
    }
}

impl Row {
    /// Sets the value in a frame from text.
    ///
    /// # Errors
    /// Fails for an invalid value, or if the frame lacks the field; the message names the accepted values.
    pub fn set(&self, frame: &mut FrameSettings, text: &str) -> Result<(), OptionError> {
        (self.set)(frame, text)
    }

    /// Returns the invalid value of a frame and the accepted ones; `None` if the value is valid or absent.
    pub fn wrong(&self, frame: &FrameSettings) -> Option<(String, String)> {
        (self.check)(frame)
    }

    /// Returns the unit of the number, from the end of its path; empty for none.
    pub fn unit(&self) -> &'static str {
        match self.path.rsplit('_').next() {
            Some("m") => "m",
            Some("px") => "px",
            Some("texels") => "texels",
            Some("ev") => "EV",
            Some("rad") => "rad",
            _ => "",
        }
    }
}

/// Returns the settings of all effects.
pub fn sections() -> &'static [Section] {
    static ALL: LazyLock<Vec<Section>> = LazyLock::new(|| {
        vec![
            section::<FrameSettings>(|f| Some(f), |f, s| *f = s),
            section::<LightSearch>(|f| Some(&mut f.lights), |f, s| f.lights = s),
            section::<Settings>(|f| Some(&mut f.settings), |f, s| f.settings = s),
            section::<Shading>(|f| Some(&mut f.settings.shading), |f, s| f.settings.shading = s),
            section::<ShadowSettings>(|f| f.settings.shadows.as_mut(), |f, s| f.settings.shadows = Some(s)),
            section::<OcclusionSettings>(|f| f.settings.occlusion.as_mut(), |f, s| f.settings.occlusion = Some(s)),
            section::<ReflectionSettings>(|f| f.settings.reflections.as_mut(), |f, s| f.settings.reflections = Some(s)),
            section::<TaaSettings>(|f| f.settings.taa.as_mut(), |f, s| f.settings.taa = Some(s)),
            section::<Upscale>(|f| f.settings.upscale.as_mut(), |f, s| f.settings.upscale = Some(s)),
            section::<FogSettings>(|f| f.settings.fog.as_mut(), |f, s| f.settings.fog = Some(s)),
            section::<DofSettings>(|f| f.settings.dof.as_mut(), |f, s| f.settings.dof = Some(s)),
            section::<BloomSettings>(|f| f.settings.bloom.as_mut(), |f, s| f.settings.bloom = Some(s)),
            section::<Transparency>(|f| Some(&mut f.settings.transparency), |f, s| f.settings.transparency = s),
            section::<PostSettings>(|f| Some(&mut f.settings.post), |f, s| f.settings.post = s),
            section::<EdgeFade>(|f| f.settings.post.edge_fade.as_mut(), |f, s| f.settings.post.edge_fade = Some(s)),
            section::<Look>(|f| Some(&mut f.settings.post.look), |f, s| f.settings.post.look = s),
        ]
    });
    &ALL
}

type At<S> = fn(&mut FrameSettings) -> Option<&mut S>;

fn section<S: SettingsTable>(at: At<S>, put: fn(&mut FrameSettings, S)) -> Section {
    let choose: Choose = Box::new(move |frame, method| {
        if let Some((_, settings)) = S::METHODS.iter().find(|(name, _)| *name == method) {
            put(frame, *settings);
        }
    });
    Section {
        option: S::OPTION,
        path: S::PATH,
        about: S::ABOUT,
        methods: S::METHODS.iter().map(|(name, _)| *name).collect(),
        rows: S::FIELDS.iter().map(|field| row(field, at, put)).collect(),
        choose,
    }
}

fn row<S: SettingsTable>(field: &'static Field<S>, at: At<S>, put: fn(&mut FrameSettings, S)) -> Row {
    let path = match (S::PATH, field.path) {
        (_, "") => String::new(),
        ("", own) => own.to_owned(),
        (effect, own) => format!("{effect}.{own}"),
    };
    let of = with_field(field);
    let mut frame = FrameSettings::DEFAULT;
    put(&mut frame, of);
    Row {
        key: field.key,
        path,
        about: field.about,
        takes: field.takes(&of),
        default: field.shown(&of).unwrap_or_default(),
        alternatives: field.alternatives(&of),
        range: field.range(&of),
        frame,
        set: Box::new(move |frame, text| at(frame).map_or(Ok(()), |settings| field.set(settings, text))),
        check: Box::new(move |frame| at(&mut { *frame }).and_then(|settings| field.wrong(settings))),
    }
}
