//! A graphics adapter for machines that have none: Mesa's software Vulkan.
//!
//! A C linker is not set up here, because without one cargo could not have built this program.

use std::env;
use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The driver and, through its dependencies, the Vulkan loader.
const PACKAGE: &str = "mesa-vulkan-drivers";

/// Makes sure that there is an adapter to render with.
///
/// # Errors
/// If there is none and it cannot be installed; the message names the one command that does.
pub fn graphics_adapter() -> Result<(), String> {
    if !cfg!(target_os = "linux") || has_adapter() {
        return Ok(());
    }
    if !Path::new("/etc/debian_version").exists() {
        return Err("no Vulkan driver was found; install Mesa's software driver with your package manager, \
                    for example 'dnf install mesa-vulkan-drivers' or 'pacman -S vulkan-swrast vulkan-icd-loader'"
            .to_owned());
    }
    if !is_root() {
        return Err(format!("no Vulkan driver was found; run 'sudo apt-get install {PACKAGE}' and try again"));
    }
    println!("No Vulkan driver was found: installing {PACKAGE} (software rendering)");
    apt_get(&["update"])?;
    apt_get(&["install", "--yes", "--no-install-recommends", PACKAGE])?;
    if has_adapter() { Ok(()) } else { Err(format!("{PACKAGE} is installed, but no Vulkan driver was found")) }
}

/// Whether Vulkan is usable here, judged by files alone: the loader is there, and a driver with something to drive.
fn has_adapter() -> bool {
    if ["VK_DRIVER_FILES", "VK_ICD_FILENAMES"].iter().any(|name| env::var_os(name).is_some()) {
        return true;
    }
    let drivers = drivers(&data_folders());
    // Distributions ship drivers for hardware that the machine may not have; the software one always works.
    let usable = drivers.iter().any(|name| name.starts_with("lvp_")) || (!drivers.is_empty() && has_gpu());
    usable && has_loader()
}

/// Where the Vulkan loader looks for `vulkan/icd.d`.
fn data_folders() -> Vec<PathBuf> {
    let mut folders: Vec<PathBuf> =
        ["/etc", "/usr/share", "/usr/local/share", "/usr/local/etc"].map(PathBuf::from).into();
    folders.extend(env::var_os("XDG_DATA_DIRS").iter().flat_map(env::split_paths));
    folders.extend(env::var_os("XDG_DATA_HOME").map(PathBuf::from));
    folders.extend(env::home_dir().map(|home| home.join(".local/share")));
    folders
}

/// File names of the drivers registered in `folders`.
fn drivers(folders: &[PathBuf]) -> Vec<String> {
    let entries = folders.iter().filter_map(|folder| fs::read_dir(folder.join("vulkan/icd.d")).ok()).flatten();
    let paths = entries.flatten().map(|entry| entry.path());
    paths
        .filter(|path| path.extension() == Some(OsStr::new("json")))
        .filter_map(|path| Some(path.file_name()?.to_str()?.to_owned()))
        .collect()
}

/// Whether the kernel offers a GPU.
fn has_gpu() -> bool {
    let render_node = |entry: fs::DirEntry| entry.file_name().to_string_lossy().starts_with("renderD");
    fs::read_dir("/dev/dri").is_ok_and(|entries| entries.flatten().any(render_node))
        || ["/dev/nvidia0", "/dev/dxg"].iter().any(|device| Path::new(device).exists())
}

/// Whether the dynamic linker will find `libvulkan.so.1`.
fn has_loader() -> bool {
    let is_loader = |folder: &Path| folder.join("libvulkan.so.1").exists();
    let subfolders = |folder: &str| fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    ["/usr/lib", "/usr/lib64", "/usr/local/lib", "/lib"]
        .iter()
        .any(|folder| is_loader(Path::new(folder)) || subfolders(folder).any(|folder| is_loader(&folder)))
        || env::var_os("LD_LIBRARY_PATH").iter().flat_map(env::split_paths).any(|folder| is_loader(&folder))
}

/// Whether packages can be installed.
pub fn is_root() -> bool {
    Command::new("id").arg("-u").output().is_ok_and(|output| output.stdout.trim_ascii() == b"0")
}

/// Runs apt-get.
///
/// # Errors
/// If it fails.
pub fn apt_get(arguments: &[&str]) -> Result<(), String> {
    let line = format!("apt-get {}", arguments.join(" "));
    println!("+ {line}");
    let status = Command::new("apt-get").env("DEBIAN_FRONTEND", "noninteractive").args(arguments).status();
    match status {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(format!("'{line}' failed ({status}); repair that and try again")),
        Err(e) => Err(format!("cannot start '{line}': {e}")),
    }
}

#[cfg(test)]
mod tests {
    use super::drivers;
    use std::fs;

    #[test]
    fn drivers_are_the_json_files_of_the_loader_folders() {
        let data = std::env::temp_dir().join(format!("zfail-xtask-{}", std::process::id()));
        let folder = data.join("vulkan/icd.d");
        fs::create_dir_all(&folder).unwrap();
        assert!(drivers(std::slice::from_ref(&data)).is_empty());
        for name in ["lvp_icd.x86_64.json", "README"] {
            fs::write(folder.join(name), "").unwrap();
        }
        assert_eq!(drivers(&[data.join("missing"), data.clone()]), ["lvp_icd.x86_64.json"]);
        fs::remove_dir_all(data).unwrap();
    }
}
