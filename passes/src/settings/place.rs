//! Places of values within settings, and the values that they accept.

/// A number of any type, or `None` if it is optional.
pub trait Number {
    /// Returns the number.
    fn get(&self) -> Option<f64>;
    /// Sets the number.
    fn put(&mut self, value: Option<f64>);
    /// Returns true for integers.
    fn is_whole(&self) -> bool;
}

macro_rules! numbers {
    ($($number:ty: $whole:literal),*) => { $(
        impl Number for $number {
            fn get(&self) -> Option<f64> {
                Some(f64::from(*self))
            }
            fn put(&mut self, value: Option<f64>) {
                *self = value.unwrap_or_default() as Self;
            }
            fn is_whole(&self) -> bool {
                $whole
            }
        }
    )* };
}

numbers!(f32: false, f64: false, u8: true, u16: true, u32: true, i32: true);

impl<T: Number + Default> Number for Option<T> {
    fn get(&self) -> Option<f64> {
        self.as_ref().and_then(Number::get)
    }
    fn put(&mut self, value: Option<f64>) {
        *self = value.map(|value| {
            let mut number = T::default();
            number.put(Some(value));
            number
        });
    }
    fn is_whole(&self) -> bool {
        T::default().is_whole()
    }
}

/// Enumeration whose variants have names.
pub trait Words: Copy + PartialEq + 'static {
    /// Names of all variants.
    const WORDS: &'static [(&'static str, Self)];
}

/// Value of an enumeration.
pub trait Word {
    /// Returns the names of all variants.
    fn words(&self) -> Vec<&'static str>;
    /// Returns the name of the value; `None` for a variant without a name.
    fn word(&self) -> Option<&'static str>;
    /// Sets the variant with this name; returns `None` for an unknown name.
    fn put(&mut self, name: &str) -> Option<()>;
}

impl<T: Words> Word for T {
    fn words(&self) -> Vec<&'static str> {
        T::WORDS.iter().map(|(name, _)| *name).collect()
    }
    fn word(&self) -> Option<&'static str> {
        T::WORDS.iter().find(|(_, value)| value == self).map(|(name, _)| *name)
    }
    fn put(&mut self, name: &str) -> Option<()> {
        *self = T::WORDS.iter().find(|(known, _)| *known == name)?.1;
        Some(())
    }
}

