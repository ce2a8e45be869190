//! `cargo xtask rooms`: counts the crates, lines and build time of each package.

use super::Command;
use crate::options::Options;
use crate::source::module::Crate;
use crate::{Failure, rustc_time, workspace};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// The command.
pub const COMMAND: Command = Command {
    name: "rooms",
    summary: "print the table of docs/measurements/rooms.md: crates, lines and build time per package",
    details: "\
Prints counts for each package at commit f6971f2, before the packages were split,
and now: crates that a user compiles, crates that wgpu does not need itself, lines
of Rust without tests, and lines of WGSL. Crates are counted for Linux.

  --build       also build all packages from scratch in release, in target/rooms,
                and print rustc's processor time in seconds for each package with
                its dependencies; Linux only
",
    run,
};

/// One row: a package with a set of features.
struct Row {
    /// Name of the row.
    name: &'static str,
    package: &'static str,
    /// Options of cargo that select features.
    features: &'static [&'static str],
    /// Folder of the package; `None` if the row above counts its lines.
    folder: Option<&'static str>,
    /// Values at commit f6971f2, counted in the same way.
    before: Before,
}

/// Crates, crates beyond wgpu, lines of Rust, lines of WGSL, and build time in seconds at commit f6971f2. A dash stands
/// for a value that did not exist or that another row has.
type Before = [&'static str; 5];

const fn row(
    name: &'static str,
    package: &'static str,
    features: &'static [&'static str],
    folder: Option<&'static str>,
    before: Before,
) -> Row {
    Row { name, package, features, folder, before }
}

const ROWS: &[Row] = &[
    row("`framegraph`: the compiler", "framegraph", &[], Some("framegraph"), ["24", "-", "21254", "-", "61"]),
    row("… without default features", "framegraph", &["--no-default-features"], None, ["24", "-", "-", "-", "61"]),
    row(
        "`framegraph/pack`: its packer of memory",
        "framegraph-pack",
        &[],
        Some("framegraph/pack"),
        ["-", "-", "-", "-", "-"],
    ),
    row(
        "`framegraph/queues`: plans on several queues",
        "framegraph-queues",
        &[],
        Some("framegraph/queues"),
        ["-", "-", "-", "-", "-"],
    ),
    row("`vulkan`: the executor on Vulkan", "framegraph-vulkan", &[], Some("vulkan"), ["-", "-", "-", "-", "-"]),
    row("`renderer`: the executor", "framegraph-wgpu", &[], Some("renderer"), ["142", "81", "18179", "-", "458"]),
    row(
        "… on Vulkan alone",
        "framegraph-wgpu",
        &["--no-default-features", "--features", "vulkan"],
        None,
        ["142", "81", "-", "-", "458"],
    ),
    row("`scene`", "framegraph-scene", &[], Some("scene"), ["142", "81", "-", "-", "458"]),
    row("`shaders`", "framegraph-shaders", &[], Some("shaders"), ["62", "-", "5399", "3494", "192"]),
    row("`passes`", "framegraph-passes", &[], Some("passes"), ["143", "82", "2149", "-", "461"]),
    row("`egui`: panels for egui", "framegraph-egui", &[], Some("egui"), ["-", "-", "-", "-", "-"]),
    row("the program `render`", "examples", &[], None, ["169", "108", "-", "-", "523"]),
];

/// Crates are counted for one system, so that the table does not depend on where it is printed.
const TARGET: &str = "x86_64-unknown-linux-gnu";

/// Counts of one row.
struct Counts {
    crates: BTreeSet<String>,
    /// Number of crates that wgpu does not need itself; `None` if wgpu is not among the crates.
    beyond_wgpu: Option<usize>,
    /// Lines of Rust and of WGSL; `None` if the row above has them.
    lines: Option<(usize, usize)>,
}

fn run(options: &Options) -> Result<(), Failure> {
    let root = workspace::root();
    let seconds = if options.has("--build") { Some(build(&root)?) } else { None };
    let mut text = head();
    for row in ROWS {
        let counts = count(&root, row).map_err(Failure::Failed)?;
        text += &line(row, &counts, seconds.as_ref());
    }
    program::print(text);
    Ok(())
}

