//! Caches of wgpu objects by their descriptions, kept from frame to frame.
//!
//! Recording threads share a cache by reference. Objects of earlier frames are found without a lock and without an
//! allocation. Objects created in the current frame are stored behind a lock and moved to the main table when the next
//! frame begins.
//!
//! A caller with the same request in every frame keeps a [`LastEntry`], which finds the object again without hashing.

use crate::hash::KeyHashBuilder;
use std::collections::{BTreeSet, HashMap};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError, Weak};

/// Hits and misses of a cache since its creation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CacheCounts {
    /// Number of requests answered from the cache.
    pub hits: u64,
    /// Number of objects created.
    pub created: u64,
}

/// Cache of objects `V` by their descriptions `K`. See the [module documentation](self).
#[derive(Debug)]
pub(crate) struct Cache<K, V> {
    /// Objects that existed when the frame began.
    known: Table<K, V>,
    /// Objects created since the frame began.
    fresh: Mutex<Table<K, V>>,
    frame: u64,
    hits: AtomicU64,
    created: AtomicU64,
}

/// Maps hashes to entries, so that a lookup needs no owned description. Entries with equal hashes are compared.
type Table<K, V> = HashMap<u64, Vec<Arc<Entry<K, V>>>, KeyHashBuilder>;

#[derive(Debug)]
struct Entry<K, V> {
    key: K,
    value: V,
    /// Number of the last frame that requested the object.
    used: AtomicU64,
}

/// Weak reference to the entry that a request last returned. Expires when the cache drops the entry.
#[derive(Debug)]
pub(crate) struct LastEntry<K, V>(Weak<Entry<K, V>>);

impl<K, V> Default for LastEntry<K, V> {
    fn default() -> Self {
        Self(Weak::new())
    }
}

impl<K, V> Default for Cache<K, V> {
    fn default() -> Self {
        Self {
            known: Table::default(),
            fresh: Mutex::default(),
            frame: 0,
            hits: AtomicU64::new(0),
            created: AtomicU64::new(0),
        }
    }
}

impl<K, V: Clone> Cache<K, V> {
    /// Returns the number of hits and of created objects.
    pub(crate) fn counts(&self) -> CacheCounts {
        CacheCounts { hits: self.hits.load(Ordering::Relaxed), created: self.created.load(Ordering::Relaxed) }
    }

    /// Returns the object with this `hash` for which `is` returns true. If there is none, creates it with `make`.
    ///
    /// # Errors
    /// Returns the error of `make`; the cache is unchanged in that case.
    pub(crate) fn get<E>(
        &self,
        hash: u64,
        is: impl Fn(&K) -> bool,
        make: impl FnOnce() -> Result<(K, V), E>,
    ) -> Result<V, E> {
        self.entry(hash, &is, make).map(|entry| entry.value.clone())
    }

    /// Returns an object like [`Cache::get`], but tries `last` first. Computes the hash only if `is` rejects `last`.
    ///
    /// # Errors
    /// Fails like [`Cache::get`].
    pub(crate) fn get_repeated<E>(
        &self,
        last: &mut LastEntry<K, V>,
        hash: impl FnOnce() -> u64,
        is: impl Fn(&K) -> bool,
        make: impl FnOnce() -> Result<(K, V), E>,
    ) -> Result<V, E> {
        if let Some(value) = self.last(last, &is) {
            return Ok(value);
        }
        let entry = self.entry(hash(), &is, make)?;
        last.0 = Arc::downgrade(&entry);
        Ok(entry.value.clone())
    }

    /// Returns the object in `last` if it still exists and `is` accepts it.
    pub(crate) fn last(&self, last: &LastEntry<K, V>, is: impl Fn(&K) -> bool) -> Option<V> {
        let entry = last.0.upgrade().filter(|entry| is(&entry.key))?;
        self.mark_used(&entry);
        Some(entry.value.clone())
    }

