//! Two triangles, once wrong at a pixel: the one that is seen turns away from the light and so lies in its own shadow, and an
//! edge of the other's volume meets it within 0.001 pixels of the pixel's centre, where one of the two sides at that edge
//! counts and the other does not.

use zfail_exact::bench::{self, Images};
use zfail_plan::glam::{DAffine3, DMat3, DVec3};
use zfail_plan::light::LightKind;
use zfail_plan::view::{Projection, View};
use zfail_render::{Settings, Technique, Tiles};
use zfail_scene::{Instance, Light, LightShape, Material, Mesh, Primitive, Scene};

const SEEN: [[f32; 3]; 3] = [
    [0.015_434_263, 0.025_617_793, -0.013_433_008],
    [0.011_308_718, 0.021_269_131, -0.013_337_347],
    [0.014_622_336, 0.023_964_548, -0.014_584_583],
];
const OTHER: [[f32; 3]; 3] = [
    [0.010_563_558, 0.038_890_753, -0.004_167_617_3],
    [0.012_261_41, 0.037_975_2, -0.003_639_558_3],
    [0.011_997_568, 0.038_593_274, -0.002_823_847],
];

fn scene() -> Scene {
    let mesh = Mesh {
        positions: [SEEN, OTHER].concat(),
        triangles: vec![[0, 1, 2], [3, 4, 5]],
        primitives: vec![Primitive { triangles: 0..2, material: Some(0) }],
        ..Mesh::default()
    };
    let direction = DVec3::new(0.073_443_890_161_490_54, -0.815_139_145_939_222_3, -0.574_590_434_792_837_4);
    Scene {
        meshes: vec![mesh],
        materials: vec![Material::default()],
        instances: vec![Instance {
            name: "pair".into(),
            mesh: 0,
            world_from_object: DAffine3::IDENTITY,
            casts_shadow: true,
            receives_shadow: true,
        }],
        lights: vec![Light {
            name: "sun".into(),
            kind: LightKind::Directional { direction },
            color: [1.0; 3],
            intensity: 3.0,
            excluded: Vec::new(),
            shape: LightShape::default(),
        }],
        ..Scene::default()
    }
}

fn view(size: [u32; 2]) -> View {
    let axes = DMat3::from_cols(
        DVec3::new(0.847_998_304_005_088, 0.0, -0.529_998_940_003_179_9),
        DVec3::new(-0.206_890_401_684_699_4, 0.920_662_287_496_912_5, -0.331_024_642_695_519_1),
        DVec3::new(0.487_950_036_474_266_55, 0.390_360_029_379_413_3, 0.780_720_058_358_826_5),
    );
    let eye = DVec3::new(0.105_986_709_032_751_58, 0.086_869_930_234_986_51, 0.164_015_998_954_451_01);
    let projection =
        Projection::Perspective { yfov: std::f64::consts::FRAC_PI_4, near: 0.001_096_087_061_673_855_2, far: None };
    View::new(DAffine3 { matrix3: axes, translation: eye }, projection, size)
}

#[test]
fn what_turns_away_from_the_light_is_dark() {
    let Some(gpu) = crate::gpu() else { return };
    let (scene, mut checked) = (scene(), 0);
    for size in [[320, 200], [640, 400], [321, 197], [1280, 800]] {
        let view = view(size);
        for technique in Technique::ALL {
            let settings = Settings { technique, tiles: Tiles::Never, ..Settings::default() };
            let rendered = bench::render(&gpu, &scene, &view, &settings).expect("images");
            let truths = bench::truths(&scene, &view).expect("truth");
            let judged = (Images { rendered, truths }).judge(&format!("pair {technique} {size:?}"));
            for comparison in judged.unwrap_or_else(|e| panic!("{e}")) {
                checked += comparison.mask.shadowed;
            }
        }
    }
    assert!(checked > 100, "{checked} pixels in shadow");
}
