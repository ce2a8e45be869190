//! Command lines. Options are declared with `clap`, which parses them, suggests names and prints the help. Every error
//! is one line that names the option.

use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::parser::ValueSource;
use clap::{Arg, ArgAction, Command};
use std::ffi::{OsStr, OsString};

/// Maximum width of the help in columns.
const WIDTH: usize = 120;

/// Value name of an option whose value is a list of options, such as `--compare-with --no-fxaa`.
pub const OPTIONS: &str = "OPTIONS";

/// Options and arguments of a command line, in their order.
#[derive(Clone, Debug, Default)]
pub struct Given {
    all: Vec<(String, Vec<OsString>)>,
}

/// Option with its values, or argument under the name of its declaration.
#[derive(Clone, Debug)]
pub struct Item {
    name: String,
    values: Vec<OsString>,
}

/// Parsed command line.
#[derive(Clone, Debug)]
pub enum Parsed {
    /// The help is requested; this is its text.
    Help(String),
    /// Options and arguments.
    Given(Given),
}

/// Declares an option with a value, such as `--size WxH`.
pub fn option(name: &'static str, value: &'static str, help: impl Into<String>) -> Arg {
    flag(name, help)
        .action(ArgAction::Set)
        .value_name(value)
        .allow_hyphen_values(true)
        .value_parser(clap::value_parser!(OsString))
}

/// Declares an option without a value.
pub fn flag(name: &'static str, help: impl Into<String>) -> Arg {
    Arg::new(name).long(name).help(help.into()).action(ArgAction::SetTrue)
}

/// Declares an argument.
pub fn argument(name: &'static str, help: impl Into<String>) -> Arg {
    Arg::new(name).help(help.into()).value_parser(clap::value_parser!(OsString))
}

/// Returns a command with a description and a text after the options, such as its exit codes.
pub fn command(name: &'static str, about: &'static str, after: &'static str) -> Command {
    Command::new(name).about(about).after_help(after).next_line_help(true).max_term_width(WIDTH)
}

/// Returns the help of a command as documents show it.
pub fn help(command: Command) -> String {
    command.term_width(WIDTH).render_help().to_string()
}

/// Parses the command line; `args` excludes the program name.
///
/// # Errors
/// One line that names an unknown option with a suggestion, a missing value, or an option that is specified twice.
pub fn parse(command: Command, args: impl IntoIterator<Item = OsString>) -> Result<Parsed, String> {
    let args: Vec<OsString> = args.into_iter().collect();
    let name = OsString::from(command.get_name());
    let mut declared = command.clone();
    declared.build();
    let matches = match command.try_get_matches_from([name].into_iter().chain(args)) {
        Ok(matches) => matches,
        Err(error) if error.kind() == ErrorKind::DisplayHelp => return Ok(Parsed::Help(error.render().to_string())),
        Err(error) => return Err(line(&error)),
    };
    let mut found = Vec::new();
    for id in matches.ids().map(clap::Id::as_str) {
        if matches.value_source(id) != Some(ValueSource::CommandLine) {
            continue;
        }
        let mut indices = matches.indices_of(id).into_iter().flatten();
        for values in matches.get_raw_occurrences(id).into_iter().flatten() {
            let values: Vec<OsString> = values.map(OsStr::to_owned).collect();
            let mut checked = values.iter().filter(|_| value_name(&declared, id) != Some(OPTIONS));
            match checked.find_map(|value| option_named(&declared, value)) {
                Some("help") => return Ok(Parsed::Help(declared.render_help().to_string())),
                Some(_) => return Err(missing(&declared, id)),
                None => {}
            }
            let index = indices.by_ref().take(values.len().max(1)).last().unwrap_or_default();
            found.push((index, (id.to_owned(), values)));
        }
    }
    found.sort_by_key(|(index, _)| *index);
    Ok(Parsed::Given(Given { all: found.into_iter().map(|(_, item)| item).collect() }))
}

