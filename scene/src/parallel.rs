//! Work on the items of a list, on as many threads as there are cores.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc;
use std::thread;

/// Calls `work` for every item on some thread, and `done` on this one for each result, in the order
/// in which they are finished. After `done` breaks no further item is begun; every item before one
/// that was begun has been begun too, so all results up to the first missing one are there.
///
/// The results are in the order of the items; `None` for those that were not begun.
pub fn in_parallel<T: Sync, R: Send>(
    items: &[T],
    work: impl Fn(&T) -> R + Sync,
    mut done: impl FnMut(usize, &R) -> ControlFlow<()>,
) -> Vec<Option<R>> {
    let threads = thread::available_parallelism().map_or(1, usize::from);
    let (next, stop) = (AtomicUsize::new(0), AtomicBool::new(false));
    let (send, receive) = mpsc::channel();
    let mut results: Vec<Option<R>> = Vec::new();
    results.resize_with(items.len(), || None);
    thread::scope(|scope| {
        for _ in 0..threads.min(items.len()) {
            let send = send.clone();
            let (next, stop, work) = (&next, &stop, &work);
            scope.spawn(move || {
                while !stop.load(Ordering::Relaxed) {
                    let i = next.fetch_add(1, Ordering::Relaxed);
                    let Some(item) = items.get(i) else { break };
                    // Fails only when the receiver is gone, which is after the last result was taken.
                    if send.send((i, work(item))).is_err() {
                        break;
                    }
                }
            });
        }
        drop(send);
        for (i, result) in receive {
            if done(i, &result).is_break() {
                stop.store(true, Ordering::Relaxed);
            }
            results[i] = Some(result);
        }
    });
    results
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_keep_the_order_of_items_and_stopping_leaves_no_gap() {
        let items: Vec<u32> = (0..200).collect();
        let all = in_parallel(&items, |i| i * i, |_, _| ControlFlow::Continue(()));
        assert!(all.iter().zip(&items).all(|(r, i)| *r == Some(i * i)));
        let mut seen = 0;
        let some = in_parallel(
            &items,
            |i| *i,
            |_, _| {
                seen += 1;
                if seen == 5 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
            },
        );
        let begun = some.iter().take_while(|r| r.is_some()).count();
        assert!(begun >= 5);
        assert!(some[begun..].iter().all(Option::is_none), "there is a gap");
        assert!(in_parallel(&[], |i: &u32| *i, |_, _| ControlFlow::Continue(())).is_empty());
    }
}
