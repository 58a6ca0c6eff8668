//! What README, guide and comments say, held against the code, the program and one another. Every check is tried on a text
//! that is wrong, too: mostly one that stood here once.

use crate::support::papers;
use crate::support::{has_gpu, zfail};
use image::ImageReader;
use std::fs;
use std::path::{Path, PathBuf};
use zfail_builtin::SCENES;
use zfail_methods::Method;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn read(path: impl AsRef<Path>) -> String {
    let path = root().join(path);
    fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

/// Files with these extensions in a folder and below, by path from the root.
fn files(folder: &str, extensions: &[&str]) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut folders = vec![root().join(folder)];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(&folder).expect("a folder").flatten() {
            let path = entry.path();
            let name = entry.file_name();
            if path.is_dir() {
                folders.extend((name != "target").then_some(path));
            } else if path.extension().is_some_and(|e| extensions.iter().any(|known| e == *known)) {
                found.push(path.strip_prefix(root()).expect("below the root").to_owned());
            }
        }
    }
    found.sort();
    found
}

/// Documents for readers: path and text.
fn documents() -> Vec<(PathBuf, String)> {
    let top = ["README.md", "ARCHITECTURE.md", "CHANGELOG.md", "CONTRIBUTING.md"].map(PathBuf::from);
    let all = top.into_iter().chain(files("docs", &["md"]));
    all.map(|path| (path.clone(), read(path))).collect()
}

/// A text as one line.
fn joined(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// What stands between backticks, and lines that are indented as code.
fn code(text: &str) -> Vec<String> {
    let indented = text.lines().filter(|line| line.starts_with("    ")).map(|line| line.trim().to_owned());
    let prose: Vec<&str> = text.lines().filter(|line| !line.starts_with("    ") && !line.starts_with("```")).collect();
    let prose = prose.join("\n");
    let spans = prose.split('`').skip(1).step_by(2).map(joined);
    indented.chain(spans).collect()
}

#[test]
fn citations_name_sections_that_exist_and_tell_of_it() {
    let sources = ["crates", "xtask", "fuzz"].map(|folder| files(folder, &["rs", "wgsl", "toml"])).concat();
    let own = ["documents.rs", "papers.rs"];
    let sources = sources.into_iter().filter(|path| !own.iter().any(|name| path.ends_with(name)));
    let texts = sources.map(|path| (path.clone(), read(path))).chain(documents());
    let mut cited = 0;
    for (path, text) in texts {
        cited += usize::from(text.contains("E&K") || text.contains("McG"));
        assert_eq!(papers::faults(&text), [""; 0], "{}", path.display());
    }
    assert!(cited > 60, "{cited} files cite the papers");
    for wrong in [
        "/// for cameras with a finite far plane (E&K 2002, section 3.4, \"depth clamping\").",
        "// Depth clamping (Everitt & Kilgard 2002, section 3.4) by hand",
        "//! told apart in one draw (E&K 2002, section 4.1, \"two-sided stencil testing\"). z-pass does the opposite",
        "/// than `precision` shows (McGuire et al. 2003, section 4.1, \"effective radius\"). What is",
        "//! These stages, which are McGuire et al. 2003, section 7, and more: reach of the light, parts off screen.",
        "// Volumes cut through the near rectangle: \"no uniform adjustment\" (McG section 2).",
        "// \"only moved the problem to the far clipping plane\" (McG\n// section 2).",
        "*Papers:* McG section 5, \"Hardware Capabilities\", 6, \"Analysis\", 7",
        "as in McG, Image 3 and Figures 4 and 5 (McG Figures 4, 5)",
    ] {
        assert!(!papers::faults(wrong).is_empty(), "the check can fail: {wrong}");
    }
}

/// Claims of item after item that were found false: words that stand in one sentence. Each is false as long as `still` holds.
struct Claim {
    words: &'static [&'static str],
    still: fn() -> bool,
    example: &'static str,
}

