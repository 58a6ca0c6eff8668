//! What a test needs of the machine. In: what came of asking for it. Out: the thing, or `None` if the test is to be skipped.
//!
//! A test that passes because it did not run proves nothing and looks as if it did. So it fails where something is missing,
//! unless a variable says that this is known.

use std::env;
use std::fmt::Display;

/// A device as tests of the library use it, which have no renderer.
#[derive(Debug)]
pub struct Raw {
    /// What the device was asked of.
    pub adapter: wgpu::Adapter,
    /// The device.
    pub device: wgpu::Device,
    /// Its queue.
    pub queue: wgpu::Queue,
}

/// The graphics adapter that a test needs, or anything on it; `ZFAIL_WITHOUT_GPU=1` skips the test where there is none.
///
/// # Panics
/// If there is none otherwise.
#[track_caller]
pub fn gpu<T, E: Display>(made: Result<T, E>) -> Option<T> {
    needed("ZFAIL_WITHOUT_GPU", made)
}

/// The browser that a test needs; `ZFAIL_WITHOUT_BROWSER=1` skips the test where there is none.
///
/// # Panics
/// If there is none otherwise.
#[track_caller]
pub fn browser<T, E: Display>(made: Result<T, E>) -> Option<T> {
    needed("ZFAIL_WITHOUT_BROWSER", made)
}

/// The screen that a test needs; `ZFAIL_WITHOUT_DISPLAY=1` skips the test where there is none.
///
/// # Panics
/// If there is none otherwise.
#[track_caller]
pub fn display<T, E: Display>(made: Result<T, E>) -> Option<T> {
    needed("ZFAIL_WITHOUT_DISPLAY", made)
}

/// A device with what `describe` asks of the adapter, for [`gpu`].
///
/// # Errors
/// If there is no adapter.
///
/// # Panics
/// If the adapter refuses the device.
pub fn device(
    describe: impl FnOnce(&wgpu::Adapter) -> wgpu::DeviceDescriptor<'static>,
) -> Result<Raw, wgpu::RequestAdapterError> {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
    descriptor.backends = wgpu::Backends::from_env().unwrap_or(wgpu::Backends::PRIMARY);
    let options = wgpu::RequestAdapterOptions::default();
    let adapter = pollster::block_on(wgpu::Instance::new(descriptor).request_adapter(&options))?;
    let (device, queue) = pollster::block_on(adapter.request_device(&describe(&adapter))).expect("a device");
    Ok(Raw { adapter, device, queue })
}

#[track_caller]
fn needed<T, E: Display>(variable: &str, made: Result<T, E>) -> Option<T> {
    match decide(variable, env::var(variable).is_ok_and(|value| value == "1"), made) {
        Ok(Ok(thing)) => Some(thing),
        Ok(Err(skipped)) => {
            eprintln!("{skipped}");
            None
        }
        Err(failed) => panic!("{failed}"),
    }
}

/// The thing; or why the test is skipped; or why it fails.
fn decide<T, E: Display>(variable: &str, excused: bool, made: Result<T, E>) -> Result<Result<T, String>, String> {
    match made {
        Ok(thing) => Ok(Ok(thing)),
        Err(error) if excused => Ok(Err(format!("skipped: {error}, and {variable} is set"))),
        Err(error) => Err(format!("{error}; {variable}=1 skips tests that need it")),
    }
}

#[cfg(test)]
mod tests {
    use super::decide;

    /// In all four cases, for a rule that skips too readily hides every other test.
    #[test]
    fn what_is_missing_fails_unless_it_is_excused() {
        let decide = |excused, made: Result<u8, &str>| decide("ZFAIL_WITHOUT_GPU", excused, made);
        assert_eq!(decide(false, Ok(1)), Ok(Ok(1)));
        assert_eq!(decide(true, Ok(1)), Ok(Ok(1)), "what is there is used");
        let failed = decide(false, Err("no adapter")).expect_err("a failure");
        assert!(failed.starts_with("no adapter; ") && failed.contains("ZFAIL_WITHOUT_GPU=1"), "{failed}");
        let skipped = decide(true, Err("no adapter")).expect("no failure").expect_err("nothing to test with");
        assert!(skipped.starts_with("skipped: no adapter"), "{skipped}");
    }
}
