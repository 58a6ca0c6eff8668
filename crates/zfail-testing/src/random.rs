//! Random numbers that are the same on every machine.

use glam::DVec3;

/// SplitMix64 (Steele, Lea & Flood 2014), from any seed.
#[derive(Clone, Debug)]
pub struct Random(pub u64);

impl Random {
    /// All bits.
    #[expect(clippy::should_implement_trait, reason = "it has no end")]
    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Uniform in 0..1.
    pub fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Uniform in -1..1.
    pub fn signed(&mut self) -> f64 {
        2.0 * self.unit() - 1.0
    }

    /// Uniform in `lo..hi`.
    pub fn real(&mut self, lo: f64, hi: f64) -> f64 {
        lo + (hi - lo) * self.unit()
    }

    /// Less than `n`, which is at least 1.
    pub fn below(&mut self, n: usize) -> usize {
        (self.next() % n as u64) as usize
    }

    /// Uniform in the cube of the given half edge around the origin.
    pub fn vector(&mut self, extent: f64) -> DVec3 {
        DVec3::from_array(std::array::from_fn(|_| self.real(-extent, extent)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_those_of_the_paper_and_in_range() {
        let mut random = Random(1_234_567);
        // The first of the reference implementation from this seed.
        assert_eq!([random.next(), random.next()], [6_457_827_717_110_365_317, 3_203_168_211_198_807_973]);
        let mut sum = DVec3::ZERO;
        for _ in 0..1000 {
            let v = random.vector(2.0);
            assert!(v.abs().max_element() <= 2.0 && random.below(3) < 3);
            sum += v;
        }
        assert!(sum.abs().max_element() < 200.0, "{sum} is not around the middle");
    }
}
