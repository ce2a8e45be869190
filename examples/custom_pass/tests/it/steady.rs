//! Steady state: no new objects, changing sizes, and a lost device.

use super::{BOTH, GLOW, LINES, NEITHER, TestResult, app, picture, with_engine};
use custom_pass::app::Screen;
use framegraph_wgpu::{DeviceError, ExecuteError, FrameError};

#[test]
fn a_warm_application_makes_no_object() -> TestResult {
    with_engine("a_warm_application_makes_no_object", |engine| {
        let image = engine.picture([64, 36]);
        let mut app = app(engine, BOTH)?;
        let all = [BOTH, GLOW, LINES, NEITHER];
        for settings in all {
            app.settings = settings;
            picture(&mut app, 0.0, &image)?;
        }
        let made = app.frames.executor().objects();
        assert!(made.textures > 0 && made.pipelines > 0, "{made:?}");
        for frame in 0..40u8 {
            // Switched every other frame: unused objects stay in the pool for a while.
            app.settings = all[usize::from(frame / 2 % 4)];
            picture(&mut app, f32::from(frame) / 60.0, &image)?;
        }
        assert_eq!(app.frames.executor().objects(), made);
        Ok(())
    })
}

#[test]
fn an_image_that_is_lent_leaves_nothing_behind() -> TestResult {
    with_engine("an_image_that_is_lent_leaves_nothing_behind", |engine| {
        let mut app = app(engine, BOTH)?;
        let warm = app.engine.picture([64, 36]);
        app.draw(0.0, Screen::Surface(&warm))?;
        let made = app.frames.executor().objects();
        for frame in 1..=3u8 {
            // A surface provides another image each time.
            let lent = app.engine.picture([64, 36]);
            app.draw(0.0, Screen::Surface(&lent))?;
            let now = app.frames.executor().objects();
            assert_eq!(now.views, made.views + u64::from(frame), "its own view, and no other");
            assert_eq!(framegraph_wgpu::ObjectCounts { views: made.views, ..now }, made);
        }
        Ok(())
    })
}

#[test]
fn a_resized_picture_is_that_of_a_fresh_start() -> TestResult {
    with_engine("a_resized_picture_is_that_of_a_fresh_start", |engine| {
        let mut resized = app(engine, BOTH)?;
        for (size, settings) in
            [([64, 36], BOTH), ([61, 35], BOTH), ([1, 1], GLOW), ([200, 3], BOTH), ([64, 36], LINES)]
        {
            resized.settings = settings;
            let own = resized.engine.picture(size);
            let found = picture(&mut resized, 0.5, &own)?;
            with_engine("", |engine| {
                let own = engine.picture(size);
                let fresh = picture(&mut app(engine, settings)?, 0.5, &own)?;
                assert!(found == fresh, "{size:?}");
                Ok(())
            })?;
        }
        Ok(())
    })
}

#[test]
fn a_lost_device_is_an_error() -> TestResult {
    with_engine("a_lost_device_is_an_error", |engine| {
        let image = engine.picture([8, 8]);
        let mut app = app(engine, BOTH)?;
        picture(&mut app, 0.0, &image)?;
        app.frames.executor().gpu().wait()?;
        app.engine.device.destroy();
        let message = app.draw(0.0, Screen::Texture(&image));
        let lost = matches!(message, Err(FrameError::Execute(ExecuteError::Device(DeviceError::Lost { .. }))));
        assert!(lost, "{message:?}");
        Ok(())
    })
}
