//! Keeps Mesa's chatter out of our messages.
//!
//! Mesa's device-selection layer asks Wayland for the default GPU and prints `error: XDG_RUNTIME_DIR is invalid` where there
//! is no session, as on servers: a line that looks like ours and means nothing. The layer is switched off by an environment
//! variable, which a process can set safely only for another one, so the program replaces itself once.

/// Starts the program anew without the layer, where it would complain; returns otherwise, and if that fails.
#[cfg(target_os = "linux")]
pub fn silence() {
    use std::env;
    use std::os::unix::process::CommandExt;
    if env::var_os("XDG_RUNTIME_DIR").is_some() || env::var_os("NODEVICE_SELECT").is_some() {
        return;
    }
    let Ok(program) = env::current_exe() else { return };
    let mut arguments = env::args_os();
    let name = arguments.next().unwrap_or_else(|| "zfail".into());
    // On success this does not return; on failure the chatter is the lesser evil.
    let _ = std::process::Command::new(program).arg0(name).args(arguments).env("NODEVICE_SELECT", "1").exec();
}

/// Other systems have no such layer.
#[cfg(not(target_os = "linux"))]
pub fn silence() {}
