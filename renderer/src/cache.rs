//! Objects of wgpu, made once for each description and kept from frame to frame.
//!
//! Threads that record share a cache by reference. What earlier frames made is found without a lock and without an
//! allocation; what this frame makes is put aside behind a lock, and joins the rest when the next frame begins.
//! Who asks for the same in each frame keeps what it got ([`Last`]), and finds it again without a hash.

use crate::hash::Keyed;
use std::collections::{BTreeSet, HashMap};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError, Weak};

/// Hits and misses of a cache, since it was made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CacheCounts {
    /// Requests that found what they asked for.
    pub hits: u64,
    /// Requests for which an object was made.
    pub created: u64,
}

/// Objects `V` by their descriptions `K`. See the [module](self).
#[derive(Debug)]
pub(crate) struct Cache<K, V> {
    /// What was there when the frame began.
    known: Table<K, V>,
    /// What was made since.
    fresh: Mutex<Table<K, V>>,
    frame: u64,
    hits: AtomicU64,
    created: AtomicU64,
}

/// By hash, so that a description need not be owned to be looked up; equal hashes are told apart by comparing.
type Table<K, V> = HashMap<u64, Vec<Arc<Entry<K, V>>>, Keyed>;

#[derive(Debug)]
struct Entry<K, V> {
    key: K,
    value: V,
    /// The frame that asked for it last.
    used: AtomicU64,
}

/// What a request got last. It keeps nothing alive: what the cache drops is gone, and asked for anew.
#[derive(Debug)]
pub(crate) struct Last<K, V>(Weak<Entry<K, V>>);

impl<K, V> Default for Last<K, V> {
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
    /// Requests that found their object, and objects made, since the beginning.
    pub(crate) fn counts(&self) -> CacheCounts {
        CacheCounts { hits: self.hits.load(Ordering::Relaxed), created: self.created.load(Ordering::Relaxed) }
    }

    /// The object whose description has this `hash` and `is` the one asked for, or what `make` makes.
    ///
    /// # Errors
    /// What `make` returns; nothing is kept then.
    pub(crate) fn get<E>(
        &self,
        hash: u64,
        is: impl Fn(&K) -> bool,
        make: impl FnOnce() -> Result<(K, V), E>,
    ) -> Result<V, E> {
        self.entry(hash, &is, make).map(|entry| entry.value.clone())
    }

