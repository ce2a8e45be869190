//! Batches: instances of one mesh, level of detail, material and winding that share one instanced draw.

use crate::levels::level_of;

/// Range of an array of instance numbers that one draw call covers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Batch {
    /// Representative instance of the batch, here the first; all instances of a batch share its mesh and state.
    pub instance: u32,
    /// First position of the batch in the array of instance numbers.
    pub first: u32,
    /// Number of instances in the batch.
    pub count: u32,
    /// Level of detail of the mesh; 0 is the full mesh.
    pub level: u8,
}

impl Batch {
    /// Returns the range of the batch in the array of instance numbers.
    #[must_use]
    pub fn range(&self) -> std::ops::Range<u32> {
        self.first..self.first + self.count
    }
}

/// Order in which a list of instances is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BatchOrder {
    /// Keeps the order of the list; only adjacent instances of one group share a draw. For blended surfaces.
    Kept,
    /// Draws each group as a whole, in the order of its first instance: roughly front to back if the list is sorted so.
    FirstFirst,
    /// Draws each group as a whole, ordered by group number, which minimizes state changes.
    ByGroup,
}

/// Groups of instances that may share a draw.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Groups {
    /// Group of each instance, indexed by instance number.
    pub of: Vec<u32>,
    /// Number of groups.
    pub count: u32,
}

impl Groups {
    /// Makes groups of equal keys, numbered in the order of keys.
    pub(crate) fn new<K: Ord + Copy>(keys: &[K]) -> Self {
        let mut distinct = keys.to_vec();
        distinct.sort_unstable();
        distinct.dedup();
        // `distinct` contains every key.
        let of = keys.iter().map(|key| distinct.partition_point(|other| other < key) as u32).collect();
        Self { of, count: distinct.len() as u32 }
    }

    /// Appends the instances of `list` to `numbers` in drawing order and returns the draws.
    /// Within a group the order of the list is kept. `levels` holds the level of detail of each instance by its number;
    /// if it is empty, all instances use the full mesh.
    #[must_use]
    pub fn batches(&self, list: &[u32], levels: &[u8], order: BatchOrder, numbers: &mut Vec<u32>) -> Vec<Batch> {
        let level = |instance: u32| level_of(levels, instance);
        let deepest = || list.iter().map(|instance| level(*instance)).max();
        let deep = if levels.is_empty() { 1 } else { 1 + usize::from(deepest().unwrap_or(0)) };
        let group = |instance: u32| self.of[instance as usize] as usize * deep + usize::from(level(instance));
        let base = numbers.len() as u32;
        let mut batches: Vec<Batch> = Vec::new();
        if order == BatchOrder::Kept {
            numbers.extend_from_slice(list);
            for (first, instance) in (base..).zip(list.iter().copied()) {
                match batches.last_mut() {
                    Some(last) if group(last.instance) == group(instance) => last.count += 1,
                    _ => batches.push(Batch { instance, first, count: 1, level: level(instance) }),
                }
            }
            return batches;
        }
        if self.count == 1 && deep == 1 {
            let instance = list.first().copied();
            batches.extend(instance.map(|instance| Batch {
                instance,
                first: base,
                count: list.len() as u32,
                level: 0,
            }));
            numbers.extend_from_slice(list);
            return batches;
        }
        let groups: Vec<u32> = list.iter().map(|instance| group(*instance) as u32).collect();
        let mut counts = vec![0_u32; self.count as usize * deep];
        for group in &groups {
            counts[*group as usize] += 1;
        }
        // Next free slot of each group; initially unassigned.
        const NO_PLACE: u32 = u32::MAX;
        let (mut places, mut next) = (vec![NO_PLACE; counts.len()], base);
        let mut open = |group: usize, places: &mut [u32]| {
            let count = counts[group];
            places[group] = next;
            batches.push(Batch { instance: 0, first: next, count, level: (group % deep) as u8 });
            next += count;
        };
        if order == BatchOrder::ByGroup {
            (0..counts.len()).filter(|group| counts[*group] > 0).for_each(|group| open(group, &mut places));
        }
        numbers.resize(numbers.len() + list.len(), 0);
        for (instance, group) in list.iter().zip(&groups) {
            let group = *group as usize;
            if places[group] == NO_PLACE {
                open(group, &mut places);
            }
            numbers[places[group] as usize] = *instance;
            places[group] += 1;
        }
        for batch in &mut batches {
            batch.instance = numbers[batch.first as usize];
        }
        batches
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn instances_of_a_group_are_drawn_together() {
        let groups = Groups::new(&["b", "a", "b", "c", "a", "b"]);
        assert_eq!((groups.of.as_slice(), groups.count), (&[1, 0, 1, 2, 0, 1][..], 3));
        let list = [5, 3, 0, 2, 4];
        let drawn = |order| {
            let mut numbers = vec![77];
            let batches = groups.batches(&list, &[], order, &mut numbers);
            assert!(batches.iter().all(|batch| numbers[batch.first as usize] == batch.instance));
            let of = |batch: &Batch| numbers[batch.range().start as usize..batch.range().end as usize].to_vec();
            batches.iter().map(of).collect::<Vec<_>>()
        };
        assert_eq!(drawn(BatchOrder::Kept), [vec![5], vec![3], vec![0, 2], vec![4]]);
        assert_eq!(drawn(BatchOrder::FirstFirst), [vec![5, 0, 2], vec![3], vec![4]]);
        assert_eq!(drawn(BatchOrder::ByGroup), [vec![4], vec![5, 0, 2], vec![3]]);
        let alike = Groups::new(&[7; 6]).batches(&list, &[], BatchOrder::FirstFirst, &mut vec![1, 2]);
        assert_eq!(alike, [Batch { instance: 5, first: 2, count: 5, level: 0 }]);
        assert_eq!(Groups::new(&[7; 6]).batches(&[], &[], BatchOrder::ByGroup, &mut Vec::new()), []);
        assert_eq!(Groups::default().batches(&[], &[], BatchOrder::ByGroup, &mut Vec::new()), []);
    }

    /// Within a group, one draw covers instances of one level of detail.
    #[test]
    fn levels_are_drawn_apart() {
        let levels = [0, 2, 1, 0, 2, 1];
        for (groups, apart) in [(Groups::new(&[7; 6]), 3), (Groups::new(&["b", "a", "b", "c", "a", "b"]), 4)] {
            for order in [BatchOrder::FirstFirst, BatchOrder::ByGroup, BatchOrder::Kept] {
                let (list, mut numbers) = ([5, 3, 0, 2, 4], vec![77]);
                let batches = groups.batches(&list, &levels, order, &mut numbers);
                let all = batches.iter().flat_map(|batch| batch.range().map(move |at| (at, batch.level)));
                assert!(all.clone().all(|(at, level)| levels[numbers[at as usize] as usize] == level), "{batches:?}");
                assert!(batches.iter().all(|batch| numbers[batch.first as usize] == batch.instance));
                assert_eq!(all.count(), list.len());
                assert!(order == BatchOrder::Kept || batches.len() == apart, "{batches:?}");
            }
        }
    }
}
