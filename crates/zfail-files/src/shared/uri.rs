//! References out of the JSON: data URIs and files at or below the document's own folder.

use super::error::{Fault, Result, one_line};
use super::limits::Budget;
use base64::Engine;
use base64::alphabet::STANDARD;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};
use percent_encoding::percent_decode_str;
use std::fs;
use std::io;
use std::path::{Component, Path, PathBuf};

/// Exporters often leave the padding out.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &STANDARD,
    GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
);

/// Reads what `uri`, found at JSON path `element`, refers to.
pub(crate) fn read(uri: &str, folder: &Path, budget: &Budget, element: &str) -> Result<Vec<u8>> {
    let fault = |problem: String, remedy| Fault::Resource { element: element.into(), uri: shown(uri), problem, remedy };
    if let Some(data) = strip_scheme(uri, "data:") {
        budget.charge(data.len() as u64, 2, || element.into())?;
        return decode_data(data).map_err(|problem| fault(problem, "export the file again"));
    }
    let absent = |problem| fault(problem, "put the file there, or export as one .glb");
    let path = resolve(uri, folder).map_err(absent)?;
    let length = regular_file_length(&path).map_err(absent)?;
    budget.charge(length, 1, || element.into())?;
    fs::read(&path).map_err(|e| absent(e.to_string()))
}

/// `uri` for a message: the plain name of a file, or the begin of what is longer.
pub(crate) fn shown(uri: &str) -> String {
    let name = percent_decode_str(uri).decode_utf8().unwrap_or(uri.into());
    one_line(&name.chars().take(60).collect::<String>())
}

/// Length of the file at `path`; an error for folders, pipes and devices, which have no definite one.
pub(crate) fn regular_file_length(path: &Path) -> std::result::Result<u64, String> {
    match fs::metadata(path) {
        Ok(data) if data.is_file() => Ok(data.len()),
        Ok(data) if data.is_dir() => Err("it is a folder".into()),
        Ok(_) => Err("it is not a regular file".into()),
        Err(e) => Err(absence(&e)),
    }
}

fn absence(error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::NotFound => "there is no such file".into(),
        _ => error.to_string(),
    }
}

fn strip_scheme<'a>(uri: &'a str, scheme: &str) -> Option<&'a str> {
    let (head, rest) = uri.split_at_checked(scheme.len())?;
    head.eq_ignore_ascii_case(scheme).then_some(rest)
}

fn decode_data(data: &str) -> std::result::Result<Vec<u8>, String> {
    let (header, payload) = data.split_once(',').ok_or("the data URI has no comma before its data")?;
    let parameters = header.strip_suffix(";base64").ok_or("only base64 data URIs can be read")?;
    if parameters.split(';').skip(1).any(str::is_empty) {
        return Err("the data URI has an empty parameter".into());
    }
    let payload: String = payload.split_ascii_whitespace().collect();
    BASE64.decode(payload).map_err(|e| format!("its base64 is damaged: {e}"))
}

/// The file that a relative URI names, which must not lie outside `folder`, not even through a symbolic link.
fn resolve(uri: &str, folder: &Path) -> std::result::Result<PathBuf, String> {
    let first_segment = uri.split('/').next().unwrap_or_default();
    if first_segment.contains(':') {
        return Err("only data URIs and relative file names can be read".into());
    }
    let name = percent_decode_str(uri).decode_utf8().map_err(|_| "its name is not UTF-8".to_owned())?;
    below(Path::new(name.as_ref()), folder)
}

/// The file at `relative`, which must not lie outside `folder`, not even through a symbolic link.
pub(crate) fn below(relative: &Path, folder: &Path) -> std::result::Result<PathBuf, String> {
    if relative.as_os_str().is_empty()
        || !relative.components().all(|c| matches!(c, Component::Normal(_) | Component::CurDir))
    {
        return Err("a file may refer only to files at or below its own folder".into());
    }
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let real_folder = folder.canonicalize().map_err(|e| absence(&e))?;
    let path = folder.join(relative).canonicalize().map_err(|e| absence(&e))?;
    if !path.starts_with(&real_folder) {
        return Err("it leads out of the file's own folder through a symbolic link".into());
    }
    Ok(path)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Limits;

    fn read_in(folder: &Path, uri: &str) -> std::result::Result<Vec<u8>, String> {
        read(uri, folder, &Budget::new(Limits::default()), "buffers[0].uri").map_err(|e| e.to_string())
    }

    #[test]
    fn data_uris() {
        let here = Path::new(".");
        assert_eq!(read_in(here, "data:application/octet-stream;base64,AAEC").unwrap(), [0, 1, 2]);
        assert_eq!(read_in(here, "DATA:;base64,AAE=").unwrap(), [0, 1]);
        assert_eq!(read_in(here, "data:a/b;base64,AAE").unwrap(), [0, 1], "missing padding");
        for bad in ["data:a/b;;base64,AA==", "data:a/b,AAAA", "data:;base64AA", "data:;base64,A*==", "data:"] {
            assert!(read_in(here, bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn files_stay_in_their_folder() {
        let outer = tempfile::tempdir().unwrap();
        let folder = outer.path().join("scene");
        fs::create_dir_all(folder.join("sub")).unwrap();
        fs::write(outer.path().join("secret"), b"s").unwrap();
        fs::write(folder.join("a b%.bin"), b"x").unwrap();
        fs::write(folder.join("sub/c.bin"), b"y").unwrap();

        assert_eq!(read_in(&folder, "a%20b%25.bin").unwrap(), b"x");
        assert_eq!(read_in(&folder, "./sub/c.bin").unwrap(), b"y");
        let absolute = folder.join("sub/c.bin");
        for bad in [
            "../secret",
            "sub/../../secret",
            "%2e%2e/secret",
            "%2E%2E%2Fsecret",
            absolute.to_str().unwrap(),
            "file:///etc/passwd",
            "http://example.com/a.bin",
            "",
            "sub",
            "missing.bin",
            "%ff",
            "nul%00",
        ] {
            assert!(read_in(&folder, bad).is_err(), "{bad}");
        }
        #[cfg(unix)]
        {
            std::os::unix::fs::symlink(outer.path().join("secret"), folder.join("link")).unwrap();
            assert!(read_in(&folder, "link").unwrap_err().contains("symbolic link"));
        }
    }
}
