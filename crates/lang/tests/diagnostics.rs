//! The checker's diagnostics: scenes with the rendered messages below them, by theme.
#![allow(missing_docs)]

mod common;

use common::findings;

/// Scenes separated by lines of dashes, each followed by its diagnostics.
fn all(scenes: &[&str]) -> String {
    let found: Vec<String> = scenes.iter().map(|scene| findings(scene)).collect();
    found.join("\n\n================\n\n")
}

/// A snapshot without the expression, since it already contains the scenes.
macro_rules! assert_findings {
    ($found:expr) => {
        insta::with_settings!({ omit_expression => true }, { insta::assert_snapshot!($found) })
    };
}

#[test]
fn functions_of_quilez_are_answered_with_a_call() {
    assert_findings!(all(&[
        "sdSphere(p - vec3(1, 0, 0), 1)",
        "sdBox(p, [1, 1, 1])\nsdCapsule(p, [0, 0, 0], [1, 1, 1], 0.1)\nsdTorus(p, vec2(1, 0.2))",
        "solid s() = sdSphere(p, 1)\ns()",
        "opUnion(sphere(1), box(1))\nopSubtraction(sphere(1), box(1))\nopRound(sphere(1), 0.1)",
        "opSmoothUnion(sphere(1), box(1), 0.2)\nopSmoothSubstraction(sphere(1), box(1), 0.1)",
        "sdCross(p, [1, 0.5], 0)\nudQuad(p, [0, 0, 0])\nsdTriangleIsosceles(p, [1, 1])\nsdStar5(p)",
        "opRepetition(sphere(1), 2)\nopTwist(sphere(1), 2)\nopBlend(sphere(1), box(1))\nsdTeapot(p)",
    ]));
}

#[test]
fn a_shape_that_is_meant_for_solids_is_reported_with_the_word_to_write() {
    assert_findings!(all(&[
        "shape half(a: solid) = max(a(p), p.y)\nhalf(sphere(1))",
        "shape rod() = length(p.xz) - 1\nrod()",
        "solid s(a: solid) = a(p.xz)\ns(sphere(1))",
    ]));
}

#[test]
fn wrong_names_are_reported() {
    assert_findings!(all(&[
        "spere(1)",
        "let r = 2 * raduis\nsphere(r).color(#fff)",
        "sphere(k)\nparam k = 1 in 0..2",
        "let a = b\nlet b = a\nsphere(a)",
        "fn f() -> number = k\nlet k = f()\nsphere(k)",
        "let box = box(1)\nbox(2)",
        "let k = 3\nsphere(k(1))",
        "fn a(x: lenght) = x\nsphere(a(1))",
        "let a = 1\nfn a() = 2\nsphere(a)",
        "solid a(r: length) = length(p) - r\nregion a(r: length) = length(p) - r\na(1)",
        "fn f(a, a) = a\nsphere(f(1, 2))",
        "sphere(1).smooooth(2).tralate(x: 1)",
        "sphere(1).translate(1, 2, 3)\ncircle(1).translate(1, 2)\nsphere(1).scale(1, 2, 3)",
        "box(1).bevel(0.1)\ngear(12)\nthread()\nunion(for i in range(3): sphere(i))",
        "cube(1)\nsphere(PI)\nsdRoundCone(1)\nsmin(sphere(1), box(1), 0.1)\nsphere(1).move(x: 1).color(red)\nlight()\nfn f(x: float) = x",
    ]));
}

#[test]
fn wrong_records_are_reported() {
    assert_findings!(all(&[
        "let a = (size: 1, at: [1, 2])\nsphere(a.sise)\nsphere(a.radius)\nsphere(a)",
        "let a = (x: 1, x: 2)\nsphere(a.x)",
        "fn f(a: (x: number, y: number)) = a.x\nsphere(f((x: 1)))\nsphere(f((x: 1, y: 2, z: 3)))\nlet a = (x: 1, z: 2)\nsphere(f(a))\nsphere(f((x: #fff, y: 1)))",
        "let a = (x: 1)\nsphere(a.with(y: 2).x)\nsphere(a.with(x: #fff).x)\nsphere(a + a)",
        "let a = (body: sphere(1), scale: fn(k: number) = k)\nlet d = a.body([0, 0, 0])\nsphere(a.scale(2))",
        "let a = if true { (x: 1) } else { (y: 1) }\nsphere(1)",
        "sphere(iterate(3, (x: 1, a: sphere(1)), fn(s) = s).x)\nsphere(iterate(3, (x: 1), fn(s) = (y: 2)).x)",
        "let m = material()\nsphere(m.colour.r)\nsphere(m.rough)",
    ]));
}

