//! What Carmack says of what volumes cost, and of shadow maps.

use super::super::Inputs;
use super::super::claim::{Claim, Figure, Of, digits, figure, greatest, least, median, nothing};
use super::super::experiments::{Cost, Level};
use super::super::said::Comparison;

pub fn claims() -> Vec<Claim> {
    vec![
        Claim {
            source: "C",
            quote: "It can cost 3x the triangle count of the source model",
            experiment: "cost",
            measured: "Triangles of a light's volumes by those of all casters, everything drawn, over all lights and cameras of all \
                       scenes",
            figures: |inputs| costs(inputs, |cost| cost.everything),
            rule: "the greatest is 3 or more",
            holds: |costs| costs[1] >= 3.0,
            of: Of::Everything,
            remark: |inputs| {
                let all = &inputs.measured.cost;
                let most = all.iter().max_by(|a, b| a.everything.total_cmp(&b.everything));
                most.map_or_else(String::new, |most| {
                    format!("The greatest is of `{}`, light {}.", most.scene, most.light)
                })
            },
        },
        Claim {
            source: "C",
            quote: "<2x with some optimizations is reasonable",
            experiment: "cost",
            measured: "The same with every step that the CPU takes",
            figures: |inputs| costs(inputs, |cost| cost.optimised),
            rule: "all are less than 2",
            holds: |costs| costs[1] < 2.0,
            of: Of::Everything,
            remark: nothing,
        },
        Claim {
            source: "C",
            quote: "pathological fill rate utilization in some cases, like a light shining out horizontally through a jail cell door",
            experiment: "methods",
            measured: "Fragments of z-fail at a pixel for a light, in `jail` and at the median of the other scenes",
            figures: |inputs| {
                let fill = |of: &Comparison| {
                    let pixels = f64::from(of.size[0]) * f64::from(of.size[1]) * of.lights.len() as f64;
                    Some((of.name().to_owned(), of.of("everitt-kilgard")?.fragments / pixels))
                };
                let (jail, rest): (Vec<_>, Vec<_>) =
                    inputs.methods.iter().filter_map(fill).partition(|(scene, _)| scene == "jail");
                let rest: Vec<f64> = rest.into_iter().map(|scene| scene.1).collect();
                jail.into_iter().map(|jail| figure("jail", jail.1)).chain([figure("median", median(&rest))]).collect()
            },
            rule: "it is at least twice as much in `jail`",
            holds: |fill| fill[0] >= 2.0 * fill[1],
            of: Of::Everything,
            remark: nothing,
        },
        Claim {
            source: "C",
            quote: "The performance is more level (fixed fill rate overhead)",
            experiment: "level",
            measured: "Fragments in the most expensive of several directions by those of the mean, of a shadow map and of z-fail, by \
                       scene",
            figures: |inputs| {
                let scenes = inputs.measured.level.chunk_by(|a, b| a.scene == b.scene);
                scenes
                    .flat_map(|of_scene| {
                        let spread = |method| Some(peak(&by(of_scene, method)?.fragments));
                        let [maps, volumes] = ["shadow-map", "everitt-kilgard"].map(spread);
                        let scene = &of_scene[0].scene;
                        [maps.map(|maps| figure(format!("{scene}: map"), maps)), volumes.map(|v| figure("z-fail", v))]
                    })
                    .flatten()
                    .collect()
            },
            rule: "that of the map is less in every scene",
            holds: |spreads| spreads.as_chunks::<2>().0.iter().all(|[maps, volumes]| maps < volumes),
            of: Of::Everything,
            remark: nothing,
        },
        Claim {
            source: "C",
            quote: "theoretically somewhat faster (only one extra drawing of the surface into the shadow buffer) in most cases",
            experiment: "level",
            measured: "Time of a shadow map of 1024 texels by that of z-fail, medians over directions, by scene",
            figures: |inputs| times(inputs, "everitt-kilgard"),
            rule: "it is less than 1 in more than half of the scenes",
            holds: |ratios| 2 * ratios.iter().filter(|ratio| **ratio < 1.0).count() > ratios.len(),
            of: Of::Everything,
            remark: |inputs| {
                let ratios = times(inputs, "zfail");
                let words: Vec<String> =
                    ratios.iter().map(|ratio| format!("{} {}", ratio.name, digits(ratio.value))).collect();
                format!("By that of this library: {}.", words.join(", "))
            },
        },
        Claim {
            source: "C",
            quote: "the quality just isn't good enough unless you use extremely high resolution shadow maps",
            experiment: "maps",
            measured: "Wrong pixels by verdicts, in percent, by scene and texels along a side",
            figures: |inputs| {
                let maps = inputs.maps.iter().filter(|of| of.shadow_map.bias == USUAL_BIAS);
                let wrong = |of: &Comparison| {
                    let wrong = of.of("shadow-map")?.wrong_pixels as f64;
                    let name = format!("{} at {}", of.name(), of.shadow_map.resolution);
                    Some(figure(name, 100.0 * wrong / of.verdicts as f64))
                };
                maps.filter_map(wrong).collect()
            },
            rule: "in every scene it is more than 0.1 at the least resolution, and at most a half of that at the greatest",
            holds: |wrong| {
                let (scenes, _) = wrong.as_chunks::<RESOLUTIONS>();
                scenes.iter().all(|wrong| wrong[0] > 0.1 && wrong[RESOLUTIONS - 1] <= 0.5 * wrong[0])
            },
            of: Of::Everything,
            remark: nothing,
        },
        Claim {
            source: "C",
            quote: "you need to tweak the biases and ranges in many scenes",
            experiment: "maps",
            measured: "The bias, of those tried, with the fewest wrong pixels, in thousandths of the range, by scene",
            figures: |inputs| {
                let by_scene = inputs.maps.chunk_by(|a, b| a.scene == b.scene);
                by_scene
                    .filter_map(|of_scene| {
                        let tried = of_scene.iter().filter(|of| of.shadow_map.resolution == USUAL_RESOLUTION);
                        let best = tried.min_by_key(|of| of.of("shadow-map").map(|outcome| outcome.wrong_pixels))?;
                        Some(figure(best.name(), (1e6 * best.shadow_map.bias).round() / 1e3))
                    })
                    .collect()
            },
            rule: "it is not the same in all scenes",
            holds: |biases| greatest(biases) > least(biases),
            of: Of::Everything,
            remark: nothing,
        },
    ]
}

