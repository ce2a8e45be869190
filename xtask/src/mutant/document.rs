//! `docs/mutants.md`, as `cargo xtask mutants` prints it.

use crate::mutant::explained::why;
use crate::mutant::judge;
use crate::mutant::plant::{Kind, Mutant};
use crate::mutant::run::Fate;

/// A room's faults and what became of them.
pub struct Tried {
    pub name: &'static str,
    /// How many faults can be planted.
    pub possible: usize,
    pub fates: Vec<(Mutant, Fate)>,
}

impl Tried {
    fn count(&self, of: impl Fn(&Mutant, Fate) -> bool) -> usize {
        self.fates.iter().filter(|(mutant, fate)| of(mutant, *fate)).count()
    }

    /// Share of the faults that compile and are neither noticed nor explained, in percent.
    pub fn unexplained_percent(&self) -> f64 {
        let valid = self.count(|_, fate| fate != Fate::Refused).max(1);
        100.0 * self.survivors(false).count() as f64 / valid as f64
    }

    fn survivors(&self, explained: bool) -> impl Iterator<Item = &Mutant> {
        let survived = self.fates.iter().filter(|(_, fate)| *fate == Fate::Survived);
        survived.map(|(mutant, _)| mutant).filter(move |mutant| why(mutant).is_some() == explained)
    }
}

/// The document.
pub fn document(rooms: &[Tried]) -> String {
    let mut text = format!(
        "# Planted faults\n\n\
         Printed by `cargo xtask mutants{named} --out docs/mutants.md`: operators, comparisons, constants and channels\n\
         are changed and statements left out, one at a time, and tests run: each alone, those alone that compile the faulty line, the likeliest\n\
         first, until one falls: those of up to {quick} seconds of processor time, and where all of those pass longer ones, each\n\
         kind for up to {asked} seconds. A fault that the compiler refuses does not count. Faults are tried in the order of a\n\
         hash of file, line and faulty line (FNV-1a), so that a sample is even, and the same one each time; `--all` tries every\n\
         one, `--count N` as many as that. A room that is not here was not asked about; `cargo xtask mutants --help` has all.\n",
        named = rooms.iter().map(|room| format!(" {}", room.name)).collect::<String>(),
        quick = judge::QUICK,
        asked = judge::ASKED,
    );
    for room in rooms {
        text += &format!(
            "\n## {}\n\n{} of {} possible faults; {:.1} % are neither noticed nor explained.\n\n",
            room.name,
            room.fates.len(),
            room.possible,
            room.unexplained_percent()
        );
        text +=
            "| fault | tried | refused | noticed | explained | unexplained |\n| --- | --- | --- | --- | --- | --- |\n";
        for kind in Kind::ALL {
            text += &row(room, kind.name(), |mutant| mutant.kind == kind);
        }
        text += &row(room, "all", |_| true);
        if room.survivors(true).next().is_some() {
            text += "\n| where | the line | with the fault | why no test can see it |\n| --- | --- | --- | --- |\n";
            for mutant in room.survivors(true) {
                let why = why(mutant).unwrap_or_default();
                text += &format!("| {} | {} | {} | {why} |\n", mutant.file, cell(&mutant.before), cell(&mutant.after));
            }
        }
        if room.survivors(false).next().is_some() {
            text += "\nUnexplained:\n\n| where | the line | with the fault |\n| --- | --- | --- |\n";
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

/// A line of code in a cell of a table.
fn cell(code: &str) -> String {
    if code.is_empty() { "(left out)".to_owned() } else { format!("`{}`", code.replace('|', "\\|")) }
}
