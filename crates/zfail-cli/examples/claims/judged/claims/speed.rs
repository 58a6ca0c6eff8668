//! What is faster than what, and what limits it.

use super::super::Inputs;
use super::super::claim::{Claim, Figure, Of, digits, figure, greatest, least, median, nothing};
use super::super::said::Outcome;

pub fn claims() -> Vec<Claim> {
    vec![
        Claim {
            source: "McG 7",
            quote: "Our algorithm performed strictly faster than Lengyel's algorithm",
            experiment: "frames",
            measured: "CPU time of a frame by that of Lengyel's, rendering included, medians of interleaved frames, by scene",
            figures: |inputs| {
                against_lengyel(inputs, |inputs, scene, technique| {
                    Some(inputs.frame(scene, technique, true)?.cpu_ms.median)
                })
            },
            rule: "it is less than 1 in every scene",
            holds: |ratios| greatest(ratios) < 1.0,
            of: Of::Everything,
            remark: where_not_faster,
        },
        Claim {
            source: "McG, abstract",
            quote: "effectively reduce the fill rate consumption of shadow rendering",
            experiment: "frames",
            measured: "Fragments of volumes by those of Everitt and Kilgard's, by scene",
            figures: |inputs| {
                let of = |scene: &str, technique| inputs.frame(scene, technique, true)?.fragments;
                let ratio = |scene: &str| Some(of(scene, "mcguire")? / of(scene, "everitt-kilgard")?);
                inputs.scenes().filter_map(|scene| Some(figure(scene, ratio(scene)?))).collect()
            },
            rule: "it is less than 1 in every scene",
            holds: |ratios| greatest(ratios) < 1.0,
            of: Of::Everything,
            remark: |inputs| {
                let of = |scene: &str, technique| inputs.frame(scene, technique, true)?.fragments;
                let ratio = |scene: &str| Some(of(scene, "auto")? / of(scene, "everitt-kilgard")?);
                let words: Vec<String> =
                    inputs.scenes().filter_map(|scene| Some(format!("{scene} {}", digits(ratio(scene)?)))).collect();
                format!("With every step of this library: {}.", words.join(", "))
            },
        },
        Claim {
            source: "McG 3",
            quote: "large performance improvement when many lights shine over a limited area",
            experiment: "frames",
            measured: "CPU time that shadows add to a frame of `stage`, under spot lights, by that of Everitt and Kilgard's",
            figures: |inputs| {
                let added = |technique| {
                    let [on, off] = [true, false].map(|shadows| inputs.frame("stage", technique, shadows));
                    Some(on?.cpu_ms.median - off?.cpu_ms.median)
                };
                let ratio = || Some(added("mcguire")? / added("everitt-kilgard")?);
                ratio().map(|ratio| figure("stage", ratio)).into_iter().collect()
            },
            rule: "it is at most two thirds",
            holds: |ratios| greatest(ratios) <= 2.0 / 3.0,
            of: Of::Everything,
            remark: nothing,
        },
        Claim {
            source: "McG 3",
            quote: "renders O( f ) triangles, so it is slower than Heidmann's",
            experiment: "methods",
            measured: "Time of Everitt and Kilgard's method by that of Heidmann's in one pass, by scene",
            figures: |inputs| ratios(inputs, "everitt-kilgard", "heidmann-two-sided", |outcome| outcome.milliseconds()),
            rule: "it is more than 1 at the median of scenes",
            holds: |ratios| median(ratios) > 1.0,
            of: Of::Everything,
            remark: nothing,
        },
        Claim {
            source: "McG, abstract",
            quote: "the simplification method trades vertex rate for fill rate",
            experiment: "fan",
            measured: "Triangles and fragments of a dark cap that is a fan, by those of one that is extruded",
            figures: |inputs| {
                let bodies = inputs.measured.fan.iter();
                bodies
                    .flat_map(|body| {
                        let ratio = |a: u32, b: u32| f64::from(a) / f64::from(b);
                        [
                            figure(
                                format!("{}: triangles", body.body),
                                ratio(body.fan.triangles, body.extruded.triangles),
                            ),
                            figure("fragments", ratio(body.fan.fragments, body.extruded.fragments)),
                        ]
                    })
                    .collect()
            },
            rule: "triangles are fewer for all bodies, and fragments more for one and fewer for none",
            holds: |ratios| {
                let (pairs, _) = ratios.as_chunks::<2>();
                pairs.iter().all(|[triangles, fragments]| *triangles < 1.0 && *fragments >= 0.99)
                    && pairs.iter().any(|[_, fragments]| *fragments > 1.0)
            },
            of: Of::Everything,
            remark: nothing,
        },
        Claim {
            source: "E&K 4.3",
            quote: "the same number of stencil buffer updates as the two-pass approach",
            experiment: "methods and two-sided",
            measured: "Percent by which fragments of z-pass in two passes differ from those in one, in the scene where it is most, and \
                       pixels at which z-fail in two passes leaves another count, of all scenes",
            figures: |inputs| {
                let ratios = ratios(inputs, "heidmann-two-pass", "heidmann-two-sided", |outcome| outcome.fragments);
                let off: Vec<f64> = ratios.iter().map(|ratio| 100.0 * (ratio.value - 1.0).abs()).collect();
                let different: usize = inputs.measured.two_sided.iter().map(|line| line.different).sum();
                vec![figure("percent", greatest(&off)), figure("pixels", different as f64)]
            },
            rule: "it is less than 0.1 percent, and there is no such pixel",
            holds: |found| found[0] < 0.1 && found[1] == 0.0,
            of: Of::Everything,
            remark: nothing,
        },
        Claim {
            source: "E&K 4.3",
            quote: "in fill-limited shadow volume rendering situations, the advantage of a single pass is marginal",
            experiment: "two-sided",
            measured: "Time of z-fail in two passes by that in one, without that of the depth pass, medians of runs in turn, by scene",
            figures: |inputs| {
                let scenes = inputs.measured.two_sided.iter();
                scenes
                    .map(|line| {
                        let [two, one] = [line.two_passes_ms, line.one_pass_ms].map(|ms| ms - line.depth_ms);
                        figure(&*line.scene, two / one)
                    })
                    .collect()
            },
            rule: "it is less than 1.25 in every scene",
            holds: |ratios| greatest(ratios) < 1.25,
            of: Of::Everything,
            remark: |inputs| {
                let triangles: Vec<String> =
                    inputs.measured.two_sided.iter().map(|line| format!("{} {}", line.scene, line.triangles)).collect();
                format!("Triangles, which two passes send twice: {}.", triangles.join(", "))
            },
        },
        Claim {
            source: "McG 7",
            quote: "limited by fill rate and not vertex rate",
            experiment: "frames",
            measured: "Fragments by vertices submitted, by scene",
            figures: |inputs| {
                let scenes = inputs.by_scene("mcguire", |frame| frame.fragments.unwrap_or(f64::NAN) / frame.vertices);
                scenes.into_iter().map(|(scene, ratio)| figure(scene, ratio)).collect()
            },
            rule: "it is 10 or more in every scene, and the device has units for both",
            holds: |ratios| least(ratios) >= 10.0,
            of: Of::Hardware,
            remark: nothing,
        },
        Claim {
            source: "McG 6",
            quote: "dominated by hardware triangle rendering and place little demand on the main processor",
            experiment: "frames",
            measured: "Planning by all CPU time of a frame, by scene",
            figures: |inputs| {
                let scenes = inputs.by_scene("mcguire", |frame| frame.planning_ms.median / frame.cpu_ms.median);
                scenes.into_iter().map(|(scene, share)| figure(scene, share)).collect()
            },
            rule: "planning is more than half of it in every scene",
            holds: |shares| least(shares) > 0.5,
            of: Of::Hardware,
            remark: nothing,
        },
        Claim {
            source: "E&K 5, Figure 4",
            quote: "34 frames/second on a GeForce4 Ti 4600 at 640x480",
            experiment: "frames",
            measured: "Frames per second of `room` by their technique, at the size of the experiment",
            figures: |inputs| {
                let frame = inputs.frame("room", "everitt-kilgard", true);
                frame.map(|frame| figure("room", 1e3 / frame.wall_ms.median)).into_iter().collect()
            },
            rule: "they are 34 or more",
            holds: |rates| least(rates) >= 34.0,
            of: Of::Hardware,
            remark: nothing,
        },
    ]
}

