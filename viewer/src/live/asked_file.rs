//! What a panel asks a file for; the application answers with a dialog.

/// What a file is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AskedFile {
    /// A scene, light or settings, to be opened.
    Open,
    /// To write the settings of the frame to.
    SaveSettings,
}
