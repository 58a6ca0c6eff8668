//! The sorts of scenes, each aimed at what stencil shadows get wrong.
//!
//! In: a kind and a seed. Out: a recipe: a room or a floor to receive shadows, casters, two lights, a camera.

use crate::{
    random::Random,
    recipe::{CastsFor, Part, Recipe, Surface, look},
    shapes::Shape,
};
use std::f64::consts::PI;
use zfail_plan::glam::{DAffine3, DMat3, DQuat, DVec3};
use zfail_plan::light::LightKind;
use zfail_plan::view::{Projection, View};

/// What a scene is to exercise.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Kind {
    /// Closed meshes.
    Closed,
    /// Open meshes: bowls, sheets, boxes without lid.
    Open,
    /// Triangles at random, edges with any number of them.
    Soup,
    /// Fins, books, solids that share an edge, layers upon layers.
    NonManifold,
    /// Mirrored, sheared and unevenly scaled instances.
    Sheared,
    /// A whole scene of 10^-3 to 10^3 times the size.
    Scaled,
    /// A scene up to 10^6 m from the origin.
    Far,
    /// The eye in shadow, inside solids or between nested ones.
    EyeInside,
    /// Lights in containers, rooms, solids and close to surfaces.
    Enclosed,
    /// Directional lights, also along and across the view axis.
    Sun,
    /// Spot lights with a range.
    Spot,
    /// Orthographic cameras.
    Orthographic,
    /// The near plane cuts casters.
    NearCut,
    /// Integer coordinates, lights exactly on vertices, edges and planes.
    Grid,
    /// Up to 300 layers.
    Stack,
    /// Blended parts, parts that cast for some lights or none.
    Mixed,
    /// Many small separate triangles, half of them turned away from the light.
    Shards,
    /// Triangles whose edges lie on and end on surfaces, most of them turned away from the light.
    Planted,
    /// The near plane of an orthographic view cuts casters.
    OrthographicCut,
    /// One mesh of many parts, near the eye and around it, under a light that ends at a box.
    District,
}

impl Kind {
    /// Every kind.
    pub const ALL: [Self; 20] = [
        Self::Closed,
        Self::Open,
        Self::Soup,
        Self::NonManifold,
        Self::Sheared,
        Self::Scaled,
        Self::Far,
        Self::EyeInside,
        Self::Enclosed,
        Self::Sun,
        Self::Spot,
        Self::Orthographic,
        Self::NearCut,
        Self::Grid,
        Self::Stack,
        Self::Mixed,
        Self::Shards,
        Self::Planted,
        Self::OrthographicCut,
        Self::District,
    ];

    /// The scene of this kind that `seed` makes.
    #[must_use]
    pub fn recipe(self, seed: u64, size: [u32; 2]) -> Recipe {
        let random = &mut Random::new(seed ^ (self as u64) << 32);
        let eye = DVec3::new(random.between(-3.0, 3.0), random.between(1.5, 4.0), random.between(3.5, 5.5));
        let yfov = random.between(0.6, 1.1);
        let near = 10f64.powf(random.between(-2.0, -0.7));
        let view = View::new(
            look(eye, random.in_cube(0.7) + DVec3::Y * 0.8),
            Projection::Perspective { yfov, near, far: None },
            size,
        );
        let lights = vec![point(random), point(random)];
        let mut recipe = Recipe { kind: self, seed, parts: stage(random), lights, half_extents: None, view };
        self.furnish(&mut recipe, random);
        recipe
    }

