//! Files whose names differ from their URI in letter case.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::json;

use super::fixture::{Fixture, png};
use crate::import::load;
use crate::progress::silent;

/// A temporary folder, removed on drop.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("framegraph-{name}-{}", std::process::id()));
        fs::create_dir_all(folder.join("scene/tex")).expect("a temporary folder");
        Self(folder)
    }

    fn write(&self, path: &str, bytes: &[u8]) {
        fs::write(self.0.join("scene").join(path), bytes).expect("the folder is ours");
    }

    /// Returns the error of a scene that refers to an image or a buffer.
    fn error(&self, image: Option<&str>, buffer: Option<&str>) -> String {
        let mut fixture = Fixture::triangle();
        let uv = fixture.floats(2, &[0.0; 6]);
        fixture.set("/meshes/0/primitives/0/attributes/TEXCOORD_0", json!(uv));
        fixture.set("/meshes/0/primitives/0/material", json!(0));
        fixture.push("materials", json!({"emissiveTexture": {"index": 0}}));
        fixture.push("textures", json!({"source": 0}));
        fixture.push("images", json!({"uri": image.unwrap_or("unused")}));
        fixture.json["buffers"] = json!([{"uri": buffer.unwrap_or("data.bin"), "byteLength": fixture.bin.len()}]);
        self.write("data.bin", &fixture.bin);
        let file = self.0.join("scene/a.gltf");
        fs::write(&file, fixture.json.to_string()).expect("the folder is ours");
        load(&file, &mut silent).expect_err("the file is missing").to_string()
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        _ = fs::remove_dir_all(&self.0);
    }
}

/// Returns true if the file system of a folder is case-sensitive.
fn tells_case_apart(folder: &Path) -> bool {
    fs::write(folder.join("case"), "").expect("the folder is ours");
    !folder.join("CASE").exists()
}

#[test]
fn a_missing_file_names_the_one_with_other_letters() {
    let folder = Folder::new("letter-case");
    if !tells_case_apart(&folder.0) {
        return;
    }
    folder.write("wood.png", &png(1, 1, [1; 4]));
    folder.write("tex/Überzug.PNG", &png(1, 1, [1; 4]));
    let suffix = |name: &str| format!("; the folder has {name:?}, whose letters differ in case");
    let error = folder.error(Some("Wood.PNG"), None);
    let scene = folder.0.join("scene");
    let start =
        format!("{}: image 0: {}: cannot be read: ", scene.join("a.gltf").display(), scene.join("Wood.PNG").display());
    assert!(error.starts_with(&start) && error.ends_with(&suffix("wood.png")), "{error}");
    // Percent-encoded non-ASCII letters, in each part of a path, also with `..` parts.
    for uri in ["tex/%C3%BCberzug.png", "Tex/%C3%9Cberzug.PNG", "TEX/überZUG.png", "./tex/../TEX/überzug.png"] {
        let error = folder.error(Some(uri), None);
        assert!(error.ends_with(&suffix("tex/Überzug.PNG")), "{uri}: {error}");
    }
    let error = folder.error(None, Some("DATA.bin"));
    assert!(error.contains(": buffer 0: ") && error.ends_with(&suffix("data.bin")), "{error}");
    // The first of several names is used.
    folder.write("WOOD.png", &[]);
    assert!(folder.error(Some("Wood.PNG"), None).ends_with(&suffix("WOOD.png")));
}

#[test]
fn names_that_are_not_alike_and_places_outside_are_not_named() {
    let folder = Folder::new("other-names");
    folder.write("wood.png", &[]);
    fs::write(folder.0.join("secret.png"), "").expect("the folder is ours");
    fs::create_dir_all(folder.0.join("scene/Stone.PNG")).expect("the folder is ours");
    #[cfg(unix)]
    std::os::unix::fs::symlink("../secret.png", folder.0.join("scene/link.png")).expect("the folder is ours");
    // Another name, a folder, and a link to the outside.
    for uri in ["wood.jpg", "wool.png", "stone.png", "no/wood.png", "LINK.png"] {
        let error = folder.error(Some(uri), None);
        assert!(!error.contains("differ in case") && error.contains("image 0"), "{uri}: {error}");
    }
    let error = folder.error(Some("../SECRET.png"), None);
    assert!(error.contains("leads out of") && !error.contains("differ in case"), "{error}");
}
