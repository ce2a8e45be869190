//! URIs of buffers and images: data URIs, and percent-encoded paths beside the file.

use std::path::{Path, PathBuf};

use super::encoding::{decode_base64, decode_percent};
use crate::error::{SceneError, Unsupported, one_line};

/// What a URI stands for.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Resource {
    /// The bytes themselves.
    Bytes(Vec<u8>),
    /// A file to read.
    File(PathBuf),
}

/// Resolves a URI of `file`, named `at` in messages.
///
/// Data URIs may be base64 or percent-encoded (RFC 2397). Anything without a scheme is a path
/// relative to `file`, percent-encoded or not. Other schemes are refused: nothing is fetched.
pub(super) fn resolve(file: &Path, at: &str, uri: &str) -> Result<Resource, SceneError> {
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
    // A file whose name really holds a percent sign, written by an exporter that did not encode it.
    let literal = folder.join(uri);
    let decoded = folder.join(path);
    Ok(Resource::File(if !decoded.exists() && literal.exists() { literal } else { decoded }))
}

/// The scheme of a URI (RFC 3986, section 3.1), if it has one.
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
        resolve(Path::new("dir/a.gltf"), "buffer 0", uri).map_err(|e| e.to_string())
    }

    #[test]
    fn every_form_of_uri() {
        let bytes = |b: &[u8]| Ok(Resource::Bytes(b.to_vec()));
        let file = |p: &str| Ok(Resource::File(PathBuf::from(p)));
        assert_eq!(of("data:application/octet-stream;base64,AQID"), bytes(&[1, 2, 3]));
        assert_eq!(of("data:;base64,"), bytes(&[]));
        assert_eq!(of("data:,a%00b"), bytes(b"a\0b"));
        assert_eq!(of("b.bin"), file("dir/b.bin"));
        assert_eq!(of("../tex/my%20file%C3%A9.png"), file("dir/../tex/my fileé.png"));
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
