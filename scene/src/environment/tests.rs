//! Environments against closed forms, brute-force integration, and real and damaged files.

mod extract;
mod files;
mod projection;
mod sky;
