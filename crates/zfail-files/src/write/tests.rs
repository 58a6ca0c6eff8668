//! What is written and loaded again is the same scene.

use super::{WriteError, to_glb};
use glam::{DAffine3, DMat3, DVec3};
use zfail_builtin::shapes::{cuboid, merged, painted, tinted, uv_sphere};
use zfail_plan::light::LightKind;
use zfail_plan::view::Projection;
use zfail_scene::{
    AlphaMode, Camera, Clearcoat, Filter, Image, Instance, Light, LightShape, MaskCasting, Material, Mesh, Scene,
    Sheen, Specular, SpecularGlossiness, Texture, TextureRef, Transmission, Wrap,
};

fn reloaded(scene: &Scene) -> Scene {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("scene.glb");
    std::fs::write(&file, to_glb(scene).unwrap()).unwrap();
    crate::load(&file).unwrap()
}

/// Every kind of everything.
fn sampler() -> Scene {
    let texture = |image, filter, mipmaps| Texture {
        image,
        wrap_u: Wrap::Mirror,
        wrap_v: Wrap::Clamp,
        mag: filter,
        min: filter,
        mipmaps,
    };
    let image = |alpha: u8| Image {
        name: format!("image {alpha}"),
        width: 3,
        height: 2,
        rgba: (0..24).map(|i| if i % 4 == 3 { alpha } else { 9 * i }).collect(),
    };
    let scaled = TextureRef { uv_from_mesh: [[0.3, 0.0, 0.7], [0.0, -2.0, 0.1]], ..TextureRef::new(0) };
    let turned = TextureRef { uv_from_mesh: [[0.0, 3.0, 0.5], [-2.0, 0.0, 0.0]], uv_set: 1, ..TextureRef::new(1) };
    let materials = vec![
        Material {
            name: "everything".into(),
            base_color: [0.1, 0.2, 0.3, 0.4],
            base_color_texture: Some(scaled),
            metallic: 0.3,
            roughness: 0.7,
            metallic_roughness_texture: Some(TextureRef::new(0)),
            normal_texture: Some(turned),
            normal_scale: 0.6,
            occlusion_texture: Some(TextureRef::new(1)),
            occlusion_strength: 0.35,
            emissive: [5.3, 0.1, 0.0],
            emissive_texture: Some(TextureRef::new(0)),
            alpha: AlphaMode::Mask(0.3),
            double_sided: true,
            specular: Specular { ior: 1.75, strength: 0.5, color: [0.25, 2.0, 0.0], color_texture: Some(scaled) },
            clearcoat: Some(Clearcoat { strength: 0.75, texture: Some(scaled), roughness: 0.125 }),
            sheen: Some(Sheen { color: [0.5, 0.0, 0.25], texture: Some(scaled), roughness: 0.375 }),
            transmission: Some(Transmission { share: 0.625, texture: None, tint: [1.0, 0.5, 0.25] }),
            ..Material::default()
        },
        Material {
            name: "glossy".into(),
            specular_glossiness: Some(SpecularGlossiness {
                color: [0.5, 0.25, 1.0],
                glossiness: 0.75,
                texture: Some(scaled),
            }),
            ..Material::default()
        },
        Material { name: "glass".into(), alpha: AlphaMode::Blend, unlit: true, ..Material::default() },
    ];

    let ball = tinted(uv_sphere(0.3, 9, 5), [0.2, 0.7, 0.9]);
    let mut both = merged("both", [painted(cuboid(DVec3::NEG_ONE, DVec3::ONE), 0), painted(ball, 1)]);
    both.uv1 = both.uv0.iter().map(|[u, v]| [v * 0.5, u + 1.0]).collect();
    both.tangents = both.normals.iter().map(|[x, y, z]| [*y, *z, *x, -1.0]).collect();
    let shear = DMat3::from_cols(DVec3::X, DVec3::new(0.4, 1.0, 0.0), DVec3::Z);
    let place = |name: &str, mesh, matrix3: DMat3, casts_shadow| {
        let translation = DVec3::new(1e6 + 1.0 / 3.0, 0.1, -7.0);
        let world_from_object = DAffine3 { matrix3, translation };
        Instance {
            name: name.into(),
            mesh,
            world_from_object,
            casts_shadow,
            receives_shadow: name.len().is_multiple_of(2),
        }
    };
    let light = |name: &str, kind, excluded| Light {
        name: name.into(),
        kind,
        color: [1.0, 0.3, 0.7],
        intensity: 12.3,
        excluded,
        shape: LightShape::default(),
    };
    let direction = DVec3::new(0.3, -0.5, 0.1).normalize();
    let position = DVec3::new(1e6, 2.0, 1.0 / 7.0);
    let camera = |name: &str, projection| Camera {
        name: name.into(),
        world_from_view: DAffine3 { matrix3: DMat3::from_rotation_y(0.4), translation: position },
        projection,
    };
    let falloff = LightShape { falloff: vec![1.0, 0.3, 0.0], ..LightShape::default() };
    let projected = LightShape {
        cookie: Some(1),
        half_extents: Some(DVec3::new(1.0, 2.5, 1.0 / 3.0)),
        axes: DMat3::from_rotation_x(0.7),
        ..LightShape::default()
    };
    let shaped = |light: Light, shape| Light { shape, ..light };
    Scene {
        name: "scene".into(),
        blended_casts: false,
        meshes: vec![
            both,
            painted(cuboid(DVec3::ZERO, DVec3::ONE), 1),
            Mesh { name: "plain".into(), ..cuboid(DVec3::ZERO, DVec3::X + 0.1) },
        ],
        materials,
        textures: vec![texture(1, Filter::Nearest, true), texture(0, Filter::Linear, false)],
        images: vec![image(255), image(100)],
        instances: vec![
            place("twin", 0, DMat3::IDENTITY, true),
            place("twin", 1, DMat3::from_rotation_x(0.3) * DMat3::from_diagonal(DVec3::new(-1.0, 2.0, 0.5)), false),
            place("sheared", 2, shear, true),
        ],
        lights: vec![
            light("point", LightKind::Point { position, range: 9.5 }, vec![1, 2]),
            light(
                "spot",
                LightKind::Spot { position, direction, range: f64::INFINITY, inner: 0.2, outer: 0.7 },
                vec![],
            ),
            shaped(light("curved", LightKind::Point { position, range: 9.5 }, vec![2]), falloff),
            shaped(
                light(
                    "projector",
                    LightKind::Spot { position, direction, range: f64::INFINITY, inner: 0.2, outer: 0.7 },
                    vec![],
                ),
                projected,
            ),
            light("sun", LightKind::Directional { direction }, vec![]),
        ],
        cameras: vec![
            camera("lens", Projection::Perspective { yfov: 0.9, near: 0.07, far: None }),
            camera("map", Projection::Orthographic { ymag: 3.3, near: 0.0, far: 50.0 }),
        ],
        mask_casting: MaskCasting::default(),
        ambient: [0.1, 0.2, 0.3],
        background: [0.3, 0.2, 0.1],
        sky: None,
        ground: None,
        exposure: None,
        notices: vec![],
    }
}

