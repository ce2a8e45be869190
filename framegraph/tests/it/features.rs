//! What the crate costs whoever builds it.

#[test]
fn without_features_nothing_else_is_built() {
    let manifest = include_str!("../../Cargo.toml");
    let section = manifest.split("\n[").find_map(|s| s.strip_prefix("dependencies]")).expect("a list of dependencies");
    let dependencies: Vec<_> = section.lines().filter(|l| l.contains('=') && !l.starts_with('#')).collect();
    assert!(dependencies.len() >= 4, "{dependencies:?}");
    for line in dependencies {
        assert!(line.contains("optional = true"), "`{line}` is built by every user; put it behind a feature");
    }
}
