//! Options of the animation and its time.

use framegraph_scene::Scene;
use program::clap::Arg;
use program::cli::{Item, option};

/// Declares the options of this module.
pub fn options() -> Vec<Arg> {
    let all = vec![
        option(
            "time",
            "S",
            "Time of the animation in seconds; it repeats. Animates nodes, skins, morph targets, lights and cameras \
             on nodes, and the targets of KHR_animation_pointer",
        ),
        option("animation", "NAME", "Animation by name or index (0)"),
    ];
    all.into_iter().map(|option| option.help_heading("Animation")).collect()
}

/// Animation and its time.
#[derive(Clone, Debug, Default)]
pub struct AnimationTime {
    /// Time in seconds; `None` for the rest pose.
    time_s: Option<f64>,
    animation: Option<String>,
}

impl AnimationTime {
    /// Parses the value of an option of this module; returns false for other options.
    ///
    /// # Errors
    /// One line that names the option and the expected value.
    pub fn take(&mut self, item: &Item) -> Result<bool, String> {
        match item.name() {
            "time" => {
                let seconds = |text: &str| text.parse().ok().filter(|seconds| (0.0..=1e9).contains(seconds));
                self.time_s = Some(item.parse("seconds from 0 to 1e9", seconds)?);
            }
            "animation" => self.animation = Some(item.text()?),
            _ => return Ok(false),
        }
        Ok(true)
    }

    /// Returns whether an animation plays.
    pub fn plays(&self) -> bool {
        self.time_s.is_some()
    }

    /// Poses the scene at the time of the options plus `later_s` seconds.
    ///
    /// # Errors
    /// One line that names the option and the missing animation.
    pub fn apply(&self, scene: &mut Scene, later_s: f64) -> Result<(), String> {
        let Some(time_s) = self.time_s.map(|time_s| time_s + later_s) else { return Ok(()) };
        let all = &scene.motion.animations;
        let number = match &self.animation {
            None => 0,
            Some(asked) => {
                let named = all.iter().position(|animation| animation.name == *asked);
                let names = || all.iter().map(|animation| animation.name.as_str()).collect::<Vec<_>>().join(", ");
                let found = named.or_else(|| asked.parse().ok().filter(|number| *number < all.len()));
                found.ok_or_else(|| {
                    format!("--animation {asked}: no such animation; the scene has {}: {}", all.len(), names())
                })?
            }
        };
        let animation = all.get(number).ok_or_else(|| format!("--time {time_s}: the scene has no animation"))?;
        let duration_s = animation.duration_s();
        let time_s = if duration_s > 0.0 && time_s > duration_s { time_s % duration_s } else { time_s };
        scene.pose(Some(number), time_s).map_err(|error| format!("--time: {error}"))
    }
}