    /// As [`Cache::get`], by one that asks in each frame: where `is` still holds of what it got `last`, nothing is hashed.
    ///
    /// # Errors
    /// As [`Cache::get`].
    pub(crate) fn again<E>(
        &self,
        last: &mut Last<K, V>,
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

    /// What a request got last, where `is` holds of it.
    pub(crate) fn last(&self, last: &Last<K, V>, is: impl Fn(&K) -> bool) -> Option<V> {
        let entry = last.0.upgrade().filter(|entry| is(&entry.key))?;
        self.note(&entry);
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
        // Held while the object is made: two threads that ask for one description get one object.
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
        self.note(entry);
        Some(Arc::clone(entry))
    }

    /// Notes that a frame asked for it.
    fn note(&self, entry: &Entry<K, V>) {
        // Only the first request of a frame writes to the entry.
        if entry.used.load(Ordering::Relaxed) != self.frame {
            entry.used.store(self.frame, Ordering::Relaxed);
        }
        self.hits.fetch_add(1, Ordering::Relaxed);
    }

    /// Begins a frame, and now and then drops objects that no frame asked for during `max_age` frames.
    pub(crate) fn begin_frame(&mut self, max_age: u64) {
        self.adopt();
        self.frame += 1;
        let frame = self.frame;
        // Looking through all of them costs more than keeping a few for longer.
        if frame.is_multiple_of(max_age.max(1)) {
            self.retain_entries(|entry| frame - entry.used.load(Ordering::Relaxed) <= max_age);
        }
    }

    /// Drops the objects whose descriptions `stays` refuses.
    pub(crate) fn retain(&mut self, stays: impl Fn(&K) -> bool) {
        self.adopt();
        self.retain_entries(|entry| stays(&entry.key));
    }

    /// What `make` makes in the place of each object whose description `is` one of those meant, in the order that
    /// [`Cache::replace`] wants.
    ///
    /// # Errors
    /// The first that `make` returns.
    pub(crate) fn remade<E>(
        &mut self,
        is: impl Fn(&K) -> bool,
        make: impl Fn(&K) -> Result<V, E>,
    ) -> Result<Vec<(u64, usize, V)>, E> {
        self.adopt();
        let hashes: BTreeSet<u64> = self.known.keys().copied().collect();
        let entries = hashes.iter().flat_map(|hash| self.known[hash].iter().enumerate().map(move |e| (*hash, e)));
        let meant = entries.filter(|(_, (_, entry))| is(&entry.key));
        meant.map(|(hash, (index, entry))| Ok((hash, index, make(&entry.key)?))).collect()
    }

    /// Puts what [`Cache::remade`] returned in the place of what was there.
    pub(crate) fn replace(&mut self, remade: Vec<(u64, usize, V)>) {
        for (hash, index, value) in remade {
            let Some(entries) = self.known.get_mut(&hash).filter(|entries| index < entries.len()) else { continue };
            // Another entry, so that nobody finds the old value as the last that it got. No thread holds one meanwhile.
            if let Some(Entry { key, used, .. }) = Arc::into_inner(entries.remove(index)) {
                entries.insert(index, Arc::new(Entry { key, value, used }));
            }
        }
    }

    /// Drops all objects.
    pub(crate) fn clear(&mut self) {
        self.retain(|_| false);
    }

    /// Puts what was made in the frame to the rest.
    fn adopt(&mut self) {
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

    /// Asks for a word; its hash is its length, so that words of one length have to be told apart.
    fn get(cache: &Cache<String, usize>, word: &str) -> usize {
        let make = || Ok::<_, Infallible>((word.to_owned(), cache.counts().created as usize));
        cache.get(word.len() as u64, |known| known == word, make).unwrap_or_else(|never| match never {})
    }

    #[test]
    fn an_object_is_made_once_and_dropped_with_age() {
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

    /// As `get`, with what it got last; a hash of its own tells whether it was hashed for.
    fn again(cache: &Cache<String, usize>, last: &mut Last<String, usize>, word: &str) -> (usize, bool) {
        let mut hashed = false;
        let hash = || {
            hashed = true;
            word.len() as u64
        };
        let make = || Ok::<_, Infallible>((word.to_owned(), cache.counts().created as usize));
        let got = cache.again(last, hash, |known| known == word, make).unwrap_or_else(|never| match never {});
        (got, hashed)
    }

    #[test]
    fn who_asks_again_needs_no_hash_until_it_asks_for_another_or_the_object_is_gone() {
        let (mut cache, mut last) = (Cache::default(), Last::default());
        assert_eq!(again(&cache, &mut last, "a"), (0, true), "made");
        assert_eq!(again(&cache, &mut last, "a"), (0, false));
        assert_eq!(again(&cache, &mut last, "b"), (1, true), "another");
        assert_eq!(again(&cache, &mut last, "b"), (1, false));
        assert_eq!(cache.counts(), CacheCounts { hits: 2, created: 2 });
        for _ in 0..3 {
            cache.begin_frame(1);
            assert_eq!(again(&cache, &mut last, "b"), (1, false), "asking keeps it young");
        }
        assert_eq!(get(&cache, "a"), 2, "nobody asked for the other");
        let remade =
            cache.remade(|word| word == "b", |_| Ok::<_, Infallible>(9)).unwrap_or_else(|never| match never {});
        cache.replace(remade);
        assert_eq!(again(&cache, &mut last, "b"), (9, true), "replaced");
        cache.clear();
        assert_eq!(again(&cache, &mut last, "b"), (3, true), "dropped");
    }

    #[test]
    fn what_cannot_be_made_is_not_kept() {
        let cache = Cache::<(), ()>::default();
        assert_eq!(cache.get(0, |()| true, || Err("no")), Err("no"));
        assert_eq!(cache.counts(), CacheCounts::default());
        assert_eq!(cache.get::<&str>(0, |()| true, || Ok(((), ()))), Ok(()));
    }

    #[test]
    fn threads_that_ask_at_once_get_one_object() {
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
