//! How often casters are in which of the three cases.

use super::super::claim::{Claim, Of, digits, figure, least, median, nothing};

pub fn claims() -> Vec<Claim> {
    vec![
        Claim {
            source: "McG 7",
            quote: "the probability of case 1 approaches unity",
            experiment: "placements",
            measured: "Share of case 1 in what is drawn, of placements at random in a sphere, by its radius in radii of the caster",
            figures: |inputs| {
                let large = inputs.measured.placements.iter().filter(|placement| placement.radius > 1.0);
                large.map(|placement| figure(format!("{}:", placement.radius), placement.case_1())).collect()
            },
            rule: "it grows with the sphere, to 0.99 or more",
            holds: |shares| shares[0] >= 0.99 && shares.is_sorted_by(|a, b| a >= b),
            of: Of::Everything,
            remark: nothing,
        },
        Claim {
            source: "McG 7",
            quote: "approaches zero because the light is most probably inside the caster",
            experiment: "placements",
            measured: "The same in spheres that are small",
            figures: |inputs| {
                let small = inputs.measured.placements.iter().filter(|placement| placement.radius <= 1.0);
                small.map(|placement| figure(format!("{}:", placement.radius), placement.case_1())).collect()
            },
            rule: "it is at most 0.01 in the smallest",
            holds: |shares| shares.last().is_some_and(|share| *share <= 0.01),
            of: Of::Everything,
            remark: nothing,
        },
        Claim {
            source: "McG 7",
            quote: "Case 1 is extremely common for such scenes",
            experiment: "frames",
            measured: "Share of case 1 among casters drawn, by scene",
            figures: |inputs| {
                let share = |cases: [f64; 3]| cases[0] / cases.iter().sum::<f64>();
                let scenes = inputs.by_scene("mcguire", |frame| share(frame.cases));
                scenes.into_iter().map(|(scene, share)| figure(scene, share)).collect()
            },
            rule: "the median of scenes is 0.9 or more",
            holds: |shares| median(shares) >= 0.9,
            of: Of::Everything,
            remark: nothing,
        },
        Claim {
            source: "McG 7",
            quote: "most objects were still in the fast cases 1 and 2",
            experiment: "frames",
            measured: "Share of cases 1 and 2 among casters drawn, by scene",
            figures: |inputs| {
                let share = |cases: [f64; 3]| (cases[0] + cases[1]) / cases.iter().sum::<f64>();
                let scenes = inputs.by_scene("mcguire", |frame| share(frame.cases));
                scenes.into_iter().map(|(scene, share)| figure(scene, share)).collect()
            },
            rule: "it is more than a half in every scene",
            holds: |shares| least(shares) > 0.5,
            of: Of::Everything,
            remark: nothing,
        },
        Claim {
            source: "McG 7",
            quote: "any object along the path between the viewer and the sun is in case 3",
            experiment: "sunset",
            measured: "Boxes before a low sun, and how many of them are in case 3",
            figures: |inputs| {
                let low = inputs.measured.sunset.iter().find(|sun| sun.elevation < 10.0);
                low.map_or_else(Vec::new, |sun| {
                    vec![
                        figure("before it", f64::from(sun.before)),
                        figure("in case 3", f64::from(sun.before_in_case_3)),
                    ]
                })
            },
            rule: "all are",
            holds: |counts| counts[0] > 0.0 && counts[0] == counts[1],
            of: Of::Everything,
            remark: |inputs| {
                let share = |cases: [u32; 3]| f64::from(cases[2]) / f64::from(cases.iter().sum::<u32>());
                let suns = inputs.measured.sunset.iter();
                let words: Vec<String> =
                    suns.map(|sun| format!("{} at {} degrees", digits(share(sun.cases)), sun.elevation)).collect();
                format!("Share of case 3 among all boxes drawn: {}.", words.join(", "))
            },
        },
    ]
}
