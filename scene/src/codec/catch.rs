//! Conversion of panics in third-party decoders to errors.

use std::panic::{AssertUnwindSafe, catch_unwind};

use super::error::CodecError;

/// Runs `decode` and converts a panic to an error with its message. Use it only for third-party decoders, which promise
/// not to panic but receive untrusted input. No state that a panic could leave inconsistent outlives the call.
pub(crate) fn catch_panic<T>(decode: impl FnOnce() -> Result<T, CodecError>) -> Result<T, CodecError> {
    catch_unwind(AssertUnwindSafe(decode)).unwrap_or_else(|panic| {
        let message =
            panic.downcast_ref::<String>().map(String::as_str).or_else(|| panic.downcast_ref::<&str>().copied());
        Err(CodecError::Panicked(message.unwrap_or("no reason given").into()))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_becomes_its_message() {
        assert!(matches!(catch_panic(|| Ok(7)), Ok(7)));
        let failed: Result<(), _> = catch_panic(|| panic!("bad block {}", 3));
        assert_eq!(failed.expect_err("it panicked").to_string(), "the decoder failed: bad block 3");
    }
}
