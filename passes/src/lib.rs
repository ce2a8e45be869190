//! The frame of Filament as render-graph pass plugins.