    fn furnish(self, recipe: &mut Recipe, random: &mut Random) {
        let any = [CLOSED, OPEN].concat();
        match self {
            Self::Closed => scatter(recipe, random, CLOSED),
            Self::Open => scatter(recipe, random, OPEN),
            Self::Soup => {
                let (count, seed) = (random.between(6.0, 40.0) as u32, u64::from(random.below(1 << 20)));
                scatter(recipe, random, &[Shape::Tangle(count, seed), Shape::Soup(count, seed), Shape::Wreck(8)]);
            }
            Self::NonManifold => {
                let pages = 3 + random.below(5);
                scatter(recipe, random, &[Shape::Book(pages), Shape::Finned, Shape::Twins, Shape::Layers(pages)]);
            }
            Self::Sheared => {
                scatter(recipe, random, &any);
                for part in recipe.parts.iter_mut().skip(1) {
                    part.pose.matrix3 *= shear(random);
                }
            }
            Self::Scaled => {
                scatter(recipe, random, &any);
                recipe.transform(10f64.powf(random.between(-3.0, 3.0)), DVec3::ZERO);
            }
            Self::Far => {
                scatter(recipe, random, &any);
                let distance = 10f64.powf(random.between(3.0, 6.0));
                recipe.transform(1.0, random.direction() * distance);
            }
            Self::EyeInside => {
                scatter(recipe, random, &any);
                eye_inside(recipe, random);
            }
            Self::Enclosed => {
                scatter(recipe, random, &any);
                enclose(recipe, random);
            }
            Self::Sun => {
                scatter(recipe, random, &any);
                let axes = recipe.view.world_from_view.matrix3;
                let across = (axes.x_axis * random.between(-1.0, 1.0) - axes.y_axis).normalize();
                let down = (random.in_cube(1.0) - DVec3::Y * 1.2).normalize();
                let all = [-axes.z_axis, axes.z_axis, across, down, DVec3::NEG_Y, down, random.direction()];
                recipe.lights = [random.pick(&all), down].map(|direction| LightKind::Directional { direction }).into();
            }
            Self::Spot => {
                scatter(recipe, random, &any);
                recipe.lights = vec![spot(random), spot(random)];
            }
            Self::Orthographic => {
                scatter(recipe, random, &any);
                let direction = (random.in_cube(1.0) - DVec3::Y).normalize();
                recipe.lights[1] = LightKind::Directional { direction };
                let near = random.pick(&[0.1, 2.0, -3.0]);
                recipe.view.projection = Projection::Orthographic { ymag: random.between(1.5, 3.0), near, far: 30.0 };
            }
            Self::NearCut => {
                scatter(recipe, random, &any);
                let near = random.between(1.5, 5.0);
                recipe.view.projection = Projection::Perspective { yfov: random.between(0.6, 1.1), near, far: None };
                let cut = recipe.view.world_from_view.transform_point3(DVec3::Z * -near + random.in_cube(0.5));
                recipe.parts.push(Part::new(random.pick(&any), place(random, cut, 0.7)).double());
            }
            Self::Grid => grid(recipe, random),
            Self::Stack => {
                let layers = random.pick(&[100, 127, 128, 129, 200, 255, 256, 257, 300]);
                let shape = random.pick(&[Shape::Stack(layers), Shape::Layers(layers), Shape::Layers(layers)]);
                let pose = place_upright(DVec3::new(0.0, 0.8, 0.0), DVec3::splat(0.8));
                recipe.parts.push(Part::new(shape, pose).double());
                let position = DVec3::new(random.between(-0.5, 0.5), 5.0, random.between(-0.5, 0.5));
                recipe.lights[0] = LightKind::Point { position, range: f64::INFINITY };
            }
            Self::Mixed => {
                scatter(recipe, random, &any);
                for part in recipe.parts.iter_mut().skip(1) {
                    part.surface = random.pick(&[Surface::Single, Surface::Double, Surface::Blended]);
                    part.casting = random.pick(&[CastsFor::All, CastsFor::AllButFirst, CastsFor::None]);
                }
            }
            Self::OrthographicCut => {
                scatter(recipe, random, &any);
                let seed = u64::from(random.below(1 << 20));
                scatter(recipe, random, &[Shape::Planted(60, seed), Shape::Lattice(3), Shape::Torus(12)]);
                let ymag = random.between(1.5, 3.0);
                let caster = recipe.parts[1 + random.below(recipe.parts.len() as u32 - 1) as usize].pose.translation;
                let eye = recipe.view.world_from_view;
                let near = eye.matrix3.z_axis.dot(eye.translation - caster) + random.between(-0.4, 0.4);
                recipe.view.projection = Projection::Orthographic { ymag, near, far: near + 30.0 };
                if random.once_in(2) {
                    let direction = (random.in_cube(1.0) - DVec3::Y).normalize();
                    recipe.lights[1] = LightKind::Directional { direction };
                }
                // From below, the floor shadows everything.
                let position = DVec3::new(random.between(-2.0, 2.0), -1.0, random.between(-2.0, 2.0));
                recipe.lights[0] = LightKind::Point { position, range: f64::INFINITY };
            }
            Self::District => district(recipe, random),
            Self::Shards => {
                let seed = |random: &mut Random| u64::from(random.below(1 << 20));
                let count = random.between(40.0, 300.0) as u32;
                let shapes = [Shape::Shards(count, seed(random)), Shape::Shards(count, seed(random))];
                small_parts(recipe, random, shapes);
            }
            Self::Planted => {
                let seed = |random: &mut Random| u64::from(random.below(1 << 20));
                let count = random.between(20.0, 120.0) as u32;
                let shapes = [Shape::Planted(count, seed(random)), Shape::Planted(count, seed(random))];
                small_parts(recipe, random, shapes);
            }
        }
    }
}