/// Per triangle, all that its corners carry, bit for bit, and its material. `origin` is added to the positions.
fn corners(mesh: &Mesh, origin: DVec3) -> Vec<(Vec<u64>, Option<usize>)> {
    let bits = |v: u32| {
        let position = (mesh.position(v) + origin).to_array().map(f64::to_bits);
        let v = v as usize;
        let others = [&mesh.normals[v][..], &mesh.tangents[v], &mesh.uv0[v], &mesh.uv1[v], &mesh.colors[v]];
        position.into_iter().chain(others.into_iter().flatten().map(|x| x.to_bits().into())).collect::<Vec<_>>()
    };
    let triangle =
        |(t, triangle): (usize, &[u32; 3])| (triangle.iter().flat_map(|&v| bits(v)).collect(), mesh.material_of(t));
    mesh.triangles.iter().enumerate().map(triangle).collect()
}

/// The material with its texture transforms to six digits: an angle between does not keep them exact.
fn rounded(material: &Material) -> Material {
    let texture = |texture: Option<TextureRef>| {
        let round = |x: f32| (x * 1e6).round() / 1e6 + 0.0;
        texture.map(|t| TextureRef { uv_from_mesh: t.uv_from_mesh.map(|row| row.map(round)), ..t })
    };
    Material {
        base_color_texture: texture(material.base_color_texture),
        metallic_roughness_texture: texture(material.metallic_roughness_texture),
        normal_texture: texture(material.normal_texture),
        occlusion_texture: texture(material.occlusion_texture),
        emissive_texture: texture(material.emissive_texture),
        ..material.clone()
    }
}