fn head() -> String {
    let titles = ["room", "crates before", "now", "beyond wgpu before", "now", "Rust lines before", "now"];
    let titles = titles.into_iter().chain(["WGSL lines before", "now", "build s before", "now"]);
    let titles: Vec<&str> = titles.collect();
    format!("| {} |\n|{}\n", titles.join(" | "), " --- |".repeat(titles.len()))
}

fn line(row: &Row, counts: &Counts, seconds: Option<&BTreeMap<String, f64>>) -> String {
    let Counts { crates, beyond_wgpu, lines } = counts;
    let cell = |number: Option<usize>| number.map_or_else(|| "-".to_owned(), |number| number.to_string());
    // Crates that only build scripts need are built, but are not in the counted tree.
    let seconds = seconds.map(|all| {
        let own = crates.iter().filter_map(|name| name.split(' ').next());
        own.filter_map(|name| all.get(&name.replace('-', "_"))).sum::<f64>().round() as usize
    });
    let now = [
        Some(crates.len()),
        *beyond_wgpu,
        lines.map(|(rust, _)| rust),
        lines.map(|(_, wgsl)| wgsl).filter(|lines| *lines > 0),
        seconds,
    ];
    let cells = row.before.iter().zip(now).map(|(before, now)| format!("{before} | {}", cell(now)));
    format!("| {} | {} |\n", row.name, cells.collect::<Vec<_>>().join(" | "))
}

fn count(root: &Path, row: &Row) -> Result<Counts, String> {
    let tree = tree(root, row)?;
    let crates: BTreeSet<String> = tree.iter().map(|(_, name)| name.clone()).collect();
    let wgpus = below(&tree, "wgpu");
    let beyond_wgpu = (!wgpus.is_empty()).then(|| crates.len() - wgpus.len());
    let lines = row.folder.map(|folder| lines(root, folder)).transpose()?;
    Ok(Counts { crates, beyond_wgpu, lines })
}

/// Returns the crates of a row as a tree: depth, then name and version.
fn tree(root: &Path, row: &Row) -> Result<Vec<(usize, String)>, String> {
    let fixed = ["tree", "--locked", "--edges", "normal", "--prefix", "depth", "--no-dedupe", "--target", TARGET];
    let mut command = workspace::cargo(&fixed);
    command.current_dir(root).args(["--package", row.package]).args(row.features);
    let output = command.output().map_err(|error| format!("cargo tree: {error}"))?;
    if !output.status.success() {
        let told = String::from_utf8_lossy(&output.stderr);
        return Err(format!("{}: cargo tree: {}", row.package, told.trim()));
    }
    let parse = |line: &str| {
        let digits = line.find(|c: char| !c.is_ascii_digit())?;
        let name: Vec<&str> = line[digits..].split(' ').take(2).collect();
        Some((line[..digits].parse().ok()?, name.join(" ")))
    };
    Ok(String::from_utf8_lossy(&output.stdout).lines().filter_map(parse).collect())
}

/// Returns a crate and its dependencies in the tree.
fn below(tree: &[(usize, String)], name: &str) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    let mut inside = None;
    for (depth, krate) in tree {
        if inside.is_some_and(|top| *depth <= top) {
            inside = None;
        }
        if inside.is_none() && krate.split(' ').next() == Some(name) {
            inside = Some(*depth);
        }
        if inside.is_some() {
            found.insert(krate.clone());
        }
    }
    found
}

