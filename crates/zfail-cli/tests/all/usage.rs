//! Wrong command lines and impossible wishes: one line, the right exit code, nothing touched, no GPU needed.

use crate::support::{command, files, small_scene, zfail};
use std::fs;
use std::io::Write;

#[test]
fn wrong_usage_is_one_line_and_exit_code_2() {
    let folder = tempfile::tempdir().unwrap();
    let cases: &[(&[&str], &[&str])] = &[
        (&[], &["render", "info", "gallery"]),
        (&["rendr", "x"], &["unknown command 'rendr'", "did you mean 'render'", "info", "gallery"]),
        (&["render"], &["SCENE", "--output"]),
        (&["render", "small.gltf"], &["--output"]),
        (&["render", "small.gltf", "-o"], &["--output"]),
        (&["render", "small.gltf", "-o", "a.jpg"], &["a.jpg", ".png", ".exr"]),
        (&["render", "small.gltf", "-o", "a"], &[".png", ".exr"]),
        (&["render", "small.gltf", "-o", "a.png/"], &[".png", ".exr"]),
        (&["render", "small.gltf", "-o", "a.png", "-o", "b.png"], &["--output"]),
        (&["render", "small.gltf", "-o", "a.png", "--sizee", "1x1"], &["--sizee", "--size"]),
        (&["render", "small.gltf", "-o", "a.png", "--size", "0x10"], &["0x10", "from 1 to"]),
        (&["render", "small.gltf", "-o", "a.png", "--size", "0"], &["WIDTHxHEIGHT"]),
        (&["render", "small.gltf", "-o", "a.png", "--size", "100000x100000"], &["16384"]),
        (&["render", "small.gltf", "-o", "a.png", "--samples", "2"], &["1 or 4"]),
        (&["render", "small.gltf", "-o", "a.png", "--technique", "everit-kilgard"], &["auto", "everitt-kilgard"]),
        (&["render", "small.gltf", "-o", "a.png", "--exposure", "bright"], &["auto", "stops"]),
        (&["render", "small.gltf", "-o", "a.png", "--alpha-shadows", "on"], &["off, solid or cut=PIXELS"]),
        (&["render", "small.gltf", "-o", "a.png", "--alpha-shadows", "cut=0"], &["number from 0.02", "cut=1"]),
        (&["render", "small.gltf", "-o", "a.png", "--backend", "vulkn"], &["vulkan", "gl"]),
        (&["render", "small.gltf", "-o", "a.png", "--light", "sun"], &["number of a light"]),
        (&["render", "small.gltf", "-o", "a.png", "--light", "3"], &["'3'", "0 'sun'", "1 'lamp'", "2 'torch'"]),
        (&["render", "small.gltf", "-o", "a.png", "--camera", "abov"], &["did you mean 'above'", "1 'aside'"]),
        (&["render", "small.gltf", "-o", "a.png", "--camera", "2"], &["'2'", "0 'above'", "1 'aside'"]),
        (&["render", "small.gltf", "-o", "a.png", "--time", "-1"], &["--time"]),
        (&["render", "small.gltf", "-o", "a.png", "--time", "soon"], &["number of seconds"]),
        (&["render", "small.gltf", "-o", "a.png", "--animation", "glid"], &["did you mean 'glide'", "0 'glide'"]),
        (&["render", "small.gltf", "-o", "a.png", "--time", "1", "--animation", "2"], &["'2'", "1 'sunset'"]),
        (&["render", "builtin:open", "-o", "a.png", "--animation", "0"], &["animation '0'", "there are: none"]),
        (&["render", "small.gltf", "-o", "a.png", "--aov", "shadow"], &["KIND=PATH"]),
        (&["render", "small.gltf", "-o", "a.png", "--aov", "dept=d.exr"], &["did you mean 'depth'", "albedo"]),
        (&["render", "small.gltf", "-o", "a.png", "--aov", "depth=d.png"], &["depth", ".exr"]),
        (&["render", "small.gltf", "-o", "a.exr", "--aov", "depth=./a.exr"], &["a.exr", "two results"]),
        (&["render", "small.gltf", "-o", "a.png", "--aov", "shadow=m", "--aov", "stencil=m"], &["'m'", "two results"]),
        (&["render", "builtin:nowhere", "-o", "a.png"], &["built-in scene 'nowhere'", "there are: "]),
        (&["render", "small.gltf", "-o", "a-%d.png"], &["a-%d.png", "--frames A..B"]),
        (&["render", "small.gltf", "-o", "a.png", "--frames", "0..3"], &["'a.png'", "%04d"]),
        (&["render", "small.gltf", "-o", "%d.png", "--frames", "0..3", "--stats", "s.json"], &["'s.json'", "%04d"]),
        (&["render", "small.gltf", "-o", "%x.png", "--frames", "0..3"], &["after %"]),
        (&["render", "small.gltf", "-o", "%d.png", "--frames", "3..3"], &["no frame"]),
        (&["render", "small.gltf", "-o", "%d.png", "--frames", "-1..3"], &["A..B"]),
        (&["render", "small.gltf", "-o", "%d.png", "--frames", "0..3", "--time", "1"], &["--frames", "--time"]),
        (&["render", "small.gltf", "-o", "%d.png", "--frames", "0..3", "--fps", "-1"], &["frames per second"]),
        (&["render", "small.gltf", "-o", "a.png", "--fps", "25"], &["--frames"]),
        (
            &["render", "small.gltf", "-o", "%d.png", "--aov", "albedo=%02d.png", "--frames", "9..12"],
            &["'10.png'", "two results"],
        ),
        (&["render", "small.gltf", "-o", "a.png", "--limit", "memory"], &["NAME=VALUE"]),
        (&["info", "small.gltf", "--limit", "memry=1GiB"], &["did you mean 'memory'", "image-side"]),
        (&["bench", "small.gltf", "--limit", "image-side=0"], &["number of pixels"]),
        (&["info"], &["SCENE"]),
        (&["info", "small.gltf", "other.gltf"], &["other.gltf"]),
        (&["info", "builtin:"], &["there are: "]),
        (&["gallery"], &["DIR"]),
        (&["verify"], &["SCENE"]),
        (&["verify", "builtin:nowher"], &["built-in scene 'nowher'", "there are: "]),
        (&["verify", "small.gltf", "--technique", "everit"], &["everit", "everitt-kilgard", "all"]),
        (&["verify", "small.gltf", "--light", "3"], &["'3'", "2 'torch'"]),
        (&["compare", "small.gltf"], &["--output"]),
        (&["compare", "small.gltf", "-o", "out", "--method", "heidman-two-pass"], &["heidmann-two-pass", "ray-query"]),
        (&["compare", "small.gltf", "-o", "out", "--shadow-map", "resolutoin=4"], &["did you mean 'resolution'"]),
        (&["compare", "small.gltf", "-o", "out", "--shadow-map", "resolution=0"], &["from 1 to 16384"]),
        (&["adapters", "--backend", "vulkn"], &["vulkan", "gl"]),
        (&["bench", "builtin:nowhere"], &["built-in scene 'nowhere'", "there are: "]),
        (&["bench", "--frames", "0"], &["--frames", "0"]),
        (&["bench", "--fps", "0"], &["frames per second"]),
        (&["bench", "--size", "12"], &["WIDTHxHEIGHT"]),
        (&["bench", "--samples", "2"], &["1 or 4"]),
        (&["bench", "--technique", "auto,everit"], &["everit", "everitt-kilgard"]),
        (&["bench", "--scaling", "builtin:open"], &["--scaling", "SCENE"]),
        (&["bench", "--scaling", "--frames", "9"], &["--scaling", "--frames"]),
    ];
    small_scene(folder.path());
    for (args, words) in cases {
        zfail(folder.path(), args).fails(2, words);
    }
    assert_eq!(files(folder.path()), ["small.bin", "small.gltf"]);
}

