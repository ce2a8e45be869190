//! Cost of each effect: the frame with and without it, measured alternately.

use crate::args::Args;
use crate::kept_shadows::{OwnResources, declare};
use crate::run::{Failure, Frames, Prepared, WARM_UP, device, executed, input};
use crate::table::{aligned, mebibytes};
use framegraph::{Plan, Scratch, compile};
use framegraph_passes::feature_culling::{Cost, Decision, Saved};
use framegraph_passes::gpu_scene::view::ViewSettings;
use framegraph_passes::{CameraView, Effect, EffectSet, FrameIndex, Settings, ViewId, World};
use framegraph_wgpu::{Executor, Frame, Imports};
use std::time::Instant;

/// Frame with modified settings.
struct Variant {
    frame: Frame<World>,
    imports: Imports,
    plan: Plan,
    executor: Executor,
    view: CameraView,
    /// Time of each frame from recording to completion, in milliseconds.
    times_ms: Vec<f64>,
}

impl Variant {
    fn new(args: &Args, prepared: &Prepared, settings: &Settings) -> Result<Self, Failure> {
        let (options, execute) = prepared.options(args);
        let Prepared { gpu, facts, loaded, seen, world, .. } = prepared;
        let (frame, _, imports) =
            declare(settings, facts, false, OwnResources { kept: None, dirt: prepared.dirt.as_ref() })?;
        let mut plan = Plan::new();
        compile(frame.graph(), &gpu.caps(), &options, &mut Scratch::new(), &mut plan).map_err(input)?;
        let seen = ViewSettings { shadows: settings.shadows, ..seen.clone() };
        let view = CameraView::new(&loaded.scene, &world.lighting.image, &loaded.background, &seen);
        Ok(Self { frame, imports, plan, executor: Executor::with(gpu, execute), view, times_ms: Vec::new() })
    }

    fn frame(&mut self, prepared: &mut Prepared, round: u32) -> Result<(), Failure> {
        let Prepared { gpu, world, .. } = prepared;
        world.set_view(gpu, ViewId::MAIN, self.view.clone()).map_err(device)?;
        world.frame_index = FrameIndex(round);
        let begun = Instant::now();
        self.executor.execute(&self.plan, &self.frame, world, &self.imports).map_err(executed)?;
        gpu.wait().map_err(device)?;
        if round >= WARM_UP {
            self.times_ms.push(begun.elapsed().as_secs_f64() * 1e3);
        }
        Ok(())
    }

    fn median_ms(&mut self) -> f64 {
        self.times_ms.sort_by(f64::total_cmp);
        let half = self.times_ms.len() / 2;
        self.times_ms.get(half).copied().unwrap_or(0.0)
    }
}

/// Measures the frame with and without each requested effect, all other decisions unchanged.
///
/// Each row has the medians over `--frames` frames.
///
/// # Errors
/// An input or device failure with a one-line message.
pub fn measure(args: &Args, prepared: &mut Prepared) -> Result<Vec<Saved>, Failure> {
    let decided = prepared.facts.apply(&prepared.asked);
    let asked: Vec<Effect> = Effect::ALL.into_iter().filter(|effect| prepared.asked.has(*effect)).collect();
    let mut own = Variant::new(args, prepared, &decided)?;
    let rounds = WARM_UP + args.frames;
    let mut shown = Frames::new(rounds * asked.len() as u32);
    let mut rows = Vec::new();
    for effect in asked {
        let dropped = prepared.facts.dropped().contains(effect);
        let other = match dropped {
            true => prepared.facts.apply_but(&prepared.asked, EffectSet::NONE.with(effect)),
            false => decided.without(effect),
        };
        let mut variant = Variant::new(args, prepared, &other)?;
        own.times_ms.clear();
        for round in 0..rounds {
            own.frame(prepared, round)?;
            variant.frame(prepared, round)?;
            shown.next()?;
        }
        let (with, without) = if dropped { (&mut variant, &mut own) } else { (&mut own, &mut variant) };
        let ms = Some([with.median_ms(), without.median_ms()]);
        rows.push(Saved { effect, with: Cost::of(&with.plan), without: Cost::of(&without.plan), ms });
    }
    Ok(rows)
}

/// Formats the rows as a table.
pub fn table(prepared: &Prepared, rows: &[Saved]) -> String {
    let head = ["effect", "decided", "passes", "loads", "stores", "moved", "ms with", "ms without"];
    let mut lines = vec![head.map(String::from)];
    lines.extend(rows.iter().map(|Saved { effect, with, without, ms }| {
        let dropped = prepared.facts.dropped().contains(*effect);
        let less = |of: fn(&Cost) -> u32| (i64::from(of(with)) - i64::from(of(without))).to_string();
        let [with_ms, without_ms] = ms.unwrap_or_default().map(|ms| format!("{ms:.2}"));
        [
            effect.name().into(),
            (if dropped { Decision::Dropped } else { Decision::Kept }).word().into(),
            less(|cost| cost.passes),
            less(|cost| cost.loads),
            less(|cost| cost.stores),
            mebibytes(with.moved_bytes.saturating_sub(without.moved_bytes)),
            with_ms,
            without_ms,
        ]
    }));
    format!("\n{}", aligned(&lines, 2))
}
