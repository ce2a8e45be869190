//! The importer on files made in code: what is right comes out right, what is wrong is one line.

mod attached;
mod cases;
mod character;
mod document;
mod fixture;
mod fuzz;
mod geometry;
mod hostile;
mod lobes;
mod motion;
mod placing;
mod real_files;
mod shading;
