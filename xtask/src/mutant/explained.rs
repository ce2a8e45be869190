//! Faults that no test can see, each with the reason. A test sees to it that each still stands in its file.

use crate::mutant::plant::Mutant;

/// A fault that makes no difference, or none that a test could be sure of.
#[derive(Debug)]
pub struct Explained {
    pub file: &'static str,
    pub before: &'static str,
    pub after: &'static str,
    /// A sentence for the document.
    pub why: &'static str,
}

/// All of them, by file.
pub const EXPLAINED: &[Explained] = &[];

/// Why a fault that survived is no gap, if that is known.
pub fn why(mutant: &Mutant) -> Option<&'static str> {
    let same = |e: &&Explained| e.file == mutant.file && e.before == mutant.before && e.after == mutant.after;
    EXPLAINED.iter().find(same).map(|explained| explained.why)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mutant::room::ROOMS;

    #[test]
    fn every_explained_fault_can_still_be_planted() {
        let all: Vec<Mutant> = ROOMS.iter().flat_map(|room| room.mutants().expect("readable sources")).collect();
        assert!(all.len() > 1000, "{}", all.len());
        for Explained { file, before, after, why } in EXPLAINED {
            let there = all.iter().any(|m| m.file == *file && m.before == *before && m.after == *after);
            assert!(there && why.ends_with('.'), "{file}: `{before}` with `{after}` instead");
        }
    }
}
