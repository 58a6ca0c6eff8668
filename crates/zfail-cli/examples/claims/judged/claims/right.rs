//! Methods of which it is said that they are right.

use super::super::Inputs;
use super::super::claim::{Claim, Figure, Of, figure, greatest, nothing};

pub fn claims() -> Vec<Claim> {
    let right = |source, quote, figures| Claim {
        source,
        quote,
        experiment: "methods",
        measured: "Pixels with a wrong verdict, by scene",
        figures,
        rule: "there is none",
        holds: |wrong| greatest(wrong) == 0.0,
        of: Of::Everything,
        remark: nothing,
    };
    vec![
        right("C, of preloading", "That works all the time", |inputs| wrong(inputs, "carmack-preload")),
        right("McG 3, of E&K", "gives correct results for all scenes", |inputs| wrong(inputs, "everitt-kilgard")),
        right("McG 3, of itself", "use z-fail testing to ensure robustness", |inputs| wrong(inputs, "mcguire")),
    ]
}

fn wrong(inputs: &Inputs, method: &str) -> Vec<Figure> {
    let scenes = inputs.methods.iter();
    scenes.filter_map(|of| Some(figure(of.name(), of.of(method)?.wrong_pixels as f64))).collect()
}
