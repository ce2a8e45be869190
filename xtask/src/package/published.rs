//! Packages of the workspace that are published, and what they must have.

use std::fs;
use std::path::Path;

/// Files of a package outside of its source folders.
const FILES: [&str; 8] = [
    ".cargo_vcs_info.json",
    "Cargo.lock",
    "Cargo.toml",
    "Cargo.toml.orig",
    "LICENSE-APACHE",
    "LICENSE-MIT",
    "README.md",
    "build.rs",
];
/// Files that every package has.
const REQUIRED: [&str; 4] = ["LICENSE-APACHE", "LICENSE-MIT", "README.md", "src/lib.rs"];
/// Lines that every manifest has.
const LINES: [&str; 5] = [
    "repository.workspace = true",
    "readme = \"README.md\"",
    "[package.metadata.docs.rs]",
    "all-features = true",
    "rustdoc-args = [\"--cfg\", \"docsrs\"]",
];
/// Line of a library that shows on docs.rs which feature an item needs.
const BADGES: &str = "#![cfg_attr(docsrs, feature(doc_cfg))]";

/// A package of the workspace that is published.
#[derive(Debug)]
pub struct Published {
    /// Folder, from the workspace's root.
    pub folder: String,
    /// Name on crates.io.
    pub name: String,
    manifest: String,
}

impl Published {
    /// Returns what is missing in the manifest and the library.
    pub fn faults(&self, root: &Path) -> Vec<String> {
        let Self { folder, name, manifest } = self;
        let mut faults = Vec::new();
        let documentation = format!("documentation = \"https://docs.rs/{name}\"");
        for line in LINES.into_iter().chain([documentation.as_str()]) {
            if !manifest.lines().any(|own| own == line) {
                faults.push(format!("{folder}/Cargo.toml: the line `{line}` is missing; add it"));
            }
        }
        // Limits of crates.io.
        for (key, max_words, max_length) in [("keywords", 5, 20), ("categories", 5, usize::MAX)] {
            let words: Vec<&str> = value(manifest, key).unwrap_or_default().split('"').skip(1).step_by(2).collect();
            if words.is_empty() || words.len() > max_words || words.iter().any(|word| word.len() > max_length) {
                faults.push(format!("{folder}/Cargo.toml: `{key}` needs 1 to {max_words} words"));
            }
        }
        if value(manifest, "description").is_none_or(|text| text.len() < 30) {
            faults.push(format!("{folder}/Cargo.toml: `description` is missing; add one sentence"));
        }
        match fs::read_to_string(root.join(folder).join("src/lib.rs")) {
            Ok(text) if text.lines().any(|line| line == BADGES) => {}
            Ok(_) => faults.push(format!("{folder}/src/lib.rs: the line `{BADGES}` is missing; add it")),
            Err(error) => faults.push(format!("{folder}/src/lib.rs: {error}")),
        }
        faults
    }

    /// Returns the faults in the list of the package's files, as printed by `cargo package --list`.
    pub fn faults_of_files(&self, list: &str) -> Vec<String> {
        let files: Vec<String> = list.lines().map(|line| line.replace('\\', "/")).collect();
        let known =
            |file: &str| FILES.contains(&file) || ["src/", "wgsl/"].into_iter().any(|folder| file.starts_with(folder));
        let missing = REQUIRED.into_iter().filter(|file| !files.iter().any(|own| own == file));
        let missing = missing.map(|file| format!("{}: the package has no {file}; add it to `include`", self.folder));
        let foreign = files.iter().filter(|file| !known(file));
        let foreign = foreign.map(|file| format!("{}: the package has {file}; narrow `include`", self.folder));
        missing.chain(foreign).collect()
    }
}

/// Returns the text after `key = ` in a manifest.
fn value<'m>(manifest: &'m str, key: &str) -> Option<&'m str> {
    manifest.lines().find_map(|line| line.strip_prefix(key)?.trim_start().strip_prefix('='))
}

/// Returns all members of the workspace in `root` without `publish = false`.
///
/// # Errors
/// A manifest cannot be read, or has no name.
pub fn published(root: &Path) -> Result<Vec<Published>, String> {
    let read = |path: &Path| fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()));
    let workspace = read(&root.join("Cargo.toml"))?;
    let members = value(&workspace, "members").ok_or("Cargo.toml: no `members`")?;
    let mut all = Vec::new();
    for folder in members.split('"').skip(1).step_by(2) {
        let manifest = read(&root.join(folder).join("Cargo.toml"))?;
        if manifest.lines().any(|line| line == "publish = false") {
            continue;
        }
        let name = value(&manifest, "name").map(|name| name.trim().trim_matches('"').to_owned());
        let name = name.ok_or_else(|| format!("{folder}/Cargo.toml: no `name`"))?;
        all.push(Published { folder: folder.to_owned(), name, manifest });
    }
    Ok(all)
}

/// Returns published packages that other packages of the workspace cannot name by version.
///
/// # Errors
/// The workspace's manifest cannot be read.
pub fn without_version(root: &Path, all: &[Published]) -> Result<Vec<String>, String> {
    let text = fs::read_to_string(root.join("Cargo.toml")).map_err(|error| format!("Cargo.toml: {error}"))?;
    let version = value(&text, "version").map(str::trim).ok_or("Cargo.toml: no `version`")?;
    let wrong = |package: &&Published| {
        let dependency = value(&text, &package.name);
        dependency.is_some_and(|value| !value.contains(&format!("version = {version}")))
    };
    let told = |package: &Published| format!("Cargo.toml: `{}` needs `version = {version}`", package.name);
    Ok(all.iter().filter(wrong).map(told).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tree::Tree;
    use crate::workspace;

    #[test]
    fn every_published_package_is_complete() {
        let root = workspace::root();
        let all = published(&root).expect("the manifests can be read");
        assert!(all.len() >= 7, "{all:?}");
        let mut faults = without_version(&root, &all).expect("the manifest can be read");
        for package in &all {
            faults.extend(package.faults(&root));
            let list = ["package", "--list", "--offline", "--allow-dirty", "--package", &package.name];
            let output = workspace::cargo(&list).output().expect("cargo starts");
            assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
            faults.extend(package.faults_of_files(&String::from_utf8_lossy(&output.stdout)));
        }
        assert_eq!(faults, [""; 0]);
    }

    #[test]
    fn what_is_missing_is_named() {
        let workspace = "[workspace]\nmembers = [\"a\", \"b\"]\nversion = \"0.1.0\"\na = { path = \"a\" }\n";
        let tree = Tree::new(&[
            ("Cargo.toml", workspace),
            ("a/Cargo.toml", "name = \"a\"\nkeywords = [\"a-word-that-is-longer-than-others\"]\n"),
            ("a/src/lib.rs", ""),
            ("b/Cargo.toml", "name = \"b\"\npublish = false\n"),
        ]);
        let all = published(tree.root()).expect("sound");
        assert_eq!(all.iter().map(|package| &*package.name).collect::<Vec<_>>(), ["a"]);
        let faults = all[0].faults(tree.root()).join("\n");
        for part in ["`repository.workspace = true`", "docs.rs/a", "`keywords`", "`categories`", "lib.rs: the line"] {
            assert!(faults.contains(part), "{part}: {faults}");
        }
        let files = all[0].faults_of_files("src/lib.rs\nREADME.md\nLICENSE-MIT\ntests/big.png\n");
        assert_eq!(files.len(), 2, "{files:?}");
        assert!(files[0].contains("no LICENSE-APACHE") && files[1].contains("tests/big.png"));
        assert_eq!(without_version(tree.root(), &all).expect("sound").len(), 1);
    }
}
