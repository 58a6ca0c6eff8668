//! The README and the documentation of each crate that is published, which say the same where they say it twice: both open with
//! one sentence, both know the crate's features, and code in a README calls nothing that the documentation, whose code is
//! compiled, does not call.

use std::fs;
use std::path::{Path, PathBuf};

fn crates() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// A crate's manifest, README and documentation.
struct Crate {
    manifest: String,
    readme: String,
    docs: String,
}

impl Crate {
    fn read(folder: &Path) -> Option<Self> {
        let read = |name: &str| fs::read_to_string(folder.join(name)).ok();
        let source = read("src/lib.rs").or_else(|| read("src/main.rs"))?;
        let docs = source.lines().map_while(|line| line.strip_prefix("//!"));
        let docs = docs.map(|line| line.strip_prefix(' ').unwrap_or(line)).collect::<Vec<_>>().join("\n");
        let manifest = read("Cargo.toml").filter(|manifest| !manifest.contains("publish = false"))?;
        Some(Self { manifest, readme: read("README.md")?, docs })
    }

    fn faults(&self) -> Vec<String> {
        let mut faults = Vec::new();
        let [said, meant] = [sentence(&self.readme), sentence(&self.docs)];
        if said != meant {
            faults.push(format!("README opens with '{said}', the documentation with '{meant}'"));
        }
        for feature in features(&self.manifest) {
            if !self.readme.contains(&format!("`{feature}`")) && !self.readme.contains(&format!("--features {feature}"))
            {
                faults.push(format!("README does not name the feature {feature}"));
            }
        }
        let (compiled, shown) = (code(&self.docs), code(&self.readme));
        let compiled = calls(&compiled);
        let unknown = calls(&shown).into_iter().filter(|name| !compiled.contains(name));
        faults.extend(unknown.map(|name| format!("README calls {name}, the documentation does not")));
        faults
    }
}

/// The first sentence below headings, without markup.
fn sentence(text: &str) -> String {
    let lines = text.lines().skip_while(|line| line.is_empty() || line.starts_with('#'));
    let paragraph = lines.take_while(|line| !line.is_empty()).collect::<Vec<_>>().join(" ");
    // Of a link, what it shows.
    let mut shown = String::new();
    let mut rest = paragraph.as_str();
    while let Some((before, after)) = rest.split_once("](") {
        shown += before;
        rest = after.split_once(')').map_or("", |(_, rest)| rest);
    }
    let shown = (shown + rest).replace(['[', ']', '`'], "");
    shown.split_inclusive(". ").next().unwrap_or_default().trim().to_owned()
}

/// Features other than the default ones.
fn features(manifest: &str) -> Vec<&str> {
    let section = manifest.split("[features]\n").nth(1).unwrap_or_default().split("\n[").next().unwrap_or_default();
    let names = section.lines().filter(|line| !line.starts_with('#')).filter_map(|line| line.split_once(" = "));
    names.map(|(name, _)| name).filter(|name| *name != "default").collect()
}

/// The Rust code of a text.
fn code(text: &str) -> String {
    let blocks = text.split("```").skip(1).step_by(2);
    let rust = blocks
        .filter_map(|block| block.split_once('\n'))
        .filter(|(kind, _)| ["", "rust"].contains(&kind.split(',').next().unwrap_or("")));
    rust.map(|(_, code)| code).collect()
}

/// Names of what code calls or fills, each once: what stands before a bracket.
fn calls(code: &str) -> Vec<&str> {
    let is_name = |c: char| c.is_alphanumeric() || c == '_';
    let mut names: Vec<&str> = Vec::new();
    for (at, _) in code.match_indices(['(', '{']) {
        let before = code[..at].trim_end();
        let name = &before[before.rfind(|c| !is_name(c)).map_or(0, |end| end + 1)..];
        if !name.is_empty() && !names.contains(&name) {
            names.push(name);
        }
    }
    names
}

#[test]
fn readmes_say_what_the_documentation_says() {
    let folders = fs::read_dir(crates()).unwrap().map(|entry| entry.unwrap().path());
    let published: Vec<(PathBuf, Crate)> =
        folders.filter_map(|folder| Crate::read(&folder).map(|read| (folder, read))).collect();
    assert!(published.len() > 10, "{}", published.len());
    for (folder, read) in &published {
        assert_eq!(read.faults(), [""; 0], "{}", folder.display());
    }
    let wrong = Crate {
        manifest: "[features]\ndefault = [\"fast\"]\n# Faster.\nfast = []\n[dependencies]\nslow = \"1\"\n".to_owned(),
        readme: "# a\n\nShadows of [a](b) kind. More.\n\n```rust,ignore\nlet a = cast(&light);\n```\n".to_owned(),
        docs: "Shadows of `a` kind. Other things.\n\n```\nlet a = shine(&light);\n```\n".to_owned(),
    };
    assert_eq!(
        wrong.faults(),
        ["README does not name the feature fast", "README calls cast, the documentation does not"]
    );
    assert!(Crate { docs: "Shadows of another kind.".to_owned(), ..wrong }.faults()[0].contains("another kind"));
}

#[test]
fn the_front_page_calls_what_the_documentation_calls() {
    let library = Crate::read(&crates().join("zfail")).unwrap();
    let front = fs::read_to_string(crates().join("../README.md")).unwrap();
    let (compiled, shown) = (code(&library.docs), code(&front));
    let compiled = calls(&compiled);
    for name in calls(&shown) {
        assert!(compiled.contains(&name), "{name}");
    }
    assert!(!compiled.contains(&"encode_shadows"), "the check can fail");
}