/// Panics where `after` differs from `before`; `rounding` is what transforms and directions may differ by.
fn assert_same(before: &Scene, after: &Scene, rounding: f64) {
    assert_eq!((before.ambient, before.background), (after.ambient, after.background));
    // Some built-in meshes are inside out on purpose.
    let told = |notice: &String| notice.contains("normals disagree");
    assert!(after.notices.iter().all(told), "{:?}", after.notices);
    assert_eq!(after.meshes.len(), before.meshes.len());
    assert_eq!(after.instances.len(), before.instances.len());
    // Meshes come back in the order of their first use, each used by the same instances.
    let mut counterparts = std::collections::BTreeMap::new();
    for (a, b) in after.instances.iter().zip(&before.instances) {
        let (a_mesh, b_mesh) = (&after.meshes[a.mesh], &before.meshes[b.mesh]);
        let name = &b_mesh.name;
        assert_eq!(*counterparts.entry(a.mesh).or_insert(b.mesh), b.mesh, "mesh {name}");
        assert_eq!(a_mesh.name, *name);
        // The loader moves a mesh that is far from its origin, exactly.
        let origin = b_mesh.position(b_mesh.triangles[0][0]) - a_mesh.position(a_mesh.triangles[0][0]);
        assert!(corners(a_mesh, origin) == corners(b_mesh, DVec3::ZERO), "triangles of {name}");
        let world_from_mesh = b.world_from_object * DAffine3::from_translation(origin);
        assert!(a.world_from_object.abs_diff_eq(world_from_mesh, rounding), "{}", b.name);
        assert!(a.name.starts_with(&b.name), "{} instead of {}", a.name, b.name);
        assert_eq!((a.casts_shadow, a.receives_shadow), (b.casts_shadow, b.receives_shadow), "{}", b.name);
    }
    let materials = |scene: &Scene| format!("{:?}", scene.materials.iter().map(rounded).collect::<Vec<_>>());
    assert_eq!(materials(after), materials(before));
    assert_eq!(after.textures, before.textures);
    assert_eq!(format!("{:?}", after.images), format!("{:?}", before.images));
    assert_eq!(after.lights.len(), before.lights.len());
    for (a, b) in after.lights.iter().zip(&before.lights) {
        assert_eq!((&a.name, a.color, a.intensity, &a.excluded), (&b.name, b.color, b.intensity, &b.excluded));
        let parts = |shape: &LightShape| (shape.falloff.clone(), shape.cookie, shape.half_extents);
        assert_eq!(parts(&a.shape), parts(&b.shape), "{}", a.name);
        if !b.shape.is_plain() {
            assert!(a.axes().abs_diff_eq(b.axes(), rounding), "{}: {} instead of {}", a.name, a.axes(), b.axes());
        }
        let difference = (a.kind.homogeneous() - b.kind.homogeneous()).abs().max_element();
        assert!(difference <= rounding, "{:?} instead of {:?}", a.kind, b.kind);
        match (a.kind, b.kind) {
            (LightKind::Point { range: a, .. }, LightKind::Point { range: b, .. }) => assert_eq!(a, b),
            (
                LightKind::Spot { direction: d, range: r, inner: i, outer: o, .. },
                LightKind::Spot { direction, range, inner, outer, .. },
            ) => {
                assert!(d.abs_diff_eq(direction, rounding));
                assert_eq!([r, i, o], [range, inner, outer]);
            }
            (LightKind::Directional { .. }, LightKind::Directional { .. }) => {}
            (a, b) => panic!("{a:?} instead of {b:?}"),
        }
    }
    assert_eq!(after.cameras.len(), before.cameras.len());
    for (a, b) in after.cameras.iter().zip(&before.cameras) {
        assert_eq!((&a.name, a.projection), (&b.name, b.projection));
        assert!(a.world_from_view.abs_diff_eq(b.world_from_view, rounding));
    }
}

#[test]
fn everything_comes_back() {
    let scene = sampler();
    assert_same(&scene, &reloaded(&scene), 1e-15);
}

#[test]
fn built_in_scenes_come_back() {
    for entry in zfail_builtin::SCENES {
        let scene = zfail_builtin::scene(entry.name).unwrap();
        assert_same(&scene, &reloaded(&scene), 1e-12);
    }
}

#[test]
#[should_panic(expected = "triangles of both")]
fn comparison_sees_a_single_bit() {
    let scene = sampler();
    let mut changed = reloaded(&scene);
    let x = &mut changed.meshes[0].positions[5][1];
    *x = x.next_up();
    assert_same(&scene, &changed, 1e-15);
}

#[test]
#[should_panic(expected = "projector")]
fn comparison_sees_a_light_turned() {
    let scene = sampler();
    let mut changed = reloaded(&scene);
    let axes = &mut changed.lights[3].shape.axes;
    *axes *= DMat3::from_rotation_z(1e-9);
    assert_same(&scene, &changed, 1e-15);
}

#[test]
fn exclusion_stays_with_its_instance_among_namesakes() {
    let after = reloaded(&sampler());
    assert_eq!(after.lights[0].excluded, [1, 2]);
    assert_eq!((after.instances[0].name.as_str(), after.instances[1].name.as_str()), ("twin", "twin #1"));
}