/// McGuire et al. by Lengyel, by scene.
fn against_lengyel(inputs: &Inputs, of: impl Fn(&Inputs, &str, &str) -> Option<f64>) -> Vec<Figure> {
    let ratio = |scene: &str| Some(of(inputs, scene, "mcguire")? / of(inputs, scene, "lengyel")?);
    inputs.scenes().filter_map(|scene| Some(figure(scene, ratio(scene)?))).collect()
}

/// Where Lengyel's is as fast or faster: what the other saves, and what finding that costs.
fn where_not_faster(inputs: &Inputs) -> String {
    let explained = |scene: &str| {
        let [ours, lengyel] = ["mcguire", "lengyel"].map(|technique| inputs.frame(scene, technique, true));
        let (ours, lengyel) = (ours?, lengyel?);
        (ours.cpu_ms.median >= lengyel.cpu_ms.median).then(|| {
            format!(
                "{scene}, where it draws {} of Lengyel's triangles and {} of the fragments and plans for {} ms instead of {} ms of \
                 {} ms",
                digits(ours.drawn() / lengyel.drawn()),
                digits(ours.fragments.unwrap_or(f64::NAN) / lengyel.fragments.unwrap_or(f64::NAN)),
                digits(ours.planning_ms.median),
                digits(lengyel.planning_ms.median),
                digits(lengyel.cpu_ms.median),
            )
        })
    };
    let scenes: Vec<String> = inputs.scenes().filter_map(explained).collect();
    if scenes.is_empty() { String::new() } else { format!("Not faster in {}.", scenes.join("; in ")) }
}

/// A number of one method by that of another, by scene.
fn ratios(inputs: &Inputs, method: &str, other: &str, number: fn(&Outcome) -> f64) -> Vec<Figure> {
    let scenes = inputs.methods.iter();
    scenes.filter_map(|of| Some(figure(of.name(), number(of.of(method)?) / number(of.of(other)?)))).collect()
}
