//! A fence around decoders that are not ours.

use std::panic::{AssertUnwindSafe, catch_unwind};

/// Runs `decode`; a panic inside becomes its message. Only for calls into third-party decoders, which
/// promise not to panic but are fed whatever a file holds. Nothing they could leave half-changed
/// outlives the call.
pub(crate) fn guard<T>(decode: impl FnOnce() -> T) -> Result<T, String> {
    catch_unwind(AssertUnwindSafe(decode)).map_err(|panic| {
        let said = panic.downcast_ref::<String>().map(String::as_str).or_else(|| panic.downcast_ref::<&str>().copied());
        format!("the decoder failed: {}", said.unwrap_or("no reason given"))
    })
}

#[cfg(test)]
mod tests {
    use super::guard;

    #[test]
    fn a_panic_becomes_its_message() {
        assert_eq!(guard(|| 7), Ok(7));
        let failed: Result<(), String> = guard(|| panic!("bad block {}", 3));
        assert_eq!(failed, Err("the decoder failed: bad block 3".into()));
    }
}