#[test]
fn a_record_cannot_grow_without_limit() {
    let doubled: String =
        (1..40).map(|at| format!("let a{at} = (x: a{0}, y: a{0})\n", at - 1)).collect();
    let found = findings(&format!("let a0 = (x: 1)\n{doubled}sphere(1)"));
    assert!(found.contains("this type has more than 1024 parts"), "{found}");
    assert_eq!(found.matches("error[").count(), 1, "{found}");
}

#[test]
fn wrong_calls_are_reported() {
    assert_findings!(all(&[
        "sphere(1, 2)\nsphere(radius: 1)\nsphere(r: 1, r: 2)\nsphere(r: 1, 2)",
        "plane().color(checker(size: 1))",
        "polygon([0, 0], [1, 0], [0, 1]).extrude(0.2)\nsphere(1).sweep([0, 0, 0], [1, 0, 0])",
        "union(sphere(1), box(1), smooth(0.1))",
        "let color = #f00\nsphere(1).color(color)",
        "let union = 3\nfn difference(a) = a\n(sphere(1) | box(1)) - sphere(difference(union))",
        "torus(majr: 1)",
        "box([1, 1, 1], round: 0.1)\nsphere(1, color: #f00)\ncone(h: 1, r1: 1)\nbox(r: 0.1)\ncamera(eye: [1, 2, 3], translate: 1)",
        "solid arm(a: angle) = capsule([0, 0, 0], [0, 1, 0]).rotate(z: a)\narm(20deg)",
        "translate([1, 2, 3])\nbox(1).rotate([0, 45, 0])",
        "sphere(1).mirror(x)\nsphere(r)\nsphere(1).translate(x: y)",
        "sphere(1)\nsun(shadow: soft)\nsphere(min)\nambient(0.3)\nsun(#fff)\nsun(1)\nsphere(#f00)",
        "sphere(for i in 0..3: i)",
        "let ball = sphere(1)\nlet d = ball(1, 2, 3)\nlet e = ball([1, 2])\nsphere(d + e)",
        "let f = fn(a, b) = a + b\nsphere(f(1)).round(f(a: 1, b: 2))",
        "sphere(min()).round(max(a: 1, 2)).round(pow(2)).round(pi(3))",
        "sphere(length(vec3(1, 2))).round(dot([1, 2], [1, 2, 3]))",
        "solid wall(p: length) = p\nsolid slab() = { let p = 1\n p }\nwall(1) | slab()",
        "camera(target: [0, 0, 0])\ncamera(eye: [1, 2, 3])\nsun(shadow: 8)\nsphere(1)\nlet s = sun(direction: [1, 2, 3])",
        "camera(eye: [1, 2, 3], fov: 40deg, height: 3)\nambient(1, 2, 3)\nsphere(camera)",
        "let line = [[0, 0, 0], [1, 0, 0], [1, 1, 0]]\ntube(line, r: 0.1)\npipe(line)\nrope(line)\nsphere(smin(1, 2, 0.1))",
        "let letters = \"QWERTY\"\ntext(letters[1])",
        "sphere(1).emission(#fff, 5)\ntext(\"a\", align: center)\nfn f(q) = normalize(q)\nsphere(f(1))",
        "union [sphere(1), box(1)]",
        "union(for i in 1..=12: sphere(i))",
        "let part = import(\"part.stl\")",
        "sweep(circle(0.1), bezier([0, 0, 0], [1, 1, 0], [2, 0, 1]))",
        "fn f(a = 1) exact = a\nsolid g() -> number\n lipschitz 1\n lipschitz 2\n = f()\ng()\nlet h = fn(a = 1, b: number...) bounds 0..1 = a",
    ]));
}

