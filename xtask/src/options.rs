//! Command line: one command and its options.

use std::ffi::OsString;

use crate::Failure;
use crate::command::Command;

/// Options of all commands.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Options {
    /// Prints the command that would install a missing driver, instead of running it.
    pub no_install: bool,
    /// Rooms given to `mutants`; all rooms if empty.
    pub rooms: Vec<String>,
    /// Arguments after `corpus`, for its program.
    pub words_of_corpus: Vec<OsString>,
    /// Options of individual commands, with their values.
    own: Vec<(&'static str, Option<OsString>)>,
}

impl Options {
    /// Returns true if an option was given.
    pub fn has(&self, name: &str) -> bool {
        self.own.iter().any(|(own, _)| *own == name)
    }

    /// Returns the value of an option, the last one if it was given twice.
    pub fn value(&self, name: &str) -> Option<&OsString> {
        self.own.iter().rfind(|(own, _)| *own == name).and_then(|(_, value)| value.as_ref())
    }

    /// Returns the options and values, to pass on to another program.
    pub fn words(&self) -> impl Iterator<Item = OsString> + '_ {
        self.own.iter().flat_map(|(name, value)| [Some(name.into()), value.clone()].into_iter().flatten())
    }
}

/// An option of certain commands.
struct Own {
    name: &'static str,
    /// True if a value follows.
    valued: bool,
    commands: &'static [&'static str],
}

const OWN: [Own; 15] = [
    Own { name: "--frames", valued: false, commands: &["bench"] },
    Own { name: "--scene", valued: true, commands: &["bench"] },
    Own { name: "--preset", valued: true, commands: &["bench"] },
    Own { name: "--size", valued: true, commands: &["bench"] },
    Own { name: "--beside", valued: true, commands: &["bench"] },
    Own { name: "--with", valued: true, commands: &["bench"] },
    Own { name: "--rounds", valued: true, commands: &["bench"] },
    Own { name: "--build", valued: false, commands: &["rooms", "package"] },
    Own { name: "--quick", valued: false, commands: &["prove"] },
    Own { name: "--dsa", valued: true, commands: &["prove"] },
    Own { name: "--out", valued: true, commands: &["prove", "mutants"] },
    Own { name: "--all", valued: false, commands: &["mutants", "test"] },
    Own { name: "--count", valued: true, commands: &["mutants"] },
    Own { name: "--list", valued: false, commands: &["mutants", "prose"] },
    Own { name: "--lower", valued: false, commands: &["prose"] },
];

/// Action that the command line requests.
#[derive(Debug)]
pub enum Request<'a> {
    /// Print help for one command, or for the program.
    Help(Option<&'a Command>),
    /// Run a command.
    Run(&'a Command, Options),
}

/// Parses `arguments` (without the program's name).
///
/// No arguments print the help, as `--help` does.
///
/// # Errors
/// [`Failure::Usage`], which names the first unknown command or option.
pub fn parse(arguments: impl IntoIterator<Item = OsString>, commands: &[Command]) -> Result<Request<'_>, Failure> {
    let mut command: Option<&Command> = None;
    let mut options = Options::default();
    let mut help = false;
    let mut arguments = arguments.into_iter();
    while let Some(word) = arguments.next() {
        if let Some(Command { name: "corpus", .. }) = command
            && !matches!(word.to_str(), Some("--help" | "-h"))
        {
            options.words_of_corpus.push(word);
            continue;
        }
        let argument = word.to_string_lossy();
        match &*argument {
            "--help" | "-h" | "help" => help = true,
            "--no-install" => options.no_install = true,
            option if option.starts_with('-') => {
                let unknown = || Failure::Usage(format!("unknown option `{option}`"));
                let Own { name, valued, .. } = OWN.iter().find(|own| own.name == option).ok_or_else(unknown)?;
                let missing = || Failure::Usage(format!("`{option}` needs a value"));
                let value = if *valued { Some(arguments.next().ok_or_else(missing)?) } else { None };
                options.own.push((name, value));
            }
            name => {
                if let Some(Command { name: "mutants", .. }) = command {
                    options.rooms.push(name.to_owned());
                    continue;
                }
                if command.is_some() {
                    return Err(Failure::Usage(format!("unexpected argument `{name}`")));
                }
                let known = commands.iter().find(|command| command.name == name);
                command = Some(known.ok_or_else(|| Failure::Usage(format!("unknown command `{name}`")))?);
            }
        }
    }
    match command {
        _ if help => Ok(Request::Help(command)),
        Some(command) => {
            let foreign = |own: &&Own| options.has(own.name) && !own.commands.contains(&command.name);
            match OWN.iter().find(foreign) {
                None => Ok(Request::Run(command, options)),
                Some(Own { name, commands, .. }) => {
                    let commands = commands.join("` and `");
                    Err(Failure::Usage(format!("`{name}` is an option of `{commands}` only")))
                }
            }
        }
        None if options == Options::default() => Ok(Request::Help(None)),
        None => Err(Failure::Usage("missing command".to_owned())),
    }
}