/// Whether the guide's last chapter has something in its list of what is missing.
fn something_is_missing() -> bool {
    let chapter = read("docs/guide/11-using-it.md");
    let list = chapter.split("\n## What is not here yet\n").nth(1).expect("the list of what is missing");
    let list = list.split("\n## ").next().unwrap_or_default();
    list.lines().any(|line| line.starts_with("- "))
}

fn illumination_has_no_scissor() -> bool {
    !read("crates/zfail-render/src/passes/forward_pass.rs").contains("set_scissor_rect")
}

fn there_are_no_depth_bounds() -> bool {
    !files("crates", &["rs"]).iter().any(|path| !path.ends_with("documents.rs") && read(path).contains("depth_bounds"))
}

const CLAIMS: [Claim; 12] = [
    Claim {
        words: &["complete", "McGuire"],
        still: something_is_missing,
        example: "with the complete pipeline of McGuire et al. 2003: animated",
    },
    Claim {
        words: &["very", "method that the papers"],
        still: something_is_missing,
        example: "Every shadow method that the papers tell of, runnable side by side",
    },
    Claim {
        words: &["very method that led to it"],
        still: something_is_missing,
        example: "`zfail compare` runs every method that led to it, since 1991",
    },
    Claim {
        words: &["`--technique auto` takes all"],
        still: || true,
        example: "none changes a verdict, and `--technique auto` takes all.",
    },
    Claim {
        words: &["depth bounds did"],
        still: there_are_no_depth_bounds,
        example: "This does in three dimensions what McG's depth bounds did in one.",
    },
    Claim {
        words: &["depth-bounds", "has what replaces it"],
        still: there_are_no_depth_bounds,
        example: "The depth-bounds test exists in few interfaces today, and chapter 8 has what replaces it.",
    },
    Claim {
        words: &["olds for volumes and illumination"],
        still: illumination_has_no_scissor,
        example: "It holds for volumes and illumination;",
    },
    Claim {
        words: &["deeply nested"],
        still: || true,
        example: "A light on top of a long staircase: deeply nested volumes",
    },
    Claim { words: &["ase 2", "without caps"], still: || true, example: "case 2: z-fail without caps" },
    Claim {
        words: &["2 (z-fail, no caps)"],
        still: || true,
        example: "Casters in case 1 (z-pass), 2 (z-fail, no caps) and 3",
    },
    Claim { words: &["sent on by Mark Kilgard"], still: || true, example: "sent on by Mark Kilgard on 23 May 2000." },
    Claim {
        words: &["about a microsecond per caster"],
        still: || true,
        example: "planning takes about a microsecond per caster while nothing moves",
    },
];

fn claimed(claim: &Claim, text: &str) -> Option<String> {
    let found = |sentence: &&str| claim.words.iter().all(|word| sentence.contains(word));
    joined(text).split(". ").find(found).map(str::to_owned)
}

#[test]
fn what_was_found_false_is_not_said_again() {
    let sources = files("crates", &["rs", "toml", "html"]);
    let sources = sources.into_iter().filter(|path| !path.ends_with("documents.rs"));
    let texts: Vec<(PathBuf, String)> = sources.map(|path| (path.clone(), read(path))).chain(documents()).collect();
    for claim in CLAIMS.iter().filter(|claim| (claim.still)()) {
        for (path, text) in &texts {
            // Source is no sentence; each of its strings and comments may be a claim.
            let parts: Vec<&str> =
                if path.extension().is_some_and(|e| e == "md") { vec![text] } else { text.lines().collect() };
            let said = parts.iter().find_map(|part| claimed(claim, part));
            assert_eq!(said, None, "{}", path.display());
        }
        assert!(claimed(claim, claim.example).is_some(), "the check can fail: {}", claim.example);
    }
}

