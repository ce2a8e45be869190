//! Results of mutants, stored in `target/mutants` while the test programs are unchanged, so that an interrupted run
//! resumes. If the tests change, only the name of the test that detected each mutant is kept, since it is likely to
//! detect it again.

use crate::mutant::plant::Mutant;
use crate::mutant::run::Fate;
use std::collections::BTreeMap;
use std::fs::{self, OpenOptions};
use std::io::Write as _;
use std::path::{Path, PathBuf};

const WORDS: [(Fate, &str); 4] =
    [(Fate::Refused, "refused"), (Fate::Noticed, "noticed"), (Fate::Left, "left"), (Fate::Survived, "survived")];

/// Results of a room's mutants by rank.
#[derive(Default)]
pub struct Kept {
    file: PathBuf,
    fates: BTreeMap<u64, Fate>,
    /// Last test that detected each mutant, with the mutant's file.
    noticed_by: BTreeMap<u64, (String, String)>,
}

impl Kept {
    /// Reads stored results if the hash of the test programs matches. Otherwise keeps only the detecting tests, and
    /// starts the file anew.
    pub fn read(file: &Path, judge: u64) -> Self {
        let text = fs::read_to_string(file).unwrap_or_default();
        let head = format!("judge {judge:016x}");
        let mut lines = text.lines();
        let same = lines.next() == Some(&head);
        let (mut fates, mut noticed_by) = (BTreeMap::new(), BTreeMap::new());
        for line in lines {
            let mut words = line.split(' ');
            let (Some(rank), Some(word)) = (words.next(), words.next()) else { continue };
            let Ok(rank) = u64::from_str_radix(rank, 16) else { continue };
            let by = words.next().zip(words.next()).map(|(test, file)| (test.to_owned(), file.to_owned()));
            noticed_by.extend(by.map(|by| (rank, by)));
            let fate = WORDS.iter().find(|(_, other)| *other == word);
            fates.extend(fate.filter(|_| same).map(|(fate, _)| (rank, *fate)));
        }
        if !same {
            let likely = noticed_by.iter().map(|(rank, (test, file))| format!("{rank:016x} likely {test} {file}\n"));
            // If the file cannot be written, only time is lost on the next run.
            let _ = fs::write(file, format!("{head}\n{}", likely.collect::<String>()));
        }
        Self { file: file.to_owned(), fates, noticed_by }
    }

    /// Returns the stored result of a mutant.
    pub fn of(&self, mutant: &Mutant) -> Option<Fate> {
        self.fates.get(&mutant.rank()).copied()
    }

    /// Returns the test that is likely to detect a mutant.
    pub fn likely(&self, mutant: &Mutant) -> Option<&str> {
        self.noticed_by.get(&mutant.rank()).map(|(test, _)| test.as_str())
    }

    /// Returns the files of the mutants that a test detected.
    pub fn noticed_by<'k>(&'k self, test: &'k str) -> impl Iterator<Item = &'k str> {
        self.noticed_by.values().filter(move |(by, _)| by == test).map(|(_, file)| file.as_str())
    }

    /// Stores the result of a mutant, and the test that detected it.
    pub fn keep(&self, mutant: &Mutant, fate: Fate, test: &str) {
        let word = WORDS.iter().find(|(other, _)| *other == fate).map_or("", |(_, word)| word);
        if let Ok(mut file) = OpenOptions::new().append(true).open(&self.file) {
            let by = if test.is_empty() { String::new() } else { format!(" {test} {}", mutant.file) };
            let _ = writeln!(file, "{:016x} {word}{by}", mutant.rank());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mutant::plant::mutants;
    use crate::tree::Tree;

    #[test]
    fn fates_are_found_again_while_the_judge_is_the_same() {
        let tree = Tree::new(&[]);
        let file = tree.root().join("fates");
        let [first, second] = &mutants("a.wgsl", "a = b + c;")[..2] else { panic!("two faults") };
        let kept = Kept::read(&file, 7);
        kept.keep(first, Fate::Noticed, "a::b");
        let again = Kept::read(&file, 7);
        assert_eq!((again.of(first), again.of(second)), (Some(Fate::Noticed), None));
        let other = Kept::read(&file, 8);
        assert_eq!((other.of(first), other.likely(first)), (None, Some("a::b")));
        other.keep(second, Fate::Survived, "");
        let other = Kept::read(&file, 8);
        assert_eq!((other.of(first), other.likely(first)), (None, Some("a::b")));
        assert_eq!((other.of(second), other.likely(second)), (Some(Fate::Survived), None));
    }
}