#[test]
fn wrong_ray_intersections_are_reported() {
    assert_findings!(all(&[
        "region r() intersect [0, 1] = length(p) - 1\nr().extrude(1)",
        "shape s() intersect [0, 1] = length(p) - 1\nsphere(1)",
        "fn f(a = 1) intersect [0, 1] = a\nsphere(f())",
        "solid s() intersect [0, 1] intersect [0, 1] = length(p) - 1\ns()",
        "solid s() intersect \"far\" = length(p) - 1\ns()",
        "solid s() intersect [p.x, 1] = length(p) - 1\ns()",
        "solid s() intersect [o.x, d.x] = length(p) - o.x\ns()",
    ]));
}

#[test]
fn wrong_dimensions_are_reported() {
    assert_findings!(all(&[
        "circle(1)\nsphere(1)\nrect([1, 2])",
        "circle(1)\ncamera(eye: [0, 0, 5])\nsky()\nisolines(0.1)",
        "circle(1)\ncamera(eye: [0, 0, 5], fov: 30deg)\nmarch()",
        "sphere(1)\nisolines(0.1)",
        "circle(1).translate(z: 1).extrude(1)",
        "union(sphere(1), circle(1))\nsphere(1) | rect([1, 2])",
        "sphere(1).extrude(1)",
        "shape stretch(a: shape) = a(p * [1, 2, 1])\nsphere(1).stretch()",
        "shape tall(a: shape) = a(p) - p.z\nsphere(1).tall()",
        "let f = fn(a: shape, q: point) = a(q)\nsphere(f(sphere(1), [0, 0, 0]))",
        "sphere.translate(x: 1)",
        "[sphere(1), box(1)]\nfn ball() = sphere(1)\nball\n3 + 4",
    ]));
}

#[test]
fn missing_angle_units_are_reported() {
    assert_findings!(all(&[
        "sphere(1).rotate(y: 90)",
        "param turn = 10 in 0..90\nsphere(1).rotate(y: turn).rotate(x: -1.5, z: 45deg + 10)",
        "sphere(1).rotate(y: 0).rotate(x: 90 * 1rad, z: 45deg * 2 - 0.25turn / 2)",
        "let a = 30deg\nsphere(a / 1deg).twist(atan2(1, 2) + a).rotate(y: a / 2deg)",
        "fn f(t: angle = 45) = sin(t)\nparam tilt: angle = 30 in 0..45deg\nsphere(f(0))",
    ]));
}

#[test]
fn wrong_types_are_reported() {
    assert_findings!(all(&[
        "sphere(\"big\")\nsphere([1, 2, 3])\nsphere(true)",
        "sphere(1).color(0.5)\nsphere(1).color([1, 0, 0])\nsphere(1).color(fn(q) = q.x)",
        "box([1, 2])\nbox([1, 2, 3, 4])",
        "fn f(n: int) = n\nsphere(f(1.5)).round(f(round(1.5)))",
        "sphere(if true { 1 } else { [1, 2] })\nlet a = if 1 { 2 } else { 3 }\nlet b = if true { sphere(1) } else { 2 }",
        "let a = [1, sphere(1)]\nlet b = []\nlet c = [[1, 2], 3]\nsphere(1)",
        "let v = [1, 2]\nsphere(v.z).round(v.length).round((1..2).x).round(v.xw)",
        "let v = [1, 2]\nsphere(v[0.5]).round(1[0]).round([for i in 0..3: i][0..1.5])",
        "let a = [for i in 5: i]\nlet b = [for i in true: i]\nsphere(1)",
        "union(sphere(1), sphere(2), blend: 0.25)\nunion(sphere(1), sphere(2), blend: fn(a) = a)\nunion(sphere(1), sphere(2), blend: checker)",
        "fn f(n: int) = if n == 0 { 0 } else { f(n - 1) }\nsphere(f(3))",
        "fn a(n) = b(n)\nfn b(n) = a(n)\nsphere(a(1))",
        "let f = min\nlet g = sphere\nlet h = union\nsphere(1)",
        "let s = iterate(3.5, 0, fn(s) = s + 1)\nlet t = iterate(3, 0, fn(s) = [s, 1])\nlet u = iterate(3, true, fn(s) = s)\nlet v = iterate(3, 0, fn(s, i, j) = s)\nsphere(1)",
        "let m = material(color: 1)\nlet n = material(shine: 1)\nlet o = m.with(roughness: true)\nsphere(1).paint(#fff)",
        "box(1).fillet(0.1)\nsphere(1).material(color: #f00)",
        "solid a() exact if 1\n lipschitz [1, 2]\n bounds 1\n require 2, \"no\"\n material true\n = [1, 2, 3]\na()",
    ]));
}