    fn entry<E>(
        &self,
        hash: u64,
        is: &impl Fn(&K) -> bool,
        make: impl FnOnce() -> Result<(K, V), E>,
    ) -> Result<Arc<Entry<K, V>>, E> {
        if let Some(entry) = self.find(&self.known, hash, is) {
            return Ok(entry);
        }
        // The lock is held during creation, so that two threads with equal requests get one object.
        let mut fresh = self.fresh.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(entry) = self.find(&fresh, hash, is) {
            return Ok(entry);
        }
        let (key, value) = make()?;
        self.created.fetch_add(1, Ordering::Relaxed);
        let entry = Arc::new(Entry { key, value, used: self.frame.into() });
        fresh.entry(hash).or_default().push(Arc::clone(&entry));
        Ok(entry)
    }

    fn find(&self, table: &Table<K, V>, hash: u64, is: &impl Fn(&K) -> bool) -> Option<Arc<Entry<K, V>>> {
        let entry = table.get(&hash)?.iter().find(|entry| is(&entry.key))?;
        self.mark_used(entry);
        Some(Arc::clone(entry))
    }

    /// Marks the entry as used by the current frame.
    fn mark_used(&self, entry: &Entry<K, V>) {
        // Only the first request of a frame writes to the entry.
        if entry.used.load(Ordering::Relaxed) != self.frame {
            entry.used.store(self.frame, Ordering::Relaxed);
        }
        self.hits.fetch_add(1, Ordering::Relaxed);
    }

    /// Begins a frame. Every `max_age` frames, drops objects that were not requested during the last `max_age` frames.
    pub(crate) fn begin_frame(&mut self, max_age: u64) {
        self.merge_fresh();
        self.frame += 1;
        let frame = self.frame;
        // Checking all entries in every frame would cost more than keeping a few for longer.
        if frame.is_multiple_of(max_age.max(1)) {
            self.retain_entries(|entry| frame - entry.used.load(Ordering::Relaxed) <= max_age);
        }
    }

    /// Drops the objects whose descriptions `stays` rejects.
    pub(crate) fn retain(&mut self, stays: impl Fn(&K) -> bool) {
        self.merge_fresh();
        self.retain_entries(|entry| stays(&entry.key));
    }

    /// Returns the descriptions of all objects, without those created since [`Cache::merge_fresh`].
    pub(crate) fn keys(&self) -> impl Iterator<Item = &K> {
        self.known.values().flatten().map(|entry| &entry.key)
    }

    /// Creates a replacement with `make` for every object whose description `is` accepts. `make` also gets the object. Pass the result to
    /// [`Cache::replace`].
    ///
    /// # Errors
    /// Returns the first error of `make`.
    pub(crate) fn rebuild<E>(
        &mut self,
        is: impl Fn(&K) -> bool,
        make: impl Fn(&K, &V) -> Result<V, E>,
    ) -> Result<Vec<(u64, usize, V)>, E> {
        self.merge_fresh();
        let hashes: BTreeSet<u64> = self.known.keys().copied().collect();
        let entries = hashes.iter().flat_map(|hash| self.known[hash].iter().enumerate().map(move |e| (*hash, e)));
        let meant = entries.filter(|(_, (_, entry))| is(&entry.key));
        meant.map(|(hash, (index, entry))| Ok((hash, index, make(&entry.key, &entry.value)?))).collect()
    }

    /// Replaces objects with the results of [`Cache::rebuild`].
    pub(crate) fn replace(&mut self, rebuilt: Vec<(u64, usize, V)>) {
        for (hash, index, value) in rebuilt {
            let Some(entries) = self.known.get_mut(&hash).filter(|entries| index < entries.len()) else { continue };
            // A new entry invalidates each `LastEntry`. No thread holds the old one here.
            if let Some(Entry { key, used, .. }) = Arc::into_inner(entries.remove(index)) {
                entries.insert(index, Arc::new(Entry { key, value, used }));
            }
        }
    }

    /// Drops all objects.
    pub(crate) fn clear(&mut self) {
        self.retain(|_| false);
    }

    /// Moves the objects created in the last frame to the main table.
    pub(crate) fn merge_fresh(&mut self) {
        let Self { known, fresh, .. } = self;
        let fresh = fresh.get_mut().unwrap_or_else(PoisonError::into_inner);
        fresh.drain().for_each(|(hash, entries)| known.entry(hash).or_default().extend(entries));
    }

