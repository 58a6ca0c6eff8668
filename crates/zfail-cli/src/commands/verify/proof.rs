//! How much a verification proves.
//!
//! In: what was judged of each light in each view. Out: whether that is enough, and if not why, in a sentence. A light is
//! proved by certain pixels that it reaches, some lit and some in shadow; pixels of a view that leaves out more than its
//! boundaries explain prove nothing, and neither do pixels out of a light's reach.

use super::light::LightReport;
use serde::Serialize;
use zfail_scene::Scene;

/// As many pixels of each kind are enough.
pub const ENOUGH: usize = 100;

/// Of all views together.
#[derive(Debug, Serialize)]
pub struct Proof {
    /// Whether nothing is lacking.
    pub enough: bool,
    pub views: usize,
    /// Verdicts compared that prove something.
    pub pixels: usize,
    pub lights: Vec<LightProof>,
}

/// Of one light.
#[derive(Debug, Serialize)]
pub struct LightProof {
    /// Its number in the scene.
    pub light: usize,
    pub name: String,
    /// Certain pixels that are lit, of views that leave out little.
    pub lit: usize,
    /// Likewise in shadow.
    pub shadowed: usize,
    /// Whether it reaches anything that was seen.
    pub reaches: bool,
    /// Whether any view has a lit pixel, those that leave out much included.
    #[serde(skip)]
    lights_something: bool,
    /// Why views did not count, if any did not.
    left_out: Option<String>,
}

impl Proof {
    /// Of `lights` before anything was judged.
    pub fn new(scene: &Scene, lights: &[usize]) -> Self {
        let of = |&light: &usize| LightProof {
            light,
            name: scene.lights[light].name.clone(),
            lit: 0,
            shadowed: 0,
            reaches: false,
            lights_something: false,
            left_out: None,
        };
        Self { enough: false, views: 0, pixels: 0, lights: lights.iter().map(of).collect() }
    }

    /// Adds a view of some of the lights.
    pub fn add(&mut self, lights: &[LightReport]) {
        self.views += 1;
        for judged in lights.iter().map(|light| &light.judged) {
            let Some(proof) = self.lights.iter_mut().find(|proof| proof.light == judged.light) else { continue };
            proof.reaches |= judged.checked > 0;
            proof.lights_something |= judged.lit > 0;
            if let Some(why) = &judged.leaves_out {
                proof.left_out = Some(why.clone());
                continue;
            }
            proof.lit += judged.lit;
            proof.shadowed += judged.shadowed;
            self.pixels += judged.checked + judged.background;
        }
        self.enough = self.lights.iter().any(|light| light.reaches) && self.lacking().is_empty();
    }

    /// The lights of which more has to be seen.
    pub fn lacking(&self) -> Vec<usize> {
        self.lights.iter().filter(|proof| !proof.is_proved()).map(|proof| proof.light).collect()
    }

    /// Of one of the lights.
    pub fn of(&self, light: usize) -> Option<&LightProof> {
        self.lights.iter().find(|proof| proof.light == light)
    }

    /// Says that what is out of reach everywhere is not lacking any more, nor what a light would have to light if all that it
    /// reaches lies in shadow: shadows are what is to be proved.
    pub fn conclude(&mut self) {
        let reached = || self.lights.iter().filter(|light| light.reaches);
        self.enough = reached().next().is_some() && reached().all(|light| light.is_proved() || light.is_dark());
    }

    /// What is proved, or why it is too little: the last line of a report.
    pub fn sentence(&self) -> String {
        let views = if self.views == 1 { "1 view".to_owned() } else { format!("{} views", self.views) };
        let seen = format!("0 wrong among {} certain pixels of {views}", self.pixels);
        let titles = |of: fn(&LightProof) -> bool, what: &str| {
            let titles: Vec<String> = self.lights.iter().filter(|l| of(l)).map(LightProof::title).collect();
            if titles.is_empty() { String::new() } else { format!("; {} {what}", titles.join(", ")) }
        };
        let beyond = titles(|l| !l.reaches, "out of reach of all that was seen");
        if self.enough {
            let dark = titles(LightProof::is_dark, "lights nothing that was seen");
            let proved = || self.lights.iter().filter(|l| l.is_proved());
            if proved().next().is_none() {
                return format!("proved: {seen}, all in shadow{dark}{beyond}");
            }
            let least = |of: fn(&LightProof) -> usize| proved().map(of).min();
            let (lit, shadowed) = (least(|l| l.lit).unwrap_or(0), least(|l| l.shadowed).unwrap_or(0));
            return format!(
                "proved: {seen}; every light within reach has at least {lit} of them lit and {shadowed} in shadow{dark}{beyond}"
            );
        }
        let short: Vec<&LightProof> = self.lights.iter().filter(|l| l.reaches && !l.is_proved()).collect();
        let why = match short.first() {
            None => "no light reaches anything that was seen".to_owned(),
            Some(first) => {
                let others =
                    if short.len() > 1 { format!(" (and {} more lights)", short.len() - 1) } else { String::new() };
                format!("of {}{others} {}", first.title(), first.why_not())
            }
        };
        format!("too little is proved: {seen}, but {why}{beyond}")
    }
}