/// Counts the lines of a package: Rust files of its library, with comments and without tests, and WGSL files.
fn lines(root: &Path, folder: &str) -> Result<(usize, usize), String> {
    let library = Crate::read(root, &Path::new(folder).join("src/lib.rs"))?;
    let mut wgsl = 0;
    let mut open = vec![root.join(folder)];
    while let Some(folder) = open.pop() {
        let entries = fs::read_dir(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
        for path in entries.flatten().map(|entry| entry.path()) {
            if path.is_dir() {
                open.push(path);
            } else if path.extension().is_some_and(|ending| ending == "wgsl") {
                let text = fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
                wgsl += text.lines().count();
            }
        }
    }
    Ok((library.lines.iter().sum(), wgsl))
}

/// Builds all packages from scratch. Returns seconds of processor time by crate.
fn build(root: &Path) -> Result<BTreeMap<String, f64>, Failure> {
    let folder: PathBuf = root.join("target/rooms");
    let failed = |error: std::io::Error| Failure::Failed(format!("{}: {error}", folder.display()));
    if folder.exists() {
        fs::remove_dir_all(&folder).map_err(failed)?;
    }
    fs::create_dir_all(&folder).map_err(failed)?;
    let log = folder.join("rustc.log");
    let mut command = workspace::cargo(&["build", "--release", "--locked", "--package", "examples", "--bin", "render"]);
    command.env("CARGO_TARGET_DIR", folder.join("target")).env(rustc_time::LOG, &log);
    let program = std::env::current_exe().map_err(failed)?;
    let outcome = crate::stage::run("build", command.env("RUSTC_WRAPPER", program));
    outcome.result.map_err(|reason| Failure::Failed(format!("build: {reason}")))?;
    let text = fs::read_to_string(&log).map_err(failed)?;
    Ok(rustc_time::sums(&text))
}

#[cfg(test)]
mod tests {
    use super::*;

    const DOCUMENT: &str = include_str!("../../../docs/measurements/rooms.md");

    /// Crate counts must match, since Cargo.lock fixes them. Lines may differ by 2 % before the table has to be printed
    /// again. Build times are not compared.
    #[test]
    fn the_document_holds_what_the_command_prints() {
        let (_, after) = DOCUMENT.split_once("<!-- table: rooms -->").expect("the document has the table");
        let (table, _) = after.split_once("<!-- end -->").expect("the table ends");
        let mut rows = table.trim().lines();
        assert_eq!(rows.by_ref().take(2).map(|line| format!("{line}\n")).collect::<String>(), head());
        let cells = |line: &str| -> Vec<String> { line.trim_matches('|').split(" | ").map(str::to_owned).collect() };
        for row in ROWS {
            let counts = count(&workspace::root(), row).expect("the room can be counted");
            promised(row, &counts);
            let printed = cells(line(row, &counts, None).trim());
            let shown = cells(rows.next().unwrap_or_else(|| panic!("{}: no row", row.name)));
            for (at, (printed, shown)) in printed.iter().zip(&shown).enumerate().take(10) {
                let near = match (printed.trim().parse::<f64>(), shown.trim().parse::<f64>()) {
                    (Ok(printed), Ok(shown)) if at == 6 || at == 8 => (printed - shown).abs() <= printed / 50.0,
                    _ => printed == shown,
                };
                assert!(near, "{}: column {at} is {printed}, not {shown}: `cargo xtask rooms`", row.name);
            }
        }
        assert_eq!(rows.next(), None);
    }

    /// Checks the limits on dependencies: the compiler alone needs almost none, and the executor few beyond wgpu.
    fn promised(row: &Row, Counts { crates, beyond_wgpu, .. }: &Counts) {
        match (row.package, row.features) {
            ("framegraph", ["--no-default-features"]) => assert!(crates.len() <= 8, "{crates:?}"),
            ("framegraph-wgpu", _) => assert!(beyond_wgpu.is_some_and(|crates| crates <= 12), "{beyond_wgpu:?}"),
            _ => {}
        }
    }

    #[test]
    fn what_is_below_a_crate_is_found_wherever_it_stands() {
        let tree = [(0, "a v1"), (1, "wgpu v3"), (2, "b v1"), (1, "b v1"), (1, "c v1"), (2, "wgpu v3"), (3, "d v1")];
        let tree = tree.map(|(depth, name)| (depth, name.to_owned()));
        assert_eq!(below(&tree, "wgpu").into_iter().collect::<Vec<_>>(), ["b v1", "d v1", "wgpu v3"]);
        assert!(below(&tree, "gone").is_empty());
    }
}
