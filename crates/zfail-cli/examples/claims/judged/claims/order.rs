//! O(s) and O(f): how what is drawn grows with the mesh.

use super::super::Inputs;
use super::super::claim::{Claim, Figure, Of, digits, figure, greatest, least, nothing};
use super::super::experiments::{Growth, Size};

/// Powers up to this are the silhouette's growth, s = f^0.5.
const SILHOUETTE: f64 = 0.6;
/// Powers from this on are the mesh's.
const MESH: f64 = 0.75;

pub fn claims() -> Vec<Claim> {
    vec![
        Claim {
            quote: "only the shadow volume sides are drawn so O(s) triangles are rendered",
            figures: |inputs| powers(inputs, "mcguire", 1),
            ..grows_as_silhouette("McG 7")
        },
        Claim {
            quote: "the dark cap and sides are drawn so again O(s) triangles",
            figures: |inputs| powers(inputs, "mcguire", 2),
            ..grows_as_silhouette("McG 7")
        },
        Claim {
            quote: "The light cap is not culled, so O( f ) triangles are rendered",
            figures: |inputs| powers(inputs, "mcguire", 3),
            ..grows_as_mesh("McG 7")
        },
        Claim {
            quote: "Everitt and Kilgard's method renders O( f ) triangles",
            figures: |inputs| [1, 2, 3].into_iter().flat_map(|eye| powers(inputs, "everitt-kilgard", eye)).collect(),
            ..grows_as_mesh("McG 3")
        },
        Claim {
            quote: "characterize his algorithm as O(s), O( f ), O( f )",
            figures: |inputs| [1, 2, 3].into_iter().flat_map(|eye| powers(inputs, "lengyel", eye)).collect(),
            rule: "those of the first case are at most 0.6 and all others at least 0.75",
            holds: |powers| {
                let (first, rest) = powers.split_at(powers.len() / 3);
                greatest(first) <= SILHOUETTE && least(rest) >= MESH
            },
            ..grows_as_mesh("McG 3, of Lengyel")
        },
        Claim {
            quote: "characterized as O(s), O(s), O( f )",
            figures: |inputs| [1, 2, 3].into_iter().flat_map(|eye| powers(inputs, "auto", eye)).collect(),
            rule: "those of the first two cases are at most 0.6 and the others at least 0.75",
            holds: |powers| {
                let (first, rest) = powers.split_at(2 * powers.len() / 3);
                greatest(first) <= SILHOUETTE && least(rest) >= MESH
            },
            ..grows_as_mesh("McG 3, of this library's steps")
        },
        Claim {
            source: "McG 7",
            quote: "It is expected that half the triangles are light facing",
            experiment: "growth",
            measured: "Share of a body's triangles in its light cap",
            figures: |inputs| shares(inputs, |size| f64::from(size.light_cap)),
            rule: "all lie between 0.4 and 0.6",
            holds: |shares| shares.iter().all(|share| (0.4..=0.6).contains(share)),
            of: Of::Everything,
            remark: nothing,
        },
        Claim {
            source: "McG 7",
            quote: "s < f (and frequently, s << f )",
            experiment: "growth",
            measured: "Silhouette edges by triangles, of the largest bodies",
            figures: |inputs| shares(inputs, |size| 0.5 * f64::from(size.sides)),
            rule: "none exceeds 0.1",
            holds: |shares| greatest(shares) <= 0.1,
            of: Of::Everything,
            remark: nothing,
        },
        Claim {
            source: "McG, abstract",
            quote: "reduce the memory bandwidth requirement from 36 to 6 bytes per triangle",
            experiment: "frames",
            measured: "Bytes of indices by triangles drawn, in the scene with the most",
            figures: |inputs| {
                // An index has 32 bits.
                let bytes: Vec<f64> = inputs
                    .by_scene("mcguire", |frame| 4.0 * frame.vertices / frame.drawn())
                    .iter()
                    .map(|s| s.1)
                    .collect();
                vec![figure("bytes", greatest(&bytes))]
            },
            rule: "at most 6",
            holds: |bytes| greatest(bytes) <= 6.0,
            of: Of::Everything,
            remark: |inputs| {
                let bytes = inputs.by_scene("mcguire", |frame| 4.0 * frame.vertices / frame.drawn());
                let most = greatest(&bytes.iter().map(|scene| scene.1).collect::<Vec<_>>());
                format!(
                    "Indices have 32 bits here, so that a frame may have more than 2^16 vertices: {} times less than 36.",
                    digits(36.0 / most)
                )
            },
        },
    ]
}

fn grows_as_silhouette(source: &'static str) -> Claim {
    Claim { rule: "none exceeds 0.6", holds: |powers| greatest(powers) <= SILHOUETTE, ..grows_as_mesh(source) }
}

fn grows_as_mesh(source: &'static str) -> Claim {
    Claim {
        source,
        quote: "",
        experiment: "growth",
        measured: "Power with which the triangles drawn grow with those of the mesh, by body and case",
        figures: |_| Vec::new(),
        rule: "none is less than 0.75",
        holds: |powers| least(powers) >= MESH,
        of: Of::Everything,
        remark: nothing,
    }
}

/// By body, from the place at which McGuire et al. have so many cases.
fn powers(inputs: &Inputs, technique: &str, case: usize) -> Vec<Figure> {
    let eye = ["beside", "in shadow, looking away", "in shadow, looking at it"][case - 1];
    let lines = inputs.measured.growth.iter().filter(|line| line.technique == technique && line.eye == eye);
    lines.filter_map(|line| Some(figure(format!("{} in case {case}", line.body), line.power()?))).collect()
}

/// Of the largest of each body where everything is drawn, by its triangles.
fn shares(inputs: &Inputs, of: fn(&Size) -> f64) -> Vec<Figure> {
    let everything = |line: &&Growth| line.technique == "everitt-kilgard" && line.eye == "in shadow, looking at it";
    let lines = inputs.measured.growth.iter().filter(everything);
    lines
        .filter_map(|line| line.sizes.last().map(|size| figure(&*line.body, of(size) / size.triangles as f64)))
        .collect()
}