const CLOSED: &[Shape] = &[
    Shape::Cube,
    Shape::Sphere(8),
    Shape::Sphere(12),
    Shape::Torus(8),
    Shape::Torus(12),
    Shape::Cage,
    Shape::Lattice(2),
    Shape::Lattice(3),
];

const OPEN: &[Shape] =
    &[Shape::OpenBox, Shape::Bowl(5), Shape::Tube(12), Shape::Sheet(1), Shape::Sheet(3), Shape::Waves(8)];

/// What receives the shadows: the inside of a room, or a floor.
fn stage(random: &mut Random) -> Vec<Part> {
    let floor = |half: f64| place_upright(DVec3::ZERO, DVec3::splat(half));
    vec![match random.below(4) {
        0 => Part::new(Shape::Room, place_upright(DVec3::Y * 6.0, DVec3::new(8.0, 6.0, 8.0))),
        1 => Part::new(Shape::Sheet(7), floor(9.0)),
        2 => Part::new(Shape::Waves(9), floor(9.0)).double(),
        _ => Part::new(Shape::Sheet(1), floor(9.0)).double(),
    }]
}

/// Adds one to five casters.
fn scatter(recipe: &mut Recipe, random: &mut Random, shapes: &[Shape]) {
    for _ in 0..1 + random.below(5) {
        let at = DVec3::new(random.between(-1.8, 1.8), random.between(0.5, 2.2), random.between(-1.8, 1.8));
        let size = random.between(0.3, 0.9);
        let part = Part::new(random.pick(shapes), place(random, at, size));
        recipe.parts.push(if random.once_in(3) { part } else { part.double() });
    }
}

fn place(random: &mut Random, at: DVec3, size: f64) -> DAffine3 {
    DAffine3::from_scale_rotation_translation(DVec3::splat(size), random.rotation(), at)
}

fn place_upright(at: DVec3, size: DVec3) -> DAffine3 {
    DAffine3::from_scale_rotation_translation(size, DQuat::IDENTITY, at)
}

fn shear(random: &mut Random) -> DMat3 {
    let mirror = DVec3::new(random.pick(&[-1.0, 1.0]), random.between(0.3, 1.5), random.between(0.3, 1.5));
    let slant = DMat3::from_cols(DVec3::X, DVec3::new(random.between(-1.0, 1.0), 1.0, 0.0), DVec3::Z);
    DMat3::from_diagonal(mirror) * slant
}

fn point(random: &mut Random) -> LightKind {
    let position = DVec3::new(random.between(-4.0, 4.0), random.between(1.0, 5.5), random.between(-4.0, 4.0));
    let range = if random.once_in(4) { random.between(3.0, 8.0) } else { f64::INFINITY };
    LightKind::Point { position, range }
}

