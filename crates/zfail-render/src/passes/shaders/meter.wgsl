// Automatic exposure: a histogram of log luminance, then one number from it. Counting with integers makes the result
// independent of the order in which pixels are visited.

const BINS: u32 = 1024u;
// Stops of pre-exposed luminance that the histogram spans. Anything darker counts as black, which has no say.
const DARKEST: f32 = -24.0;
const BRIGHTEST_STOP: f32 = 16.0;

struct Exposure {
    // What radiance in the target is multiplied with.
    scale: f32,
}

@group(0) @binding(1) var<storage, read_write> histogram: array<atomic<u32>, BINS>;
@group(0) @binding(2) var<storage, read_write> exposure: Exposure;

var<workgroup> counts: array<atomic<u32>, BINS>;

@compute @workgroup_size(16, 16)
fn count(@builtin(global_invocation_id) pixel: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    for (var bin = local; bin < BINS; bin += 256u) {
        atomicStore(&counts[bin], 0u);
    }
    workgroupBarrier();

    if all(pixel.xy < textureDimensions(radiance_texture)) {
        let radiance = textureLoad(radiance_texture, pixel.xy, 0);
        let luminance = dot(radiance.rgb, vec3<f32>(0.2126, 0.7152, 0.0722));
        // Surfaces only (the background has a negative alpha), and only those that exposure applies to. False for NaN.
        if radiance.a >= 0.0 && radiance.a < 0.5 && luminance > exp2(DARKEST) {
            let stop = (log2(luminance) - DARKEST) / (BRIGHTEST_STOP - DARKEST);
            atomicAdd(&counts[u32(clamp(stop, 0.0, 1.0) * f32(BINS - 1u) + 0.5)], 1u);
        }
    }

    workgroupBarrier();
    for (var bin = local; bin < BINS; bin += 256u) {
        let n = atomicLoad(&counts[bin]);
        if n > 0u {
            atomicAdd(&histogram[bin], n);
        }
    }
}

// The share of surface pixels, from the darkest, whose mean becomes KEY: shadows are dark on purpose, and highlights may
// burn out.
const LOW: f32 = 0.5;
const HIGH: f32 = 0.95;
const KEY: f32 = 0.36;
// The share that must stay below BURNT, so that what a small lamp lights keeps its colours.
const NOT_BURNT: f32 = 0.97;
const BURNT: f32 = 1.8;

fn luminance_of(bin: f32) -> f32 {
    return exp2(DARKEST + bin * (BRIGHTEST_STOP - DARKEST) / f32(BINS - 1u));
}

@compute @workgroup_size(1)
fn expose() {
    var total = 0u;
    for (var bin = 0u; bin < BINS; bin++) {
        total += atomicLoad(&histogram[bin]);
    }
    if total == 0u {
        exposure.scale = 1.0;
        return;
    }
    var below = 0u;
    var bins = 0.0;
    var weight = 0.0;
    var bright = 0u;
    for (var bin = 0u; bin < BINS; bin++) {
        let before = f32(below) / f32(total);
        below += atomicLoad(&histogram[bin]);
        let after = f32(below) / f32(total);
        let counted = max(min(after, HIGH) - max(before, LOW), 0.0);
        bins += counted * f32(bin);
        weight += counted;
        if before < NOT_BURNT {
            bright = bin;
        }
    }
    exposure.scale = min(KEY / luminance_of(bins / weight), BURNT / luminance_of(f32(bright)));
}
