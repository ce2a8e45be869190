//! Whether colors are graded one by one, or looked up.

use crate::settings::key_value::{KeyValue, OptionError};

/// How a look is brought to a picture. Which is faster is the device's matter.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum GradeBy {
    /// Every pixel is computed.
    #[default]
    Direct,
    /// Every pixel is looked up in a table, which is made when the look changes.
    Table(TableDesc),
}

/// Size and numbers of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct TableDesc {
    /// Entries along each of three axes, 16 to 64. Where channels do not mix, a table of one axis with
    /// [`TableDesc::CURVE_ENTRIES`] is made instead.
    pub entries: u8,
    /// Numbers of the entries.
    pub format: TableFormat,
}

/// Numbers of a table's entries, which are sRGB encoded.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum TableFormat {
    /// Ten bits a channel: `Rgb10a2Unorm`, four bytes an entry.
    Rgb10,
    /// Half floats: `Rgba16Float`, eight bytes an entry. Curves of one axis always have them.
    Half,
}

impl TableFormat {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Rgb10, Self::Half];

    /// As it is asked for.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Rgb10 => "rgb10",
            Self::Half => "f16",
        }
    }
}

impl TableDesc {
    /// Entries of a table of one axis.
    pub const CURVE_ENTRIES: usize = 1024;
    /// 32 entries of half floats: Filament's high quality.
    pub const DEFAULT: Self = Self { entries: 32, format: TableFormat::Half };
}

impl GradeBy {
    /// `direct`, `table`, `table:SIZE`, or `table:SIZE:rgb10|f16`.
    ///
    /// # Errors
    /// [`OptionError::Value`].
    pub fn from_text(text: &str) -> Result<Self, OptionError> {
        let mut desc = TableDesc::DEFAULT;
        let choice = KeyValue { key: "by", value: text };
        let wrong = || choice.wrong("`direct` or `table[:SIZE[:rgb10|f16]]` with a size from 16 to 64");
        let mut words = text.split(':');
        match words.next() {
            Some("direct") if text == "direct" => return Ok(Self::Direct),
            Some("table") => {}
            _ => return Err(wrong()),
        }
        if let Some(size) = words.next() {
            desc.entries = size.parse().ok().filter(|n| (16..=64).contains(n)).ok_or_else(wrong)?;
        }
        if let Some(name) = words.next() {
            desc.format = TableFormat::ALL.into_iter().find(|format| format.name() == name).ok_or_else(wrong)?;
        }
        if words.next().is_some() { Err(wrong()) } else { Ok(Self::Table(desc)) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ways_are_found_by_name() {
        let table = |entries, format| Ok(GradeBy::Table(TableDesc { entries, format }));
        assert_eq!(GradeBy::from_text("direct"), Ok(GradeBy::Direct));
        assert_eq!(GradeBy::from_text("table"), table(32, TableFormat::Half));
        assert_eq!(GradeBy::from_text("table:16"), table(16, TableFormat::Half));
        assert_eq!(GradeBy::from_text("table:64:rgb10"), table(64, TableFormat::Rgb10));
        for wrong in ["", "lut", "direct:1", "table:8", "table:65", "table:x", "table:32:f32", "table:32:f16:1"] {
            let told = GradeBy::from_text(wrong).map_err(|error| error.to_string());
            assert!(told.is_err_and(|told| told.contains("`direct` or `table")), "{wrong}");
        }
    }
}
