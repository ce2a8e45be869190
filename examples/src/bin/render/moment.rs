//! Options that say at which moment of an animation the scene is.

use framegraph_scene::Scene;
use lexopt::Parser;

/// What `render --help` prints of them.
pub const HELP: &str = "
  --time S             the scene S seconds into its animation, which repeats: nodes, skins, morph targets, lights and
                       cameras on nodes, and what KHR_animation_pointer changes
  --animation WHICH    the animation by name or number (0)
";

/// What was asked for.
#[derive(Clone, Debug, Default)]
pub struct Moment {
    /// In seconds; none for the scene at rest.
    time_s: Option<f64>,
    animation: Option<String>,
}

impl Moment {
    /// Takes an option of this file; false for others.
    ///
    /// # Errors
    /// One line that names the option and what it takes.
    pub fn take(&mut self, name: &str, parser: &mut Parser) -> Result<bool, String> {
        let mut value = || {
            let value = parser.value().map_err(|_| format!("--{name}: a value is missing"))?;
            value.into_string().map_err(|v| format!("--{name} {v:?}: the value is not Unicode"))
        };
        match name {
            "time" => {
                let text = value()?;
                let seconds = text.parse().ok().filter(|seconds| (0.0..=1e9).contains(seconds));
                self.time_s = Some(seconds.ok_or_else(|| format!("--time {text}: seconds from 0 to 1e9 are needed"))?);
            }
            "animation" => self.animation = Some(value()?),
            _ => return Ok(false),
        }
        Ok(true)
    }

    /// Whether an animation plays.
    pub fn plays(&self) -> bool {
        self.time_s.is_some()
    }

    /// Moves the scene to that time, and so many seconds later.
    ///
    /// # Errors
    /// One line that names the option and what the scene lacks.
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
                    format!(
                        "--animation {asked}: the scene has no such animation; there are {}: {}",
                        all.len(),
                        names()
                    )
                })?
            }
        };
        let animation = all.get(number).ok_or_else(|| format!("--time {time_s}: the scene has no animation"))?;
        let duration_s = animation.duration_s();
        let time_s = if duration_s > 0.0 && time_s > duration_s { time_s % duration_s } else { time_s };
        scene.pose(Some(number), time_s).map_err(|told| format!("--time: {told}"))
    }
}
