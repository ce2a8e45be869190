//! File names, device names and arguments with control characters are escaped in every output.

use crate::{run, scratch};

#[test]
fn no_output_has_control_characters() {
    let file = |name: &str, text: &str| {
        let path = scratch(name);
        std::fs::write(&path, text).expect("written");
        path.display().to_string()
    };
    let device = file("escaped.ron", r#"(version: 1, name: "a\u{1b}[31m")"#);
    let empty = file("\u{1b}[31m empty.ron", r#"(version: 1, passes: [Compute(name: "p")])"#);
    let wrong = file("\u{1b}[31m wrong.ron", "(version: 1, x: 1)");
    let table = file("escaped.csv", "id,lower,upper,size\na\u{1b}[31m,1,2,4\n");
    let cases: [(&[&str], &str); 8] = [
        (&[&empty, "--caps", &device], r"plan 2 for a\u{1b}[31m at"),
        (&[&empty, "--format", "svg", "--caps", &device], r"plan for a\u{1b}[31m at"),
        (&[&empty], r"\u{1b}[31m empty.ron: warning: no pass runs"),
        (&[&wrong], r"\u{1b}[31m wrong.ron:1:14: "),
        (&["\u{1b}[31m.ron"], r"\u{1b}[31m.ron: cannot be read"),
        (&[&empty, "--caps", "\u{1b}[31m"], r"invalid value `\u{1b}[31m`"),
        (&["--\u{1b}[31m"], r"--\u{1b}[31m: unknown option"),
        (&["--offsets", &table], r"a\u{1b}[31m,1,2,4,0"),
    ];
    for (args, shown) in cases {
        let (_, text, error) = run(args);
        assert!(text.contains(shown) || error.contains(shown), "{args:?}: {text:?} {error:?}");
        let bad = text.chars().chain(error.chars()).find(|c| c.is_control() && *c != '\n');
        assert_eq!(bad, None, "{text:?} {error:?}");
    }
}
