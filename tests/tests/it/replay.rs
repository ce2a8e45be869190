//! The corpus of the fuzz targets, replayed as it is and with thousands of deterministic damages.

use std::path::Path;
use tests::fuzz::{Damage, TARGETS};

/// Number of damaged copies of each file.
const ROUNDS: usize = 400;
/// Maximum size of a corpus file in bytes, so that it remains readable.
const MAX_BYTES: usize = 8 << 10;

#[test]
fn the_corpus_is_read_and_no_damage_to_it_panics() {
    for (name, target) in TARGETS {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("corpus").join(name);
        let entries = std::fs::read_dir(&folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
        let mut paths: Vec<_> = entries.flatten().map(|entry| entry.path()).collect();
        paths.sort();
        let files: Vec<Vec<u8>> = paths.iter().map(|path| std::fs::read(path).expect("a file of the corpus")).collect();
        assert!(files.len() >= 2, "{}: {} files", folder.display(), files.len());
        let mut damage = Damage(0x5eed);
        let (mut sound, mut broken) = (0, 0);
        for (index, (path, file)) in paths.iter().zip(&files).enumerate() {
            let shown = path.display();
            assert!(file.len() <= MAX_BYTES, "{shown}: {} bytes", file.len());
            assert!(target(file), "{shown}: it is refused as it is");
            for round in 0..ROUNDS {
                let bytes = damage.done_to(file, &files[(index + 1) % files.len()]);
                let read = std::panic::catch_unwind(|| target(&bytes));
                match read.unwrap_or_else(|_| panic!("{shown}: round {round}: {}", bytes.escape_ascii())) {
                    true => sound += 1,
                    false => broken += 1,
                }
            }
        }
        // Damage that always or never breaks a file would test nothing.
        assert!(sound > 10 && broken > 100, "{name}: {sound} sound, {broken} broken");
    }
}
