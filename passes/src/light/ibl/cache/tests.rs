//! Tests of the cache on disk.

use super::super::entry::{DFG, encode_dfg};
use super::*;

fn folder(name: &str) -> PathBuf {
    std::env::temp_dir().join(format!("light-cache-{name}-{}", std::process::id()))
}

#[test]
fn a_variable_chooses_the_folder_or_none() {
    let chosen = |value: &str| Cache::chosen(Some(value.into()));
    assert_eq!(chosen("off"), Cache::off());
    assert_eq!(chosen("some/where"), Cache::at("some/where"));
    assert_eq!((chosen(""), Cache::chosen(None)), (Cache::user(), Cache::user()));
}

#[test]
fn an_entry_comes_back_and_every_damage_is_noticed() {
    let folder = folder("damage");
    let cache = Cache::at(&folder);
    let (key, payload) = (Key::of("test", "pass/ibl.wgsl"), (0..=255).collect::<Vec<u8>>());
    let load = |warnings: &mut Vec<String>| cache.load(key, 7, warnings, |payload| Ok(payload.to_vec()));
    let mut warnings = Vec::new();
    assert_eq!(load(&mut warnings), None);
    cache.store(key, 7, &payload, &mut warnings);
    assert_eq!(load(&mut warnings), Some(payload));
    assert!(warnings.is_empty(), "{warnings:?}");
    let path = cache.path(key).expect("a folder was given");
    let good = std::fs::read(&path).expect("it was written");
    let spoilt = |bytes: &[u8], word: &str| {
        std::fs::write(&path, bytes).expect("the folder is ours");
        let mut warnings = Vec::new();
        assert_eq!(load(&mut warnings), None, "{word}");
        assert!(warnings.len() == 1 && warnings[0].contains(word), "{word}: {warnings:?}");
        assert!(warnings[0].contains(&*path.to_string_lossy()), "{warnings:?}");
    };
    spoilt(&[], "cut short");
    spoilt(&good[..40], "cut short");
    spoilt(&good[..good.len() - 1], "cut short");
    spoilt(&[good.clone(), vec![0]].concat(), "cut short");
    for at in 0..good.len() {
        let mut bytes = good.clone();
        bytes[at] ^= 1 << (at % 8);
        let word = match at {
            0..8 => "no entry",
            8..12 => "version",
            40..48 => "cut short",
            _ => "checksum",
        };
        spoilt(&bytes, word);
    }
    // Sound, but another entry.
    spoilt(&file(&[1], 3, 7), "wrong name");
    spoilt(&file(&[1], key.finish(), 8), "wrong name");
    std::fs::remove_dir_all(folder).expect("the folder is ours");
}

#[test]
fn what_a_killed_program_left_is_swept_away_and_what_is_being_written_is_not() {
    let folder = folder("stale");
    std::fs::create_dir_all(&folder).expect("a temporary folder");
    let (old, new) = (folder.join("0.1-0.part"), folder.join("1.2-0.part"));
    for path in [&old, &new] {
        std::fs::write(path, b"x").expect("the folder is ours");
    }
    let long_ago = std::time::SystemTime::now() - 2 * STALE;
    let file = std::fs::File::options().write(true).open(&old).expect("it is there");
    file.set_modified(long_ago).expect("the file is ours");
    Cache::at(&folder).store(Key::of("test", "pass/ibl.wgsl"), 1, &[], &mut Vec::new());
    assert!(!old.exists() && new.exists());
    std::fs::remove_dir_all(folder).expect("the folder is ours");
}

#[test]
fn what_is_examined_is_what_is_loaded() {
    let table = encode_dfg(&[7; 4 * 4 * 8], 4);
    assert!(examine(&file(&table, 3, DFG)));
    assert!(!examine(&file(&table[1..], 3, DFG)) && !examine(&[]));
}

#[test]
fn a_folder_that_cannot_be_written_only_warns() {
    let blocked = folder("blocked");
    // A file where the folder should be: fails for every user, root too.
    std::fs::write(&blocked, b"x").expect("a temporary file");
    let cache = Cache::at(blocked.join("ibl"));
    let mut warnings = Vec::new();
    cache.store(Key::of("test", "pass/ibl.wgsl"), 1, &[], &mut warnings);
    assert!(warnings.len() == 1 && warnings[0].contains(&*blocked.to_string_lossy()), "{warnings:?}");
    assert!(warnings[0].contains("FRAMEGRAPH_LIGHT_CACHE"));
    std::fs::remove_file(blocked).expect("the file is ours");
    let mut warnings = Vec::new();
    Cache::off().store(Key::of("test", "pass/ibl.wgsl"), 1, &[], &mut warnings);
    assert_eq!(Cache::off().load(Key::of("test", "pass/ibl.wgsl"), 1, &mut warnings, |_| Ok(())), None);
    assert!(warnings.is_empty());
}

#[test]
fn the_users_folder_follows_the_environment() {
    let with = |pairs: &'static [(&'static str, &'static str)]| {
        user_folder(move |name| pairs.iter().find(|(n, _)| *n == name).map(|(_, v)| OsString::from(v)))
    };
    let expected = |base: &str| Some(PathBuf::from(base).join("framegraph").join("ibl"));
    if cfg!(unix) {
        assert_eq!(with(&[("XDG_CACHE_HOME", "/a"), ("HOME", "/h")]), expected("/a"));
        assert_eq!(with(&[("XDG_CACHE_HOME", "relative"), ("HOME", "/h")]), expected("/h/.cache"));
    }
    assert_eq!(with(&[("XDG_CACHE_HOME", "")]), None);
}

/// A pass and what it may import, with a file beside them that it cannot import.
fn shader(pass: &'static str, library: &'static str) -> impl Iterator<Item = Source<'static>> {
    let texts = [("lib/a.wgsl", library), ("pass/a.wgsl", pass), ("pass/b.wgsl", "another")];
    texts.into_iter().map(|(path, wgsl)| Source { path, wgsl })
}

#[test]
fn keys_tell_apart_what_is_added() {
    let of = |add: fn(&mut Key)| {
        let mut key = Key::of("a", "pass/ibl.wgsl");
        add(&mut key);
        key.finish()
    };
    let by = |text, library| Key::made_by("a", "pass/a.wgsl", shader(text, library)).finish();
    let keys = [
        of(|_| ()),
        of(|k| k.add(&[1_u32, 2])),
        of(|k| k.add(&[2_u32, 1])),
        of(|k| {
            k.add(&[1_u32]);
            k.add(&[2_u32]);
        }),
        Key::of("a", "pass/dfg.wgsl").finish(),
        Key::of("b", "pass/ibl.wgsl").finish(),
        by("pass", "library"),
        by("another pass", "library"),
        by("pass", "another library"),
    ];
    for (i, a) in keys.iter().enumerate() {
        assert!(keys[..i].iter().all(|b| a != b), "{i}");
    }
    assert_eq!(of(|k| k.add(&[1_u32, 2])), of(|k| k.add(&[1_u32, 2])));
}
