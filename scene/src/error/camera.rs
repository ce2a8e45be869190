//! What can be wrong with a camera.

/// Why a camera cannot look from one point to another.
#[derive(Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum LookAtError {
    /// A coordinate is infinite or NaN.
    #[error("a coordinate is not finite")]
    NotFinite,
    /// There is no direction from a point to itself.
    #[error("eye and target coincide")]
    Coincide,
}

impl std::fmt::Debug for LookAtError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}

/// Why a camera written as text, `NAME`, `orbit`, or `EX,EY,EZ:TX,TY,TZ:FOVY`, is none.
#[derive(Clone, PartialEq, Eq, thiserror::Error)]
pub enum CameraTextError {
    /// There is no text.
    #[error("the name is empty")]
    EmptyName,
    /// There are not three parts between colons.
    #[error("{found} parts between colons, not 3")]
    Parts {
        /// How many there are.
        found: usize,
    },
    /// A point has not three coordinates.
    #[error("{part}: {found} coordinates, not 3")]
    Coordinates {
        /// `eye` or `target`.
        part: &'static str,
        /// How many there are.
        found: usize,
    },
    /// A number does not parse.
    #[error("{part}: {text:?} is not a number")]
    Number {
        /// `eye`, `target` or `field of view`.
        part: &'static str,
        /// The text in place of the number.
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
    /// The field of view is that of no camera.
    #[error("the field of view must lie between 0 and 180 degrees")]
    FieldOfView,
    /// The points give no view.
    #[error(transparent)]
    LookAt(#[from] LookAtError),
}

impl std::fmt::Debug for CameraTextError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}
