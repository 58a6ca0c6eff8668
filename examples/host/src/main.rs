//! Writes the example's image: `cargo run -p zfail-example-host -- host.png`.

use zfail_example_host::{Error, Host, scene};

fn main() -> Result<(), Error> {
    let path = std::env::args().nth(1).unwrap_or_else(|| "host.png".into());
    let [width, height] = [960, 540];
    let pixels = Host::new()?.render(&scene::scene(), &scene::view([width, height]), true)?;
    image::save_buffer(&path, &pixels, width, height, image::ColorType::Rgba8)?;
    println!("wrote {path}");
    Ok(())
}
