// Keeps one light's verdict beyond the stencil buffer, which the next light needs: draws over what the stencil test
// finds in shadow. The pipeline's write mask chooses the channel, the instance the bit.

@fragment
fn verdict(pixel: Pixel) -> @location(0) vec4<f32> {
    return vec4<f32>(f32(1u << pixel.light) / 255.0);
}
