//! Cross-crate tests: counts, images, properties.
