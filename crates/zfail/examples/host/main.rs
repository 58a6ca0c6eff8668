//! A renderer that is not zfail's: a forward renderer of its own, four samples, one colour target, that takes its shadows from
//! the crate `zfail` in a few calls (search for "Shadows, part"). It registers its meshes once, and then draws frames in which
//! camera, casters and a light move.
//!
//! `cargo run -p zfail --example host` writes `host-0.png` to `host-3.png`.

mod forward;
mod scene;

use forward::Host;

/// Why there is no image.
type Error = Box<dyn std::error::Error>;

const SIZE: [u32; 2] = [960, 540];

fn main() -> Result<(), Error> {
    let mut host = Host::new(&scene::scene(0.0), SIZE)?;
    for second in 0..4_u8 {
        let time = f64::from(second);
        let pixels = host.render(&scene::scene(time), &scene::view(time, SIZE), true)?;
        let path = format!("host-{second}.png");
        image::save_buffer(&path, &pixels, SIZE[0], SIZE[1], image::ColorType::Rgba8)?;
        println!("wrote {path}");
    }
    Ok(())
}