#[test]
fn a_near_plane_behind_the_eye_stays_where_it_is() {
    let mut scene = sampler();
    scene.cameras[1].projection = Projection::Orthographic { ymag: 1.0, near: -4.0, far: 6.0 };
    let before = &scene.cameras[1];
    let after = &reloaded(&scene).cameras[1];
    assert_eq!(after.projection, Projection::Orthographic { ymag: 1.0, near: 0.0, far: 10.0 });
    let near = |camera: &Camera, near: f64| camera.world_from_view.transform_point3(DVec3::NEG_Z * near);
    assert!(near(after, 0.0).abs_diff_eq(near(before, -4.0), 1e-9));
}

#[test]
fn the_container_is_well_formed() {
    let glb = to_glb(&sampler()).unwrap();
    let word = |at: usize| u32::from_le_bytes(glb[at..at + 4].try_into().unwrap()) as usize;
    assert_eq!((&glb[..4], word(4), word(8)), (&b"glTF"[..], 2, glb.len()));
    let json_length = word(12);
    assert_eq!((json_length % 4, &glb[16..20]), (0, &b"JSON"[..]));
    let json: serde_json::Value = serde_json::from_slice(&glb[20..20 + json_length]).unwrap();
    assert_eq!(word(20 + json_length), glb.len() - 28 - json_length);
    assert_eq!(json["scenes"][0]["extras"]["ambient"][2].as_f64(), Some(f64::from(0.3_f32)));
    let position = json["meshes"][0]["primitives"][0]["attributes"]["POSITION"].as_u64().unwrap() as usize;
    assert_eq!(json["accessors"][position]["min"], serde_json::json!([-1.0, -1.0, -1.0]));
    assert_eq!(json["accessors"][position]["max"], serde_json::json!([1.0, 1.0, 1.0]));
}

#[test]
fn an_empty_scene_is_a_file() {
    let glb = to_glb(&Scene::default()).unwrap();
    assert!(glb.len() < 300);
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("empty.glb");
    std::fs::write(&file, glb).unwrap();
    assert!(crate::load(&file).unwrap().instances.is_empty());
}

#[test]
fn broken_scenes_are_named_and_not_written() {
    let broken = |damage: fn(&mut Scene)| {
        let mut scene = sampler();
        damage(&mut scene);
        match to_glb(&scene) {
            Err(WriteError::Invalid { element, .. }) => element,
            other => panic!("{:?}", other.map(|bytes| bytes.len())),
        }
    };
    assert!(zfail_scene::check(&sampler()).is_ok());
    assert_eq!(broken(|s| s.meshes[1].triangles[3][2] = 99), "meshes[1].triangles[3]");
    assert_eq!(broken(|s| s.meshes[1].uv0.truncate(5)), "meshes[1]");
    assert_eq!(broken(|s| s.meshes[0].primitives[1].triangles.start = 5), "meshes[0].primitives[1]");
    assert_eq!(broken(|s| s.meshes[0].primitives[1].material = Some(7)), "meshes[0].primitives[1]");
    assert_eq!(broken(|s| s.meshes[0].primitives.truncate(1)), "meshes[0]");
    assert_eq!(broken(|s| s.meshes[0].positions[0][0] = f32::NAN), "meshes[0]");
    assert_eq!(broken(|s| s.materials[0].emissive[0] = f32::INFINITY), "materials[0]");
    assert_eq!(broken(|s| s.materials[0].normal_texture = Some(TextureRef::new(2))), "materials[0]");
    assert_eq!(broken(|s| s.textures[1].image = 2), "textures[1]");
    assert_eq!(broken(|s| s.images[0].rgba.truncate(23)), "images[0]");
    assert_eq!(broken(|s| s.instances[2].mesh = 3), "instances[2]");
    assert_eq!(broken(|s| s.instances[2].world_from_object.matrix3.x_axis = DVec3::ZERO), "instances[2]");
    assert_eq!(broken(|s| s.lights[0].excluded[0] = 3), "lights[0]");
    assert_eq!(broken(|s| s.lights[2].shape.falloff.truncate(1)), "lights[2].falloff");
    assert_eq!(broken(|s| s.lights[3].shape.cookie = Some(2)), "lights[3].cookie");
    assert_eq!(broken(|s| s.lights[3].shape.half_extents = Some(DVec3::X)), "lights[3].box");
    assert_eq!(broken(|s| s.lights[3].shape.axes.x_axis.x = f64::NAN), "lights[3]");
    assert_eq!(
        broken(|s| s.cameras[1].projection = Projection::Orthographic { ymag: 1.0, near: 2.0, far: 1.0 }),
        "cameras[1]"
    );
    let skewed = |s: &mut Scene| {
        s.materials[0].emissive_texture =
            Some(TextureRef { uv_from_mesh: [[1.0, 0.5, 0.0], [0.0, 1.0, 0.0]], ..TextureRef::new(0) });
    };
    assert_eq!(broken(skewed), "materials[0].emissiveTexture");
}
