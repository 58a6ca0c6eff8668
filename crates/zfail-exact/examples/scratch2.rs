//! scratch
use zfail_exact::{bench, kinds::Kind};
use zfail_plan::{casting, glam::*, scene::*, topology::*, view::*};
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let kind = Kind::ALL.into_iter().find(|k| format!("{k:?}") == a[1]).unwrap();
    let recipe = kind.recipe(a[2].parse().unwrap(), [256, 160]);
    let (l, x, y): (usize, f64, f64) = (a[3].parse().unwrap(), a[4].parse().unwrap(), a[5].parse().unwrap());
    let scene = recipe.scene();
    let view = recipe.view;
    let light = scene.lights[l].kind.homogeneous();
    let Projection::Perspective { yfov, near, .. } = view.projection else { panic!() };
    let px = 2.0 * (0.5 * yfov).tan() / 160.0;
    let m = view.world_from_view.matrix3;
    let eye = view.eye();
    let d = -m.z_axis + m.x_axis * px * (x + 0.5 - 128.0) - m.y_axis * px * (y + 0.5 - 80.0);
    let _ = bench::truths;
    // surface
    let mut best = (f64::INFINITY, 0, 0);
    for (i, inst) in scene.instances.iter().enumerate() {
        let mesh = &scene.meshes[inst.mesh];
        for t in 0..mesh.triangles.len() {
            let v = world_triangle(mesh, &inst.world_from_object, t);
            let n = (v[1] - v[0]).cross(v[2] - v[0]);
            let depth = n.dot(v[0] - eye) / n.dot(d);
            let p = eye + d * depth;
            let inside = (0..3).all(|k| (v[(k + 1) % 3] - v[k]).cross(p - v[k]).dot(n) >= 0.0);
            let front = n.dot(d) < 0.0 || recipe.parts[i].surface != zfail_exact::recipe::Surface::Single;
            if inside && depth > near && depth < best.0 && front {
                best = (depth, i, t);
            }
        }
    }
    println!("surface {best:?} near {near} unit error d2/n 2^-24 = {:e}", best.0 * best.0 / near / 16777216.0);
    for (i, inst) in scene.instances.iter().enumerate() {
        let mesh = &scene.meshes[inst.mesh];
        let top = Topology::new(&mesh.positions, &mesh.triangles, |_| true).unwrap();
        let mi = inst.world_from_object.inverse();
        let ol = if light.w == 0.0 {
            mi.transform_vector3(light.truncate()).normalize().extend(0.0)
        } else {
            mi.transform_point3(light.truncate()).extend(1.0)
        };
        let mut c = vec![];
        casting::castings(&top, ol.as_vec4(), &mut c);
        let mut w = vec![];
        casting::weights(&top, &c, ol.as_vec4(), &mut w);
        let mut b = vec![];
        top.boundary(&w, |e, m| b.push((e, m)));
        for (e, mult) in b {
            let p = e.map(|v| inst.world_from_object.transform_point3(top.position(v)));
            let ext = p.map(|q| q * light.w - light.truncate());
            let n = (p[1] - p[0]).cross(ext[0]);
            let depth = n.dot(p[0] - eye) / n.dot(d);
            // px distance of the extruded lines and the edge from the pixel centre
            let dist = |q: DVec3, dir: DVec3| {
                let k = (q - eye).cross(dir);
                k.dot(d) / px / k.dot(m.x_axis).hypot(k.dot(m.y_axis))
            };
            let s = [dist(p[0], ext[0]), dist(p[1], ext[1]), dist(p[0], p[1] - p[0])];
            let q = eye + d * depth;
            // inside quad: between extruded lines and beyond edge
            let nn = n;
            let s0 = ext[0].cross(q - p[0]).dot(nn);
            let s1 = ext[1].cross(q - p[1]).dot(nn);
            let s2 = (p[1] - p[0]).cross(q - p[0]).dot(nn);
            let inside = depth > 0.0 && s0 * s1 <= 0.0 && s2 * (p[1] - p[0]).cross(ext[0]).dot(nn) >= 0.0;
            let near_line = s.iter().any(|x| x.abs() < 0.05);
            if inside && (depth - best.0).abs() < 0.05 * best.0 || near_line {
                println!(
                    "inst {i} edge {e:?} m {mult} depth {depth} (diff {:e}) inside {inside} px {s:?}",
                    depth - best.0
                );
            }
        }
    }
}
