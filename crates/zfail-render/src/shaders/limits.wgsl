// Numbers that passes agree on.

// The depth that marks pixels without a surface; every real one is less.
const NO_SURFACE: f32 = 1e38;

// The greatest radiance that one draw adds to a target: half floats end at 65504, and sums must not reach infinity.
const BRIGHTEST: f32 = 30000.0;

