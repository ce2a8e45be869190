//! Decoding of base64 and percent-encoding in URIs.

/// Error of decoding base64.
#[derive(Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub(super) enum Base64Error {
    /// A byte is not a base64 digit.
    #[error("the byte {byte} at {at} is not a base64 digit")]
    Digit {
        /// Position in the text.
        at: usize,
        /// The byte.
        byte: u8,
    },
    /// An incomplete last group, or nonzero unused bits.
    #[error("it ends within a byte")]
    Length,
}

impl std::fmt::Debug for Base64Error {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}

/// Decodes base64 (RFC 4648, section 4). The padding may be omitted.
pub(super) fn decode_base64(text: &[u8]) -> Result<Vec<u8>, Base64Error> {
    let padding = text.iter().rev().take_while(|b| **b == b'=').count();
    let digits = &text[..text.len() - padding];
    if padding > 0 && (padding > 2 || !text.len().is_multiple_of(4)) {
        return Err(Base64Error::Length);
    }
    let mut bytes = Vec::with_capacity(digits.len() / 4 * 3 + 2);
    // The low `count` bits of `bits` are not written yet.
    let (mut bits, mut count) = (0_u32, 0);
    for (at, &byte) in digits.iter().enumerate() {
        let digit = match byte {
            b'A'..=b'Z' => byte - b'A',
            b'a'..=b'z' => byte - b'a' + 26,
            b'0'..=b'9' => byte - b'0' + 52,
            b'+' => 62,
            b'/' => 63,
            _ => return Err(Base64Error::Digit { at, byte }),
        };
        (bits, count) = (bits << 6 | u32::from(digit), count + 6);
        if count >= 8 {
            count -= 8;
            bytes.push((bits >> count) as u8);
        }
    }
    if count == 6 || bits & ((1 << count) - 1) != 0 {
        return Err(Base64Error::Length);
    }
    Ok(bytes)
}

/// Decodes percent-encoding (RFC 3986, section 2.1); a percent sign without two hexadecimal digits is kept.
pub(super) fn decode_percent(text: &[u8]) -> Vec<u8> {
    let digit = |byte: u8| char::from(byte).to_digit(16).map(|digit| digit as u8);
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text;
    while let [first, behind @ ..] = rest {
        let named = match rest {
            [b'%', high, low, ..] => digit(*high).zip(digit(*low)).map(|(high, low)| high * 16 + low),
            _ => None,
        };
        bytes.push(named.unwrap_or(*first));
        rest = if named.is_some() { &rest[3..] } else { behind };
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_of_every_length_and_nothing_else() {
        for (text, bytes) in [
            ("", &b""[..]),
            ("Zg==", b"f"),
            ("Zg", b"f"),
            ("Zm8=", b"fo"),
            ("Zm9v", b"foo"),
            ("Zm9vYmFy", b"foobar"),
            ("+/+/", &[0xfb, 0xff, 0xbf]),
        ] {
            assert_eq!(decode_base64(text.as_bytes()).as_deref(), Ok(bytes), "{text}");
        }
        for text in ["A", "Zg=", "Zg===", "====", "Zh==", "Zm9v YmFy", "Z-==", "Zg==Zg=="] {
            assert!(decode_base64(text.as_bytes()).is_err(), "{text}");
        }
    }

    #[test]
    fn percent_signs_name_bytes_or_stay() {
        for (text, bytes) in [
            ("a%20b", &b"a b"[..]),
            ("%C3%a9", "é".as_bytes()),
            ("100%", b"100%"),
            ("%zz%4", b"%zz%4"),
            ("%%41", b"%A"),
        ] {
            assert_eq!(decode_percent(text.as_bytes()), bytes, "{text}");
        }
    }
}
