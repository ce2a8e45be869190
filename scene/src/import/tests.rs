//! The importer on files made in code: what is right comes out right, what is wrong is one line.

mod document;
mod fixture;
mod fuzz;
mod geometry;
mod hostile;
mod lines;
mod lobes;
mod motion;
mod real_files;
mod shading;
