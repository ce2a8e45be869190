//! New light after a change of the environment, the sun of a clear sky, or the light settings.

use super::capture::Sun;
use super::loading::{self, EnvironmentSource};
use super::shown::LightRequest;
use super::{Live, loading::Lit};
use crate::job::Job;
use crate::session::Session;
use framegraph_passes::light::shading::LightSettings;

impl Live {
    /// Returns the light settings of the current settings.
    pub(super) fn light_settings(&self) -> LightSettings {
        let frame = &self.document().frame;
        frame.settings.shading.light(frame.quality)
    }

    /// Stops the preparation of light and keeps the displayed light. The same light is not prepared again until the
    /// request changes. Returns false if no light is being prepared.
    pub(super) fn stop_relighting(&mut self) -> bool {
        let Some((_, request)) = self.relighting.take() else { return false };
        self.declined = Some(request);
        self.keep_environment();
        true
    }

    /// Requests the environment of the displayed scene.
    fn keep_environment(&mut self) {
        if let Some(shown) = &self.shown {
            self.wanted = shown.light.environment.clone();
        }
    }

    /// Creates new light if the settings or the sun of a clear sky require it.
    pub(super) fn relight(&mut self, session: &mut Session) {
        self.take_light(session);
        let sun = self.document().capture.sun;
        if let EnvironmentSource::Sky(own) = &mut self.wanted {
            *own = if let Sun::Custom { .. } = sun { sun.toward() } else { None };
        }
        let request = LightRequest { environment: self.wanted.clone(), settings: self.light_settings() };
        let levels = self.document().frame.lod_error_px > 0.0;
        let Some(shown) = &mut self.shown else { return };
        if self.loading.is_none() && levels && !std::mem::replace(&mut shown.levels, true) {
            let name = shown.name.clone();
            return self.load(&name);
        }
        if shown.light == request {
            self.declined = None;
            return;
        }
        if self.relighting.is_some() || self.loading.is_some() || self.refused.is_some() {
            return;
        }
        let declined = self.declined.as_ref().is_some_and(|declined| {
            let environments = [&declined.environment, &shown.light.environment];
            declined.settings == request.settings && environments.contains(&&request.environment)
        });
        let Some(loaded) = self.running.as_ref().map(|running| &running.loaded).filter(|_| !declined) else { return };
        // Light depends on the ground color and the lights, but not on materials.
        let scene = framegraph_scene::Scene {
            ground_albedo: loaded.scene.ground_albedo,
            lights: loaded.lights.clone(),
            ..framegraph_scene::Scene::default()
        };
        let (gpu, wake, light) = (self.screen.gpu.clone(), self.wake.clone(), request.clone());
        let job = Job::start(
            "preparing light",
            move || wake(),
            move |handle| loading::light(&gpu, &scene, &light.environment, &light.settings, handle),
        );
        (self.relighting, self.declined) = (Some((job, request)), None);
    }

    /// Applies finished light. Without the frame, which another thread may have, the light waits.
    fn take_light(&mut self, session: &mut Session) {
        let (Some(running), Some((job, _))) = (&mut self.running, &self.relighting) else { return };
        let Some(result) = job.poll() else { return };
        let result: Result<Lit, String> = result.unwrap_or_else(|()| Err(job.failure()));
        let request = self.relighting.take().map(|(_, request)| request);
        match result {
            Ok(lit) => {
                if let Some(shown) = &mut self.shown {
                    shown.relight(&lit);
                }
                running.relight(lit);
                self.again();
            }
            Err(error) => {
                session.say(error);
                let environment = |light: &LightRequest| light.environment.clone();
                let shown = self.shown.as_ref().map(|shown| environment(&shown.light));
                // Without the file, the settings are tried with the displayed environment.
                let other_file = request.as_ref().is_some_and(|request| {
                    matches!(request.environment, EnvironmentSource::File(_))
                        && shown.as_ref() != Some(&request.environment)
                });
                self.declined = request.filter(|_| !other_file);
                self.keep_environment();
            }
        }
    }
}
