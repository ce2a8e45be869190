//! Distribution of work over threads.

use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Returns the number of threads that run at the same time.
pub fn processors() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// Calls `work` for every number below `count` and returns the results in order. Its arguments are the number of the
/// thread, from 0, and the number of the item.
///
/// # Errors
/// The first error of `work`; remaining items are not started.
pub fn share<T: Send, E: Send>(
    workers: usize,
    count: usize,
    work: impl Fn(usize, usize) -> Result<T, E> + Sync,
) -> Result<Vec<T>, E> {
    let (next, failure) = (AtomicUsize::new(0), Mutex::new(None));
    let made: Mutex<Vec<(usize, T)>> = Mutex::new(Vec::with_capacity(count));
    let run = |worker: usize| {
        while locked(&failure).is_none() {
            let index = next.fetch_add(1, Relaxed);
            if index >= count {
                break;
            }
            match work(worker, index) {
                Ok(one) => locked(&made).push((index, one)),
                Err(error) => *locked(&failure) = Some(error),
            }
        }
    };
    std::thread::scope(|scope| (0..workers).for_each(|worker| drop(scope.spawn(move || run(worker)))));
    if let Some(error) = locked(&failure).take() {
        return Err(error);
    }
    let mut made = std::mem::take(&mut *locked(&made));
    made.sort_by_key(|(index, _)| *index);
    Ok(made.into_iter().map(|(_, one)| one).collect())
}

fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_made_comes_in_order_and_the_first_failure_ends_it() {
        let doubled = share(3, 50, |_, index| Ok::<_, usize>(2 * index));
        assert_eq!(doubled, Ok((0..50).map(|index| 2 * index).collect()));
        let begun = AtomicUsize::new(0);
        let failed = share(1, 50, |_, index| {
            begun.fetch_add(1, Relaxed);
            if index == 7 { Err(index) } else { Ok(()) }
        });
        assert_eq!((failed, begun.into_inner()), (Err(7), 8));
    }
}
