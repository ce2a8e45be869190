//! File dialogs that panels request from the application.

/// Kind of a requested file dialog.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileRequest {
    /// Opens a scene, an environment or settings.
    Open,
    /// Saves the settings of the frame.
    SaveSettings,
    /// Saves the texture of the preview.
    SaveTexture,
}
