//! Text of `docs/measurements/mutants.md`.

use crate::mutant::explained::why;
use crate::mutant::judge;
use crate::mutant::plant::{Kind, Mutant};
use crate::mutant::run::Fate;

/// Mutants of a room with their results.
pub struct Tried {
    pub name: &'static str,
    /// Number of possible mutants.
    pub possible: usize,
    pub fates: Vec<(Mutant, Fate)>,
}

impl Tried {
    fn count(&self, of: impl Fn(&Mutant, Fate) -> bool) -> usize {
        self.fates.iter().filter(|(mutant, fate)| of(mutant, *fate)).count()
    }

    /// Percentage of compiled mutants that are neither detected nor explained.
    pub fn unexplained_percent(&self) -> f64 {
        let valid = self.count(|_, fate| fate != Fate::Refused).max(1);
        100.0 * self.survivors(false).count() as f64 / valid as f64
    }

    fn survivors(&self, explained: bool) -> impl Iterator<Item = &Mutant> {
        let survived = self.fates.iter().filter(|(_, fate)| *fate == Fate::Survived);
        survived.map(|(mutant, _)| mutant).filter(move |mutant| why(mutant).is_some() == explained)
    }
}

/// Returns the document.
pub fn document(rooms: &[Tried]) -> String {
    let mut text = format!(
        "# Mutation testing\n\n\
         Printed by `cargo xtask mutants{named} --out docs/measurements/mutants.md`. A mutant changes an operator, comparison, constant or\n\
         vector component, or removes a statement. Tests run one at a time until one fails, the most likely first, and only tests\n\
         that compile the changed line. Tests of up to {quick} s of processor time run first, then longer ones, each group for up to\n\
         {asked} s. Mutants that do not compile are invalid and not counted.\n\n\
         Mutants are drawn in the order of a hash (FNV-1a) of file, line and changed line, so a sample is uniform and reproducible.\n\
         `--all` tries every mutant, `--count N` the first N. `cargo xtask mutants --help` lists all sets of files.\n",
        named = rooms.iter().map(|room| format!(" {}", room.name)).collect::<String>(),
        quick = judge::QUICK,
        asked = judge::ASKED,
    );
    for room in rooms {
        text += &format!(
            "\n## {}\n\n{} of {} possible mutants; {:.1} % are neither detected nor explained.\n\n",
            room.name,
            room.fates.len(),
            room.possible,
            room.unexplained_percent()
        );
        text +=
            "| kind | tried | invalid | detected | explained | unexplained |\n| --- | --- | --- | --- | --- | --- |\n";
        for kind in Kind::ALL {
            text += &row(room, kind.name(), |mutant| mutant.kind == kind);
        }
        text += &row(room, "all", |_| true);
        if room.survivors(true).next().is_some() {
            text += "\n| file | line | mutant | why no test can detect it |\n| --- | --- | --- | --- |\n";
            for mutant in room.survivors(true) {
                let why = why(mutant).unwrap_or_default();
                text += &format!("| {} | {} | {} | {why} |\n", mutant.file, cell(&mutant.before), cell(&mutant.after));
            }
        }
        if room.survivors(false).next().is_some() {
            text += "\nUnexplained:\n\n| file | line | mutant |\n| --- | --- | --- |\n";
            for mutant in room.survivors(false) {
                text += &format!("| {} | {} | {} |\n", mutant.file, cell(&mutant.before), cell(&mutant.after));
            }
        }
    }
    text
}

fn row(room: &Tried, name: &str, of: impl Fn(&Mutant) -> bool) -> String {
    let count = |wanted: fn(Fate) -> bool| room.count(|mutant, fate| of(mutant) && wanted(fate));
    let (tried, refused) = (count(|_| true), count(|fate| fate == Fate::Refused));
    let noticed = count(|fate| fate == Fate::Noticed);
    let explained = room.survivors(true).filter(|mutant| of(mutant)).count();
    let unexplained = room.survivors(false).filter(|mutant| of(mutant)).count();
    format!("| {name} | {tried} | {refused} | {noticed} | {explained} | {unexplained} |\n")
}

/// Formats a line of code for a table cell.
fn cell(code: &str) -> String {
    if code.is_empty() { "(left out)".to_owned() } else { format!("`{}`", code.replace('|', "\\|")) }
}
