//! Texture viewer of an attached engine.

use super::contents;
use crate::attached::Attached;
use crate::drawing::Item;
use crate::session::Session;
use egui::Ui;

/// Shows the texture of the selected resource, which the engine sends on demand.
pub fn remote_preview(ui: &mut Ui, attached: &mut Attached, session: &mut Session) {
    if attached.is_ended() {
        ui.label("The engine is no longer attached");
        return;
    }
    let plan = session.plan.clone();
    if let Some((Item::Resource(index), plan)) = session.selected.zip(plan.as_ref())
        && let Some(resource) = plan.form.resources.get(index)
    {
        attached.preview.look_at(&resource.name);
    }
    attached.request_texture();
    if contents(ui, &mut attached.preview, session, false, &[]) {
        attached.asks_file = true;
    }
}
