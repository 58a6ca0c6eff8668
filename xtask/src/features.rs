//! Every feature of every package alone, where a missing `cfg` would show; with all of them the workspace is built anyway.

use crate::metadata::{self, Package};
use crate::{cargo, succeeds};

/// Checks each package that has features without any, and with each of them alone.
///
/// # Errors
/// If one does not build.
pub fn run() -> Result<(), String> {
    metadata::packages()?
        .iter()
        .flat_map(choices)
        .try_for_each(|choice| succeeds(cargo().args(["check", "--no-default-features"]).args(choice)))
}

/// What is asked of a package.
fn choices(package: &Package) -> Vec<Vec<String>> {
    let choice =
        |words: &[&str]| [&["--package", &package.name], words].concat().into_iter().map(str::to_owned).collect();
    let alone = package.features.iter().map(|feature| choice(&["--features", feature]));
    if package.features.is_empty() { Vec::new() } else { [choice(&[])].into_iter().chain(alone).collect() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn none_and_each_alone() {
        let with = |features: &[&str]| Package {
            name: "a".to_owned(),
            features: features.iter().map(|&name| name.to_owned()).collect(),
            rust_version: None,
            is_published: true,
        };
        let said: Vec<String> = choices(&with(&["b", "c"])).iter().map(|words| words.join(" ")).collect();
        assert_eq!(said, ["--package a", "--package a --features b", "--package a --features c"]);
        assert!(choices(&with(&[])).is_empty());
    }
}
