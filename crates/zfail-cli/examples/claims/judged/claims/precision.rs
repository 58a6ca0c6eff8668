//! Bits of depth, and bits of colour.

use super::super::Inputs;
use super::super::claim::{Claim, Figure, Of, digits, figure, greatest, nothing};
use super::super::experiments::{Buffer, Depth};
use super::super::said::Comparison;

pub fn claims() -> Vec<Claim> {
    vec![
        Claim {
            source: "E&K 3.2.1",
            quote: "typically reduces the depth buffer precision only marginally",
            experiment: "depth",
            measured: "Percent of the distances that a 24-bit buffer no longer tells apart, at the median of places between the \
                       planes, by near and far plane",
            figures: |inputs| lost(inputs, Buffer::Conventional24),
            rule: "none exceeds 2",
            holds: |lost| greatest(lost) <= 2.0,
            of: Of::Everything,
            remark: |inputs| {
                let words = |buffer| {
                    let figures = lost(inputs, buffer);
                    figures.iter().map(|figure| digits(figure.value)).collect::<Vec<_>>().join(", ")
                };
                format!(
                    "Less than 0 is more that is told apart: without a far plane, the matrix has a row that needs no rounding. The \
                     renderer has no conventional depth; it is computed on the CPU, in the same f32 arithmetic. With depth stored \
                     as f32 the losses are {}; with reversed depth, as the library draws, {}.",
                    words(Buffer::ConventionalFloat),
                    words(Buffer::ReversedFloat)
                )
            },
        },
        Claim {
            source: "E&K 3.2.1",
            quote: "squeezed by just 1%",
            experiment: "depth",
            measured: "Percent of the values of a 24-bit buffer that lie beyond the far plane, by planes",
            figures: |inputs| {
                let of = |depth: &Depth| depth.near == 1.0 && depth.far == 100.0;
                let depths = inputs.measured.depth.iter().filter(|depth| of(depth));
                depths.filter_map(|depth| Some(figure(planes(depth), 100.0 * (1.0 - depth.values?)))).collect()
            },
            rule: "it lies between 0.5 and 1.5",
            holds: |lost| lost.iter().all(|lost| (0.5..=1.5).contains(lost)),
            of: Of::Everything,
            remark: nothing,
        },
        Claim {
            source: "McG 8",
            quote: "about 20 light sources can illuminate a single point",
            experiment: "bands",
            measured: "Lights of an area light from which on the sum in 8 bits is off by more than 2 % of white somewhere on a floor",
            figures: |inputs| {
                let bands = &inputs.measured.bands;
                let banded = bands.iter().find(|bands| bands.eight_bits > 0.02 * 255.0).or(bands.last());
                banded.map(|bands| figure("from", bands.lights as f64)).into_iter().collect()
            },
            rule: "they are 10 to 40",
            holds: |lights| lights.iter().all(|lights| (10.0..=40.0).contains(lights)),
            of: Of::Everything,
            remark: |inputs| {
                let twenty = inputs.measured.bands.iter().find(|bands| bands.lights == 20);
                twenty.map_or_else(String::new, |twenty| {
                    format!(
                        "At 20 lights the error is {} levels of 255, and {} where floats are added and only their sum is rounded, as \
                         the renderer does.",
                        digits(twenty.eight_bits),
                        digits(twenty.floats)
                    )
                })
            },
        },
        Claim {
            source: "E&K 4.1",
            quote: "in practice, particularly with an 8-bit stencil buffer, this is quite unlikely",
            experiment: "methods",
            measured: "Scenes compared and, of these, scenes at a pixel of which 256 layers look like none",
            figures: |inputs| {
                let wrapped =
                    |of: &&Comparison| of.of("everitt-kilgard").is_some_and(|outcome| outcome.wrong_pixels > 0);
                let wrong = inputs.methods.iter().filter(wrapped).count();
                vec![figure("compared", inputs.methods.len() as f64), figure("wrong", wrong as f64)]
            },
            rule: "they are fewer than a fifth",
            holds: |scenes| scenes[1] < 0.2 * scenes[0],
            of: Of::Everything,
            remark: |inputs| {
                let wrong = |of: &Comparison| of.of("everitt-kilgard").map(|o| o.wrong_pixels);
                let scenes = inputs.methods.iter().filter(|of| wrong(of).is_some_and(|wrong| wrong > 0));
                let names: Vec<&str> = scenes.map(|of| of.name()).collect();
                format!("Wrong in: {}; `stacked` is built to be.", names.join(", "))
            },
        },
    ]
}

/// Percent that are no longer told apart, by planes.
fn lost(inputs: &Inputs, buffer: Buffer) -> Vec<Figure> {
    let depths = inputs.measured.depth.iter().filter(|depth| depth.buffer == buffer);
    depths.map(|depth| figure(planes(depth), 100.0 * (1.0 - depth.median))).collect()
}

fn planes(depth: &Depth) -> String {
    format!("{} to {}:", depth.near, depth.far)
}
