//! Decides whether a depth prepass pays: triangles drawn twice against pixels shaded once.
//!
//! Overdraw is estimated at sample points of the picture: boxes are visited in draw order, and each box nearer than
//! those before it counts as shaded. A box is larger than its mesh. The estimate has too little shading behind boxes
//! and too much in front.

use super::decided::Facts;
use super::effect::Effect;
use super::fact::{Fact, Proof};
use super::rule_input::RuleInput;
use super::visibility::fit_camera;
use framegraph_scene::levels::level_of;
use framegraph_scene::{BatchOrder, SHADED_POINTS, shaded_at_points};

/// Cost of drawing a triangle into depth, in shaded pixels (`docs/design/feature-culling.md`).
const TRIANGLE: f64 = 1.0;
/// Cost of drawing a pixel into depth, in shaded pixels.
const DEPTH_PIXEL: f64 = 0.02;
/// Greatest number of instances for which coverage is estimated.
const MAX_INSTANCES: usize = 2048;

pub(super) fn rules(case: &RuleInput<'_>, facts: &mut Facts) {
    if !case.settings.prepass {
        return;
    }
    let kept = |why: String| Fact::kept(Effect::Prepass, Proof::Exact, why);
    if case.settings.draws_velocity() {
        facts.rows.push(kept("velocity is drawn over its depth".into()));
        return;
    }
    if case.settings.samples == 1 && case.settings.reads_structure() {
        facts.rows.push(kept("other effects read its depth".into()));
        return;
    }
    let most = case.seen.most(|lists| lists.opaque.len() + lists.mask.len());
    if most > MAX_INSTANCES {
        facts.rows.push(kept(format!("{most} instances are seen, and of more than {MAX_INSTANCES} nothing is known")));
        return;
    }
    let (mut triangles, mut seen_px, mut saved_px) = (0, 0.0, 0.0);
    let seen = case.input.views.iter().zip(&case.seen.lists);
    for (view, lists) in seen.filter(|(_, lists)| lists.opaque.len() + lists.mask.len() > 0) {
        let (renderables, scene) = (&case.seen.renderables, case.seen.scene);
        let mut numbers = Vec::with_capacity(lists.opaque.len() + lists.mask.len());
        let mut levels = view.unlimited_levels(renderables);
        view.limit_levels(renderables, lists, &mut levels);
        for list in [&lists.opaque, &lists.mask] {
            _ = renderables.surfaces().batches(list, &levels, BatchOrder::FirstFirst, &mut numbers);
        }
        // Shadow maps may need the prepass.
        let in_level = |number: &u32| {
            let mesh = &scene.meshes[scene.instances[*number as usize].mesh.index()];
            if mesh.has_area() { mesh.indices_in(level_of(&levels, *number)).len() / 3 } else { 0 }
        };
        triangles += numbers.iter().map(in_level).sum::<usize>();
        // Lines and points cover almost nothing of their boxes.
        let has_area = |i: &&framegraph_scene::Instance| scene.meshes[i.mesh.index()].has_area();
        let instances = numbers.iter().map(|number| &scene.instances[*number as usize]);
        let bounds = instances.filter(has_area).map(|instance| &instance.bounds);
        let [seen, shaded] = shaded_at_points(bounds, &view.camera, fit_camera(view).width_over_height);
        let point_px = view.size_px.map(f64::from).iter().product::<f64>() / f64::from(SHADED_POINTS * SHADED_POINTS);
        seen_px += f64::from(seen) * point_px;
        saved_px += f64::from(shaded - seen) * point_px;
    }
    let cost_px = triangles as f64 * TRIANGLE + seen_px * DEPTH_PIXEL;
    let told = format!(
        "{triangles} triangles drawn once more cost as much as shading {:.0} thousand pixels, and it saves {:.0} thousand",
        cost_px / 1e3,
        saved_px / 1e3,
    );
    facts.rows.push(Fact::decide(Effect::Prepass, Proof::Exact, saved_px <= cost_px, told.clone(), told));
}
