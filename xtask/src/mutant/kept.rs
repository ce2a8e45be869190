//! What became of faults, kept in `target/mutants` for as long as the tests are the same: an interrupted run goes on where it
//! was.

use crate::mutant::plant::Mutant;
use crate::mutant::run::Fate;
use std::collections::BTreeMap;
use std::fs::{self, OpenOptions};
use std::io::Write as _;
use std::path::{Path, PathBuf};

const WORDS: [(Fate, &str); 3] = [(Fate::Refused, "refused"), (Fate::Noticed, "noticed"), (Fate::Survived, "survived")];

/// The fates of a room's faults by their rank.
pub struct Kept {
    file: PathBuf,
    fates: BTreeMap<u64, Fate>,
    /// The tests have passed without a fault.
    pub sound: bool,
}

impl Kept {
    /// Those in `file` if they were judged by programs of this hash, else none.
    pub fn read(file: &Path, judge: u64) -> Self {
        let text = fs::read_to_string(file).unwrap_or_default();
        let head = format!("judge {judge:016x}");
        let mut lines = text.lines();
        let sound = lines.next() == Some(&head);
        let fate = |line: &str| {
            let (rank, word) = line.split_once(' ')?;
            let (fate, _) = WORDS.iter().find(|(_, other)| *other == word)?;
            Some((u64::from_str_radix(rank, 16).ok()?, *fate))
        };
        let fates = if sound { lines.filter_map(fate).collect() } else { BTreeMap::new() };
        Self { file: file.to_owned(), fates, sound }
    }

    /// Notes that the tests pass without a fault; what was kept of other tests goes.
    pub fn begin(&mut self, judge: u64) {
        // A file that cannot be written costs the next run its time, and no more.
        let _ = fs::write(&self.file, format!("judge {judge:016x}\n"));
        self.sound = true;
    }

    /// What is known of a fault.
    pub fn of(&self, mutant: &Mutant) -> Option<Fate> {
        self.fates.get(&mutant.rank()).copied()
    }

    /// Keeps what became of a fault.
    pub fn keep(&self, mutant: &Mutant, fate: Fate) {
        let word = WORDS.iter().find(|(other, _)| *other == fate).map_or("", |(_, word)| word);
        if let Ok(mut file) = OpenOptions::new().append(true).open(&self.file) {
            let _ = writeln!(file, "{:016x} {word}", mutant.rank());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mutant::plant::{Language, mutants};
    use crate::tree::Tree;

    #[test]
    fn fates_are_found_again_while_the_judge_is_the_same() {
        let tree = Tree::new(&[]);
        let file = tree.root().join("fates");
        let [first, second] = &mutants("a.wgsl", "a = b + c;", Language::Wgsl)[..2] else { panic!("two faults") };
        let mut kept = Kept::read(&file, 7);
        assert!(!kept.sound);
        kept.begin(7);
        kept.keep(first, Fate::Survived);
        let again = Kept::read(&file, 7);
        assert_eq!((again.sound, again.of(first), again.of(second)), (true, Some(Fate::Survived), None));
        let other = Kept::read(&file, 8);
        assert_eq!((other.sound, other.of(first)), (false, None));
    }
}
