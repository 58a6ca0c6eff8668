//! One claim, and how it is judged.

use super::Inputs;

/// What a paper says, and when that is true.
pub struct Claim {
    /// Paper and section.
    pub source: &'static str,
    /// A few words of it.
    pub quote: &'static str,
    /// By which of the page's experiments it is judged.
    pub experiment: &'static str,
    /// What the figures are.
    pub measured: &'static str,
    /// The figures on which the verdict depends.
    pub figures: fn(&Inputs) -> Vec<Figure>,
    /// "confirmed if", in words.
    pub rule: &'static str,
    /// The same of the figures' values.
    pub holds: fn(&[f64]) -> bool,
    /// Whether a software rasteriser has what it speaks of.
    pub of: Of,
    /// What else there is to say, from the same experiments.
    pub remark: fn(&Inputs) -> String,
}

/// What a claim is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Of {
    /// Something that every device can show.
    Everything,
    /// Units of a graphics processor beside a main processor.
    Hardware,
}

/// A number with its name.
pub struct Figure {
    pub name: String,
    pub value: f64,
}

/// What becomes of a claim.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    Confirmed,
    Refuted,
    /// The device is a program on the main processor.
    NotHere,
}

impl Verdict {
    pub const ALL: [Self; 3] = [Self::Confirmed, Self::Refuted, Self::NotHere];

    pub const fn name(self) -> &'static str {
        match self {
            Self::Confirmed => "confirmed",
            Self::Refuted => "refuted",
            Self::NotHere => "not on this hardware",
        }
    }
}

impl Claim {
    /// What follows from figures; nothing from none, or from what is no number.
    pub fn verdict(&self, values: &[f64], software: bool) -> Option<Verdict> {
        if values.is_empty() || values.iter().any(|value| !value.is_finite()) {
            return None;
        }
        Some(match (self.of, software) {
            (Of::Hardware, true) => Verdict::NotHere,
            _ if (self.holds)(values) => Verdict::Confirmed,
            _ => Verdict::Refuted,
        })
    }
}

/// A figure.
pub fn figure(name: impl Into<String>, value: f64) -> Figure {
    Figure { name: name.into(), value }
}

/// For claims to which there is nothing to add.
pub fn nothing(_: &Inputs) -> String {
    String::new()
}

pub fn greatest(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::NEG_INFINITY, f64::max)
}

pub fn least(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::INFINITY, f64::min)
}

/// The middle one, or that above the middle.
pub fn median(values: &[f64]) -> f64 {
    let mut values = values.to_vec();
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

/// As many digits as tell something.
pub fn digits(value: f64) -> String {
    match value.abs() {
        v if v.fract() == 0.0 && v < 1e6 => format!("{value:.0}"),
        v if v >= 100.0 => format!("{value:.0}"),
        v if v >= 10.0 => format!("{value:.1}"),
        v if v >= 0.1 => format!("{value:.2}"),
        _ => format!("{value:.4}"),
    }
}
