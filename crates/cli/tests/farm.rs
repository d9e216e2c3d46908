//! Tests pictures and sequences that several processes draw, on the CPU.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod common;

use std::path::Path;
use std::process::{Command, Output, Stdio};

use common::{folder, names, run, said};
use tempfile::TempDir;

const SCENE: &str = "import ball from \"part.sdf\"\nparam r = 0.5 in 0.1..1\n\
                     ball(r).translate(x: sin(time))\nplane(y: -0.5)\n";
const PART: &str = "fn ball(r: length) = sphere(r)\n";

fn scene() -> TempDir {
    folder(&[("a.sdf", SCENE), ("part.sdf", PART)])
}

/// Runs `sdfc render` on the scene, 50 by 37 pixels.
fn render(folder: &TempDir, options: &str) -> Output {
    run(folder, &format!("render a.sdf --backend cpu --size 50x37 {options}"))
}

fn drawn(folder: &TempDir, options: &str) -> String {
    let output = render(folder, options);
    assert_eq!(output.status.code(), Some(0), "{options}: {}", said(&output));
    String::from_utf8(output.stdout).unwrap()
}

fn join(folder: &TempDir, args: &str) -> Output {
    run(folder, &format!("join {args}"))
}

fn read(folder: &TempDir, name: &str) -> Vec<u8> {
    std::fs::read(folder.path().join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// The names of the parts of a picture.
fn parts(folder: &TempDir, start: &str) -> String {
    let names = names(folder.path());
    let parts = names.iter().filter(|name| name.starts_with(&format!("{start}.part-")));
    parts.cloned().collect::<Vec<_>>().join(" ")
}

#[test]
fn joined_parts_are_the_file_of_the_whole() {
    let folder = scene();
    for extension in ["png", "exr"] {
        let options = format!("--samples 2 --set r=0.4 -o w.{extension} --depth z.exr");
        drawn(&folder, &options);
        let cut = options.replace("w.", "p.").replace("z.", "q.");
        for region in ["1/3", "2/3", "0,24,13x13", "13,24,37x13"] {
            drawn(&folder, &format!("{cut} --region {region}"));
        }
        for (whole, part) in [(format!("w.{extension}"), "p"), ("z.exr".to_owned(), "q")] {
            let joined = format!("joined.{whole}");
            let output = join(&folder, &format!("{} -o {joined}", parts(&folder, part)));
            assert_eq!(output.status.code(), Some(0), "{}", said(&output));
            assert_eq!(read(&folder, &whole), read(&folder, &joined), "{whole}");
            let beside = whole.replacen(['w', 'z'], part, 1);
            let output = join(&folder, &format!("-o {beside}"));
            assert_eq!(output.status.code(), Some(0), "{}", said(&output));
            assert_eq!(read(&folder, &whole), read(&folder, &beside), "{beside}");
        }
        for part in parts(&folder, "p").split(' ').chain(parts(&folder, "q").split(' ')) {
            std::fs::remove_file(folder.path().join(part)).unwrap();
        }
    }
}

#[test]
fn parts_that_do_not_make_one_picture_are_refused() {
    let folder = scene();
    drawn(&folder, "-o p.png --region 1/2");
    drawn(&folder, "-o p.png --region 2/2");
    drawn(&folder, "-o o.png --region 10,10,9x9");
    drawn(&folder, "-o s.png --region 2/2 --set r=0.6");
    drawn(&folder, "-o t.png --region 2/2 --time 1");
    drawn(&folder, "-o e.exr --region 2/2");
    let (one, two) = ("p.part-0-0-50x16.png", "p.part-0-16-50x21.png");
    let refused = |args: &str, code: i32, part: &str| {
        let output = join(&folder, args);
        assert_eq!(output.status.code(), Some(code), "{args}: {}", said(&output));
        assert!(said(&output).contains(part), "{args}: {}", said(&output));
        assert!(!folder.path().join("out.png").exists());
    };
    refused(&format!("{two} -o out.png"), 2, "--region 0,0,50x16");
    refused(&format!("{one} {two} {one} -o out.png"), 2, "another part has too");
    refused(&format!("{one} o.part-10-10-9x9.png {two} -o out.png"), 2, "another part has too");
    refused(&format!("{one} s.part-0-16-50x21.png -o out.png"), 2, "other settings");
    refused(&format!("{one} t.part-0-16-50x21.png -o out.png"), 2, "another frame or time");
    refused(&format!("{one} e.part-0-16-50x21.exr -o out.png"), 2, "holds colours as EXR");
    refused(&format!("{one} missing.png -o out.png"), 3, "cannot read missing.png");
    refused(&format!("{one} {two} -o {two}"), 2, two);
    refused("-o out.png", 2, "no parts beside out.png");
    refused(&format!("{one} {two} -o out.exr"), 2, "the parts hold colours as PNG");
    let mut damaged = read(&folder, two);
    damaged.truncate(damaged.len() - 20);
    std::fs::write(folder.path().join(two), damaged).unwrap();
    refused(&format!("{one} {two} -o out.png"), 3, "damaged");
    std::fs::write(folder.path().join("part.sdf"), PART.replace("(r)", "(r + 0.1)")).unwrap();
    drawn(&folder, "-o p.png --region 2/2");
    refused(&format!("{one} {two} -o out.png"), 2, "another scene");
}

#[test]
fn a_damaged_part_that_can_be_read_is_refused() {
    let folder = scene();
    drawn(&folder, "-o p.exr --region 1/1");
    let name = "p.part-0-0-50x37.exr";
    let mut file = read(&folder, name);
    // EXR has no checksums: a changed value reads like any other.
    let last = file.len() - 2;
    file[last] ^= 1;
    std::fs::write(folder.path().join(name), file).unwrap();
    let output = join(&folder, &format!("{name} -o out.exr"));
    assert_eq!(output.status.code(), Some(3), "{}", said(&output));
    assert!(said(&output).contains("damaged"), "{}", said(&output));
}

#[test]
fn chunks_are_the_frames_of_the_whole() {
    let (whole, cut) = (scene(), scene());
    drawn(&whole, "-o f.png --frames 3..10");
    for share in ["3/3", "1/3", "2/3"] {
        drawn(&cut, &format!("-o f.png --frames 3..10 --chunk {share}"));
    }
    assert_eq!(names(whole.path()), names(cut.path()));
    for name in names(whole.path()) {
        assert_eq!(read(&whole, &name), read(&cut, &name), "{name}");
    }
    let empty = render(&cut, "-o g.png --frames 0..2 --chunk 1/9");
    assert_eq!(empty.status.code(), Some(0));
    assert!(said(&empty).contains("no frame in share 1/9"), "{}", said(&empty));
    assert_eq!(names(whole.path()), names(cut.path()));
}

/// Returns the states of all pictures that a call reports, such as `drawn`.
fn states(lines: &str) -> Vec<String> {
    let state = |line: &str| {
        let line: serde_json::Value = serde_json::from_str(line).unwrap();
        line["state"].as_str().unwrap().to_owned()
    };
    lines.lines().map(state).collect()
}

#[test]
fn finished_frames_are_skipped_and_others_are_drawn_again() {
    let folder = scene();
    let options = "-o f.exr --frames 0..4 --depth z.exr --resume --progress json";
    assert_eq!(states(&drawn(&folder, options)), ["drawn"; 4]);
    let first: Vec<Vec<u8>> = (0..4).map(|n| read(&folder, &format!("f.000{n}.exr"))).collect();
    assert_eq!(states(&drawn(&folder, options)), ["skipped"; 4]);

    let path = |name: &str| folder.path().join(name);
    std::fs::write(path("f.0000.exr"), &first[0][..first[0].len() / 2]).unwrap();
    let mut changed = first[1].clone();
    let last = changed.len() - 2;
    changed[last] ^= 1;
    std::fs::write(path("f.0001.exr"), changed).unwrap();
    std::fs::copy(path("f.0003.exr"), path("f.0002.exr")).unwrap();
    std::fs::remove_file(path("z.0003.exr")).unwrap();
    let output = render(&folder, options);
    assert_eq!(states(&String::from_utf8(output.stdout.clone()).unwrap()), ["drawn"; 4]);
    for reason in ["f.0001.exr is drawn again: the file is damaged", "another frame or time"] {
        assert!(said(&output).contains(reason), "{}", said(&output));
    }
    for (n, file) in first.iter().enumerate() {
        assert_eq!(&read(&folder, &format!("f.000{n}.exr")), file, "{n}");
    }

    for other in ["--set r=0.6", "--samples 2", "--fps 25", "--live-literals", "--march sphere"] {
        let lines = drawn(&folder, &format!("{options} {other}"));
        assert_eq!(states(&lines), ["drawn"; 4], "{other}");
    }
    drawn(&folder, options);
    std::fs::write(path("part.sdf"), PART.replace("(r)", "(0.9 * r)")).unwrap();
    assert_eq!(states(&drawn(&folder, options)), ["drawn"; 4], "an import changed");
}

#[test]
fn progress_is_one_line_of_json_for_each_picture() {
    let folder = scene();
    let options = "-o f.png --frames 5..7 --region 2/2 --progress json";
    let lines: Vec<serde_json::Value> =
        drawn(&folder, options).lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert_eq!(lines.len(), 2);
    let last = &lines[1];
    assert_eq!(last["file"], "f.0006.part-0-16-50x21.png");
    assert_eq!((&last["frame"], &last["done"], &last["total"]), (&6.into(), &2.into(), &2.into()));
    assert_eq!((&last["region"], &last["state"]), (&"0,16,50x21".into(), &"drawn".into()));
    assert!(folder.path().join("f.0006.part-0-16-50x21.png").exists());
}

#[test]
fn options_that_do_not_fit_are_refused() {
    let folder = scene();
    for (options, part) in [
        ("--chunk 1/2", "--frames"),
        ("--frames 0..2 --chunk 3/2", "shares are numbered from 1"),
        ("--region 0,0,51x1", "not within the picture of 50x37"),
        ("--region 1,2", "expected X,Y,WxH"),
        ("--frames 0..2 --chunk 1/2 -o a.gif", "--chunk needs one file per picture"),
        ("--region 1/2 -o a.gif", "--region needs one file per picture"),
        ("--resume -o a.gif", "--resume needs one file per picture"),
        ("--resume --stats a.json", "cannot be used with"),
        ("--progress json -o -", "--progress json writes to stdout"),
    ] {
        let output = render(&folder, options);
        assert_eq!(output.status.code(), Some(2), "{options}: {}", said(&output));
        assert!(said(&output).contains(part), "{options}: {}", said(&output));
    }
    assert_eq!(names(folder.path()), ["a.sdf", "part.sdf"]);
}

/// Starts a process that draws frames until it is killed.
fn worker(folder: &Path) -> std::process::Child {
    let args = "render a.sdf --backend cpu --size 50x37 -o f.png --frames 0..12 --resume";
    Command::new(env!("CARGO_BIN_EXE_sdfc"))
        .args(args.split(' '))
        .current_dir(folder)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap()
}

#[test]
fn workers_that_are_killed_or_run_twice_lose_and_mix_nothing() {
    let (alone, shared) = (scene(), scene());
    drawn(&alone, "-o f.png --frames 0..12");
    let mut killed = worker(shared.path());
    while names(shared.path()).len() < 4 && killed.try_wait().unwrap().is_none() {
        std::thread::yield_now();
    }
    killed.kill().unwrap();
    killed.wait().unwrap();
    // What has a final name is whole, also where a worker was killed.
    for name in names(shared.path()).iter().filter(|name| name.starts_with("f.")) {
        assert_eq!(read(&shared, name), read(&alone, name), "{name}");
    }
    let twins = [worker(shared.path()), worker(shared.path())];
    for mut twin in twins {
        assert!(twin.wait().unwrap().success());
    }
    let finished = names(shared.path()).into_iter().filter(|name| !name.starts_with(".sdfc-"));
    assert_eq!(finished.collect::<Vec<_>>(), names(alone.path()));
    for name in names(alone.path()) {
        assert_eq!(read(&shared, &name), read(&alone, &name), "{name}");
    }
}
