//! Figures that the guide states, counted. `-- --nocapture` prints them.

use crate::shapes;
use glam::{DVec3, Vec4};
use zfail_plan::casting::{self, Casting};
use zfail_plan::topology::Topology;
use zfail_plan::volume;

/// A chapter of the guide, its lines joined.
fn joined(chapter: &str) -> String {
    chapter.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Chapter 5: a depth of `z / w` with `z = w`, on hardware that multiplies by the reciprocal. All w of one binade: the
/// others differ by powers of two, which round nothing.
#[test]
fn the_reciprocal_of_w_does_not_always_give_one() {
    let wrong =
        |one: f32| (0..1_u32 << 23).map(|m| one + m as f32 * f32::EPSILON).filter(|w| w * (1.0 / w) != 1.0).count();
    let percent = 100.0 * wrong(1.0) as f64 / f64::from(1_u32 << 23);
    println!("z * (1/w) is not 1 for {percent:.1} % of all w = z");
    let stated = format!("`z * (1/w)` is not 1 for {percent:.1} % of all `w` in single precision");
    let chapter = joined(include_str!("../../../../docs/guide/05-to-infinity.md"));
    assert!(chapter.contains(&stated), "the guide has to say: {stated}");
    assert!(
        (-60_i8..=60).map(f32::from).all(|e: f32| e.exp2() * (1.0 / e.exp2()) == 1.0),
        "powers of two round nothing"
    );
}

/// Unit vectors all over the sphere.
fn directions(count: u32) -> impl Iterator<Item = DVec3> {
    (0..count).map(move |i| {
        let (turn, height) = (f64::from(i) * 2.399_963, (2.0 * f64::from(i) + 1.0) / f64::from(count) - 1.0);
        let radius = (1.0 - height * height).sqrt();
        DVec3::new(radius * turn.cos(), radius * turn.sin(), height)
    })
}

/// How many spheres a fan covers more than the extruded triangles, for casters that cast from their fronts.
fn spheres(topology: &Topology, light: DVec3) -> i32 {
    let mut c = Vec::new();
    let at = light.as_vec3();
    casting::weights(topology, &vec![Casting::Front; topology.parts().len()], at.extend(1.0), &mut c);
    let [mut cap, mut fan] = [Vec::new(), Vec::new()];
    volume::dark_cap(topology, &c, &mut cap);
    volume::sides(topology, &c, false, &mut fan);
    let sides = fan.len();
    volume::dark_fan(0..sides, &mut fan);
    let covered = |triangles: &[u32], along: DVec3| {
        let hit = |t: &[u32]| {
            let d = [t[0], t[1], t[2]].map(|i| topology.position(i >> 1) - at.as_dvec3());
            let det = d[0].dot(d[1].cross(d[2]));
            let a = [d[1].cross(d[2]), d[2].cross(d[0]), d[0].cross(d[1])].map(|n| n.dot(along) / det);
            // Counter-clockwise from outside is clockwise from the light.
            if a.iter().all(|&x| x > 0.0) { det.signum() as i32 } else { 0 }
        };
        triangles.chunks(3).map(hit).sum::<i32>()
    };
    let mut difference = None;
    for along in directions(40) {
        let here = covered(&fan[sides..], along) - covered(&cap, along);
        assert_eq!(*difference.get_or_insert(here), here, "the same in every direction: {light} {along}");
    }
    difference.unwrap_or(0)
}

/// Chapter 7: the fan of McGuire et al. differs by whole spheres, and only where the light is among the caster's triangles.
#[test]
fn fans_are_off_by_spheres_where_the_light_is_in_the_hull() {
    let (positions, triangles) = shapes::torus(32, 16, 0.4);
    let topology = Topology::new(&positions, &triangles, |_| true).unwrap();
    let corners: Vec<DVec3> =
        positions.iter().map(|p| Vec4::new(p[0], p[1], p[2], 0.0).as_dvec4().truncate()).collect();
    let largest = corners.iter().fold(DVec3::ZERO, |most, p| most.max(p.abs()));
    let (mut inside, mut wrong, mut all) = (0, 0, 0);
    let steps = |axis: f64| (-4..=4).map(move |i| (f64::from(i) + 0.07) / 4.0 * 1.5 * axis);
    for x in steps(largest.x) {
        for y in steps(largest.y) {
            for z in steps(largest.z) {
                let light = DVec3::new(x, y, z);
                // Beyond a plane that has all of the torus on its other side.
                let outside = directions(2000).any(|n| corners.iter().all(|p| n.dot(*p - light) < 0.0));
                let off = spheres(&topology, light) != 0;
                assert!(!(off && outside), "the fan is wrong outside of the hull: {light}");
                all += 1;
                inside += usize::from(!outside);
                wrong += usize::from(off);
            }
        }
    }
    println!("{all} lights, {inside} in the hull, {wrong} with a wrong fan");
    let stated = format!("of {all} lights on a grid about a torus, {inside} are in its hull, and {wrong} of these");
    let chapter = joined(include_str!("../../../../docs/guide/07-doing-less.md"));
    assert!(chapter.contains(&stated), "the guide has to say: {stated}");
    assert!(0 < wrong && wrong < inside && inside < all, "the test sees all kinds");
}
