//! The report as a person reads it.

use super::light::{LightReport, TechniqueReport};
use super::report::{Closeup, Report, Suspect};
use std::fmt::Write;

/// The whole report.
pub fn text(report: &Report) -> String {
    let mut text = String::new();
    let [width, height] = report.size;
    // Writing to a string cannot fail.
    let _ = writeln!(
        text,
        "{} at {width}x{height} on {} ({}, driver {}, {})",
        report.scene, report.adapter, report.backend, report.driver, report.depth_format
    );
    for light in &report.lights {
        text += &of_light(light);
    }
    for closeup in &report.closeups {
        text += &of_closeup(closeup);
    }
    let closed = &report.closure;
    let left_out = match closed.left_out {
        0 => String::new(),
        casters => format!("; {casters} more casters are too many to examine"),
    };
    let _ = writeln!(
        text,
        "closure: {} volumes of {} triangles, also under random weights, have {} open edges{left_out}",
        closed.volumes, closed.triangles, closed.open_edges
    );
    match (&report.suspect, report.complaint()) {
        (_, None) => {
            let _ = writeln!(text, "{}", report.proof.sentence());
        }
        (opinion, Some(complaint)) => {
            let _ = writeln!(text, "MISMATCH: {complaint}");
            if let Some(opinion) = opinion {
                let who = match opinion.points_to {
                    Suspect::Driver => "This points to a bug of the driver",
                    Suspect::Zfail => "This points to a bug of zfail, please report it",
                    Suspect::Unknown => "Whose bug it is cannot be told here",
                };
                let _ = writeln!(text, "{who}: {}.", opinion.because);
            }
        }
    }
    text
}

/// A line, and what is wrong.
fn of_closeup(closeup: &Closeup) -> String {
    let [x, y, z] = closeup.eye;
    let seen = closeup.lights.iter().map(|light| {
        let judged = &light.judged;
        format!("light {} {} lit, {} in shadow", judged.light, judged.lit, judged.shadowed)
    });
    let seen: Vec<String> = seen.collect();
    let mut text = format!("closer, from ({x:.4} {y:.4} {z:.4}): {}\n", seen.join("; "));
    for light in closeup.lights.iter().filter(|light| !light.techniques.iter().all(TechniqueReport::passes)) {
        text += &of_light(light);
    }
    text
}

fn of_light(light: &LightReport) -> String {
    let (mut text, judged) = (String::new(), &light.judged);
    let excluded: usize = judged.excluded.values().sum();
    let reasons: Vec<String> = judged.excluded.iter().map(|(reason, pixels)| format!("{reason} {pixels}")).collect();
    let reasons = if reasons.is_empty() { String::new() } else { format!(" ({})", reasons.join(", ")) };
    let beyond = match judged.out_of_reach {
        0 => String::new(),
        pixels => format!(", {pixels} out of its reach"),
    };
    let _ = writeln!(
        text,
        "light {} '{}', {}: {} pixels checked ({} lit, {} in shadow), {excluded} left out{reasons}{beyond}",
        judged.light, judged.name, judged.kind, judged.checked, judged.lit, judged.shadowed
    );
    if let Some(why) = &judged.proves_little {
        let _ = writeln!(text, "  this picture proves little: {why}");
    }
    for row in &light.techniques {
        let _ = write!(
            text,
            "  {:<16} {} wrong pixels, {} wrong counts",
            row.technique, row.wrong_pixels, row.wrong_counts
        );
        if let Some(first) = row.examples.first() {
            let _ = write!(text, "; first at {},{}: {}, not {}", first.x, first.y, first.found, first.expected);
        }
        text.push('\n');
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::commands::judged::JudgedLight;
    use crate::commands::verify::light::Example;
    use crate::commands::verify::proof::Proof;
    use crate::commands::verify::report::{ClosureReport, Opinion};

    fn report(wrong_pixels: usize) -> Report {
        let examples = vec![Example { x: 7, y: 9, expected: 255, found: 0 }];
        let techniques = vec![TechniqueReport { technique: "auto", wrong_pixels, wrong_counts: 0, examples }];
        Report {
            scene: "a.glb".to_owned(),
            size: [64, 48],
            adapter: "A".to_owned(),
            backend: "vulkan".to_owned(),
            driver: "1".to_owned(),
            depth_format: "D".to_owned(),
            closure: ClosureReport { volumes: 3, triangles: 12, open_edges: 0, left_out: 0 },
            lights: vec![LightReport {
                judged: JudgedLight {
                    light: 2,
                    name: "sun".to_owned(),
                    kind: "directional",
                    checked: 5,
                    out_of_reach: 0,
                    background: 0,
                    lit: 3,
                    shadowed: 2,
                    excluded: [("boundary", 1)].into(),
                    leaves_out: None,
                    proves_little: Some("it is small".to_owned()),
                },
                techniques,
            }],
            closeups: Vec::new(),
            proof: Proof { enough: false, views: 1, pixels: 5, lights: Vec::new() },
            passed: wrong_pixels == 0,
            suspect: Some(Opinion { points_to: Suspect::Driver, because: "B is right".to_owned() }),
        }
    }

    #[test]
    fn a_mismatch_says_where_and_whose() {
        let said = text(&report(4));
        for words in [
            "light 2 'sun', directional: 5 pixels checked (3 lit, 2 in shadow), 1 left out (boundary 1)\n",
            "  this picture proves little: it is small\n",
            "4 wrong pixels, 0 wrong counts; first at 7,9: 0, not 255\n",
            "MISMATCH: 4 wrong pixels\nThis points to a bug of the driver: B is right.\n",
        ] {
            assert!(said.contains(words), "{said}");
        }
        assert!(!said.contains("proved"));
        let passed = text(&report(0));
        let last = "too little is proved: 0 wrong among 5 certain pixels of 1 view, but no light reaches anything that was seen\n";
        assert!(passed.ends_with(last) && !passed.contains("MISMATCH"), "{passed}");
    }
}
