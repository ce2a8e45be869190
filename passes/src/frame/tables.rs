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
use crate::settings::table::{SettingsTable, method, unknown, with_field};
use At::{Always, Optional};
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
    /// True if the effect can be off.
    pub is_optional: bool,
    take: Set,
}

type Set = Box<dyn Fn(&mut FrameSettings, &str) -> Result<(), OptionError> + Send + Sync>;
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
    set: Set,
    check: CheckRow,
}

impl Section {
    /// Sets the effect from text: `off`, a method with changes, such as `gtao:slices=4`, or changes alone if the effect
    /// has no methods.
    ///
    /// # Errors
    /// Fails for an unknown method or key, or an invalid value; the message names the accepted ones.
    pub fn take(&self, frame: &mut FrameSettings, text: &str) -> Result<(), OptionError> {
        (self.take)(frame, text)
    }
}

impl FrameSettings {
    /// Sets an effect by its option, such as `ao` to `gtao:slices=4`, or a field of the frame by its key, such as `msaa`
    /// to `4`. The texts are those of settings tables ([`sections`]). A field of an effect without an option turns the effect
    /// on, with its defaults.
    ///
    /// # Errors
    /// Fails for an unknown option or an invalid value; the message names the accepted ones.
    pub fn set_option(&mut self, option: &str, text: &str) -> Result<(), OptionError> {
        if let Some(section) = sections().iter().find(|section| !option.is_empty() && section.option == option) {
            return section.take(self, text);
        }
        let rows = sections().iter().filter(|section| section.option.is_empty()).flat_map(|section| &section.rows);
        match rows.clone().find(|row| row.key == option) {
            Some(row) => row.set(self, text),
            None => {
                let options = sections().iter().map(|section| section.option);
                Err(unknown(option, options.filter(|option| !option.is_empty()).chain(rows.map(|row| row.key))))
            }
        }
    }
}

impl Row {
    /// Sets the value in a frame from text. An effect that is off is turned on, with its defaults.
    ///
    /// # Errors
    /// Fails for an invalid value; the message names the accepted ones.
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
            section::<FrameSettings>(Always(|f| f)),
            section::<LightSearch>(Always(|f| &mut f.lights)),
            section::<Settings>(Always(|f| &mut f.settings)),
            section::<Shading>(Always(|f| &mut f.settings.shading)),
            section::<ShadowSettings>(Optional(|f| &mut f.settings.shadows)),
            section::<OcclusionSettings>(Optional(|f| &mut f.settings.occlusion)),
            section::<ReflectionSettings>(Optional(|f| &mut f.settings.reflections)),
            section::<TaaSettings>(Optional(|f| &mut f.settings.taa)),
            section::<Upscale>(Optional(|f| &mut f.settings.upscale)),
            section::<FogSettings>(Optional(|f| &mut f.settings.fog)),
            section::<DofSettings>(Optional(|f| &mut f.settings.dof)),
            section::<BloomSettings>(Optional(|f| &mut f.settings.bloom)),
            section::<Transparency>(Always(|f| &mut f.settings.transparency)),
            section::<PostSettings>(Always(|f| &mut f.settings.post)),
            section::<EdgeFade>(Optional(|f| &mut f.settings.post.edge_fade)),
            section::<Look>(Always(|f| &mut f.settings.post.look)),
        ]
    });
    &ALL
}

/// Place of the settings of an effect.
#[derive(Clone, Copy)]
enum At<S> {
    Always(fn(&mut FrameSettings) -> &mut S),
    Optional(fn(&mut FrameSettings) -> &mut Option<S>),
}

impl<S: SettingsTable> At<S> {
    fn find(self, frame: &mut FrameSettings) -> Option<&mut S> {
        match self {
            Always(at) => Some(at(frame)),
            Optional(at) => at(frame).as_mut(),
        }
    }

    fn put(self, frame: &mut FrameSettings, settings: S) {
        match self {
            Always(at) => *at(frame) = settings,
            Optional(at) => *at(frame) = Some(settings),
        }
    }

    fn take(self, frame: &mut FrameSettings, text: &str) -> Result<(), OptionError> {
        match self {
            Optional(at) if text == "off" => *at(frame) = None,
            _ if S::METHODS.is_empty() => {
                let mut settings = self.find(frame).map_or(S::DEFAULT, |own| *own);
                settings.set_all(text)?;
                self.put(frame, settings);
            }
            Optional(_) => self.put(frame, method(text, &["off"])?),
            Always(_) => self.put(frame, method(text, &[])?),
        }
        Ok(())
    }
}

fn section<S: SettingsTable>(at: At<S>) -> Section {
    Section {
        option: S::OPTION,
        path: S::PATH,
        about: S::ABOUT,
        methods: S::METHODS.iter().map(|(name, _)| *name).collect(),
        rows: S::FIELDS.iter().map(|field| row(field, at)).collect(),
        is_optional: matches!(at, Optional(_)),
        take: Box::new(move |frame, text| at.take(frame, text)),
    }
}

fn row<S: SettingsTable>(field: &'static Field<S>, at: At<S>) -> Row {
    let path = match (S::PATH, field.path) {
        (_, "") => String::new(),
        ("", own) => own.to_owned(),
        (effect, own) => format!("{effect}.{own}"),
    };
    let of = with_field(field);
    let mut frame = FrameSettings::DEFAULT;
    at.put(&mut frame, of);
    Row {
        key: field.key,
        path,
        about: field.about,
        takes: field.takes(&of),
        default: field.shown(&of).unwrap_or_default(),
        alternatives: field.alternatives(&of),
        range: field.range(&of),
        frame,
        set: Box::new(move |frame, text| {
            let mut own = at.find(frame).map_or(S::DEFAULT, |own| *own);
            field.set(&mut own, text)?;
            at.put(frame, own);
            Ok(())
        }),
        check: Box::new(move |frame| at.find(&mut { *frame }).and_then(|settings| field.wrong(settings))),
    }
}