    fn retain_entries(&mut self, stays: impl Fn(&Entry<K, V>) -> bool) {
        self.known.retain(|_, entries| {
            entries.retain(|entry| stays(entry));
            !entries.is_empty()
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::convert::Infallible;

    /// Requests a word. Its hash is its length, so words of equal length collide.
    fn get(cache: &Cache<String, usize>, word: &str) -> usize {
        let make = || Ok::<_, Infallible>((word.to_owned(), cache.counts().created as usize));
        cache.get(word.len() as u64, |known| known == word, make).unwrap_or_else(|never| match never {})
    }

    #[test]
    fn an_object_is_created_once_and_dropped_with_age() {
        let mut cache = Cache::default();
        assert_eq!([get(&cache, "a"), get(&cache, "b"), get(&cache, "a")], [0, 1, 0]);
        cache.begin_frame(2);
        assert_eq!([get(&cache, "b"), get(&cache, "a")], [1, 0], "found again in the next frame");
        assert_eq!(cache.counts(), CacheCounts { hits: 3, created: 2 });
        for _ in 0..3 {
            assert_eq!(get(&cache, "a"), 0);
            cache.begin_frame(2);
        }
        assert_eq!([get(&cache, "a"), get(&cache, "b")], [0, 2], "`b` was dropped");
        cache.retain(|word| word != "a");
        assert_eq!([get(&cache, "a"), get(&cache, "b")], [3, 2]);
        cache.clear();
        assert_eq!(get(&cache, "b"), 4);
    }

    /// Requests a word through `last`. Also returns whether the hash was computed.
    fn get_repeated(cache: &Cache<String, usize>, last: &mut LastEntry<String, usize>, word: &str) -> (usize, bool) {
        let mut hashed = false;
        let hash = || {
            hashed = true;
            word.len() as u64
        };
        let make = || Ok::<_, Infallible>((word.to_owned(), cache.counts().created as usize));
        let got = cache.get_repeated(last, hash, |known| known == word, make).unwrap_or_else(|never| match never {});
        (got, hashed)
    }

    #[test]
    fn repeated_requests_need_no_hash() {
        let (mut cache, mut last) = (Cache::default(), LastEntry::default());
        assert_eq!(get_repeated(&cache, &mut last, "a"), (0, true), "made");
        assert_eq!(get_repeated(&cache, &mut last, "a"), (0, false));
        assert_eq!(get_repeated(&cache, &mut last, "b"), (1, true), "another");
        assert_eq!(get_repeated(&cache, &mut last, "b"), (1, false));
        assert_eq!(cache.counts(), CacheCounts { hits: 2, created: 2 });
        for _ in 0..3 {
            cache.begin_frame(1);
            assert_eq!(get_repeated(&cache, &mut last, "b"), (1, false), "asking keeps it young");
        }
        assert_eq!(get(&cache, "a"), 2, "the other was not requested");
        let rebuilt =
            cache.rebuild(|word| word == "b", |_, _| Ok::<_, Infallible>(9)).unwrap_or_else(|never| match never {});
        cache.replace(rebuilt);
        assert_eq!(get_repeated(&cache, &mut last, "b"), (9, true), "replaced");
        cache.clear();
        assert_eq!(get_repeated(&cache, &mut last, "b"), (3, true), "dropped");
    }

    #[test]
    fn failed_objects_are_not_cached() {
        let cache = Cache::<(), ()>::default();
        assert_eq!(cache.get(0, |()| true, || Err("no")), Err("no"));
        assert_eq!(cache.counts(), CacheCounts::default());
        assert_eq!(cache.get::<&str>(0, |()| true, || Ok(((), ()))), Ok(()));
    }

    #[test]
    fn concurrent_requests_get_one_object() {
        let cache = Cache::default();
        let words = ["one", "two", "six", "ten"];
        let asked = || words.map(|word| get(&cache, word));
        let (first, second) = std::thread::scope(|threads| {
            let other = threads.spawn(asked);
            (asked(), other.join())
        });
        assert!(second.is_ok_and(|second| second == first));
        assert_eq!(cache.counts(), CacheCounts { hits: 4, created: 4 });
    }
}
