//! Figures over many comparisons.

use std::fmt;
use zfail_oracle::{Doubt, Report};

/// Sums of reports.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tally {
    /// Images compared.
    pub images: usize,
    /// Pixels with a surface that were compared, in images within the budget.
    pub checked: usize,
    /// Of these, lit.
    pub lit: usize,
    /// Of these, in shadow.
    pub shadowed: usize,
    /// Pixels left out, by [`Doubt::ALL`].
    pub excluded: [usize; Doubt::ALL.len()],
    /// Pixels that are not right, in any image.
    pub wrong: usize,
    /// Images that left out more than the budget allows: too fine for their size.
    pub rejected: usize,
    /// Pixels compared in those images; none may be wrong, but they prove less.
    pub checked_in_rejected: usize,
    /// Largest count.
    pub max_count: i32,
}

impl Tally {
    /// Adds one comparison.
    pub fn add(&mut self, report: &Report) {
        self.images += 1;
        self.wrong += report.wrong.len();
        if report.budget().is_err() {
            self.rejected += 1;
            self.checked_in_rejected += report.checked;
            return;
        }
        self.checked += report.checked;
        self.lit += report.lit;
        self.shadowed += report.shadowed;
        self.max_count = self.max_count.max(report.max_count);
        for (sum, excluded) in self.excluded.iter_mut().zip(report.excluded) {
            *sum += excluded;
        }
    }

    /// Adds all of another's.
    pub fn merge(&mut self, other: &Self) {
        self.images += other.images;
        self.checked += other.checked;
        self.lit += other.lit;
        self.shadowed += other.shadowed;
        self.wrong += other.wrong;
        self.rejected += other.rejected;
        self.checked_in_rejected += other.checked_in_rejected;
        self.max_count = self.max_count.max(other.max_count);
        for (sum, excluded) in self.excluded.iter_mut().zip(other.excluded) {
            *sum += excluded;
        }
    }

    /// Pixels left out, as a share of all with a surface.
    #[must_use]
    pub fn excluded_share(&self) -> f64 {
        let excluded: usize = self.excluded.iter().sum();
        excluded as f64 / (excluded + self.checked).max(1) as f64
    }
}

impl fmt::Display for Tally {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let share = |part: usize| 100.0 * part as f64 / self.checked.max(1) as f64;
        write!(
            f,
            "{:4} images {:9} px checked (and {} in {} too fine), {:2.0} % lit {:2.0} % shadowed, left out {:.3} % {:?}, \
             count to {}, wrong {}",
            self.images,
            self.checked,
            self.checked_in_rejected,
            self.rejected,
            share(self.lit),
            share(self.shadowed),
            100.0 * self.excluded_share(),
            self.excluded,
            self.max_count,
            self.wrong,
        )
    }
}
