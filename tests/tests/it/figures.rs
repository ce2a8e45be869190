//! Consistency of figures within rows of long runs: sums, quotients, differences, proofs. `cargo xtask documents`
//! compares with new runs; this test detects a changed figure.

const PROOFS: &str = include_str!("../../../docs/measurements/proofs.md");
const PERFORMANCE: &str = include_str!("../../../docs/measurements/performance.md");

/// A table row, accessed by column names.
struct Row<'a> {
    heads: &'a [&'a str],
    cells: Vec<&'a str>,
}

impl Row<'_> {
    fn text(&self, head: &str) -> &str {
        self.cells[self.heads.iter().position(|h| *h == head).unwrap_or_else(|| panic!("no column {head}"))]
    }

    /// Returns the first number of a cell and the one in parentheses, or the first twice.
    fn numbers(&self, at: usize) -> [f64; 2] {
        let number = |text: &str| {
            let text = text.trim().trim_end_matches(" %").trim_end_matches(')');
            text.parse().unwrap_or_else(|_| panic!("{text:?} is no number, in {:?}", self.cells))
        };
        match self.cells[at].split_once(" (") {
            Some((first, second)) => [number(first), number(second)],
            None => [number(self.cells[at]); 2],
        }
    }

    fn number(&self, head: &str) -> f64 {
        self.numbers(self.heads.iter().position(|h| *h == head).unwrap_or_else(|| panic!("no column {head}")))[0]
    }
}

fn cells(line: &str) -> Vec<&str> {
    line.strip_prefix('|').map_or_else(Vec::new, |line| line.trim_end_matches('|').split('|').map(str::trim).collect())
}

/// Checks each row of the tables whose head starts with `head`. Returns the number of rows.
fn each<'a>(document: &'a str, head: &str, mut holds: impl FnMut(&Row<'a>, &[Row<'a>]) -> bool) -> usize {
    let mut asked = 0;
    let mut lines = document.lines();
    while let Some(line) = lines.next() {
        if !line.starts_with(head) {
            continue;
        }
        let heads: &'a [&'a str] = Vec::leak(cells(line));
        let rows = lines.by_ref().take_while(|line| line.starts_with('|')).skip(1);
        let rows: Vec<Row<'a>> = rows.map(|line| Row { heads, cells: cells(line) }).collect();
        for row in &rows {
            assert!(holds(row, &rows), "{:?} of {heads:?}", row.cells);
        }
        asked += rows.len();
    }
    asked
}

/// Returns true if a figure with a number of digits is `made`, up to a relative rounding error of its inputs.
fn is(figure: f64, made: f64, digits: i32, off: f64) -> bool {
    (figure - made).abs() <= 0.51 * 10_f64.powi(-digits) + off * made.abs()
}

#[test]
fn proofs_of_long_runs_follow_from_their_row() {
    let (yes, open) = ("yes", "open");
    let cuts = each(PROOFS, "| cuts |", |row, _| {
        let [top, bound] = [row.number("top"), row.number("lower bound")];
        let is_proved = row.text("proved") == if top == bound { yes } else { open };
        is_proved && top >= bound && is(row.number("above it"), 100.0 * (top - bound) / bound, 2, 0.0)
    });
    let instances = each(PROOFS, "| instance |", |row, _| {
        let [top, bound] = [row.number("top"), row.number("lower bound")];
        let fits = row.number("peak") <= bound && top <= row.number("capacity in the name");
        fits && row.text("proved") == if top == bound { yes } else { open }
    });
    let frames = each(PROOFS, "| frame |", |row, _| {
        let [heap, bound] = [row.number("heap, B"), row.number("lower bound, B")];
        let [apart, pool] = [row.number("nothing shared, MiB"), row.number("pool, MiB")];
        let shared = heap / f64::from(1 << 20) <= pool && pool <= apart;
        shared && row.text("proved") == if heap == bound { yes } else { open }
    });
    let memory = each(PROOFS, "| shape | device | memory |", |row, _| {
        let [at_peak, optimal] = [row.number("at the peak"), row.number("proved optimal")];
        let [mean, largest] = [row.number("mean excess"), row.number("largest excess")];
        let whole = row.number("plans") * at_peak / 100.0;
        is(whole, whole.round(), 1, 0.0)
            && at_peak <= optimal
            && mean <= largest
            && (at_peak == 100.0) == (largest == 0.0)
    });
    let classes = each(PROOFS, "| shape | device | classes |", |row, _| {
        row.number("classes") == row.number("by brute force") + row.number("by the most alive")
            && row.number("shared") <= row.number("classes")
            && row.number("with one too many") == 0.0
    });
    let graphs = each(PROOFS, "| device | graphs | plans |", |row, _| {
        row.number("plans") == 3.0 * row.number("graphs") && row.number("violations") + row.number("wastes") == 0.0
    });
    assert!(cuts > 15 && instances > 5 && frames > 5 && memory > 20 && classes > 6 && graphs > 5);
}