fn spot(random: &mut Random) -> LightKind {
    let position = DVec3::new(random.between(-3.0, 3.0), random.between(2.5, 5.0), random.between(-3.0, 3.0));
    let outer = random.between(0.3, 0.9);
    let direction = (random.in_cube(1.0) + DVec3::Y * 0.5 - position).normalize();
    LightKind::Spot { position, direction, range: random.between(5.0, 20.0), inner: 0.5 * outer, outer }
}

/// Fills the picture with two parts of many small triangles, under lights that mostly come from beyond them. Every second
/// view is orthographic.
fn small_parts(recipe: &mut Recipe, random: &mut Random, shapes: [Shape; 2]) {
    let eye = recipe.view.world_from_view.translation;
    let centre = DVec3::Y * 1.2;
    for shape in shapes {
        let (at, size) = (centre + random.in_cube(0.5), random.between(0.7, 1.3));
        let part = Part::new(shape, place(random, at, size));
        recipe.parts.push(if random.once_in(4) { part } else { part.double() });
    }
    let towards = (centre - eye).normalize();
    let beyond = |random: &mut Random| centre + towards * random.between(0.5, 4.0) + random.in_cube(1.5);
    let direction = (-towards + random.in_cube(0.9)).normalize();
    let range = f64::INFINITY;
    recipe.lights = vec![LightKind::Point { position: beyond(random), range }, LightKind::Directional { direction }];
    if random.once_in(2) {
        // All of it in the shadow of one sheet.
        let LightKind::Point { position, .. } = recipe.lights[0] else { return };
        let pose = DAffine3 { translation: position, ..look(position, centre) };
        let turned = pose * DAffine3::from_translation(DVec3::NEG_Z * 0.05) * DAffine3::from_rotation_x(0.5 * PI);
        recipe.parts.push(Part::new(Shape::Sheet(1), turned * DAffine3::from_scale(DVec3::splat(0.5))));
    }
    recipe.view.world_from_view = look(eye, centre);
    let distance = eye.distance(centre);
    recipe.view.projection = if random.once_in(2) {
        Projection::Orthographic { ymag: random.between(1.0, 1.8), near: 0.1, far: 30.0 }
    } else {
        let yfov = 2.0 * (random.between(1.0, 1.8) / distance).atan();
        Projection::Perspective { yfov, near: 10f64.powf(random.between(-2.0, -0.7)), far: None }
    };
}

/// Puts a mesh of many parts around the eye, so that few of them stand before it, and a box around the first light.
fn district(recipe: &mut Recipe, random: &mut Random) {
    let (count, seed) = (random.between(16.0, 50.0) as u32, u64::from(random.below(1 << 20)));
    let pose = place_upright(DVec3::Y * 1.1, DVec3::new(random.between(2.0, 4.0), 2.0, random.between(2.0, 4.0)));
    let part = Part::new(Shape::District(count, seed), pose);
    recipe.parts.push(if random.once_in(3) { part.double() } else { part });
    // A card on which no shadow falls.
    let at = DVec3::new(random.between(-1.0, 1.0), 0.9, random.between(-1.0, 1.0));
    let label = place(random, at, 0.6);
    recipe.parts.push(Part { receives: false, ..Part::new(Shape::Sheet(2), label).double() });
    let eye = DVec3::new(random.between(-2.5, 2.5), random.between(0.6, 2.4), random.between(-2.5, 2.5));
    recipe.view.world_from_view = look(eye, random.in_cube(1.0) + DVec3::Y * 0.5);
    recipe.half_extents = Some(DVec3::splat(0.4) + random.in_cube(3.0).abs());
    if random.once_in(3) {
        recipe.lights[0] = spot(random);
    }
    if random.once_in(2) {
        let direction = (random.in_cube(1.0) - DVec3::Y).normalize();
        recipe.lights[1] = LightKind::Directional { direction };
    }
}