#[test]
fn methods_are_counted() {
    const NUMBERS: [&str; 21] = [
        "no",
        "one",
        "two",
        "three",
        "four",
        "five",
        "six",
        "seven",
        "eight",
        "nine",
        "ten",
        "eleven",
        "twelve",
        "thirteen",
        "fourteen",
        "fifteen",
        "sixteen",
        "seventeen",
        "eighteen",
        "nineteen",
        "twenty",
    ];
    /// Numbers of methods that a text states.
    fn stated(text: &str) -> Vec<usize> {
        let text = joined(text).to_lowercase();
        let words: Vec<&str> = text.split(' ').collect();
        let number =
            |pair: &[&str]| NUMBERS.iter().position(|n| *n == pair[0]).filter(|_| pair[1].starts_with("methods"));
        words.windows(2).filter_map(number).collect()
    }
    let said: Vec<usize> =
        documents().iter().flat_map(|(_, text)| stated(&text.replace("shadow methods", "methods"))).collect();
    assert!(said.len() >= 4, "{said:?}");
    assert!(said.iter().all(|&n| n == Method::ALL.len()), "{said:?} of {}", Method::ALL.len());
    assert_eq!(stated("`zfail compare` runs eleven methods"), [11]);
}

#[test]
fn commands_and_scenes_exist() {
    let folder = tempfile::tempdir().unwrap();
    let overview = zfail(folder.path(), &["--help"]).ok().stdout;
    // The parser's verdict: it reaches `--help` only after everything before it.
    let fault = |command: &str| -> Option<String> {
        // Lists explain commands at some distance.
        let command = command.split("  ").next().unwrap_or_default().replace(['[', ']'], "").replace("KIND", "volumes");
        let words: Vec<&str> = command.split_whitespace().filter(|word| *word != "...").collect();
        let (&name, rest) = words.strip_prefix(&["zfail"])?.split_first()?;
        let known = |name: &str| overview.lines().any(|line| line.trim_start().starts_with(&format!("{name} ")));
        // The viewer may be left out of the program.
        if name == "help" || name == "view" && !known(name) {
            return None;
        }
        let scene = rest.iter().find_map(|word| word.strip_prefix("builtin:"));
        if let Some(scene) = scene.filter(|scene| *scene != "NAME" && !SCENES.iter().any(|entry| entry.name == *scene))
        {
            return Some(format!("{command}: there is no scene {scene}"));
        }
        let run = zfail(folder.path(), &[&words[1..], &["--help"]].concat());
        (run.code != Some(0)).then(|| format!("{command}: {}", run.stderr))
    };
    let mut tried = 0;
    for (path, text) in documents() {
        for command in code(&text).into_iter().filter(|code| code.starts_with("zfail ")) {
            tried += 1;
            assert_eq!(fault(&command), None, "{}", path.display());
        }
    }
    assert!(tried > 60, "{tried} commands");
    for wrong in [
        "zfail render builtin:container --tiles sometimes",
        "zfail render builtin:stairs -o a.png",
        "zfail compare builtin:room --methods zfail",
        "zfail compare builtin:room --method diefenbach",
        "zfail draw builtin:room",
    ] {
        assert!(fault(wrong).is_some(), "{wrong}");
    }
}

/// A heading as links name it.
fn anchor(heading: &str) -> String {
    let kept = heading.trim_start_matches('#').trim().to_lowercase();
    kept.chars().filter(|c| c.is_alphanumeric() || " -_".contains(*c)).collect::<String>().replace(' ', "-")
}

#[test]
fn links_lead_somewhere() {
    let broken = |from: &Path, text: &str| -> Option<String> {
        let targets = text.split("](").skip(1).filter_map(|rest| rest.split(')').next());
        targets.filter(|target| !target.contains("://")).map(str::to_owned).find(|target| {
            let (file, heading) = target.split_once('#').unwrap_or((target, ""));
            let path =
                if file.is_empty() { from.to_owned() } else { from.parent().unwrap_or(Path::new("")).join(file) };
            let path = root().join(path);
            let headed = |text: String| text.lines().any(|l| l.starts_with('#') && anchor(l) == heading);
            !path.exists() || !heading.is_empty() && !fs::read_to_string(path).is_ok_and(headed)
        })
    };
    for (path, text) in documents() {
        assert_eq!(broken(&path, &text), None, "{}", path.display());
    }
    let guide = Path::new("docs/guide/README.md");
    assert!(broken(guide, "[a](12-nothing.md)").is_some() && broken(guide, "[a](README.md#no-heading)").is_some());
    assert_eq!(broken(guide, "[a](README.md#the-figures)"), None);
}

