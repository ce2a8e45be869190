//! Dependencies of the workspace, checked against `deny.toml`: licenses, duplicate versions, sources, known advisories.
//!
//! `cargo deny check` does more; this test runs everywhere, from Cargo.lock and cargo's metadata.

use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::Command;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn read(name: &str) -> String {
    std::fs::read_to_string(root().join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// Returns the quoted texts after `key = [`, up to `]`.
fn list(deny: &str, key: &str) -> Vec<String> {
    let (_, after) = deny.split_once(&format!("\n{key} = [")).unwrap_or_else(|| panic!("{key} is not there"));
    let (inside, _) = after.split_once(']').expect("the list ends");
    inside.split('"').skip(1).step_by(2).map(str::to_owned).collect()
}

/// A package of the lock file, as described by cargo.
struct Package {
    name: String,
    version: String,
    license: String,
    /// Source of the package; `None` for a crate of the workspace.
    source: Option<String>,
}

fn packages() -> Vec<Package> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let words = ["metadata", "--format-version", "1", "--locked", "--all-features"];
    let output = Command::new(cargo).args(words).current_dir(root()).output().expect("cargo starts");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let all: Value = serde_json::from_slice(&output.stdout).expect("cargo writes JSON");
    let text = |package: &Value, key: &str| package[key].as_str().map(str::to_owned);
    let packages = all["packages"].as_array().expect("there are packages").iter();
    let packages: Vec<Package> = packages
        .map(|package| Package {
            name: text(package, "name").expect("each has a name"),
            version: text(package, "version").expect("each has a version"),
            license: text(package, "license").unwrap_or_default(),
            source: text(package, "source"),
        })
        .collect();
    assert!(packages.len() > 100, "{} packages", packages.len());
    packages
}

/// Returns true if an SPDX expression can be satisfied with these licenses. `AND` binds more tightly than `OR`; an
/// exception only adds permissions.
fn is_met(expression: &str, allowed: &[String]) -> bool {
    let spaced = expression.replace('/', " OR ").replace('(', " ( ").replace(')', " ) ");
    let words: Vec<&str> = spaced.split_whitespace().collect();
    any(&mut words.as_slice(), allowed)
}

fn any(words: &mut &[&str], allowed: &[String]) -> bool {
    let mut met = all(words, allowed);
    while let ["OR", rest @ ..] = *words {
        *words = rest;
        met |= all(words, allowed);
    }
    met
}

fn all(words: &mut &[&str], allowed: &[String]) -> bool {
    let mut met = one(words, allowed);
    while let ["AND", rest @ ..] = *words {
        *words = rest;
        met &= one(words, allowed);
    }
    met
}

fn one(words: &mut &[&str], allowed: &[String]) -> bool {
    match *words {
        ["(", rest @ ..] => {
            *words = rest;
            let met = any(words, allowed);
            *words = words.strip_prefix(&[")"]).expect("a bracket closes");
            met
        }
        [license, "WITH", _, rest @ ..] | [license, rest @ ..] => {
            *words = rest;
            allowed.iter().any(|allowed| allowed == license)
        }
        [] => false,
    }
}

#[test]
fn every_license_is_allowed() {
    let allowed = list(&read("deny.toml"), "allow");
    let refused: Vec<String> = packages()
        .into_iter()
        .filter(|package| !is_met(&package.license, &allowed))
        .map(|package| format!("{} {}: {:?}", package.name, package.version, package.license))
        .collect();
    assert!(refused.is_empty(), "{refused:#?}");
    let mit = ["MIT".to_owned()];
    for (expression, met) in [
        ("MIT/Apache-2.0", true),
        ("(GPL-3.0 OR MIT) AND MIT", true),
        ("MIT AND (GPL-3.0 OR BSD-3-Clause)", false),
        ("Apache-2.0 WITH LLVM-exception OR MIT", true),
        ("GPL-3.0", false),
        ("", false),
    ] {
        assert_eq!(is_met(expression, &mit), met, "{expression}");
    }
}

#[test]
fn a_crate_has_two_versions_only_with_a_reason() {
    let skip = list(&read("deny.toml"), "skip");
    // Each entry is a crate with a reason.
    assert!(skip.iter().skip(1).step_by(2).all(|reason| !reason.is_empty()));
    let skipped: Vec<&String> = skip.iter().step_by(2).collect();
    let mut versions: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for package in packages() {
        versions.entry(package.name).or_default().insert(package.version);
    }
    let mut twice = BTreeSet::new();
    for (name, versions) in versions.iter().filter(|(_, versions)| versions.len() > 1) {
        let named: BTreeSet<String> = versions.iter().map(|version| format!("{name}@{version}")).collect();
        let left: Vec<_> = named.iter().filter(|version| !skipped.contains(version)).collect();
        assert_eq!(left.len(), 1, "{left:?} beside each other; move to one, or say why in deny.toml");
        twice.extend(named);
    }
    let gone: Vec<_> = skipped.iter().filter(|skip| !twice.contains(**skip)).collect();
    assert!(gone.is_empty(), "deny.toml skips what is not there twice: {gone:?}");
}

#[test]
fn crates_come_from_the_registry_alone() {
    let registry = "registry+https://github.com/rust-lang/crates.io-index";
    for Package { name, source, .. } in packages() {
        assert!(source.as_deref().is_none_or(|source| source == registry), "{name}: {source:?}");
    }
}

/// Number of crates that were added after the snapshot and not looked up when this list was started. The two crates of
/// `multiversion`, which came with the list, are not included.
const OPEN: usize = 58;

/// Parses the three numbers of a version.
fn numbers(version: &str) -> [u64; 3] {
    let mut parts = version.split(['.', '-', '+']).map(|part| part.parse().unwrap_or(0));
    std::array::from_fn(|_| parts.next().unwrap_or(0))
}

/// Returns true if a line of the snapshot applies to this version of a crate.
fn concerns(line: &[&str], name: &str, version: &str) -> bool {
    let version = numbers(version);
    name == line[0] && version >= numbers(line[2]) && (line[3] == "-" || version < numbers(line[3]))
}

#[test]
fn no_version_has_a_known_advisory() {
    let snapshot = read("tests/advisories.txt");
    let lines = snapshot.lines().filter(|line| !line.starts_with('#'));
    let lines: Vec<Vec<&str>> = lines.map(|line| line.split(' ').collect()).collect();
    assert!(lines.len() > 20 && lines.iter().all(|line| line.len() == 4), "{lines:?}");
    for Package { name, version, .. } in packages() {
        let known: Vec<_> = lines.iter().filter(|line| concerns(line, &name, &version)).map(|line| line[1]).collect();
        assert!(known.is_empty(), "{name} {version}: {known:?}, see https://rustsec.org/advisories");
    }
    let known = |name, version| lines.iter().filter(|line| concerns(line, name, version)).count();
    assert_eq!((known("slab", "0.4.9"), known("slab", "0.4.10"), known("slab", "0.4.11")), (0, 1, 0));
    assert_eq!(known("paste", "1.0.15"), 1, "it left with pulp, which newer versions of exr ask for");
}

/// Returns the names below a heading of the list, up to an empty line.
fn names<'a>(list: &'a str, head: &str) -> BTreeSet<&'a str> {
    let (_, after) = list.split_once(&format!("\n{head}:\n")).unwrap_or_else(|| panic!("{head} is not there"));
    after.split("\n\n").next().unwrap_or_default().split_whitespace().collect()
}

/// Every crate was looked up in the snapshot, or is listed as not looked up. A new crate fails this test, and the list
/// may not grow.
#[test]
fn every_crate_was_looked_up_or_is_said_not_to_be() {
    let (lock, list) = (read("Cargo.lock"), read("tests/advisories_looked_up.txt"));
    let foreign = lock.split("[[package]]").filter(|package| package.contains("\nsource = "));
    let locked: BTreeSet<&str> =
        foreign.filter_map(|package| package.split("name = \"").nth(1)?.split('"').next()).collect();
    let (known, open) = (names(&list, "looked up"), names(&list, "not looked up yet"));
    assert!(locked.len() > 200 && known.is_disjoint(&open));
    let new: Vec<_> = locked.iter().filter(|name| !known.contains(*name) && !open.contains(*name)).collect();
    assert!(new.is_empty(), "look up on https://rustsec.org, and add to tests/advisories_looked_up.txt: {new:?}");
    let gone: Vec<_> = known.union(&open).filter(|name| !locked.contains(*name)).collect();
    assert!(gone.is_empty(), "no longer in Cargo.lock: {gone:?}");
    assert!(open.len() <= OPEN, "{} crates are not looked up", open.len());
}
