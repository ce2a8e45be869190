//! Errors of cameras.

/// Error of pointing a camera at a target.
#[derive(Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum LookAtError {
    /// A coordinate is infinite or NaN.
    #[error("a coordinate is not finite")]
    NotFinite,
    /// Eye and target coincide.
    #[error("eye and target coincide")]
    Coincide,
}

impl std::fmt::Debug for LookAtError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}

/// Error of parsing a camera, `NAME`, `orbit`, or `EX,EY,EZ:TX,TY,TZ:FOVY`.
#[derive(Clone, PartialEq, Eq, thiserror::Error)]
pub enum CameraTextError {
    /// The text is empty.
    #[error("the name is empty")]
    EmptyName,
    /// The text does not have three parts separated by colons.
    #[error("{found} parts between colons, not 3")]
    Parts {
        /// Number of parts.
        found: usize,
    },
    /// A point does not have three coordinates.
    #[error("{part}: {found} coordinates, not 3")]
    Coordinates {
        /// `eye` or `target`.
        part: &'static str,
        /// Number of coordinates.
        found: usize,
    },
    /// A number cannot be parsed.
    #[error("{part}: {text:?} is not a number")]
    Number {
        /// `eye`, `target` or `field of view`.
        part: &'static str,
        /// Text that is not a number.
        text: String,
    },
    /// A number is infinite or NaN.
    #[error("{part}: {text:?} is not finite")]
    NotFinite {
        /// `eye`, `target` or `field of view`.
        part: &'static str,
        /// The text of the number.
        text: String,
    },
    /// The field of view is out of range.
    #[error("the field of view must lie between 0 and 180 degrees")]
    FieldOfView,
    /// The points do not define a view.
    #[error(transparent)]
    LookAt(#[from] LookAtError),
}

impl std::fmt::Debug for CameraTextError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}
