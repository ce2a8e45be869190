//! The importer on generated files: valid files load correctly, and invalid files return one line.

mod attached;
mod cases;
mod character;
#[cfg(all(feature = "draco", feature = "meshopt"))]
mod compressed;
mod document;
mod extras;
mod fixture;
mod fuzz;
mod geometry;
mod hostile;
mod hostile_motion;
mod letter_case;
mod lines;
mod lobes;
mod loose_json;
mod motion;
mod placing;
mod pointer;
mod real_files;
mod repairs;
mod shading;
mod spec_gloss;
mod switches;
#[cfg(all(feature = "webp", feature = "basisu"))]
mod textures;
mod variants;
