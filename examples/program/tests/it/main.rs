//! Output files: replacement, rejected paths and temporary files.

use program::outputs::{OutputError, Outputs, check_folder};
use std::fs::{self, File};
use std::path::{Path, PathBuf};

/// Creates an empty folder for a test.
fn folder(test: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(test);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("the target folder can be written");
    folder
}

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("the folder is there").flatten();
    let mut names: Vec<_> = entries.map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

fn one(path: &Path, text: &str) -> Result<(), OutputError> {
    let mut outputs = Outputs::default();
    outputs.write(path, |file| file.write_all(text.as_bytes()))?;
    outputs.commit().map(drop)
}

#[test]
fn a_file_is_whole_or_as_it_was() {
    let folder = folder("whole");
    let file = folder.join("a.txt");
    one(&file, "old").expect("it can be written");
    let mut outputs = Outputs::default();
    outputs.add(&file).expect("it can be written");
    let failed = outputs.write(&file, |to| to.write_all(b"half").and_then(|()| Err(std::io::Error::other("no more"))));
    assert!(failed.is_err_and(|error| error.to_string().contains("a.txt") && error.to_string().contains("no more")));
    drop(outputs);
    assert_eq!((fs::read_to_string(&file).expect("it is there"), names(&folder)), ("old".into(), vec!["a.txt".into()]));
    one(&file, "new").expect("it can be written");
    assert_eq!((fs::read_to_string(&file).expect("it is there"), names(&folder)), ("new".into(), vec!["a.txt".into()]));
}

#[test]
fn names_may_be_as_long_as_names_can_be() {
    let folder = folder("long");
    let (longest, longer) = ("n".repeat(255), "n".repeat(256));
    one(&folder.join(&longest), "x").expect("255 bytes are allowed");
    assert_eq!(names(&folder), [longest]);
    assert!(Outputs::default().add(&folder.join(longer)).is_err(), "256 bytes are rejected before the work");
}

#[test]
fn what_cannot_be_written_is_said_before_the_work() {
    let folder = folder("refused");
    fs::create_dir(folder.join("d")).expect("the folder is ours");
    for (name, reason) in [("d", "it is a folder"), ("gone/a", "does not exist"), ("..", "it is a folder")] {
        let message = Outputs::default().add(&folder.join(name)).map_err(|error| error.to_string());
        assert!(
            message.as_ref().is_err_and(|message| message.contains(name) && message.contains(reason)),
            "{name}: {message:?}"
        );
    }
    assert!(check_folder(&folder).is_ok() && check_folder(&folder.join("gone")).is_err());
    assert_eq!(names(&folder), ["d"], "nothing is left of asking");
}

#[test]
fn nothing_that_is_read_is_written_and_no_file_twice() {
    let folder = folder("read");
    for name in ["scene", "texture"] {
        fs::write(folder.join(name), name).expect("the folder is ours");
    }
    fs::hard_link(folder.join("texture"), folder.join("hard")).expect("the folder is ours");
    let mut outputs = Outputs::default();
    outputs.reads(&folder.join("scene")).expect("no output yet");
    outputs.add(&folder.join("texture")).expect("it is not read yet");
    outputs.add(&folder.join("new")).expect("it is new");
    for scene in ["scene", "./scene", "../read/scene"] {
        assert!(matches!(outputs.add(&folder.join(scene)), Err(OutputError::Read { .. })), "{scene}");
    }
    assert!(
        matches!(outputs.reads(&folder.join("texture")), Err(OutputError::Read { .. })),
        "known only after loading"
    );
    for other in ["texture", "hard", "./new", "../read/new"] {
        assert!(matches!(outputs.add(&folder.join(other)), Err(OutputError::Twice { .. })), "{other}");
    }
}

#[cfg(unix)]
mod unix {
    use super::{File, Outputs, Path, PathBuf, folder, fs, names, one};
    use std::io::Read;
    use std::os::unix::fs::{PermissionsExt, symlink};
    use std::process::Command;
    use std::thread;

    fn pipe(folder: &Path) -> PathBuf {
        let pipe = folder.join("pipe");
        assert!(Command::new("mkfifo").arg(&pipe).status().is_ok_and(|status| status.success()));
        pipe
    }

