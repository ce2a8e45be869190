//! URIs of buffers and images: data URIs, and percent-encoded paths relative to the file.

use std::path::{Component, Path, PathBuf};

use super::encoding::{decode_base64, decode_percent};
use crate::error::{SceneError, Unsupported, one_line};

/// Target of a URI.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Resource {
    /// Embedded bytes.
    Bytes(Vec<u8>),
    /// Path of a file.
    File(PathBuf),
}

/// Resolves a URI of `file`, named `at` in messages.
///
/// Data URIs may be base64 or percent-encoded (RFC 2397). A URI without a scheme is a path relative to `file`,
/// percent-encoded or not. Other schemes are rejected: nothing is fetched. A path that leaves the folder of `file`,
/// also by a link, is rejected unless `allow_outside`.
pub(super) fn resolve(file: &Path, at: &str, uri: &str, allow_outside: bool) -> Result<Resource, SceneError> {
    let malformed = |reason: String| SceneError::malformed(file, at, reason);
    if let Some(data) = uri.strip_prefix("data:") {
        let (header, payload) = data.split_once(',').ok_or_else(|| malformed("a data URI without a comma".into()))?;
        let bytes = if header.ends_with(";base64") {
            decode_base64(payload.as_bytes()).map_err(|e| malformed(format!("base64: {e}")))?
        } else {
            decode_percent(payload.as_bytes())
        };
        return Ok(Resource::Bytes(bytes));
    }
    if let Some(scheme) = scheme(uri) {
        let feature = Unsupported::UriScheme { at: at.into(), scheme: scheme.into() };
        return Err(SceneError::Unsupported { file: file.into(), feature });
    }
    let path = String::from_utf8(decode_percent(uri.as_bytes()));
    let path = path.map_err(|_| malformed(format!("the path {:?} is not UTF-8", one_line(uri))))?;
    if path.is_empty() || path.contains('\0') {
        return Err(malformed(format!("the path {:?} names no file", one_line(uri))));
    }
    let folder = file.parent().unwrap_or_else(|| Path::new(""));
    // The file name may contain a literal percent sign, written by an exporter without encoding.
    let literal = folder.join(uri);
    let decoded = folder.join(path);
    let found = if !decoded.exists() && literal.exists() { literal } else { decoded };
    if allow_outside || is_inside(folder, &found) {
        Ok(Resource::File(found))
    } else {
        Err(SceneError::Outside { file: file.into(), at: at.into(), uri: uri.into() })
    }
}

/// Returns true if a path in `folder` stays there after all links are resolved. A path that does not exist is judged by
/// its components.
pub(super) fn is_inside(folder: &Path, path: &Path) -> bool {
    let here = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    if let (Ok(here), Ok(path)) = (here.canonicalize(), path.canonicalize()) {
        return path.starts_with(here);
    }
    let Ok(words) = path.strip_prefix(folder) else { return false };
    let mut depth = 0_i64;
    words.components().all(|part| {
        depth += match part {
            Component::Normal(_) => 1,
            Component::CurDir => 0,
            Component::ParentDir => -1,
            Component::RootDir | Component::Prefix(_) => i64::from(i32::MIN),
        };
        depth >= 0
    })
}

/// Returns the scheme of a URI (RFC 3986, section 3.1), if any.
fn scheme(uri: &str) -> Option<&str> {
    let (scheme, _) = uri.split_once(':')?;
    let mut letters = scheme.chars();
    let valid = letters.next().is_some_and(|c| c.is_ascii_alphabetic())
        && letters.all(|c| c.is_ascii_alphanumeric() || "+-.".contains(c));
    valid.then_some(scheme)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(uri: &str) -> Result<Resource, String> {
        resolve(Path::new("dir/a.gltf"), "buffer 0", uri, false).map_err(|e| e.to_string())
    }

    #[test]
    fn paths_stay_in_the_folder_of_the_scene() {
        let folder = std::env::temp_dir().join(format!("framegraph-uri-{}", std::process::id()));
        std::fs::create_dir_all(folder.join("scene/tex")).expect("a temporary folder");
        for file in ["secret.png", "scene/a.png", "scene/tex/b.png"] {
            std::fs::write(folder.join(file), "x").expect("the folder is ours");
        }
        let scene = folder.join("scene/s.gltf");
        let absolute = folder.join("secret.png").display().to_string();
        let mut outside =
            vec!["../secret.png", "tex/../../secret.png", "..%2fsecret.png", "../gone.png", "/etc/gone", &absolute];
        if cfg!(unix) {
            #[cfg(unix)]
            std::os::unix::fs::symlink("../secret.png", folder.join("scene/link.png")).expect("the folder is ours");
            outside.push("link.png");
        }
        for uri in outside {
            let told = resolve(&scene, "image 1", uri, false).map_err(|e| e.to_string());
            assert!(told.is_err_and(|e| e.contains("image 1") && e.contains("leads out of")), "{uri}");
            assert!(matches!(resolve(&scene, "image 1", uri, true), Ok(Resource::File(_))), "{uri}");
        }
        for uri in ["a.png", "./tex/b.png", "tex/../a.png", "../scene/a.png", "gone.png", "tex/../gone.png"] {
            assert!(matches!(resolve(&scene, "image 1", uri, false), Ok(Resource::File(_))), "{uri}");
        }
        std::fs::remove_dir_all(folder).expect("the folder is ours");
    }

    #[test]
    fn every_form_of_uri() {
        let bytes = |b: &[u8]| Ok(Resource::Bytes(b.to_vec()));
        let file = |p: &str| Ok(Resource::File(PathBuf::from(p)));
        assert_eq!(of("data:application/octet-stream;base64,AQID"), bytes(&[1, 2, 3]));
        assert_eq!(of("data:;base64,"), bytes(&[]));
        assert_eq!(of("data:,a%00b"), bytes(b"a\0b"));
        assert_eq!(of("b.bin"), file("dir/b.bin"));
        assert_eq!(of("tex/my%20file%C3%A9.png"), file("dir/tex/my fileé.png"));
        assert_eq!(of("100%.png"), file("dir/100%.png"));
    }

    #[test]
    fn what_cannot_be_read_says_why() {
        for (uri, word) in [
            ("data:base64", "without a comma"),
            ("data:;base64,A", "base64"),
            ("https://example.org/a.bin", "\"https\""),
            ("%ff%fe", "not UTF-8"),
            ("", "names no file"),
            ("a%00b", "names no file"),
        ] {
            let error = of(uri).expect_err(uri);
            assert!(error.contains(word) && error.contains("buffer 0"), "{error}");
        }
    }
}