impl LightProof {
    /// Whether it was seen lit and in shadow often enough.
    pub fn is_proved(&self) -> bool {
        self.lit >= ENOUGH && self.shadowed >= ENOUGH
    }

    /// Whether all that it reaches lies in shadow, seen often enough.
    fn is_dark(&self) -> bool {
        !self.lights_something && self.shadowed >= ENOUGH
    }

    fn title(&self) -> String {
        format!("light {} '{}'", self.light, self.name)
    }

    /// What is missing, to follow "of light N".
    fn why_not(&self) -> String {
        match (self.lit >= ENOUGH, self.shadowed >= ENOUGH, &self.left_out) {
            (false, false, Some(why)) => format!("every view leaves out too much ({why})"),
            (true, false, _) => format!("only {} certain pixels in shadow were found", self.shadowed),
            (false, true, _) => format!("only {} certain pixels that it lights were found", self.lit),
            _ => format!("only {} lit pixels and {} in shadow were found that are certain", self.lit, self.shadowed),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::commands::judged::JudgedLight;

    fn seen(light: usize, lit: usize, shadowed: usize, leaves_out: Option<&str>) -> LightReport {
        let judged = JudgedLight {
            light,
            name: "lamp".to_owned(),
            kind: "point",
            checked: lit + shadowed,
            out_of_reach: 0,
            background: 0,
            lit,
            shadowed,
            excluded: [].into(),
            leaves_out: leaves_out.map(str::to_owned),
            proves_little: None,
        };
        LightReport { judged, techniques: Vec::new() }
    }

    fn proof(lights: usize) -> Proof {
        let of = |light| LightProof {
            light,
            name: "lamp".to_owned(),
            lit: 0,
            shadowed: 0,
            reaches: false,
            lights_something: false,
            left_out: None,
        };
        Proof { enough: false, views: 0, pixels: 0, lights: (0..lights).map(of).collect() }
    }

    #[test]
    fn views_add_up_until_every_light_has_enough() {
        let mut sum = proof(2);
        sum.add(&[seen(0, 500, 40, None), seen(1, 300, 300, None)]);
        assert!(!sum.enough && sum.lacking() == [0]);
        assert!(
            sum.sentence()
                .starts_with("too little is proved: 0 wrong among 1140 certain pixels of 1 view, but of light 0")
        );
        assert!(sum.sentence().ends_with("only 40 certain pixels in shadow were found"), "{}", sum.sentence());
        // What leaves out too much proves nothing.
        sum.add(&[seen(0, 500, 500, Some("it is fine"))]);
        assert!(!sum.enough && sum.lacking() == [0]);
        sum.add(&[seen(0, 10, 70, None)]);
        assert!(sum.enough && sum.lacking().is_empty());
        let said = sum.sentence();
        assert!(said.starts_with("proved: 0 wrong among 1220 certain pixels of 3 views"), "{said}");
        assert!(said.ends_with("at least 300 of them lit and 110 in shadow"), "{said}");
    }

    #[test]
    fn what_no_light_reaches_proves_nothing_of_it() {
        let mut sum = proof(2);
        sum.add(&[seen(0, 200, 200, None), seen(1, 0, 0, None)]);
        assert!(!sum.enough && sum.lacking() == [1]);
        sum.conclude();
        assert!(sum.enough && sum.sentence().ends_with("light 1 'lamp' out of reach of all that was seen"));
        let mut dark = proof(1);
        dark.add(&[seen(0, 0, 0, None)]);
        dark.conclude();
        assert!(!dark.enough && dark.sentence().contains("no light reaches anything"), "{}", dark.sentence());
        let mut fine = proof(1);
        fine.add(&[seen(0, 900, 900, Some("too fine"))]);
        fine.conclude();
        assert!(!fine.enough && fine.sentence().contains("leaves out too much (too fine)"), "{}", fine.sentence());
        for (lit, shadowed, enough) in [(0, 900, true), (1, 900, false), (900, 0, false)] {
            let mut one_sided = proof(1);
            one_sided.add(&[seen(0, lit, shadowed, None)]);
            assert!(!one_sided.enough, "other views are looked at first");
            one_sided.conclude();
            assert_eq!(one_sided.enough, enough, "{lit} lit, {shadowed} in shadow");
            assert_eq!(one_sided.sentence().contains("lights nothing that was seen"), enough);
        }
    }
}
