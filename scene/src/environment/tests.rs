//! Environments compared with closed forms and brute-force integration; real and damaged files.

mod extract;
mod files;
mod projection;
mod sky;
