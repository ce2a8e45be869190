//! Options of the animation and its time.

use framegraph_scene::Scene;
use lexopt::Parser;

/// Help section.
pub const HELP: &str = "\
ANIMATION
  --time S             time of the animation in seconds; it repeats. Animates nodes, skins, morph targets, lights and
                       cameras on nodes, and the targets of KHR_animation_pointer
  --animation NAME     animation by name or index (0)
";

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
    pub fn take(&mut self, name: &str, parser: &mut Parser) -> Result<bool, String> {
        let mut value = || {
            let value = parser.value().map_err(|_| format!("--{name}: missing value"))?;
            value.into_string().map_err(|v| format!("--{name} {v:?}: the value is not Unicode"))
        };
        match name {
            "time" => {
                let text = value()?;
                let seconds = text.parse().ok().filter(|seconds| (0.0..=1e9).contains(seconds));
                self.time_s = Some(seconds.ok_or_else(|| format!("--time {text}: expected seconds from 0 to 1e9"))?);
            }
            "animation" => self.animation = Some(value()?),
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
