//! Whether WGSL is valid, and whether its structs lie in memory as the Rust structs that are copied into them.

use naga::valid::{Capabilities, ValidationFlags, Validator};

/// Parses and validates a program; `capabilities` are what it may ask of a device beyond WebGPU.
///
/// # Errors
/// If it is not valid, with the place.
pub fn validate(source: &str, capabilities: Capabilities) -> Result<naga::Module, String> {
    let module = naga::front::wgsl::parse_str(source).map_err(|e| e.emit_to_string(source))?;
    Validator::new(ValidationFlags::all(), capabilities).validate(&module).map_err(|e| e.emit_to_string(source))?;
    Ok(module)
}

/// Compares a WGSL struct with a Rust one of `size` bytes, whose fields, but for padding, are `fields` with their offsets.
///
/// # Errors
/// If there is no such struct, or if size, a name or an offset differs.
pub fn compare_layout(
    module: &naga::Module,
    name: &str,
    size: usize,
    fields: &[(&'static str, usize)],
) -> Result<(), String> {
    let find = |(_, ty): (_, &naga::Type)| match &ty.inner {
        naga::TypeInner::Struct { members, span } if ty.name.as_deref() == Some(name) => Some((members.clone(), *span)),
        _ => None,
    };
    let (members, span) = module.types.iter().find_map(find).ok_or_else(|| format!("no struct {name}"))?;
    let wgsl: Vec<(&str, usize)> =
        members.iter().map(|m| (m.name.as_deref().unwrap_or_default(), m.offset as usize)).collect();
    match (wgsl == fields, span as usize == size) {
        (true, true) => Ok(()),
        (false, _) => Err(format!("{name} is {wgsl:?} in WGSL and {fields:?} in Rust")),
        (true, false) => Err(format!("{name} has {span} bytes in WGSL and {size} in Rust")),
    }
}

/// Fields of a Rust type with their offsets: `fields!(Type, [first, second])`.
#[macro_export]
macro_rules! fields {
    ($rust:ty, [$($field:ident),+]) => {
        [$((stringify!($field), ::std::mem::offset_of!($rust, $field))),+]
    };
}

/// Whether a WGSL struct of a module agrees with a Rust type: `layout!(module, "Name", Type, [first, second])`.
#[macro_export]
macro_rules! layout {
    ($module:expr, $name:literal, $rust:ty, [$($field:ident),+]) => {
        $crate::wgsl::compare_layout(
            $module,
            $name,
            ::std::mem::size_of::<$rust>(),
            &$crate::fields!($rust, [$($field),+]),
        )
    };
}

#[cfg(test)]
mod tests {
    use super::*;

    const PROGRAM: &str = "
        struct Pair { first: vec3<f32>, second: f32, third: vec3<f32> }
        @group(0) @binding(0) var<uniform> pair: Pair;
        @fragment fn main() -> @location(0) vec4<f32> { return vec4<f32>(pair.first, pair.second); }";

    #[repr(C)]
    struct Right {
        first: [f32; 3],
        second: f32,
        third: [f32; 3],
        _pad: f32,
    }

    #[test]
    fn a_mistake_is_noticed() {
        validate(PROGRAM, Capabilities::empty()).expect("a valid program");
        for (from, to) in [("pair.second)", "1u)"), ("pair.first", "pair.fourth"), ("main()", "main(")] {
            assert!(validate(&PROGRAM.replace(from, to), Capabilities::empty()).is_err(), "{to}");
        }
    }

    #[test]
    fn a_wrong_offset_name_or_size_is_noticed() {
        #[repr(C)]
        struct Swapped {
            second: f32,
            first: [f32; 3],
            third: [f32; 3],
            _pad: f32,
        }
        #[repr(C)]
        struct Short {
            first: [f32; 3],
            second: f32,
            third: [f32; 3],
        }
        let module = validate(PROGRAM, Capabilities::empty()).expect("a valid program");
        layout!(&module, "Pair", Right, [first, second, third]).expect("agreement");
        layout!(&module, "Pair", Swapped, [first, second, third]).expect_err("other offsets");
        layout!(&module, "Pair", Swapped, [second, first, third]).expect_err("another order");
        layout!(&module, "Pair", Short, [first, second, third]).expect_err("another size");
        layout!(&module, "Pair", Right, [first, second]).expect_err("a field too few");
        layout!(&module, "Pear", Right, [first, second, third]).expect_err("another name");
    }
}
