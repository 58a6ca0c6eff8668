// Numbers that passes agree on.

// The depth that marks pixels without a surface; every real one is less.
const NO_SURFACE: f32 = 1e38;

// The greatest radiance that one draw adds to a target: half floats end at 65504, and sums must not reach infinity.
const BRIGHTEST: f32 = 30000.0;

// Depths travel as the bytes of their bits: not every device has multisampled targets of 32-bit floats.
fn depth_bytes(depth: f32) -> vec4<u32> {
    return unpack4xU8(bitcast<u32>(depth));
}

fn depth_from(bytes: vec4<u32>) -> f32 {
    return bitcast<f32>(pack4xU8(bytes));
}

