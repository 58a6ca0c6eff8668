//! The page on which the papers' claims are judged: made of what the program says, by rules that can say otherwise.

#[path = "../../examples/claims/judged/mod.rs"]
mod judged;

use crate::support::{has_gpu, zfail};
use judged::claim::{Claim, Of, Verdict};
use judged::experiments::{self, Extent};
use judged::{Inputs, claims, page};
use std::fs;
use std::path::Path;

fn all() -> Vec<Claim> {
    claims::themes().into_iter().flat_map(|(_, claims)| claims).collect()
}

/// Files as `cargo xtask claims` leaves them, of little.
fn fill(folder: &Path) {
    let said = |file: &str, args: &[&str]| {
        let run = zfail(folder, &[args, &["--json"]].concat()).ok();
        fs::write(folder.join(file), run.stdout).unwrap();
    };
    for part in ["methods", "maps"] {
        fs::create_dir(folder.join(part)).unwrap();
    }
    said("adapters.json", &["adapters"]);
    said("frames.json", &["bench", "builtin:room", "builtin:stage", "-q", "--frames", "1", "--size", "48x27"]);
    let compare = |file: &str, scene: &str, more: &[&str]| {
        let fixed = ["compare", scene, "-q", "-o", "pictures", "--size", "48x30", "--light", "0"];
        said(file, &[&fixed, more].concat());
    };
    for scene in ["container", "jail"] {
        compare(&format!("methods/{scene}.json"), &format!("builtin:{scene}"), &[]);
    }
    for scene in ["container", "jail"] {
        for (k, map) in ["256,bias=0.001", "512,bias=0.001", "1024,bias=0.001", "1024,bias=0.01"].iter().enumerate() {
            let map = format!("resolution={map}");
            let more = ["--method", "shadow-map", "--shadow-map", &map];
            compare(&format!("maps/{scene}-{k}.json"), &format!("builtin:{scene}"), &more);
        }
    }
    let measured = experiments::run(Extent::Small).unwrap();
    fs::write(folder.join("measured.json"), serde_json::to_string(&measured).unwrap()).unwrap();
    fs::write(folder.join("commands.txt"), "frames: zfail bench\nmethods: zfail compare SCENE").unwrap();
}

/// Figures that differ from these in a way that a rule may care about.
fn others(values: &[f64]) -> Vec<Vec<f64>> {
    let changes: [fn(f64) -> f64; 4] = [|_| 0.0, |v| 1e-3 * v, |v| 1e3 * v, |v| v + 1e3];
    // Falling, as what gets better from one to the next.
    let falling = (0..values.len() as i32).map(|i| 1e3 * 0.25_f64.powi(i)).collect();
    let mut others = vec![falling];
    for change in changes {
        others.push(values.iter().copied().map(change).collect());
        for i in 0..values.len() {
            let mut other = values.to_vec();
            other[i] = change(other[i]);
            others.push(other);
        }
    }
    others
}

#[test]
fn every_claim_is_judged_by_figures_that_might_have_been_others() {
    if !has_gpu() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    fill(folder.path());
    let mut inputs = Inputs::read(folder.path()).unwrap();
    let page = page::page(&inputs).unwrap();
    for (i, claim) in all().iter().enumerate() {
        let row = format!("| {} | \"{}\" | {} | ", i + 1, claim.quote, claim.source);
        assert!(page.contains(&row), "'{row}' is not in {page}");
        let values: Vec<f64> = (claim.figures)(&inputs).iter().map(|figure| figure.value).collect();
        let verdict = claim.verdict(&values, false).unwrap();
        assert_ne!(verdict, Verdict::NotHere);
        let turned = others(&values).iter().any(|other| claim.verdict(other, false).is_some_and(|v| v != verdict));
        assert!(turned, "\"{}\" is {} whatever is measured: {values:?}", claim.quote, verdict.name());
        let on_software = claim.verdict(&values, true).unwrap();
        assert_eq!(on_software == Verdict::NotHere, claim.of == Of::Hardware, "{}", claim.quote);
    }
    // Without figures there is no verdict.
    inputs.measured.bands.clear();
    let error = page::page(&inputs).unwrap_err().to_string();
    assert!(error.contains("20 light sources"), "{error}");
    fs::remove_file(folder.path().join("frames.json")).unwrap();
    assert!(Inputs::read(folder.path()).is_err());
}

#[test]
fn rules_say_what_they_are_told_to() {
    let claim = |words: &str| all().into_iter().find(|claim| claim.quote.contains(words)).unwrap();
    for (words, confirmed, refuted) in [
        ("strictly faster than Lengyel", &[0.9, 0.99][..], &[0.9, 1.01][..]),
        ("only marginally", &[1.0, 0.1], &[1.0, 5.0]),
        ("about 20 light sources", &[20.0], &[4.0]),
        ("a single pass is marginal", &[1.1, 1.2], &[1.1, 1.9]),
        ("<2x with some optimizations", &[1.0, 1.9], &[1.0, 2.0]),
        ("more level", &[1.0, 1.5, 1.0, 1.2], &[1.0, 1.5, 1.3, 1.2]),
        ("so again O(s)", &[0.5, 0.51], &[0.5, 0.9]),
        ("of Lengyel", &[0.5, 0.5, 0.9, 0.9, 0.9, 0.9], &[0.5, 0.5, 0.5, 0.9, 0.9, 0.9]),
    ] {
        let claim = if words == "of Lengyel" { claim("characterize his algorithm") } else { claim(words) };
        assert_eq!(claim.verdict(confirmed, true), Some(Verdict::Confirmed), "{words}");
        assert_eq!(claim.verdict(refuted, true), Some(Verdict::Refuted), "{words}");
        assert_eq!(claim.verdict(&[], true), None, "{words}");
        assert_eq!(claim.verdict(&[f64::NAN], true), None, "{words}");
    }
}

/// The claims that a page judges.
fn judged(page: &str) -> Vec<String> {
    let rows = page.lines().filter(|line| line.starts_with("| ") && line.contains(" | \""));
    rows.filter_map(|row| row.split('"').nth(1)).map(str::to_owned).collect()
}

#[test]
fn the_page_has_the_claims_of_the_list() {
    let page = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/claims.md")).unwrap();
    let listed: Vec<String> = all().iter().map(|claim| claim.quote.to_owned()).collect();
    assert_eq!(judged(&page), listed, "cargo xtask claims");
    assert_ne!(judged(&page.replacen("| \"", "| ", 1)), listed, "the check can fail");
}
