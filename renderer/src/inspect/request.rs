//! Inspection requests: texture, version and part.

use framegraph::Aspect;
use std::fmt;
use std::str::FromStr;

/// A version of a texture, and the part of it to inspect.
///
/// The text form is `NAME[@PASS|@vN|@sN][:MIP[:LAYER]]`:
///
/// - `hdr`: newest version of `hdr`
/// - `hdr@color`: version written by the pass `color`
/// - `hdr@v1`: first version that a pass wrote; `v0` is the contents on entry
/// - `hdr@s3`: contents after step 3
/// - `pyramid:2`: mip level 2
/// - `cascades:0:3`: layer 3 of level 0
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Request {
    /// Full name of the texture.
    pub name: String,
    /// Version of the texture.
    pub version: VersionSelector,
    /// Mip level.
    pub mip: u8,
    /// Layer of an array, or slice of a 3D texture.
    pub layer: u16,
    /// Plane of a depth-stencil texture. `All` selects depth if there is one.
    pub aspect: Aspect,
    /// Sample of a multisampled texture. `None` averages colors as a resolve does, and selects the first sample for
    /// depth, stencil and integers.
    pub sample: Option<u8>,
}

/// Selects one version of a texture.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum VersionSelector {
    /// Last version of the frame.
    #[default]
    Newest,
    /// Version written by the pass with this full name.
    After(String),
    /// Version with this number; 0 for the contents on entry.
    Number(usize),
    /// Contents after the step with this number.
    Step(usize),
}

impl Request {
    /// Creates a request for the newest version of a texture, its first level and layer.
    pub fn newest(name: &str) -> Self {
        let name = name.to_owned();
        Self { name, version: VersionSelector::Newest, mip: 0, layer: 0, aspect: Aspect::All, sample: None }
    }
}

/// Error: the text is not an inspection request.
#[derive(Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "`{text}` is not a texture request; write NAME[@PASS|@vN|@sN][:MIP[:LAYER]], such as `hdr@color` or `pyramid@v1:2`"
)]
pub struct RequestError {
    /// The text that was given.
    pub text: String,
}

impl fmt::Debug for RequestError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl FromStr for Request {
    type Err = RequestError;

    fn from_str(text: &str) -> Result<Self, RequestError> {
        let refuse = || RequestError { text: text.to_owned() };
        let (mut rest, mut numbers) = (text, Vec::new());
        while let Some((before, last)) = rest.rsplit_once(':').filter(|(_, last)| is_number(last)) {
            numbers.push(last.parse::<u16>().map_err(|_| refuse())?);
            rest = before;
        }
        let (mip, layer) = match numbers[..] {
            [] => (0, 0),
            [mip] => (mip, 0),
            [layer, mip] => (mip, layer),
            _ => return Err(refuse()),
        };
        // `taa@-1` is the name of a previous image of a history.
        let split = rest.rsplit_once('@').filter(|(_, version)| !version.starts_with('-'));
        let (name, version) = match split {
            None => (rest, VersionSelector::Newest),
            Some((name, version)) => {
                let number = |prefix: char| {
                    let digits = version.strip_prefix(prefix).filter(|n| is_number(n));
                    digits.map(|n| n.parse().map_err(|_| refuse())).transpose()
                };
                match (number('v')?, number('s')?) {
                    (Some(number), _) => (name, VersionSelector::Number(number)),
                    (_, Some(step)) => (name, VersionSelector::Step(step)),
                    _ => (name, VersionSelector::After(version.to_owned())),
                }
            }
        };
        let mip = u8::try_from(mip).map_err(|_| refuse())?;
        if name.is_empty() || version == VersionSelector::After(String::new()) {
            return Err(refuse());
        }
        Ok(Self { version, mip, layer, ..Self::newest(name) })
    }
}

fn is_number(text: &str) -> bool {
    !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit())
}

impl fmt::Display for Request {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.name)?;
        match &self.version {
            VersionSelector::Newest => {}
            VersionSelector::After(pass) => write!(f, "@{pass}")?,
            VersionSelector::Number(number) => write!(f, "@v{number}")?,
            VersionSelector::Step(step) => write!(f, "@s{step}")?,
        }
        match (self.mip, self.layer) {
            (0, 0) => Ok(()),
            (mip, 0) => write!(f, ":{mip}"),
            (mip, layer) => write!(f, ":{mip}:{layer}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn requests_are_parsed_and_printed() -> Result<(), RequestError> {
        let newest = Request::newest;
        let cases = [
            ("hdr", newest("hdr")),
            ("bloom/down:2", Request { mip: 2, ..newest("bloom/down") }),
            ("cascades:1:3", Request { mip: 1, layer: 3, ..newest("cascades") }),
            ("hdr@color", Request { version: VersionSelector::After("color".into()), ..newest("hdr") }),
            ("hdr@v2:1", Request { version: VersionSelector::Number(2), mip: 1, ..newest("hdr") }),
            ("hdr@s0", Request { version: VersionSelector::Step(0), ..newest("hdr") }),
            ("hdr@sky", Request { version: VersionSelector::After("sky".into()), ..newest("hdr") }),
            ("taa@-1", newest("taa@-1")),
            ("taa@-1@v0", Request { version: VersionSelector::Number(0), ..newest("taa@-1") }),
            ("hdr@vignette", Request { version: VersionSelector::After("vignette".into()), ..newest("hdr") }),
            ("a:b", newest("a:b")),
        ];
        for (text, expected) in cases {
            let request: Request = text.parse()?;
            assert_eq!(request, expected, "{text}");
            assert_eq!(request.to_string(), text);
        }
        Ok(())
    }

    #[test]
    fn invalid_requests_are_rejected() {
        for text in ["", "@color", "hdr@", "hdr:1:2:3", "hdr:256", "hdr:0:70000", ":1"] {
            let message = text.parse::<Request>().map_err(|e| e.to_string());
            assert!(message.as_ref().is_err_and(|e| e.contains(&format!("`{text}`"))), "{text}: {message:?}");
        }
    }
}