/// Moves the eye into the shadow of a caster or into nested solids.
fn eye_inside(recipe: &mut Recipe, random: &mut Random) {
    let caster = recipe.parts[1 + random.below(recipe.parts.len() as u32 - 1) as usize].pose.translation;
    let eye = if random.once_in(2) {
        // On the far side of the caster as the light sees it, above the floor.
        let position = caster + DVec3::new(random.between(-1.0, 1.0), 1.2, random.between(-1.0, 1.0)) * 1.5;
        recipe.lights[0] = LightKind::Point { position, range: f64::INFINITY };
        let beyond = caster + (caster - position) * random.between(0.2, 0.5);
        beyond.with_y(beyond.y.max(0.15))
    } else {
        let eye = DVec3::new(0.3, 1.5, 1.0) + random.in_cube(0.4);
        for (size, shape) in [(0.4, Shape::Cube), (0.9, Shape::Cage), (1.3, Shape::Sphere(10))] {
            let at = eye + random.in_cube(0.1);
            recipe.parts.push(Part::new(shape, place(random, at, size)));
        }
        eye
    };
    let target = random.in_cube(1.0) + DVec3::Y * 0.3;
    recipe.view.world_from_view = look(eye, target);
    recipe.view.projection = Projection::Perspective { yfov: 1.1, near: 0.02, far: None };
}

/// Puts the first light into or close to a part.
fn enclose(recipe: &mut Recipe, random: &mut Random) {
    let shapes = [
        Shape::OpenBox,
        Shape::Bowl(5),
        Shape::Room,
        Shape::Cube,
        Shape::Sphere(8),
        Shape::Cage,
        Shape::Torus(9),
        Shape::Lattice(2),
        Shape::Tube(10),
    ];
    let at = DVec3::new(random.between(-1.0, 1.0), random.between(1.0, 2.0), random.between(-1.0, 1.0));
    let size = random.between(0.5, 1.1);
    let pose = place(random, at, size);
    recipe.parts.push(Part::new(random.pick(&shapes), pose).double());
    // From the middle to just outside the hull.
    let local = random.direction() * random.pick(&[0.0, 0.2, 0.5, 0.9, 1.05]);
    let range = f64::INFINITY;
    recipe.lights[0] = LightKind::Point { position: pose.transform_point3(local), range };
}

/// Cubes with integer corners and a light on one of their vertices, edges or faces, or in one of their planes.
fn grid(recipe: &mut Recipe, random: &mut Random) {
    recipe.parts = vec![Part::new(Shape::Sheet(1), place_upright(DVec3::ZERO, DVec3::splat(9.0))).double()];
    let whole = |random: &mut Random, lo: i32, hi: i32| f64::from(lo + random.below((hi - lo + 1) as u32) as i32);
    let shapes = [Shape::Cube, Shape::Cube, Shape::OpenBox, Shape::Twins, Shape::Sheet(2), Shape::Layers(2)];
    let mut centers = Vec::new();
    for _ in 0..2 + random.below(3) {
        let at = DVec3::new(whole(random, -2, 2), whole(random, 1, 3), whole(random, -2, 2));
        centers.push(at);
        recipe.parts.push(Part::new(random.pick(&shapes), place_upright(at, DVec3::ONE)).double());
    }
    for light in &mut recipe.lights {
        let center = random.pick(&centers);
        let side = |random: &mut Random| random.pick(&[-1.0, 0.0, 1.0, 2.0, 0.5]);
        let position = center + DVec3::new(side(random), random.pick(&[1.0, 2.0, 0.0, 0.5]), side(random));
        *light = LightKind::Point { position, range: f64::INFINITY };
    }
    if random.once_in(3) {
        let direction = random.pick(&[DVec3::NEG_Y, DVec3::new(-0.6, -0.8, 0.0), DVec3::new(0.0, -0.8, 0.6)]);
        recipe.lights[1] = LightKind::Directional { direction };
    }
}
