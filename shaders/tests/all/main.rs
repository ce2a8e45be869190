//! Tests of the shaders as they are at run time: one binary, a module a subject.

mod backends;
mod bindings;
mod branches;
mod effects;
mod errors;
mod mirror;
mod operations;
mod sources;
mod validation;
mod variants;