/// Place of a value within settings.
pub enum Place<'a> {
    /// A number.
    Number(&'a mut dyn Number),
    /// A number, or this word for `None`; and a usual number.
    Optional(&'a mut dyn Number, &'static str, f32),
    /// An angle in radians, given in degrees.
    Degrees(&'a mut f32),
    /// Numbers separated by `:`. One number sets all three of a color.
    Numbers(&'a mut [f32]),
    /// A count, with the accepted ones.
    Count(&'a mut u8, &'static [u8]),
    /// A switch with the words for false and true.
    Switch(&'a mut bool, [&'static str; 2]),
    /// An enumeration.
    Word(&'a mut dyn Word),
    /// No number to check; the field parses its own text.
    Free,
    /// These settings lack the value; only this method has it.
    Only(&'static str),
}

impl Place<'_> {
    /// Describes the accepted values, with numbers within `range`.
    pub(crate) fn takes(&self, range: [f64; 2]) -> String {
        let [low, high] = range.map(|limit| limit as f32);
        match self {
            Self::Number(number) if number.is_whole() => format!("a whole number from {low} to {high}"),
            Self::Number(_) | Self::Degrees(_) => format!("a number from {low} to {high}"),
            Self::Optional(_, none, _) => format!("`{none}` or a number from {low} to {high}"),
            Self::Numbers(all) => format!("{} numbers from {low} to {high}, separated by `:`", all.len()),
            Self::Count(_, all) => listed(all.iter().map(ToString::to_string)),
            Self::Switch(_, [off, on]) => format!("`{on}` or `{off}`"),
            Self::Word(word) => listed(word.words().into_iter().map(|name| format!("`{name}`"))),
            Self::Free | Self::Only(_) => String::new(),
        }
    }

    /// Sets the value from text; returns `None` for a value that is not accepted.
    pub(crate) fn put(self, text: &str, range: [f64; 2]) -> Option<()> {
        match self {
            Self::Number(number) => number.put(Some(parsed(text, range, number.is_whole())?)),
            Self::Optional(number, none, _) if text == none => number.put(None),
            Self::Optional(number, ..) => number.put(Some(parsed(text, range, number.is_whole())?)),
            Self::Degrees(angle) => *angle = (parsed(text, range, false)? as f32).to_radians(),
            Self::Numbers(all) => {
                let found: Option<Vec<f64>> = text.split(':').map(|text| parsed(text, range, false)).collect();
                match found?.as_slice() {
                    [one] if all.len() == 3 => all.fill(*one as f32),
                    found if found.len() == all.len() => {
                        all.iter_mut().zip(found).for_each(|(own, found)| *own = *found as f32);
                    }
                    _ => return None,
                }
            }
            Self::Count(count, all) => *count = text.parse().ok().filter(|number| all.contains(number))?,
            Self::Switch(switch, words) => *switch = words.iter().position(|word| *word == text)? == 1,
            Self::Word(word) => word.put(text)?,
            Self::Free | Self::Only(_) => return None,
        }
        Some(())
    }

    /// Returns the value as text; `None` for a value that this place cannot show.
    pub(crate) fn shown(&self) -> Option<String> {
        let number = |value: f64| (value as f32).to_string();
        match self {
            Self::Number(own) => own.get().map(number),
            Self::Optional(own, none, _) => Some(own.get().map_or_else(|| (*none).to_owned(), number)),
            Self::Degrees(angle) => Some(angle.to_degrees().to_string()),
            Self::Numbers(all) => Some(all.iter().map(ToString::to_string).collect::<Vec<_>>().join(":")),
            Self::Count(count, _) => Some(count.to_string()),
            Self::Switch(on, words) => Some(words[usize::from(**on)].to_owned()),
            Self::Word(word) => word.word().map(str::to_owned),
            Self::Free | Self::Only(_) => None,
        }
    }

    /// Returns the values that exclude each other, as text.
    pub(crate) fn alternatives(&self) -> Vec<String> {
        match self {
            Self::Count(_, all) => all.iter().map(ToString::to_string).collect(),
            Self::Word(word) => word.words().into_iter().map(str::to_owned).collect(),
            Self::Optional(_, none, usual) => vec![(*none).to_owned(), usual.to_string()],
            _ => Vec::new(),
        }
    }

    /// Returns the first value that is not accepted, and the accepted ones.
    pub(crate) fn wrong(&self, range: [f64; 2]) -> Option<(String, String)> {
        let range = if matches!(self, Self::Degrees(_)) { range.map(f64::to_radians) } else { range };
        let outside = |value: &f64| !contains(range, *value);
        let value = match self {
            Self::Number(number) | Self::Optional(number, ..) => number.get().filter(outside)?.to_string(),
            Self::Degrees(angle) => Some(f64::from(**angle)).filter(outside)?.to_string(),
            Self::Numbers(all) => all.iter().map(|number| f64::from(*number)).find(outside)?.to_string(),
            Self::Count(count, all) => (!all.contains(count)).then(|| count.to_string())?,
            Self::Word(word) if word.word().is_none() => "another one".into(),
            Self::Word(_) | Self::Switch(..) | Self::Free | Self::Only(_) => return None,
        };
        Some((value, self.takes(range)))
    }
}

/// Returns the place of a number.
pub(crate) fn num(number: &mut impl Number) -> Place<'_> {
    Place::Number(number)
}

/// Returns the place of a switch with the words `off` and `on`.
pub(crate) fn flag(on: &mut bool) -> Place<'_> {
    Place::Switch(on, ["off", "on"])
}

/// Returns the place of an enumeration.
pub(crate) fn word(word: &mut impl Word) -> Place<'_> {
    Place::Word(word)
}

/// Returns the place of the components of a vector.
pub(crate) fn vector<const N: usize>(vector: &mut impl AsMut<[f32; N]>) -> Place<'_> {
    Place::Numbers(vector.as_mut())
}

/// Joins words by commas, and the last by `or`.
fn listed(words: impl IntoIterator<Item = String>) -> String {
    let mut words: Vec<String> = words.into_iter().collect();
    match words.pop() {
        Some(last) if !words.is_empty() => format!("{} or {last}", words.join(", ")),
        last => last.unwrap_or_default(),
    }
}

/// Compares in 32 bits, in which most settings are stored.
fn contains([low, high]: [f64; 2], value: f64) -> bool {
    (low as f32..=high as f32).contains(&(value as f32))
}

/// Parses a number within a range, which includes its limits.
pub(crate) fn parsed(text: &str, range: [f64; 2], whole: bool) -> Option<f64> {
    text.parse().ok().filter(|value: &f64| contains(range, *value) && (!whole || value.fract() == 0.0))
}

/// Parses `on` or `off`.
pub(crate) fn switched(text: &str) -> Option<bool> {
    match text {
        "on" => Some(true),
        "off" => Some(false),
        _ => None,
    }
}