/// Headings, as anchors, under which a chapter corrects a paper.
fn corrected(chapter: &str) -> Vec<String> {
    let mut heading = String::new();
    let mut found = Vec::new();
    for line in chapter.lines() {
        if line.starts_with('#') {
            heading = anchor(line);
        } else if line.starts_with("**Correction") && found.last() != Some(&heading) {
            found.push(heading.clone());
        }
    }
    found
}

#[test]
fn every_correction_is_in_the_list() {
    let list = read("docs/guide/11-using-it.md");
    let mut corrections = 0;
    for path in files("docs/guide", &["md"]) {
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        for heading in corrected(&read(&path)).into_iter().filter(|_| name != "README.md") {
            corrections += 1;
            assert!(list.contains(&format!("]({name}#{heading})")), "not in the list: {name}#{heading}");
        }
    }
    assert!(corrections >= 6, "{corrections}");
    assert!(
        joined(&list).contains("| E&K 3.3, step 2 | the projection takes the cotangent of half the angle of view |")
    );
    assert_eq!(corrected("## A b\n\nText.\n\n**Correction: x** y.\n"), ["a-b"], "the check can fail");
}

/// The wrong pixels of a method on a scene, as the guide's table has them.
fn in_table(table: &str, method: &str, scene: &str) -> Option<u64> {
    let row = |name: &str| {
        table.lines().find(|line| line.contains(name)).map(|line| line.split('|').map(str::trim).collect())
    };
    let (head, cells): (Vec<&str>, Vec<&str>) = (row("| method |")?, row(&format!("| `{method}` |"))?);
    let column = head.iter().position(|name| *name == scene)?;
    cells.get(column)?.parse().ok()
}

#[test]
fn near_caps_are_as_wrong_as_the_table_says() {
    let table = read("docs/guide/tables/compare.md");
    let wrong = in_table(&table, "near-caps", "stacked").expect("a number");
    let said = |text: &str| {
        joined(text).contains(&format!("wrong only where eight bits wrap: at {wrong} pixels of `stacked`"))
    };
    assert!(said(&read("docs/guide/03-counting-in-front.md")), "{wrong}");
    assert!(!said("On the scenes of this guide it has no wrong pixel; but"), "the check can fail");
    for scene in ["container", "nested", "cathedral", "stage", "room", "sun", "jail", "staircase", "close-lamp"] {
        assert_eq!(in_table(&table, "near-caps", scene), Some(0), "{scene}");
    }
}

#[test]
fn the_staircase_has_as_many_layers_as_is_said() {
    if !has_gpu() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let size = ["--size", "640x360", "-o", "a.png", "--aov", "stencil=counts"];
    zfail(folder.path(), &[&["render", "builtin:staircase", "--camera", "1", "--light", "0"][..], &size].concat()).ok();
    let counts = ImageReader::open(folder.path().join("counts/light-0.png")).unwrap().decode().unwrap().into_luma8();
    // 255 is -1, at an edge.
    let most = counts.pixels().map(|p| p.0[0]).filter(|count| *count < 200).max().unwrap();
    let described = SCENES.iter().find(|entry| entry.name == "staircase").unwrap().description;
    let said = |text: &str| {
        text.contains(&format!("up to {most} layers")) || text.contains(&format!("more than {most} layers"))
    };
    assert!(said(described), "{described}: {most} layers");
    assert!(said(&joined(&read("docs/guide/06-counting-in-eight-bits.md"))), "chapter 6: {most} layers");
    assert!(!said("nested volumes, up to 300 layers"), "the check can fail");
}
