//! Options of methods on the command line.

use crate::names;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use std::str::FromStr;
use zfail_methods::{FiniteOptions, Method, ShadowMapOptions};

/// Accepts the names of methods.
pub fn method_parser() -> impl TypedValueParser<Value = Method> {
    PossibleValuesParser::new(Method::ALL.map(Method::name)).try_map(|name| name.parse::<Method>())
}

/// `resolution=N,bias=X,slope=Y,pcf` in any order and number; what is not named keeps its default.
///
/// # Errors
/// If a name or a value is not one.
pub fn shadow_map(text: &str) -> Result<ShadowMapOptions, String> {
    const NAMES: [&str; 4] = ["resolution", "bias", "slope", "pcf"];
    let mut options = ShadowMapOptions::default();
    for (name, value) in items(text) {
        match name {
            "resolution" => options.resolution = number(name, value, |n| (1..=16_384).contains(n), "from 1 to 16384")?,
            "bias" => options.bias = number(name, value, |x: &f32| x.is_finite(), "such as 0.001")?,
            "slope" => options.slope_bias = number(name, value, |x: &f32| x.is_finite(), "such as 1")?,
            "pcf" if value.is_empty() => options.pcf = true,
            "pcf" => return Err("pcf takes no value".to_owned()),
            _ => return Err(unknown(name, &NAMES)),
        }
    }
    Ok(options)
}

/// `far=DISTANCE,extrusion=DISTANCE`, either or both; what is not named is left to the method.
///
/// # Errors
/// If a name or a value is not one.
pub fn finite(text: &str) -> Result<FiniteOptions, String> {
    const NAMES: [&str; 2] = ["far", "extrusion"];
    let mut options = FiniteOptions::default();
    for (name, value) in items(text) {
        let distance = |value| number(name, value, |x: &f64| x.is_finite() && *x > 0.0, "greater than 0");
        match name {
            "far" => options.far = Some(distance(value)?),
            "extrusion" => options.extrusion = Some(distance(value)?),
            _ => return Err(unknown(name, &NAMES)),
        }
    }
    Ok(options)
}

/// The names of a list, with their values.
fn items(text: &str) -> impl Iterator<Item = (&str, &str)> {
    let items = text.split(',').map(str::trim).filter(|item| !item.is_empty());
    items.map(|item| item.split_once('=').unwrap_or((item, "")))
}

fn unknown(name: &str, names: &[&str]) -> String {
    let hint = names::nearest(name, names).map(|name| format!(" (did you mean '{name}'?)")).unwrap_or_default();
    format!("unknown option '{name}'{hint}; there are: {}", names.join(", "))
}

fn number<T: FromStr>(name: &str, value: &str, good: impl Fn(&T) -> bool, which: &str) -> Result<T, String> {
    value.parse().ok().filter(good).ok_or_else(|| format!("{name} must be a number {which}, not '{value}'"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn methods_take_what_is_named() {
        let default = ShadowMapOptions::default();
        assert_eq!(shadow_map(""), Ok(default));
        assert_eq!(shadow_map("resolution=64"), Ok(ShadowMapOptions { resolution: 64, ..default }));
        let all = ShadowMapOptions { resolution: 1, bias: -0.5, slope_bias: 0.0, pcf: true };
        assert_eq!(shadow_map("pcf, slope=0,bias=-0.5,resolution=1"), Ok(all));
        for wrong in ["resolution", "resolution=0", "resolution=1e9", "bias=x", "slope=nan", "pcf=2", "size=4", "="] {
            assert!(shadow_map(wrong).is_err(), "{wrong}");
        }
        let ends = FiniteOptions { far: Some(20.0), extrusion: None };
        assert_eq!((finite(""), finite("far=20")), (Ok(FiniteOptions::default()), Ok(ends)));
        assert_eq!(finite("extrusion=1.5, far=20"), Ok(FiniteOptions { extrusion: Some(1.5), ..ends }));
        for wrong in ["far", "far=0", "far=inf", "extrusion=-1", "near=1"] {
            assert!(finite(wrong).is_err(), "{wrong}");
        }
        assert!(shadow_map("resolutoin=4").unwrap_err().contains("did you mean 'resolution'"));
    }
}