#[test]
fn scenes_that_cannot_be_read_are_one_line_and_exit_code_1() {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("folder.glb")).unwrap();
    fs::write(folder.path().join("empty.glb"), "").unwrap();
    fs::write(folder.path().join("text.gltf"), "this is no scene").unwrap();
    fs::write(folder.path().join("scene.obj"), "v 0 0 0").unwrap();
    let before = files(folder.path());
    for scene in ["missing.glb", "folder.glb", "empty.glb", "text.gltf", "scene.obj", "missing/missing.gltf"] {
        zfail(folder.path(), &["render", scene, "-o", "a.png"]).fails(1, &[scene]);
        zfail(folder.path(), &["info", scene]).fails(1, &[scene]);
        zfail(folder.path(), &["info", "--json", scene]).fails(1, &[scene]);
    }
    assert_eq!(files(folder.path()), before);
}

#[test]
fn limits_are_for_every_command_that_loads_a_scene() {
    let folder = tempfile::tempdir().unwrap();
    small_scene(folder.path());
    for command in [&["render", "small.gltf", "-o", "a.png"][..], &["info", "small.gltf"], &["bench", "small.gltf"]] {
        let run = zfail(folder.path(), &[command, &["--limit", "memory=1KiB"]].concat());
        run.fails(1, &["small.gltf", "the file", "1024 bytes", "--limit memory"]);
    }
    // The negative control: with the limit raised again the scene loads.
    zfail(folder.path(), &["info", "small.gltf", "--limit", "memory=1KiB", "--limit", "memory=1MiB"]).ok();
}

#[cfg(unix)]
#[test]
fn a_scene_without_permission_is_one_line_and_exit_code_1() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().unwrap();
    let scene = small_scene(folder.path());
    fs::set_permissions(&scene, fs::Permissions::from_mode(0o000)).unwrap();
    if fs::read(&scene).is_ok() {
        eprintln!("skipped: this user may read everything");
        return;
    }
    zfail(folder.path(), &["info", "small.gltf"]).fails(1, &["small.gltf", "permission"]);
}

