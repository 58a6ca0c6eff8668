//! Faults of ours and of drivers, told like any other error.

use crate::error::Error;
use std::panic;
use std::sync::{Mutex, PoisonError};

/// Runs `work`, and turns a panic in it, which is a bug of ours or of a driver, into an error like any other, so that
/// it cannot be taken for a result and destructors remove what is half done.
pub fn contain_faults(work: impl FnOnce() -> Result<(), Error>) -> Result<(), Error> {
    // Not thread-local: the panic may happen on a worker thread.
    static FAULT: Mutex<Option<String>> = Mutex::new(None);
    let fault = || FAULT.lock().unwrap_or_else(PoisonError::into_inner);
    panic::set_hook(Box::new(move |info| *fault() = Some(info.to_string())));
    let result = panic::catch_unwind(panic::AssertUnwindSafe(work));
    let _ = panic::take_hook();
    result.unwrap_or_else(|_| {
        let fault = fault().take().unwrap_or_else(|| "unknown fault".to_owned());
        Err(Error::failed(format!("internal fault, please report it with this command line: {fault}")))
    })
}

#[cfg(test)]
mod tests {
    use super::contain_faults;
    use crate::error::Error;

    #[test]
    fn a_panic_becomes_one_line() {
        assert!(contain_faults(|| Ok(())).is_ok());
        assert!(matches!(contain_faults(|| Err(Error::usage("x"))), Err(Error::Usage(said)) if said == "x"));
        let message = contain_faults(|| panic!("index\nout of bounds")).unwrap_err().to_string();
        assert!(message.contains("index out of bounds"), "{message}");
    }
}