/// Every undetected mutant has a proof: the proofs of a row add up to the number of equivalent plans.
#[test]
fn every_mutant_is_reported_or_proved() {
    let (_, long) = PROOFS.split_once("of 2000 plans").expect("the long run");
    let mut proved = std::collections::BTreeMap::<&str, f64>::new();
    let proofs = each(long, "| field | equivalent mutants |", |row, _| {
        *proved.entry(row.cells[0]).or_default() += row.number("equivalent mutants");
        true
    });
    let fields = each(long, "| field | mutants | rejected |", |row, _| {
        let good = row.number("equivalent");
        row.number("mutants") == row.number("rejected") + good
            && proved.remove(row.cells[0]).unwrap_or_default() == good
    });
    assert!(proofs > 5 && fields > 50 && proved.is_empty(), "{proofs} {fields} {proved:?}");
}

#[test]
fn figures_of_performance_follow_from_their_row() {
    // Times are rounded to tenths, which limits the precision of quotients.
    let heap = each(PERFORMANCE, "| aliasing |", |row, rows| {
        let (placing, off) = (row.cells[2], rows[0].numbers(1));
        let added = |i: usize| row.numbers(1)[i] - off[i];
        row.number("bytes") >= row.number("lower bound")
            && (placing.is_empty() || (0..2).all(|i| is(row.numbers(2)[i], added(i), 1, 0.01)))
    });
    let memory = each(PERFORMANCE, "| graph | declare, bytes a pass |", |row, _| {
        let declared = row.number("declare, bytes a pass");
        row.number("both") == declared + row.number("compile, bytes a pass") && row.number("again") == declared
    });
    let peer = each(PERFORMANCE, "| chain of buffers |", |row, _| {
        let [ours, theirs, ratio] = [1, 2, 3].map(|at| row.numbers(at));
        // Nanoseconds are integers.
        (0..2).all(|i| is(ratio[i], theirs[i] / ours[i], 1, 0.6 / ours[i]))
    });
    let over = each(PERFORMANCE, "| passes × draws | by hand, µs |", |row, _| {
        let quotients = [(3, 2, 1, 0.01), (6, 5, 4, 0.0), (8, 7, 4, 0.0)];
        quotients.iter().all(|&(ratio, own, hand, off)| {
            is(row.numbers(ratio)[0], row.numbers(own)[0] / row.numbers(hand)[0], 2, off)
        })
    });
    let threads = each(PERFORMANCE, "| passes × draws | threads |", |row, _| {
        [(4, 3), (6, 5)]
            .iter()
            .all(|&(speed_up, all)| is(row.numbers(speed_up)[0], row.numbers(2)[0] / row.numbers(all)[0], 2, 0.01))
    });
    let loops = each(PERFORMANCE, "| shader | loops counted |", |row, _| {
        is(row.number("less by"), 100.0 * (1.0 - row.number("not counted") / row.number("loops counted")), 1, 0.0)
    });
    let scenes = each(PERFORMANCE, "| nodes |", |row, _| {
        let sum: f64 = ["view, ms", "upload, ms", "execute, ms"].map(|head| row.number(head)).iter().sum();
        is(row.number("frame, ms"), sum, 2, 0.005)
    });
    let boxes = each(PERFORMANCE, "| boxes | order |", |row, _| {
        // Minimum times, in parentheses.
        let [one, two] = [4, 5].map(|at| row.numbers(at)[1]);
        is(row.number("speed-up"), one / two, 2, 0.001 / two)
    });
    let soak = each(PERFORMANCE, "| frames | textures held |", |row, _| {
        let [held, made] = [row.number("textures held"), row.number("made")];
        // Nothing is allocated after a device was lost.
        held <= made && (held > 0.0 || row.number("their MiB") == 0.0 && row.number("devices lost") > 0.0)
    });
    assert!(
        heap > 2
            && memory > 2
            && peer > 1
            && over > 2
            && threads > 3
            && loops > 12
            && scenes > 4
            && boxes > 5
            && soak > 4
    );
}

/// Negative control: a column that adds up is changed by one.
#[test]
fn a_changed_figure_is_noticed() {
    let changed =
        PROOFS.replacen("| attachment.clear | 6118 | 1995 | 4123 |", "| attachment.clear | 6118 | 1996 | 4123 |", 1);
    let off = std::panic::catch_unwind(|| {
        each(Box::leak(changed.into_boxed_str()), "| field | mutants | rejected |", |row, _| {
            row.number("mutants") == row.number("rejected") + row.number("equivalent")
        })
    });
    assert!(off.is_err());
}
