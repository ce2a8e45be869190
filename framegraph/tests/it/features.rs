//! Dependencies of the crate.

#[test]
fn without_features_the_packer_and_an_arc_are_built() {
    optional(include_str!("../../Cargo.toml"), &["framegraph-pack", "triomphe"]);
    optional(include_str!("../../pack/Cargo.toml"), &[]);
}

/// Checks that all other dependencies are optional.
fn optional(manifest: &str, needed: &[&str]) {
    let section = manifest.split("\n[").find_map(|s| s.strip_prefix("dependencies]")).expect("a list of dependencies");
    let dependencies: Vec<_> = section.lines().filter(|l| l.contains('=') && !l.starts_with('#')).collect();
    assert!(dependencies.len() >= 2, "{dependencies:?}");
    for line in dependencies.into_iter().filter(|line| !needed.iter().any(|name| line.starts_with(name))) {
        assert!(line.contains("optional = true"), "`{line}` is built by every user; put it behind a feature");
    }
}
