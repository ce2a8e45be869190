//! Scene panel: file, animation, cameras, instances and materials.

use crate::live::Live;
use crate::live::file_request::FileRequest;
use egui::{Button, ComboBox, RichText, ScrollArea, Slider, TextEdit, Ui};
use framegraph_scene::builtin::NAMES;
use framegraph_scene::{Camera, Scene};
use std::path::Path;

/// Maximum number of suggested file names.
const OFFERED: usize = 12;
/// Extensions of scenes and environments.
const ENDINGS: [&str; 6] = ["gltf", "glb", "hdr", "exr", "ktx", "ktx2"];

/// Shows the scene, loads another one, plays its animations, and selects its cameras.
pub fn scene(ui: &mut Ui, live: &mut Live, path: &mut String, session: &mut crate::session::Session) {
    open(ui, live, path, session);
    ui.separator();
    let Some(running) = &live.running else {
        ui.label(live.doing().map_or("No scene", |_| "Waiting for the frame"));
        return;
    };
    let loaded = &running.loaded;
    let scene = &loaded.scene;
    ui.label(format!(
        "{}: {} instances, {} triangles, {} materials, {} lights",
        loaded.name,
        scene.instances.len(),
        scene.triangle_count(),
        scene.materials.len(),
        loaded.lights.len()
    ));
    variant(ui, live);
    animation(ui, live);
    cameras(ui, live);
    super::material::material(ui, live);
    ui.separator();
    let Some(running) = &live.running else { return };
    hierarchy(ui, &running.loaded.scene, &mut live.material);
}

/// Shows a path with suggestions, and the built-in scenes.
fn open(ui: &mut Ui, live: &mut Live, path: &mut String, session: &mut crate::session::Session) {
    ui.horizontal(|ui| {
        let width = (ui.available_width() - 192.0).max(60.0);
        let edit = ui.add(TextEdit::singleline(path).hint_text("SCENE.gltf, .glb or light.hdr").desired_width(width));
        let enter = edit.lost_focus() && ui.input(|i| i.key_pressed(egui::Key::Enter));
        let tip = "Load the file. Files can also be dropped onto the window";
        if (ui.button("Load").on_hover_text(tip).clicked() || enter)
            && !path.trim().is_empty()
            && !live.open(Path::new(path.trim()), session)
        {
            live.load(path.trim());
        }
        super::ask(ui, live, FileRequest::Open, "Load a scene or an environment");
        ComboBox::from_id_salt("built-in")
            .selected_text("built-in")
            .width(60.0)
            .show_ui(ui, |ui| {
                for name in NAMES {
                    if ui.selectable_label(false, name).clicked() {
                        live.load(name);
                    }
                }
            })
            .response
            .on_hover_text("Built-in scenes");
    });
    let offered = if path.is_empty() { Vec::new() } else { completions(path) };
    if !offered.is_empty() {
        ui.horizontal_wrapped(|ui| {
            for name in offered {
                if ui.small_button(RichText::new(&name).size(11.0)).clicked() {
                    let folder = path.rfind('/').map_or("", |slash| &path[..=slash]);
                    *path = format!("{folder}{name}");
                }
            }
        });
    }
}

/// Returns folders and supported files that complete a path, sorted.
pub(super) fn completions(path: &str) -> Vec<String> {
    let (folder, begun) = path
        .rsplit_once('/')
        .map_or((".", path), |(folder, begun)| (if folder.is_empty() { "/" } else { folder }, begun));
    let Ok(entries) = std::fs::read_dir(folder) else { return Vec::new() };
    let mut names: Vec<String> = entries
        .flatten()
        .filter_map(|entry| {
            let name = entry.file_name().into_string().ok()?;
            let is_folder = entry.path().is_dir();
            let ending = Path::new(&name).extension().map(|e| e.to_string_lossy().to_lowercase());
            let fits = is_folder || ending.is_some_and(|ending| ENDINGS.contains(&ending.as_str()));
            let begins = name.starts_with(begun) && name != begun && (!name.starts_with('.') || begun.starts_with('.'));
            (fits && begins).then(|| if is_folder { format!("{name}/") } else { name })
        })
        .collect();
    names.sort_unstable();
    names.truncate(OFFERED);
    names
}

/// Shows the material variants of the file. Another variant reloads the scene.
fn variant(ui: &mut Ui, live: &mut Live) {
    let Some(loaded) = live.running.as_ref().map(|running| &running.loaded) else { return };
    if loaded.scene.variants.is_empty() {
        return;
    }
    let mut chosen = loaded.variant.clone();
    ComboBox::from_id_salt("variant")
        .selected_text(chosen.as_deref().unwrap_or("default materials"))
        .show_ui(ui, |ui| {
            ui.selectable_value(&mut chosen, None, "default materials");
            for name in &loaded.scene.variants {
                ui.selectable_value(&mut chosen, Some(name.clone()), name);
            }
        })
        .response
        .on_hover_text("Material variant of the file");
    if chosen != loaded.variant {
        let name = loaded.name.clone();
        live.load_variant(&name, chosen);
    }
}

