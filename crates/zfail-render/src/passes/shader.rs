//! The shader programs: each is a few WGSL files, one after the other.

use crate::scene::geometry::Vertices;

/// A shader module's name and text.
#[derive(Clone, Copy, Debug)]
pub struct Program {
    pub name: &'static str,
    pub source: &'static str,
}

macro_rules! program {
    ($name:literal, $($file:literal),+) => {
        Program { name: $name, source: concat!($(include_str!(concat!("shaders/", $file, ".wgsl"))),+) }
    };
}

macro_rules! forward {
    ($vertex:literal) => {
        [forward!($vertex, "forward_open"), forward!($vertex, "forward_single"), forward!($vertex, "forward_multi")]
    };
    ($vertex:literal, $entry:literal) => {
        program!(
            $entry,
            "limits",
            "frame",
            "shape",
            "light",
            $vertex,
            "material",
            "reflection",
            "sky",
            "sky_light",
            "tone_map",
            "shade",
            $entry
        )
    };
}

macro_rules! ground {
    ($entry:literal) => {
        program!(
            $entry,
            "limits",
            "frame",
            "shape",
            "light",
            "vertex_plain",
            "sky",
            "tone_map",
            "backdrop",
            "ground",
            $entry
        )
    };
}

pub const DEPTH: Program = program!("depth", "depth");
pub const CUTOUT: Program = program!("cutout", "frame", "vertex_textured", "material", "cutout");
pub const OPEN_SKY: Program =
    program!("open sky", "limits", "frame", "screen", "sky", "tone_map", "backdrop", "open_sky");
const GROUND: [Program; 2] = [ground!("ground_single"), ground!("ground_multi")];
pub const DESCRIBE: Program =
    program!("describe", "limits", "frame", "octahedral", "vertex_mapped", "material", "describe");
pub const OWN_SHADOW: Program = program!("own shadow", "frame", "vertex_plain", "own_shadow");
pub const MASK: Program = program!("mask", "limits", "frame", "shape", "reach", "attributes", "screen", "mask");
const FORWARD: [[Program; 3]; 3] = [forward!("vertex_plain"), forward!("vertex_textured"), forward!("vertex_mapped")];
const METER: [Program; 2] = [program!("meter", "hdr_single", "meter"), program!("meter 4x", "hdr_multi", "meter")];
const DEVELOP: [Program; 2] = [
    program!("develop", "hdr_single", "screen", "tone_map", "develop"),
    program!("develop 4x", "hdr_multi", "screen", "tone_map", "develop"),
];
const FURTHER: [Program; 2] = [
    program!("further", "hdr_single", "screen", "further_single"),
    program!("further 4x", "hdr_multi", "screen", "further_multi"),
];

/// Shading of what `vertices` read; `verdicts` are the samples per pixel of the light verdicts, if there are any.
pub fn forward(vertices: Vertices, verdicts: Option<u32>) -> Program {
    let row = match vertices {
        Vertices::Depth | Vertices::Plain => 0,
        Vertices::Textured => 1,
        Vertices::Mapped => 2,
    };
    FORWARD[row][match verdicts {
        None => 0,
        Some(1) => 1,
        Some(_) => 2,
    }]
}

/// The ground, with `samples` verdicts per pixel where it reads them.
pub fn ground(samples: u32) -> Program {
    GROUND[usize::from(samples > 1)]
}

pub fn meter(samples: u32) -> Program {
    METER[usize::from(samples > 1)]
}

pub fn develop(samples: u32) -> Program {
    DEVELOP[usize::from(samples > 1)]
}

pub fn further(samples: u32) -> Program {
    FURTHER[usize::from(samples > 1)]
}

impl Program {
    pub fn module(&self, device: &wgpu::Device) -> wgpu::ShaderModule {
        device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(self.name),
            source: wgpu::ShaderSource::Wgsl(self.source.into()),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::gpu_data::{FrameUniform, LightRecord, MaterialUniform, SlotUniform};
    use zfail_testing::{fields, layout, naga};

    fn programs() -> Vec<Program> {
        [
            &[DEPTH, CUTOUT, OPEN_SKY, DESCRIBE, MASK, OWN_SHADOW][..],
            FORWARD.as_flattened(),
            &GROUND,
            &METER,
            &DEVELOP,
            &FURTHER,
        ]
        .concat()
    }

    fn validate(source: &str) -> Result<naga::Module, String> {
        zfail_testing::wgsl::validate(source, naga::valid::Capabilities::MULTISAMPLED_SHADING)
    }

    #[test]
    fn every_program_is_valid() {
        assert!(!programs().is_empty());
        for program in programs() {
            if let Err(message) = validate(program.source) {
                panic!("{}: {message}", program.name);
            }
        }
    }

    #[test]
    fn validation_finds_mistakes() {
        assert!(validate(&format!("{}fn wrong() -> f32 {{ return 1u; }}", DESCRIBE.source)).is_err());
    }

    #[test]
    fn every_file_is_part_of_a_program() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/src/passes/shaders");
        let mut files = 0;
        for entry in std::fs::read_dir(folder).expect("the folder of shaders") {
            let text = std::fs::read_to_string(entry.expect("an entry").path()).expect("a text file");
            assert!(programs().iter().any(|p| p.source.contains(&text)), "in no program: {text}");
            files += 1;
        }
        assert!(files > 10);
    }

    #[test]
    fn structures_agree() {
        let shade = &validate(forward(Vertices::Mapped, Some(1)).source).expect("a valid program");
        layout!(
            shade,
            "Frame",
            FrameUniform,
            [
                view_per_ndc,
                size,
                ambient,
                orthographic,
                up,
                pre_exposure,
                background,
                exposure,
                zenith,
                light_count,
                horizon,
                all_lights,
                nadir,
                per_ground_radius,
                ground,
                window_offset,
                lights
            ]
        )
        .expect("agreement");
        layout!(shade, "Slot", SlotUniform, [u, v]).expect("agreement");
        let mut material = fields!(
            MaterialUniform,
            [
                base_color,
                emissive,
                alpha_cutoff,
                metallic,
                roughness,
                normal_scale,
                occlusion_strength,
                specular,
                specular_strength,
                sheen,
                sheen_roughness,
                tint,
                transmission,
                clearcoat,
                clearcoat_roughness
            ]
        )
        .to_vec();
        // One by one in WGSL.
        let slots = [
            "base_color_slot",
            "metallic_roughness_slot",
            "normal_slot",
            "occlusion_slot",
            "emissive_slot",
            "specular_color_slot",
            "clearcoat_slot",
            "sheen_slot",
            "transmission_slot",
        ];
        let first = std::mem::offset_of!(MaterialUniform, slots);
        material.extend(slots.iter().enumerate().map(|(i, &name)| (name, first + i * size_of::<SlotUniform>())));
        zfail_testing::wgsl::compare_layout(shade, "Material", size_of::<MaterialUniform>(), &material)
            .expect("agreement");
        layout!(
            shade,
            "Light",
            LightRecord,
            [
                position,
                placed,
                axis,
                per_range,
                color,
                sin_outer,
                cos_outer,
                angle_scale,
                angle_offset,
                shape,
                right,
                cot_outer,
                up
            ]
        )
        .expect("agreement");
    }
}