#[test]
fn results_that_cannot_be_written_are_found_before_any_work() {
    let folder = tempfile::tempdir().unwrap();
    small_scene(folder.path());
    fs::create_dir(folder.path().join("folder.png")).unwrap();
    fs::write(folder.path().join("file"), "old").unwrap();
    fs::write(folder.path().join("locked.png"), "old").unwrap();
    let mut permissions = fs::metadata(folder.path().join("locked.png")).unwrap().permissions();
    permissions.set_readonly(true);
    fs::set_permissions(folder.path().join("locked.png"), permissions).unwrap();
    let before = files(folder.path());

    // The scene does not exist, and the error is about the result: nothing was loaded.
    let cases: &[(&[&str], &[&str])] = &[
        (&["-o", "missing/a.png"], &["missing/a.png", "does not exist"]),
        (&["-o", "file/a.png"], &["file/a.png", "not a folder"]),
        (&["-o", "folder.png"], &["folder.png", "it is a folder"]),
        (&["-o", "locked.png"], &["locked.png", "read-only"]),
        (&["-o", "a.png", "--stats", "missing/s.json"], &["missing/s.json"]),
        (&["-o", "a.png", "--stats", "/dev/null"], &["/dev/null", "regular file"]),
        (&["-o", "a.png", "--aov", "shadow=file"], &["'file'", "not a folder"]),
        (&["-o", "a.png", "--aov", "stencil=file/masks"], &["file/masks", "not a folder"]),
        (&["-o", "a.png", "--aov", "depth=missing/d.exr"], &["missing/d.exr"]),
    ];
    for (args, words) in cases {
        zfail(folder.path(), &[&["render", "nothing.glb"], *args].concat()).fails(1, words);
    }
    zfail(folder.path(), &["verify", "nothing.glb", "--report", "file"]).fails(1, &["'file'", "not a folder"]);
    zfail(folder.path(), &["gallery", "file"]).fails(1, &["'file'", "not a folder"]);
    assert_eq!(files(folder.path()), before);
    // The negative control: with a good destination the complaint is about the scene.
    zfail(folder.path(), &["render", "nothing.glb", "-o", "a.png"]).fails(1, &["nothing.glb"]);
}

#[test]
fn help_lists_every_option_of_the_contract() {
    let folder = tempfile::tempdir().unwrap();
    let help = zfail(folder.path(), &["render", "--help"]).ok().stdout;
    let named: Vec<&str> =
        help.lines().map(str::trim_start).filter(|line| line.starts_with('-') && !line.starts_with("- ")).collect();
    assert_eq!(
        named,
        [
            "-o, --output <OUT>",
            "--size <WxH>",
            "--camera <N|NAME>",
            "--view <FILE.json>",
            "--time <SECONDS>",
            "--animation <NAME|N>",
            "--frames <A..B>",
            "--fps <F>",
            "--light <N>",
            "--samples <1|4>",
            "--technique <NAME>",
            "--tiles <never|always>",
            "--silhouettes <cpu|device>",
            "--no-shadows",
            "--exposure <EV|auto>",
            "--terminator <soft|exact>",
            "--aov <KIND=PATH>",
            "--stats <FILE.json>",
            "--backend <NAME>",
            "--adapter <NAME>",
            "-q, --quiet",
            "-h, --help",
            "--limit <NAME=VALUE>",
            "--alpha-shadows <off|solid|cut=PIXELS>",
            "--blended-shadows",
            "--variant <NAME|N>",
            "--sun <AZIMUTH,ELEVATION>",
            "--sky <auto|none>",
            "--ground <auto|none|HEIGHT>",
            "--overlay <KIND>",
            "--overlay-from <YAW,PITCH[,ZOOM]>",
            "--overlay-light <N>",
        ]
    );
    let overview = zfail(folder.path(), &["--help"]).ok().stdout;
    for word in ["render", "info", "bench", "verify", "compare", "adapters", "gallery"] {
        assert!(overview.contains(word), "{overview}");
    }
    assert!(zfail(folder.path(), &["--version"]).ok().stdout.starts_with("zfail 0."));
}

#[test]
fn a_reader_that_stops_reading_is_no_error() {
    let folder = tempfile::tempdir().unwrap();
    small_scene(folder.path());
    for args in [&["info", "small.gltf"][..], &["render", "--help"]] {
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let output = command(folder.path(), args).stdout(writer).stderr(std::process::Stdio::piped()).output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        assert!(output.stderr.is_empty());
    }
    // The negative control: a standard output that cannot be written for another reason is an error.
    #[cfg(target_os = "linux")]
    {
        let full = fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
        assert!((&full).write(b"x").is_err());
        let output = command(folder.path(), &["info", "small.gltf"]).stdout(full).output().unwrap();
        assert_eq!(output.status.code(), Some(1));
    }
}
