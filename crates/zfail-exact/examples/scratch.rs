//! scratch
use std::io::Write;
use zfail_exact::{bench, kinds::Kind};
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let kind = Kind::ALL.into_iter().find(|k| format!("{k:?}") == a[1]).unwrap();
    let recipe = kind.recipe(a[2].parse().unwrap(), [256, 160]);
    let truth = bench::truths(&recipe.scene(), &recipe.view).unwrap().swap_remove(a[3].parse().unwrap());
    let mut f = std::fs::File::create(&a[4]).unwrap();
    write!(f, "P6\n256 160\n255\n").unwrap();
    for p in &truth.pixels {
        let d = if a.len() > 5 { p.mask_doubt } else { p.count_doubt };
        let g = if !p.surface {
            0
        } else if p.lit {
            200
        } else {
            (90 - 20 * p.count.min(4)) as u8
        };
        let c = match d {
            None => [g, g, g],
            Some(zfail_oracle::Doubt::Surface) => [255, 0, 0],
            Some(zfail_oracle::Doubt::Boundary) => [0, 255, 0],
            Some(zfail_oracle::Doubt::Depth) => [60, 60, 255],
            _ => [255, 255, 0],
        };
        f.write_all(&c).unwrap();
    }
    if let (Ok(x), Ok(y)) = (std::env::var("X"), std::env::var("Y")) {
        let (x, y, l): (usize, usize, usize) = (x.parse().unwrap(), y.parse().unwrap(), a[3].parse().unwrap());
        let gpu = zfail_render::Gpu::new(&Default::default()).unwrap();
        let im = bench::images(&gpu, &recipe, &Default::default()).unwrap();
        println!("rendered mask {} count {} truth {:?}", im.rendered.shadow[l][y * 256 + x], im.rendered.stencil[l][y * 256 + x], im.truths[l].pixels[y * 256 + x]);
    }
    println!("{:?}\n{:?}", recipe.lights, recipe.view);
    for p in &recipe.parts {
        println!("{:?} {:?}", p.shape, p.pose);
    }
}
