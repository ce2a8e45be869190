//! Pools compared to brute force: within each class of shapes, no assignment uses fewer textures.

use crate::document::Document;
use crate::frames::{self, FRAME, Shape};
use crate::table::Table;
use framegraph::{Alias, Caps, Desc, Extent, Format, Options, Placement, Plan, ResourceId, Scratch, StepId, compile};
use framegraph_check::generate;

/// Maximum number of members of a class for brute force. Larger classes are compared to the maximum number alive at the
/// same time, a lower bound.
const MOST: usize = 9;

/// First and last step of a resource.
type Life = (StepId, StepId);

/// Properties that must be equal for two textures to share memory.
type Class = ([u32; 2], Format, u32, u8, u16);

fn class(plan: &Plan, resource: ResourceId) -> Option<Class> {
    let Desc::Texture(t) = &plan.graph().resources()[resource.index()].desc else {
        return None;
    };
    let Extent::Absolute { width, height } = t.extent else {
        let format = plan.format(resource)?.without_srgb();
        return Some((t.extent.texels(FRAME), format, t.mip_count(FRAME), t.samples, t.layers));
    };
    Some(([width, height], plan.format(resource)?.without_srgb(), t.mip_count(FRAME), t.samples, t.layers))
}

/// Finds the minimum number of textures by trying all assignments.
fn fewest(lives: &[Life], textures: &mut Vec<Vec<Life>>, best: &mut usize) {
    if textures.len() >= *best {
        return;
    }
    let Some((life, rest)) = lives.split_first() else {
        *best = textures.len();
        return;
    };
    for index in 0..textures.len() {
        if textures[index].iter().all(|other| other.1 < life.0 || life.1 < other.0) {
            textures[index].push(*life);
            fewest(rest, textures, best);
            textures[index].pop();
        }
    }
    textures.push(vec![*life]);
    fewest(rest, textures, best);
    textures.pop();
}

/// Returns the maximum number of resources alive at the same time.
fn at_once(lives: &[Life]) -> usize {
    let alive = |step: StepId| lives.iter().filter(|l| l.0 <= step && step <= l.1).count();
    lives.iter().map(|l| alive(l.0)).max().unwrap_or(0)
}

/// Prints the table over many graphs of each shape.
pub fn section(document: &mut Document, graphs: usize, note: &str) {
    let columns = ["shape", "device", "classes", "shared", "by brute force", "by the most alive", "with one too many"];
    let mut table = Table::new(&columns);
    let (mut scratch, mut plan) = (Scratch::new(), Plan::new());
    for shape in Shape::ALL {
        for caps in [Caps::wgpu(), Caps::desktop()].map(generate::capable) {
            let [mut classes, mut shared, mut forced, mut counted, mut worse] = [0; 5];
            for seed in 0..graphs {
                document.at("pools", seed, graphs);
                let resources = 10 + seed * 7919 % 51;
                let graph = frames::graph(shape, seed as u64, resources).unwrap_or_else(|error| panic!("{error}"));
                let options = Options { alias: Alias::Pool, ..Options::for_frame(FRAME[0], FRAME[1]) };
                compile(&graph, &caps, &options, &mut scratch, &mut plan).unwrap_or_else(|errors| panic!("{errors}"));
                for (lives, slots) in by_class(&plan) {
                    let least = if lives.len() <= MOST {
                        forced += 1;
                        let mut best = lives.len() + 1;
                        fewest(&lives, &mut Vec::new(), &mut best);
                        best
                    } else {
                        counted += 1;
                        at_once(&lives)
                    };
                    classes += 1;
                    shared += usize::from(slots < lives.len());
                    worse += usize::from(slots != least);
                }
            }
            document.claim(worse == 0, || format!("{worse} classes of {} use too many textures", shape.word()));
            let counts = [classes, shared, forced, counted, worse].map(|n: usize| n.to_string());
            table.row([vec![shape.word().to_owned(), caps.name.clone()], counts.to_vec()].concat());
        }
    }
    document.section(
        &format!("Pools compared to brute force{note}"),
        &format!(
            "These are the graphs of the table above. Textures with equal size, format (ignoring the transfer function), \
             levels, samples and layers are a class.\nIn classes of up to {MOST} members, all assignments are tried. The lower bound of larger classes \
             is the number alive at the same time.\n\n{}",
            table.text()
        ),
    );
}

/// Returns the lifetimes of each class's members, and the number of slots they use.
fn by_class(plan: &Plan) -> Vec<(Vec<Life>, usize)> {
    let mut classes: Vec<(Class, Vec<Life>, Vec<usize>)> = Vec::new();
    for (resource, row) in plan.graph().resource_ids().zip(plan.resources()) {
        let (Placement::Slot(slot), Some(class)) = (row.placement, class(plan, resource)) else {
            continue;
        };
        let at = classes.iter().position(|(c, ..)| *c == class).unwrap_or_else(|| {
            classes.push((class, Vec::new(), Vec::new()));
            classes.len() - 1
        });
        let (_, lives, slots) = &mut classes[at];
        lives.push((row.first, row.last));
        if !slots.contains(&slot.index()) {
            slots.push(slot.index());
        }
    }
    classes.into_iter().map(|(_, lives, slots)| (lives, slots.len())).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn brute_force_finds_the_fewest_and_no_more_than_are_alive_at_once() {
        let step = |n| StepId::new(n).expect("a small number");
        let lives: Vec<Life> =
            [(0, 2), (1, 3), (3, 4), (4, 6), (5, 6), (7, 7)].map(|(a, b)| (step(a), step(b))).to_vec();
        let mut best = usize::MAX;
        fewest(&lives, &mut Vec::new(), &mut best);
        assert_eq!((best, at_once(&lives)), (2, 2));
        let mut best = usize::MAX;
        fewest(&[lives[0]; 3], &mut Vec::new(), &mut best);
        assert_eq!((best, at_once(&[lives[0]; 3])), (3, 3));
    }
}