    #[test]
    fn links_stay_links_and_modes_stay() {
        let folder = folder("links");
        fs::create_dir(folder.join("real")).expect("the folder is ours");
        fs::write(folder.join("real/a"), "old").expect("the folder is ours");
        fs::set_permissions(folder.join("real/a"), fs::Permissions::from_mode(0o640)).expect("the file is ours");
        for (link, to) in [("a", "real/a"), ("b", "a"), ("dangling", "real/new"), ("circle", "circle")] {
            symlink(to, folder.join(link)).expect("the folder is ours");
        }
        one(&folder.join("b"), "through two links").expect("it can be written");
        one(&folder.join("dangling"), "made").expect("its folder is there");
        let message = one(&folder.join("circle"), "").map_err(|error| error.to_string());
        assert!(message.is_err_and(|message| message.contains("circle")));
        assert_eq!(fs::read_to_string(folder.join("real/a")).ok().as_deref(), Some("through two links"));
        assert_eq!(fs::read_to_string(folder.join("real/new")).ok().as_deref(), Some("made"));
        let mode = |name| fs::metadata(folder.join(name)).expect("it is there").permissions().mode() & 0o777;
        assert_eq!(mode("real/a"), 0o640);
        assert_eq!(names(&folder), ["a", "b", "circle", "dangling", "real"]);
        for link in ["a", "b", "dangling"] {
            assert!(fs::symlink_metadata(folder.join(link)).is_ok_and(|about| about.is_symlink()), "{link}");
        }
    }

    #[test]
    fn a_failed_output_leaves_no_other_new() {
        let folder = folder("together");
        let first = folder.join("first");
        let mut outputs = Outputs::default();
        for path in [first.as_path(), Path::new("/dev/full")] {
            outputs.write(path, |file| file.write_all(b"x")).expect("it fails only at the end");
        }
        let message = outputs.commit().map_err(|error| error.to_string());
        assert!(message.is_err_and(|message| message.starts_with("/dev/full: ")));
        assert!(names(&folder).is_empty());
        // The folder disappears during the run.
        fs::create_dir(folder.join("d")).expect("the folder is ours");
        let mut outputs = Outputs::default();
        for path in [&first, &folder.join("d/second")] {
            outputs.write(path, |file| file.write_all(b"x")).expect("it fails only at the end");
        }
        fs::remove_dir_all(folder.join("d")).expect("the folder is ours");
        assert!(outputs.commit().is_err());
        assert!(names(&folder).is_empty());
    }

    #[test]
    fn pipes_and_devices_are_written_through() {
        let folder = folder("through");
        let pipe = pipe(&folder);
        let reader = {
            let pipe = pipe.clone();
            thread::spawn(move || {
                let mut read = String::new();
                File::open(pipe).and_then(|mut pipe| pipe.read_to_string(&mut read)).map(|_| read)
            })
        };
        one(&pipe, "light").expect("there is a reader");
        assert_eq!(reader.join().expect("no panic").ok().as_deref(), Some("light"));
        let mut twice = Outputs::default();
        twice.add(&pipe).expect("it is there");
        assert!(twice.add(&folder.join("./pipe")).is_err(), "two outputs would mix");
        let mut null = Outputs::default();
        for _ in 0..2 {
            null.write(Path::new("/dev/null"), |file| file.write_all(b"x")).expect("it takes anything");
        }
        null.commit().expect("it takes anything");
        assert_eq!(names(&folder), ["pipe"]);
    }

    #[test]
    fn what_a_killed_run_left_is_swept_and_what_is_being_made_is_not() {
        let folder = folder("stale");
        fs::write(folder.join(".framegraph-1-0.part"), "left behind").expect("the folder is ours");
        fs::write(folder.join(".framegraph-notes"), "somebody's").expect("the folder is ours");
        let mut live = Outputs::default();
        live.add(&folder.join("live")).expect("it can be written");
        one(&folder.join("other"), "x").expect("it can be written");
        let found = names(&folder);
        assert!(found.len() == 3 && found.contains(&"other".into()), "{found:?}");
        assert!(found.contains(&".framegraph-notes".into()) && !found.contains(&".framegraph-1-0.part".into()));
        live.write(&folder.join("live"), |file| file.write_all(b"x")).expect("its part is still there");
        live.commit().expect("its part is still there");
        assert_eq!(names(&folder), [".framegraph-notes", "live", "other"]);
    }
}
