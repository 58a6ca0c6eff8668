//! What cargo says of the workspace's packages.

use crate::cargo;

/// A package, as far as checks ask.
#[derive(Debug, PartialEq, Eq)]
pub struct Package {
    pub name: String,
    /// Without the default one.
    pub features: Vec<String>,
    /// The oldest compiler that it promises to build with.
    pub rust_version: Option<String>,
    /// Whether it goes to a registry.
    pub is_published: bool,
}

/// The packages of the workspace.
///
/// # Errors
/// If cargo does not tell.
pub fn packages() -> Result<Vec<Package>, String> {
    let mut command = cargo();
    command.args(["metadata", "--no-deps", "--format-version", "1"]);
    let output = command.output().map_err(|e| format!("cannot start cargo: {e}"))?;
    if !output.status.success() {
        return Err(format!("{command:?} failed ({})", output.status));
    }
    Ok(read(&String::from_utf8_lossy(&output.stdout)))
}

/// The packages in what cargo prints: JSON without white space, always in the same order, which needs no parser.
fn read(metadata: &str) -> Vec<Package> {
    // A dependency has a source after its name, a package a version.
    let starts = metadata.match_indices("{\"name\":\"").map(|(at, _)| at);
    let starts: Vec<usize> =
        starts.filter(|&at| field(&metadata[at..], "\"name\":\"").1.starts_with(",\"version\":")).collect();
    let ends = starts.iter().skip(1).copied().chain([metadata.len()]);
    starts.iter().zip(ends).map(|(&start, end)| package(&metadata[start..end])).collect()
}

fn package(text: &str) -> Package {
    // Of dependencies, features are a list.
    let features =
        text.split_once("\"features\":{").and_then(|(_, rest)| rest.split_once('}')).map_or("", |(map, _)| map);
    let names = features.split("\":[").filter_map(|part| part.rsplit('"').next());
    let (rust_version, _) = field(text, "\"rust_version\":\"");
    Package {
        name: field(text, "\"name\":\"").0.to_owned(),
        features: names.filter(|name| !["", "default", "]"].contains(name)).map(str::to_owned).collect(),
        rust_version: Some(rust_version.to_owned()).filter(|version| !version.is_empty()),
        is_published: !text.contains("\"publish\":[]"),
    }
}

/// The string after `key`, which ends with its opening quote, and what follows it.
fn field<'a>(text: &'a str, key: &str) -> (&'a str, &'a str) {
    text.split_once(key).and_then(|(_, rest)| rest.split_once('"')).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn features_of_packages_are_told_from_those_of_dependencies() {
        let text = concat!(
            r#"{"packages":[{"name":"a","version":"1.0.0","id":"a","dependencies":[{"name":"b","source":null,"features":["c"]}],"#,
            r#""features":{"d":["dep:b","e"],"default":["d"],"e":[]},"publish":null,"rust_version":"1.90"},"#,
            r#"{"name":"f","version":"1.0.0","dependencies":[],"features":{},"publish":[],"rust_version":null}],"version":1}"#
        );
        let a = Package {
            name: "a".to_owned(),
            features: vec!["d".to_owned(), "e".to_owned()],
            rust_version: Some("1.90".to_owned()),
            is_published: true,
        };
        let f = Package { name: "f".to_owned(), features: Vec::new(), rust_version: None, is_published: false };
        assert_eq!(read(text), [a, f]);
    }

    #[test]
    fn this_workspace_is_read() {
        let packages = packages().unwrap();
        let of = |name: &str| packages.iter().find(|package| package.name == name).unwrap();
        assert_eq!(of("zfail-cli").features, ["codecs", "view", "wayland"]);
        assert_eq!(of("zfail-view").rust_version.as_deref(), Some("1.95"));
        assert!(of("zfail").is_published && !of("xtask").is_published);
    }
}