fn animation(ui: &mut Ui, live: &mut Live) {
    let Some(running) = &live.running else { return };
    let animations = &running.loaded.scene.motion.animations;
    if animations.is_empty() {
        return;
    }
    let named = |number: usize| match animations[number].name.as_str() {
        "" => format!("animation {number}"),
        name => name.to_owned(),
    };
    let mut document = live.document().clone();
    let chosen = document.capture.animation.filter(|number| *number < animations.len());
    let length_s = chosen.map_or(0.0, |number| animations[number].duration_s());
    ui.horizontal(|ui| {
        let text = chosen.map_or("rest pose".into(), named);
        ComboBox::from_id_salt("animation")
            .selected_text(text)
            .show_ui(ui, |ui| {
                ui.selectable_value(&mut document.capture.animation, None, "rest pose");
                for number in 0..animations.len() {
                    ui.selectable_value(&mut document.capture.animation, Some(number), named(number));
                }
            })
            .response
            .on_hover_text("Animation of the scene");
        if chosen.is_some() {
            ui.checkbox(&mut live.options.playing, "play");
        }
    });
    if chosen.is_some() {
        let slider =
            Slider::new(&mut live.options.time_s, 0.0..=length_s.max(1e-3)).suffix(" s").max_decimals(3).text("time");
        if ui.add(slider).changed() {
            live.again();
        }
    } else {
        live.options.playing = false;
    }
    if document != *live.document() {
        live.set(document, false);
    }
}

fn cameras(ui: &mut Ui, live: &mut Live) {
    let (Some(running), Some(rig)) = (&live.running, &mut live.rig) else { return };
    let cameras: Vec<Camera> = running.loaded.scene.cameras.clone();
    if cameras.is_empty() {
        return;
    }
    let mut taken = false;
    ui.horizontal_wrapped(|ui| {
        ui.label("cameras:");
        for (number, camera) in cameras.iter().enumerate() {
            let name = if camera.name.is_empty() { number.to_string() } else { camera.name.clone() };
            if ui.small_button(name).on_hover_text("Use this camera").clicked() {
                rig.take(camera);
                taken = true;
            }
        }
    });
    if taken {
        live.again();
    }
}

/// Lists instances below their nodes, each with its material.
fn hierarchy(ui: &mut Ui, scene: &Scene, chosen: &mut Option<usize>) {
    ScrollArea::vertical().auto_shrink(false).show_rows(ui, 22.0, scene.instances.len(), |ui, rows| {
        for number in rows {
            let instance = &scene.instances[number];
            let name = if instance.name.is_empty() { format!("instance {number}") } else { instance.name.clone() };
            let depth = depth(scene, number);
            let material = &scene.materials[instance.material.index()];
            let mesh = &scene.meshes[instance.mesh.index()];
            ui.horizontal(|ui| {
                ui.add_space(10.0 * depth as f32);
                let place = instance.world_from_model.w_axis;
                ui.label(name).on_hover_text(format!(
                    "at {:.3} {:.3} {:.3} m, {} {}",
                    place.x,
                    place.y,
                    place.z,
                    mesh.primitive_count(),
                    mesh.topology.name()
                ));
                let named = if material.name.is_empty() { "(no name)" } else { &material.name };
                let number = instance.material.index();
                let shown = *chosen == Some(number);
                let button = Button::selectable(shown, RichText::new(named).size(11.0));
                if ui.add(button).on_hover_text("Edit the material").clicked() {
                    *chosen = (!shown).then_some(number);
                }
            });
        }
    });
}

/// Returns the number of ancestor nodes of an instance.
fn depth(scene: &Scene, instance: usize) -> usize {
    let mut node = scene.motion.instance_nodes.get(instance).copied();
    let mut depth = 0;
    while let Some(parent) = node.and_then(|node| scene.motion.nodes.get(node)).and_then(|node| node.parent) {
        (node, depth) = (Some(parent), depth + 1);
        if depth > 64 {
            break;
        }
    }
    depth
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_are_completed() {
        assert!(completions("src/li").contains(&"live/".to_owned()) && completions("no/such/fold").is_empty());
        let light = completions("../tests/assets/hdri/ven");
        assert!(light.iter().all(|name| name.starts_with("ven")) && !light.is_empty(), "{light:?}");
    }
}