#[test]
fn wrong_operands_are_reported() {
    assert_findings!(all(&[
        "sphere(1) + box(1)",
        "sphere(1) * 2\nsphere(1) - 0.5\n-sphere(1)\n!sphere(1)",
        "sphere(1 | 2).round(true & false)",
        "sphere(1).round([1, 2] + [1, 2, 3]).round(#fff + [1, 2, 3])",
        "sphere(if [1, 2] == [1, 2] { 1 } else { 2 })\nlet a = true < false\nlet b = \"a\" == \"b\"\nlet c = 1 == true",
        "sphere(1) && box(1)\nlet a = 1 && 2\nlet b = true..false",
    ]));
}

#[test]
fn wrong_uses_of_the_point_are_reported() {
    assert_findings!(all(&[
        "sphere(p.x)",
        "length(p) - 1.0",
        "max(p.x * p.x + p.y * p.y, abs(p.z)) - [1, 2].x\nsphere(1) - p.x",
        "fn f(a) = a + p.y\nsphere(f(1))",
        "solid a(r = p.x) bounds -p..p\n lipschitz p.x\n = length(p) - r\na()",
        "sphere(1).color(fn(q) = mix(#fff, #000, p.y))",
        "solid a() = sphere(abs(p.x))(p)\nsolid b() = union(for i in 0..3: sphere(0.1 * i + 0.01 * p.y))(p)\na() | b()",
    ]));
}

#[test]
fn circular_definitions_are_reported() {
    assert_findings!(all(&[
        "solid a(n: int) = if n == 0 { length(p) } else { a(n - 1)(p) }\na(3)",
        "solid a() = b()(p)\nsolid b() = c()(p)\nfn c() -> solid = a()\na()",
        "let a = f()\nfn f() -> number = g()(0)\nfn g() -> fn(number) -> number = fn(x) = a + x\nsphere(a)",
        "fn f(n: int) -> solid = if n == 0 { sphere(1) } else { f(n - 1).round(0.1) }\nf(3)",
        "let ball = knob()\nlet r = 0.8\nsolid knob() = sphere(r)(p)\nball",
    ]));
}

#[test]
fn wrong_params_are_reported() {
    assert_findings!(all(&[
        "param a = [1, 2]\nparam b = \"round\"\nparam c = \"x\" in [\"a\", \"b\"]\nparam d = true in 0..1\nparam e: int = 1.5 in 0..3\nparam f = 3 in [1, 2]\nparam g = \"a\" in [\"a\", 1]\nsphere(1)",
        "param a = 8 in 2..12\nparam n: int = 6 in 3..12\nparam lid = true\nparam wood = #8a5a34\nparam style = \"round\" in [\"round\", \"flat\"]\nparam tilt = 10deg in 0deg..45deg\nsphere(if lid && style == \"flat\" { a } else { n }).color(wood).rotate(y: tilt)",
    ]));
}

#[test]
fn unused_names_are_reported() {
    assert_findings!(all(&[
        "let _a = 1\nfn _b() = 2\nsolid _c() = { let q = p\n let r = 1\n length(q) }\nsphere(1)",
        "let _a = 1\nfn _b() = { let k = 2\n fn(x) = x + k + _a }\nsphere(_b()(1))",
    ]));
}

#[test]
fn each_mistake_is_reported_once() {
    assert_findings!(all(&[
        "let a = spere(1)\nlet b = a.translate(x: 1) | box(1)\nb.rotate(y: 90deg)\nfn f() = a\nf() - b",
        "import spur from \"gear.sdf\"\nspur(3).extrude(1)",
        "let a = 1",
        "sphere(1 + true).rotate(y: 10)\nbox(\"a\" + 1)",
    ]));
}
