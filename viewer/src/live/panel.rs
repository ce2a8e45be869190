//! Panels of the live frame.

mod curves;
mod debugging;
mod effects;
mod fields;
mod lens;
mod material;
mod preview;
mod scene;
mod settings;
mod tone;
mod viewport;

pub use debugging::debugging;
pub use effects::effects;
pub use lens::lens;
pub use preview::{preview, remote_preview};
pub use scene::scene;
pub use settings::settings;
pub use viewport::viewport;

use super::Live;
use super::file_request::FileRequest;
use egui::{ColorImage, Context, TextureHandle, TextureOptions, Ui};

/// Adds a button that requests a file dialog.
fn ask(ui: &mut Ui, live: &mut Live, wanted: FileRequest, tip: &str) {
    let name = if wanted == FileRequest::Open { "Open…" } else { "Save…" };
    if ui.button(name).on_hover_text(tip).clicked() {
        live.file_request = Some(wanted);
    }
}

/// Returns whether a change continues, during a drag or while typing.
fn goes_on(ctx: &Context) -> bool {
    ctx.input(|i| i.pointer.any_down()) || ctx.egui_wants_keyboard_input()
}

/// Returns an unfiltered egui texture of RGBA pixels. It is uploaded again when `made` changes.
fn texture(ctx: &Context, name: &str, made: u64, size: [u32; 2], rgba8: &[u8]) -> TextureHandle {
    let id = egui::Id::unique(name);
    if let Some((known, handle)) = ctx.data(|data| data.get_temp::<(u64, TextureHandle)>(id))
        && known == made
    {
        return handle;
    }
    let image = ColorImage::from_rgba_unmultiplied(size.map(|side| side as usize), rgba8);
    let handle = ctx.load_texture(name, image, TextureOptions::NEAREST);
    ctx.data_mut(|data| data.insert_temp(id, (made, handle.clone())));
    handle
}
