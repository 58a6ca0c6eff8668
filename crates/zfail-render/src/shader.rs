//! The shader programs: each is a few WGSL files, one after the other.

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

pub const AMBIENT: Program = program!("ambient", "limits", "frame", "octahedral", "surface", "ambient");
pub const FINAL: Program = program!("final", "limits", "frame", "light", "surface", "final");
pub const MASK: Program = program!("mask", "limits", "frame", "light", "gbuffer_single", "screen", "mask");
const ILLUMINATE: [Program; 2] = [
    program!("illuminate", "limits", "frame", "octahedral", "light", "gbuffer_single", "screen", "illuminate"),
    program!("illuminate 4x", "limits", "frame", "octahedral", "light", "gbuffer_multi", "screen", "illuminate"),
];
const METER: [Program; 2] =
    [program!("meter", "limits", "hdr_single", "meter"), program!("meter 4x", "limits", "hdr_multi", "meter")];
const DEVELOP: [Program; 2] = [
    program!("develop", "limits", "hdr_single", "screen", "develop"),
    program!("develop 4x", "limits", "hdr_multi", "screen", "develop"),
];

pub fn illuminate(samples: u32) -> Program {
    ILLUMINATE[usize::from(samples > 1)]
}

pub fn meter(samples: u32) -> Program {
    METER[usize::from(samples > 1)]
}

pub fn develop(samples: u32) -> Program {
    DEVELOP[usize::from(samples > 1)]
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
    use crate::gpu_data::{FrameUniform, InstanceUniform, LightRecord, MaterialUniform, SlotUniform};
    use naga::valid::{Capabilities, ValidationFlags, Validator};

    fn programs() -> Vec<Program> {
        [&[AMBIENT, FINAL, MASK][..], &ILLUMINATE, &METER, &DEVELOP].concat()
    }

    fn validate(source: &str) -> Result<naga::Module, String> {
        let module = naga::front::wgsl::parse_str(source).map_err(|e| e.emit_to_string(source))?;
        Validator::new(ValidationFlags::all(), Capabilities::MULTISAMPLED_SHADING)
            .validate(&module)
            .map_err(|e| e.emit_to_string(source))?;
        Ok(module)
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
        assert!(validate(&format!("{}fn wrong() -> f32 {{ return 1u; }}", AMBIENT.source)).is_err());
    }

    #[test]
    fn every_file_is_part_of_a_program() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/src/shaders");
        let mut files = 0;
        for entry in std::fs::read_dir(folder).expect("the folder of shaders") {
            let text = std::fs::read_to_string(entry.expect("an entry").path()).expect("a text file");
            assert!(programs().iter().any(|p| p.source.contains(&text)), "in no program: {text}");
            files += 1;
        }
        assert!(files > 10);
    }

    /// Size and field offsets of a WGSL struct.
    fn layout(program: Program, name: &str) -> (u32, Vec<u32>) {
        let module = validate(program.source).expect("a valid program");
        module
            .types
            .iter()
            .find_map(|(_, ty)| match &ty.inner {
                naga::TypeInner::Struct { members, span } if ty.name.as_deref() == Some(name) => {
                    Some((*span, members.iter().map(|m| m.offset).collect()))
                }
                _ => None,
            })
            .unwrap_or_else(|| panic!("no struct {name}"))
    }

    macro_rules! assert_layout {
        ($program:expr, $wgsl:literal, $rust:ty, [$($field:ident),+]) => {
            let (size, offsets) = layout($program, $wgsl);
            assert_eq!(size as usize, size_of::<$rust>(), $wgsl);
            let rust = [$(std::mem::offset_of!($rust, $field)),+].map(|o| o as u32);
            assert_eq!(offsets[..rust.len()], rust, $wgsl);
        };
    }

    #[test]
    fn structures_agree() {
        assert_layout!(
            FINAL,
            "Frame",
            FrameUniform,
            [view_per_ndc, size, ambient, orthographic, pre_exposure, light_count]
        );
        assert_layout!(
            FINAL,
            "Instance",
            InstanceUniform,
            [clip_from_object, view_from_object, view_from_object_normal]
        );
        assert_layout!(FINAL, "Slot", SlotUniform, [u, v]);
        assert_layout!(
            FINAL,
            "Material",
            MaterialUniform,
            [
                base_color,
                emissive,
                alpha_cutoff,
                metallic,
                roughness,
                normal_scale,
                occlusion_strength,
                textured,
                unlit,
                slots
            ]
        );
        assert_layout!(
            FINAL,
            "Light",
            LightRecord,
            [position, kind, axis, per_range, color, sin_outer, cos_outer, angle_scale, angle_offset]
        );
    }
}
