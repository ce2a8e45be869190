//! Byte counts with units, as typed on a command line.

/// Parses a byte count with an optional unit.
///
/// Units are `B`, powers of 1000 (`kB`, `MB`, `GB`) and powers of 1024 (`KiB`, `MiB`, `GiB`).
#[must_use]
pub fn bytes(text: &str) -> Option<u64> {
    let digits = text.find(|c: char| !(c.is_ascii_digit() || c == '.')).unwrap_or(text.len());
    let (number, unit) = text.split_at(digits);
    let factor: u64 = match unit {
        "" | "B" => 1,
        "kB" | "KB" => 1000,
        "MB" => 1_000_000,
        "GB" => 1_000_000_000,
        "KiB" => 1 << 10,
        "MiB" => 1 << 20,
        "GiB" => 1 << 30,
        _ => return None,
    };
    if let Ok(whole) = number.parse::<u64>() {
        return whole.checked_mul(factor);
    }
    // An `f64` is precise enough for fractions of a unit.
    let value = number.parse::<f64>().ok()? * factor as f64;
    (value.is_finite() && (0.0..=9e15).contains(&value)).then_some(value as u64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_have_two_kinds_of_units() {
        assert_eq!(bytes("200MB"), Some(200_000_000));
        assert_eq!(bytes("1.5GiB"), Some(3 << 29));
        assert_eq!((bytes("7"), bytes("7B"), bytes("0.5kB")), (Some(7), Some(7), Some(500)));
        for bad in ["", "MB", "-1MB", "1.2.3MB", "1XB", "1 MB", "99999999999GiB", "inf", "1e3"] {
            assert_eq!(bytes(bad), None, "{bad}");
        }
    }
}
