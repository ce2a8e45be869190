//! Evaluation of color grading: per pixel, or from a table.

use crate::settings::key_value::OptionError;

/// Evaluation of a look. The faster one depends on the device.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum GradeBy {
    /// Computes every pixel.
    #[default]
    Direct,
    /// Looks up every pixel in a table, which is rebuilt when the look changes.
    Table(TableDesc),
}

/// Size and number format of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct TableDesc {
    /// Entries along each of three axes, 16 to 64. If channels do not mix, a one-dimensional table with
    /// [`TableDesc::CURVE_ENTRIES`] entries is used instead.
    pub entries: u8,
    /// Number format of the entries.
    pub format: TableFormat,
}

/// Number format of table entries, which are sRGB encoded.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum TableFormat {
    /// `Rgb10a2Unorm`: 10 bits per channel, 4 bytes per entry.
    Rgb10,
    /// `Rgba16Float`: half floats, 8 bytes per entry. Always used by one-dimensional tables.
    Half,
}

impl TableFormat {
    /// Both formats.
    pub const ALL: [Self; 2] = [Self::Rgb10, Self::Half];

    /// Returns the name used in options.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Rgb10 => "rgb10",
            Self::Half => "f16",
        }
    }
}

impl TableDesc {
    /// Number of entries of a one-dimensional table.
    pub const CURVE_ENTRIES: usize = 1024;
    /// 32 entries in half floats: Filament's high quality.
    pub const DEFAULT: Self = Self { entries: 32, format: TableFormat::Half };
}

impl GradeBy {
    /// Parses `direct`, `table`, `table:SIZE`, or `table:SIZE:FORMAT` with the format `rgb10` or `f16`.
    ///
    /// # Errors
    /// Fails with [`OptionError::Value`] for any other text.
    pub fn from_text(text: &str) -> Result<Self, OptionError> {
        let mut desc = TableDesc::DEFAULT;
        let takes = "`direct` or `table[:SIZE[:rgb10|f16]]` with a size from 16 to 64";
        let wrong = || OptionError::Value { key: "by".into(), value: text.into(), takes: takes.into() };
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
