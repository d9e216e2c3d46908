//! Warnings about films (W0609): where cuts end flush in a face, and nowhere else.

use sdfc::{Compiler, Located};

/// The lines and messages of the warnings about films.
fn films(text: &str) -> Vec<(u32, String)> {
    let found = Compiler::new().check("scene.sdf", text);
    assert!(!found.has_errors(), "{found}");
    let is_film = |located: &Located| located.code == "W0609";
    found.located().into_iter().filter(is_film).map(|it| (it.start.line, it.message)).collect()
}

#[test]
fn flush_cuts_leave_films() {
    for text in [
        "cylinder(r: 16, h: 40) - cylinder(r: 14, h: 40)",
        // The hole is a thousandth of the face, and rounding errors differ in rotated shapes.
        "(box([80, 5, 60]) - cylinder(r: 1.2, h: 5).translate(x: 20)).rotate(x: 33deg, z: 12deg)",
        "box(10).rotate(y: 30deg) - cylinder(r: 3, h: 10).rotate(y: 30deg)",
        // Pockets that touch.
        "box(10) - box([2, 2, 20]).translate(x: -1) - box([2, 2, 20]).translate(x: 1)",
        "box(10) - (box([2, 2, 20]).translate(x: -1) | box([2, 2, 20]).translate(x: 1))",
        "box(1) & box(1).translate(x: 1)",
        "(rect([10, 10]) - rect([4, 4]).translate(x: 3)).extrude(2)",
        // One part of many, and a loop.
        "union(for i in 0..9: sphere(1).translate(x: 3 * i), box(1) - box([0.5, 1, 0.5]))",
        "difference(box([90, 5, 9]), for i in 0..40: cylinder(r: 0.5, h: 5).translate(x: 2 * i - 40))",
    ] {
        let found = films(text);
        assert_eq!(found.len(), 1, "{text}: {found:?}");
    }
}

#[test]
fn formulas_that_are_nowhere_negative_are_films() {
    for text in [
        "solid wall() bound bounds -1..1 = max(abs(p.y), abs(p.x) - 1, abs(p.z) - 1)\nwall()",
        "solid sheet() = 0.2 * abs(p.y - 0.3 * sin(p.x) * sin(p.z))\nsheet()",
    ] {
        let found = films(text);
        let [(2, message)] = &found[..] else { panic!("{text}: {found:?}") };
        assert!(message.contains("is a surface without an inside"), "{message}");
    }
    let thick =
        "solid wall() bound bounds -1..1 = max(abs(p.y), abs(p.x) - 1, abs(p.z) - 1) - 0.01";
    assert_eq!(films(&format!("{thick}\nwall()")), []);
}

#[test]
fn other_solids_have_none() {
    for text in [
        "cylinder(r: 16, h: 40) - cylinder(r: 14, h: 40.001)",
        // Flush outside of the body, faces that lie in one plane with the same side inside, walls
        // that are thin, and shapes that touch in a union.
        "box(2) - box(1).translate(x: 1.5)",
        "box(1) & box([2, 1, 2])",
        "sphere(1) - sphere(0.9999)",
        "box(1) | box(1).translate(x: 1)",
        "difference(box(1), box([0.5, 1, 0.5]), blend: smooth(0.05))",
    ] {
        assert_eq!(films(text), [], "{text}");
    }
}

#[test]
fn the_innermost_shape_is_named() {
    let found = films(
        "let tube = cylinder(r: 1, h: 2) -\n  cylinder(r: 0.8, h: 2)\ntube.scale(3) - sphere(1)",
    );
    let [(line, message)] = &found[..] else { panic!("{found:?}") };
    assert_eq!(*line, 1);
    assert!(message.starts_with("`difference` leaves a film without thickness"), "{message}");
}
