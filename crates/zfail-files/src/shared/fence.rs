//! The fence around decoders that are not ours.
//!
//! Files are hostile and no decoder's author has thought of everything. Inputs and outputs are checked on our side of
//! the fence; a panic beyond it, against all care, becomes an error too (decision 0014).

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Runs `decode`, which owns whatever it leaves half done; a panic becomes a message.
pub(crate) fn fenced<T>(decode: impl FnOnce() -> T) -> Result<T, String> {
    catch_unwind(AssertUnwindSafe(decode)).map_err(|panic| format!("the decoder failed ({})", message(&*panic)))
}

fn message(panic: &(dyn Any + Send)) -> &str {
    let owned = panic.downcast_ref::<String>().map(String::as_str);
    owned.or(panic.downcast_ref::<&str>().copied()).unwrap_or("without a reason")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn panics_become_messages() {
        assert_eq!(fenced(|| 1), Ok(1));
        let absent: Option<u8> = std::hint::black_box(None);
        let failed = fenced(|| absent.expect("the reason"));
        assert_eq!(failed, Err("the decoder failed (the reason)".into()));
    }
}