/// Returns the help of the program: usage, commands, options, exit codes.
pub fn help(commands: &[Command]) -> String {
    let mut text = String::from("Usage: cargo xtask <COMMAND> [--no-install]\n\nCommands:\n");
    for Command { name, summary, .. } in commands {
        text += &format!("  {name:<9} {summary}\n");
    }
    text + OPTIONS + "\nExit codes: 0 success, 1 failure, 2 invalid command line.\n"
}

/// Returns the help of one command.
pub fn help_of(command: &Command) -> String {
    let Command { name, summary, details, .. } = command;
    format!("{summary}\n\nUsage: cargo xtask {name} [--no-install]\n\n{details}{OPTIONS}")
}

const OPTIONS: &str = "
Options:
  --no-install  if no adapter is usable, print the command that installs Mesa's
                software Vulkan driver and exit with code 1; for other tools that
                tests need, print the command and continue
  --quick, --dsa DIR, --out FILE
                of `prove`: see `cargo xtask prove --help`
  --all, --count N, --list, --out FILE
                of `mutants`: see `cargo xtask mutants --help`
  --list, --lower
                of `prose`: see `cargo xtask prose --help`
  --all         of `test`: see `cargo xtask test --help`
  --frames, --scene NAME, --preset NAME, --size WxH, --beside COMMAND,
  --with ARGS, --rounds N
                of `bench`: see `cargo xtask bench --help`
  --build       of `rooms` and `package`: see the `--help` of each
  DIR, --out FOLDER, --jobs N, --seconds N, --memory SIZE, --size WxH,
  --render PROGRAM
                of `corpus`: see `cargo xtask corpus --help`
  -h, --help    print help
";

#[cfg(test)]
mod tests {
    use super::*;

    const COMMANDS: &[Command] = &[
        Command { name: "one", summary: "first", details: "", run: |_| Ok(()) },
        Command { name: "two", summary: "second", details: "", run: |_| Ok(()) },
        Command { name: "prove", summary: "third", details: "", run: |_| Ok(()) },
        Command { name: "mutants", summary: "fourth", details: "", run: |_| Ok(()) },
        Command { name: "corpus", summary: "fifth", details: "", run: |_| Ok(()) },
    ];

    fn read(line: &str) -> Result<Request<'static>, Failure> {
        parse(line.split_whitespace().map(OsString::from), COMMANDS)
    }

    fn refusal(line: &str) -> String {
        match read(line) {
            Err(Failure::Usage(reason)) => reason,
            other => panic!("`{line}` should be a usage error, not {other:?}"),
        }
    }

    #[test]
    fn no_argument_and_help_both_print_help() {
        for line in ["", "--help", "-h", "help"] {
            assert!(matches!(read(line), Ok(Request::Help(None))), "`{line}`");
        }
        let Ok(Request::Help(Some(command))) = read("two --help") else { panic!("help of a command") };
        assert_eq!(command.name, "two");
    }

    #[test]
    fn options_are_read_on_either_side_of_the_command() {
        for line in ["two --no-install", "--no-install two"] {
            let Ok(Request::Run(command, options)) = read(line) else { panic!("`{line}`") };
            assert_eq!((command.name, options.no_install), ("two", true));
        }
        let Ok(Request::Run(_, options)) = read("one") else { panic!("`one`") };
        assert!(!options.no_install);
    }

    #[test]
    fn options_of_prove_are_handed_on() {
        let Ok(Request::Run(_, options)) = read("--dsa some/folder prove --out a.md") else { panic!("sound") };
        assert_eq!(options.words().collect::<Vec<_>>(), ["--dsa", "some/folder", "--out", "a.md"]);
        assert_eq!(refusal("one --quick"), "`--quick` is an option of `prove` only");
        assert_eq!(refusal("one --build"), "`--build` is an option of `rooms` and `package` only");
        assert_eq!(refusal("one --out a"), "`--out` is an option of `prove` and `mutants` only");
        assert_eq!(refusal("prove --dsa"), "`--dsa` needs a value");
    }

    #[test]
    fn rooms_and_their_options_follow_mutants() {
        let Ok(Request::Run(_, options)) = read("mutants wgsl passes --count 5 --all") else { panic!("sound") };
        assert_eq!(options.rooms, ["wgsl", "passes"]);
        assert!(options.has("--all") && options.value("--count").is_some_and(|n| n == "5"));
        assert_eq!(refusal("prove wgsl"), "unexpected argument `wgsl`");
    }

    #[test]
    fn words_after_corpus_are_for_its_program() {
        let Ok(Request::Run(_, options)) = read("corpus some/folder --size 64x64 -- --msaa 1") else { panic!("sound") };
        assert_eq!(options.words_of_corpus, ["some/folder", "--size", "64x64", "--", "--msaa", "1"]);
        assert!(matches!(read("corpus --help"), Ok(Request::Help(Some(Command { name: "corpus", .. })))));
    }

    #[test]
    fn what_is_unknown_is_named() {
        assert_eq!(refusal("one --fast"), "unknown option `--fast`");
        assert_eq!(refusal("three"), "unknown command `three`");
        assert_eq!(refusal("one two"), "unexpected argument `two`");
        assert_eq!(refusal("--no-install"), "missing command");
    }

    #[test]
    fn help_lists_every_command() {
        let text = help(crate::command::ALL);
        for command in crate::command::ALL {
            assert!(text.contains(command.name) && text.contains(command.summary));
        }
    }
}