/// Returns the name of the option that `value` is: `--out --plan` lacks the value of `--out`. Other values may start with
/// a hyphen, such as `-1,0,2`.
fn option_named<'a>(declared: &'a Command, value: &OsStr) -> Option<&'a str> {
    let value = value.to_str()?;
    let is_named = |arg: &Arg| match value.strip_prefix("--") {
        Some(name) => arg.get_long_and_visible_aliases().is_some_and(|names| names.contains(&name)),
        None => {
            value.strip_prefix('-').is_some_and(|short| arg.get_short().is_some_and(|own| short == own.to_string()))
        }
    };
    declared.get_arguments().find(|arg| is_named(arg)).map(|arg| arg.get_id().as_str())
}

/// Returns the message for an option without its value.
fn missing(declared: &Command, id: &str) -> String {
    format!("--{id}: missing {}; see --help", value_name(declared, id).unwrap_or("value"))
}

/// Returns the name of an option's first value.
fn value_name<'a>(declared: &'a Command, id: &str) -> Option<&'a str> {
    let names = declared.get_arguments().find(|arg| arg.get_id() == id).and_then(Arg::get_value_names);
    names.and_then(|names| names.first()).map(|name| name.as_str())
}

impl Given {
    /// Returns true if an option is present.
    pub fn has(&self, name: &str) -> bool {
        self.all.iter().any(|(own, _)| own == name)
    }

    /// Returns the values of an option; none if it is absent.
    pub fn values<'a>(&'a self, name: &'a str) -> impl Iterator<Item = &'a OsStr> {
        let own = self.all.iter().filter(move |(own, _)| own == name);
        own.flat_map(|(_, values)| values).map(OsString::as_os_str)
    }
}

impl IntoIterator for Given {
    type Item = Item;
    type IntoIter = std::iter::Map<std::vec::IntoIter<(String, Vec<OsString>)>, fn((String, Vec<OsString>)) -> Item>;

    fn into_iter(self) -> Self::IntoIter {
        self.all.into_iter().map(|(name, values)| Item { name, values })
    }
}

impl Item {
    /// Returns the name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns the first value, or an empty one for an option without a value.
    pub fn raw(&self) -> OsString {
        self.values.first().cloned().unwrap_or_default()
    }

    /// Returns the second value of an option with two.
    pub fn second(&self) -> OsString {
        self.values.get(1).cloned().unwrap_or_default()
    }

    /// Returns all values as text.
    ///
    /// # Errors
    /// One line that names the option if a value is not Unicode.
    pub fn values(&self) -> Result<Vec<String>, String> {
        let text = |value: &OsString| value.clone().into_string();
        self.values
            .iter()
            .map(text)
            .collect::<Result<_, _>>()
            .map_err(|_| format!("{}: a value is not Unicode", self.name))
    }

    /// Returns the first value as text.
    ///
    /// # Errors
    /// One line that names the option if the value is not Unicode.
    pub fn text(&self) -> Result<String, String> {
        self.raw().into_string().map_err(|_| format!("--{}: the value is not Unicode", self.name))
    }

    /// Parses the value with a function that returns `None` for an invalid one.
    ///
    /// # Errors
    /// One line that names the option, the value, and what is `expected`.
    pub fn parse<T>(&self, expected: &str, parse: impl FnOnce(&str) -> Option<T>) -> Result<T, String> {
        let text = self.text()?;
        parse(&text).ok_or_else(|| format!("--{} {text}: expected {expected}", self.name))
    }
}

