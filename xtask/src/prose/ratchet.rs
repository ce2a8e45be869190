//! Highest allowed share of flagged sentences per folder, in a file that is committed.

use std::collections::BTreeMap;

use super::Folder;

/// The file, from the workspace's root.
pub const FILE: &str = "xtask/prose.ron";

/// Limit of a folder that the file does not list, in tenths of a percent.
const DEFAULT: usize = 40;

/// Smallest limit, in tenths of a percent: the rules also flag a few good sentences.
const MIN_LIMIT: usize = 20;

const HEAD: &str = "\
// Highest allowed share of flagged sentences per top-level folder, in percent.
// `cargo xtask prose --lower` lowers limits to the measured shares; limits are raised by hand.
(
    version: 1,
    max_percent: {
";

/// Limits by folder, in tenths of a percent.
#[derive(Debug, PartialEq, Eq)]
pub struct Limits(BTreeMap<String, usize>);

impl Limits {
    /// Reads the file's text.
    ///
    /// # Errors
    /// Another version, or a line that is not `"folder": percent,` with at most one decimal.
    pub fn read(text: &str) -> Result<Self, String> {
        if !text.lines().any(|line| line.trim() == "version: 1,") {
            return Err(format!("{FILE}: this program reads version 1"));
        }
        let entries = text.lines().map(str::trim).filter(|line| line.starts_with('"')).map(|line| {
            let entry = line.strip_suffix(',').and_then(|line| line.split_once(':'));
            let percent = entry.and_then(|(_, percent)| percent.trim().parse::<f64>().ok());
            let wrong = || format!("{FILE}: `{line}` is not `\"folder\": percent,`");
            let (name, percent) = entry.zip(percent).map(|((name, _), percent)| (name, percent)).ok_or_else(wrong)?;
            Ok((name.trim_matches('"').to_owned(), (percent * 10.0).round() as usize))
        });
        entries.collect::<Result<_, String>>().map(Self)
    }

    /// Returns the file's text.
    pub fn written(&self) -> String {
        let entries = self.0.iter().map(|(name, limit)| format!("        \"{name}\": {},\n", percent(*limit)));
        HEAD.to_owned() + &entries.collect::<String>() + "    },\n)\n"
    }

    /// Returns the limit of a folder, in tenths of a percent.
    pub fn of(&self, folder: &str) -> usize {
        self.0.get(folder).copied().unwrap_or(DEFAULT)
    }

    /// Returns limits no higher than the measured shares, but at least [`MIN_LIMIT`]. Folders that are not listed get
    /// their share as the limit; missing folders are removed.
    pub fn lowered(&self, folders: &BTreeMap<String, Folder>) -> Self {
        let limit = |name: &str, share: usize| self.0.get(name).map_or(share, |limit| share.min(*limit)).max(MIN_LIMIT);
        Self(folders.iter().map(|(name, folder)| (name.clone(), limit(name, folder.permille()))).collect())
    }
}

/// Formats tenths of a percent as percent.
pub fn percent(permille: usize) -> String {
    format!("{}.{}", permille / 10, permille % 10)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::prose::Flagged;

    fn folder(sentences: usize, flagged: usize) -> Folder {
        let one = |_| Flagged { place: String::new(), reasons: String::new(), sentence: String::new() };
        Folder { sentences, flagged: (0..flagged).map(one).collect() }
    }

    #[test]
    fn limits_are_lowered_and_never_raised() {
        let limits = Limits::read("(\nversion: 1,\nmax_percent: {\n\"a\": 5.0,\n\"b\": 12.5,\n\"gone\": 1.0,\n},\n)\n");
        let limits = limits.expect("sound");
        assert_eq!([limits.of("a"), limits.of("b"), limits.of("new")], [50, 125, DEFAULT]);
        let folders = [("a", folder(100, 9)), ("b", folder(300, 1)), ("new", folder(10, 3))];
        let lowered = limits.lowered(&folders.map(|(name, folder)| (name.to_owned(), folder)).into());
        assert_eq!(
            lowered.0,
            [("a", 50), ("b", MIN_LIMIT), ("new", 300)].map(|(name, limit)| (name.to_owned(), limit)).into()
        );
        assert_eq!(Limits::read(&lowered.written()), Ok(lowered));
    }

    #[test]
    fn other_versions_and_lines_are_refused() {
        assert!(Limits::read("(version: 2)").is_err_and(|error| error.contains("version 1")));
        let error = Limits::read("version: 1,\n\"a\": much,\n").expect_err("no number");
        assert_eq!(error, "xtask/prose.ron: `\"a\": much,` is not `\"folder\": percent,`");
    }
}
