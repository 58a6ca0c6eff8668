//! Reflection beyond metallic-roughness, against the extensions' formulas in f64.

use crate::support::{at, close, gpu, look, matt, picture, plain, sun, wall};
use zfail_plan::glam::DVec3;
use zfail_scene::{Clearcoat, Material, Sheen, Specular, SpecularGlossiness};

const PI: f64 = std::f64::consts::PI;

/// Cosines between normal, eye, light and half vector.
struct Angles {
    n_l: f64,
    n_v: f64,
    n_h: f64,
    v_h: f64,
}

impl Angles {
    fn of(l: DVec3) -> Self {
        let (n, v) = (DVec3::Z, DVec3::Z);
        let h = (v + l).normalize();
        Self { n_l: n.dot(l), n_v: n.dot(v), n_h: n.dot(h), v_h: v.dot(h) }
    }

    fn fresnel(&self, f0: f64, f90: f64) -> f64 {
        f0 + (f90 - f0) * (1.0 - self.v_h).powi(5)
    }

    fn microfacets(&self, roughness: f64) -> f64 {
        let a2 = roughness.powi(4);
        let root = |c: f64| (a2 + (1.0 - a2) * c * c).sqrt();
        let distribution = a2 / (PI * (self.n_h * self.n_h * (a2 - 1.0) + 1.0).powi(2));
        distribution * 0.5 / (self.n_l * root(self.n_v) + self.n_v * root(self.n_l))
    }

    fn base(&self, diffuse: f64, f0: f64, f90: f64, roughness: f64) -> f64 {
        let fresnel = self.fresnel(f0, f90);
        ((1.0 - fresnel) * diffuse / PI + fresnel * self.microfacets(roughness)) * self.n_l
    }
}

#[test]
fn layers_reflect_what_the_extensions_say() {
    let Some(gpu) = gpu() else { return };
    let l = DVec3::new(0.7, 0.2, 1.0).normalize();
    let angles = Angles::of(l);
    let plain_base = angles.base(0.5, 0.04, 1.0, 0.5);
    let base = Material { roughness: 0.5, ..matt([0.5; 3]) };
    let coat = Clearcoat { strength: 0.5, texture: None, roughness: 0.25 };
    let coated = {
        let share = 0.5 * angles.fresnel(0.04, 1.0);
        plain_base * (1.0 - share) + share * angles.microfacets(0.25) * angles.n_l
    };
    let fibres = {
        let power = 4.0;
        let distribution = (2.0 + power) * (1.0 - angles.n_h * angles.n_h).sqrt().powf(power) / (2.0 * PI);
        distribution / (4.0 * (angles.n_l + angles.n_v - angles.n_l * angles.n_v)) * angles.n_l
    };
    let cases = [
        ("plain", base.clone(), plain_base),
        ("coat", Material { clearcoat: Some(coat), ..base.clone() }, coated),
        (
            "sheen",
            Material { sheen: Some(Sheen { color: [0.8; 3], texture: None, roughness: 0.5 }), ..base.clone() },
            plain_base * (1.0 - 0.157 * 0.8) + 0.8 * fibres,
        ),
        (
            "specular",
            Material {
                specular: Specular { ior: 3.0, strength: 0.5, color: [0.5; 3], color_texture: None },
                ..base.clone()
            },
            angles.base(0.5, 0.0625, 0.5, 0.5),
        ),
        (
            "specular-glossiness",
            Material {
                specular_glossiness: Some(SpecularGlossiness { color: [0.6; 3], glossiness: 0.5, texture: None }),
                metallic: 1.0,
                ..base
            },
            angles.base(0.5 * 0.4, 0.6, 1.0, 0.5),
        ),
    ];
    for (name, material, expected) in cases {
        let mut scene = wall(material);
        scene.lights.push(sun(-l, 3.0));
        let found =
            at(&picture(&gpu, &scene, &look(DVec3::new(0.0, 0.0, 3.0), DVec3::ZERO, [33, 33]), &plain()), 16, 16);
        assert!(close(found[0], 3.0 * expected, 4e-3), "{name}: {found:?} is not {}", 3.0 * expected);
        assert!(name == "plain" || !close(found[0], 3.0 * plain_base, 4e-3), "{name}: no different from none");
    }
}
