//! Effect of the switches on the plan, in counts.

use super::{BOTH, GLOW, LINES, NEITHER, TestResult, app, picture, with_engine};
use framegraph::{Placement, Plan};

/// Returns whether two resources share memory.
fn share(plan: &Plan, a: &str, b: &str) -> bool {
    let place = |name: &str| {
        let found = plan.graph().find_resource(name);
        found.map_or(Placement::Unused, |r| plan.resources()[r.index()].placement)
    };
    matches!(place(a), Placement::Slot(_)) && place(a) == place(b)
}

#[test]
fn switching_an_effect_changes_what_is_stored() -> TestResult {
    with_engine("switching_an_effect_changes_what_is_stored", |engine| {
        let image = engine.picture([64, 36]);
        let mut app = app(engine, BOTH)?;
        // Passes, steps, loads, stores, memoryless textures. Without outlines, ids and depth are never read. Nothing is
        // ever loaded, because outlines are drawn in the step of the picture below them.
        let expected =
            [(BOTH, [6, 5, 0, 4, 0]), (GLOW, [5, 5, 0, 2, 2]), (LINES, [3, 2, 0, 4, 0]), (NEITHER, [2, 2, 0, 2, 2])];
        for (settings, counts) in expected {
            app.settings = settings;
            picture(&mut app, 0.0, &image)?;
            let c = app.frames.plan().counts();
            assert_eq!([c.passes, c.steps, c.unresolves, c.resolves, c.memoryless], counts, "{settings:?}");
            let shared = share(app.frames.plan(), "blur/half", "blur/blurred");
            assert_eq!(
                shared, settings.blur,
                "the first and the last of three equal textures are never in use at once"
            );
            assert!(!share(app.frames.plan(), "blur/half", "blur/swept"));
            assert!(
                app.frames.plan().memory().optimal
                    && app.frames.plan().memory().bytes == app.frames.plan().memory().lower_bound_bytes
            );
        }
        Ok(())
    })
}

#[test]
fn everything_that_is_declared_is_used() -> TestResult {
    with_engine("everything_that_is_declared_is_used", |engine| {
        let image = engine.picture([64, 36]);
        let mut app = app(engine, BOTH)?;
        for settings in [BOTH, GLOW, LINES, NEITHER] {
            app.settings = settings;
            picture(&mut app, 0.0, &image)?;
            assert_eq!(app.frames.executor().unused_accesses(app.frames.plan()).count(), 0, "{settings:?}");
        }
        Ok(())
    })
}
