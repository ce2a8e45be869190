//! Parallel processing of list items on all cores.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, mpsc};
use std::thread;

/// Calls `work` for every item on some thread, and `done` on the calling thread with each result, in order of
/// completion.
///
/// `admit` is called for each item before its work, in list order and never concurrently. It may wait, for memory for
/// example; its result is passed to `work`. After `done` breaks, no further item is admitted. Every item before an
/// admitted one has been admitted too, so all results up to the first missing one exist.
pub fn in_parallel<T: Sync, A, R: Send>(
    items: &[T],
    admit: impl Fn(&T) -> A + Sync,
    work: impl Fn(&T, A) -> R + Sync,
    mut done: impl FnMut(usize, R) -> ControlFlow<()>,
) {
    let threads = thread::available_parallelism().map_or(1, usize::from);
    let (next, stop) = (Mutex::new(0), AtomicBool::new(false));
    let (send, receive) = mpsc::channel();
    thread::scope(|scope| {
        for _ in 0..threads.min(items.len()) {
            let send = send.clone();
            let (next, stop, admit, work) = (&next, &stop, &admit, &work);
            scope.spawn(move || {
                loop {
                    let mut next = next.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
                    let i: usize = *next;
                    let Some(item) = items.get(i).filter(|_| !stop.load(Ordering::Relaxed)) else { break };
                    *next += 1;
                    let admitted = admit(item);
                    drop(next);
                    // Fails only if the receiver is gone, after the last result was taken.
                    if send.send((i, work(item, admitted))).is_err() {
                        break;
                    }
                }
            });
        }
        drop(send);
        for (i, result) in receive {
            if done(i, result).is_break() {
                stop.store(true, Ordering::Relaxed);
            }
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn items_are_admitted_in_order_and_stopping_leaves_no_gap() {
        let items: Vec<u32> = (0..200).collect();
        let admitted = Mutex::new(Vec::new());
        let mut all = vec![0; 200];
        let admit = |i: &u32| admitted.lock().expect("no panic").push(*i);
        in_parallel(
            &items,
            admit,
            |i, ()| i * i,
            |i, square| {
                all[i] = square;
                ControlFlow::Continue(())
            },
        );
        assert!(all.iter().zip(&items).all(|(square, i)| *square == i * i));
        assert_eq!(*admitted.lock().expect("no panic"), items);
        let mut seen = Vec::new();
        in_parallel(
            &items,
            |_| (),
            |i, ()| *i,
            |i, _| {
                seen.push(i);
                if seen.len() == 5 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
            },
        );
        seen.sort_unstable();
        assert!(seen.len() >= 5 && seen.iter().enumerate().all(|(place, i)| place == *i), "there is a gap: {seen:?}");
        in_parallel(&[], |_: &u32| (), |i, ()| *i, |_, _| ControlFlow::Continue(()));
    }
}
