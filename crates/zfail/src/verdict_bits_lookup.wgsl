// Whether the light whose bit this is (0 to 31) reaches the sample whose texel of verdicts this is.
fn zfail_is_lit(texel: vec4<f32>, bit: u32) -> bool {
    let channel = u32(texel[bit >> 3u] * 255.0 + 0.5);
    return ((channel >> (bit & 7u)) & 1u) == 0u;
}