/// Formats an error as one line.
fn line(error: &clap::Error) -> String {
    let text = |kind| match error.get(kind) {
        Some(ContextValue::String(text)) => Some(text.clone()),
        Some(ContextValue::Strings(all)) => all.first().cloned(),
        _ => None,
    };
    let given = text(ContextKind::InvalidArg).unwrap_or_default();
    let (name, value) = given.split_once(" <").unwrap_or((&given, "value"));
    let near = text(ContextKind::SuggestedArg).map(|near| format!("did you mean `{near}`?"));
    let remedy = near.unwrap_or_else(|| "see --help".into());
    match error.kind() {
        ErrorKind::UnknownArgument if name.starts_with('-') => format!("{name}: unknown option; {remedy}"),
        ErrorKind::UnknownArgument => format!("{name}: unexpected argument; {remedy}"),
        ErrorKind::ArgumentConflict => match text(ContextKind::PriorArg).filter(|prior| *prior != given) {
            Some(prior) => {
                format!("{name}: cannot be used with {}; remove one", prior.split(" <").next().unwrap_or(""))
            }
            None => format!("{name}: specified twice; remove one"),
        },
        ErrorKind::InvalidValue | ErrorKind::WrongNumberOfValues | ErrorKind::TooFewValues => {
            format!("{name}: missing {}; see --help", value.trim_end_matches(['>', '.']))
        }
        ErrorKind::TooManyValues => format!("{name}: takes no value; see --help"),
        ErrorKind::MissingRequiredArgument => format!("{name}: required; see --help"),
        _ => error.to_string().lines().next().unwrap_or_default().trim_start_matches("error: ").to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(line: &str) -> Result<Parsed, String> {
        let options = [
            option("size", "WxH", "size"),
            option("enable", "EFFECT", "effect").action(ArgAction::Append),
            option("turntable", "N", "pictures").num_args(2).value_names(["N", "DIR"]),
            flag("plan", "plan").alias("former"),
            option("other", OPTIONS, "other options"),
            argument("FILE", "file"),
        ];
        parse(command("own", "about", "after").args(options), line.split_whitespace().map(OsString::from))
    }

    #[test]
    fn options_keep_their_order() {
        let Ok(Parsed::Given(given)) = parsed("--enable b a.ron --former --turntable 3 d --enable=a --size -3") else {
            panic!("a valid command line");
        };
        assert!(given.has("plan") && !given.has("former"));
        assert_eq!(given.values("enable").collect::<Vec<_>>(), ["b", "a"]);
        let items: Vec<_> = given.into_iter().collect();
        let names: Vec<_> = items.iter().map(Item::name).collect();
        assert_eq!(names, ["enable", "FILE", "plan", "turntable", "enable", "size"]);
        assert_eq!((items[3].raw(), items[3].second()), ("3".into(), "d".into()));
        assert_eq!(items[5].parse("a number", |text| text.parse().ok()), Ok(-3));
        assert_eq!(items[5].parse("WxH", |_| None::<u8>), Err("--size -3: expected WxH".into()));
        for line in ["--other --plan", "--other=--plan"] {
            let Ok(Parsed::Given(given)) = parsed(line) else { panic!("{line}: a list of options is a value") };
            assert_eq!((given.values("other").next(), given.has("plan")), (Some("--plan".as_ref()), false), "{line}");
        }
        for line in ["--help", "--size --help", "--enable -h"] {
            assert!(matches!(parsed(line), Ok(Parsed::Help(text)) if text.contains("--size <WxH>")), "{line}");
        }
    }

    #[test]
    fn errors_are_one_line_with_a_remedy() {
        for (line, expected) in [
            ("--sise 3", "--sise: unknown option; did you mean `--size`?"),
            ("--colour", "--colour: unknown option; see --help"),
            ("-x", "-x: unknown option; see --help"),
            ("a b", "b: unexpected argument; see --help"),
            ("--size", "--size: missing WxH; see --help"),
            ("--size --plan", "--size: missing WxH; see --help"),
            ("--turntable 3 --plan", "--turntable: missing N; see --help"),
            ("--size 1 --size 2", "--size: specified twice; remove one"),
            ("--plan --plan", "--plan: specified twice; remove one"),
            ("--plan=3", "--plan: takes no value; see --help"),
        ] {
            assert_eq!(parsed(line).err().as_deref(), Some(expected), "{line}");
        }
    }
}
