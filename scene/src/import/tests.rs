//! The importer on files made in code: what is right comes out right, what is wrong is one line.

#[cfg(all(feature = "draco", feature = "meshopt"))]
mod compressed;
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
#[cfg(all(feature = "webp", feature = "basisu"))]
mod textures;
