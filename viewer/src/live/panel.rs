//! Panels of the frame that is drawn.

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
pub use preview::preview;
pub use scene::scene;
pub use settings::settings;
pub use viewport::viewport;

use super::Live;
use super::asked_file::AskedFile;
use egui::{ColorImage, Context, TextureHandle, TextureOptions, Ui};

/// A button that asks for a file by a dialog of the desktop.
fn ask(ui: &mut Ui, live: &mut Live, wanted: AskedFile, tip: &str) {
    let name = if wanted == AskedFile::Open { "Open…" } else { "Save…" };
    if ui.button(name).on_hover_text(tip).clicked() {
        live.asks_file = Some(wanted);
    }
}

/// Whether a change goes on: the pointer is held, as while a slider is dragged, or a text is typed.
fn goes_on(ctx: &Context) -> bool {
    ctx.input(|i| i.pointer.any_down()) || ctx.egui_wants_keyboard_input()
}

/// A picture of four bytes a pixel as egui shows it, its pixels not blurred; made anew where `made` is another number than before.
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