/// With which resolutions are tried; the program's default.
const USUAL_BIAS: f64 = 0.001;
/// With which biases are tried.
const USUAL_RESOLUTION: u32 = 1024;
/// How many are tried.
const RESOLUTIONS: usize = 3;

fn costs(inputs: &Inputs, of: fn(&Cost) -> f64) -> Vec<Figure> {
    let costs: Vec<f64> = inputs.measured.cost.iter().map(of).collect();
    vec![figure("median", median(&costs)), figure("greatest", greatest(&costs))]
}

fn by<'a>(of_scene: &'a [Level], method: &str) -> Option<&'a Level> {
    of_scene.iter().find(|level| level.method == method)
}

/// The greatest by the mean.
fn peak(values: &[f64]) -> f64 {
    greatest(values) * values.len() as f64 / values.iter().sum::<f64>()
}

/// Of shadow maps by those of another method.
fn times(inputs: &Inputs, other: &str) -> Vec<Figure> {
    let scenes = inputs.measured.level.chunk_by(|a, b| a.scene == b.scene);
    scenes
        .filter_map(|of_scene| {
            let [maps, other] = ["shadow-map", other].map(|method| by(of_scene, method));
            Some(figure(&*of_scene[0].scene, median(&maps?.milliseconds) / median(&other?.milliseconds)))
        })
        .collect()
}
