//! Names from other tools and their equivalents here: from Quilez's articles, GLSL, OpenSCAD, Curv,
//! Bauble and CSS.

/// The expression to write here, and the names from other tools for which it is suggested. Names
/// are in lower case and without underscores.
const ROWS: &[(&str, &str)] = &[
    // Shapes.
    ("sphere", "ball orb"),
    ("box", "cube cuboid block brick fbox fboxcheap"),
    ("rounded_box", "roundbox rbox roundedcube roundcube fboxround"),
    ("mitred_box", "boxsharp"),
    ("capsule", "pill stick line verticalcapsule"),
    ("torus", "donut doughnut"),
    ("cylinder", "rod infinitecylinder"),
    ("capped_cone", "frustum truncatedcone"),
    ("pyramid", "squarepyramid"),
    ("plane", "ground halfspace floorplane"),
    ("ellipsoid", "spheroid"),
    ("circle", "disc disk"),
    ("rect", "rectangle square box2 box2d"),
    ("regular_polygon(6, 0.5).extrude(1)", "prism"),
    ("regular_polygon", "ngon hexagon pentagon octagon octogon"),
    ("triangle", "equilateraltriangle"),
    ("isosceles_triangle", "triangleisosceles"),
    ("triangle_plate", "udtriangle"),
    ("quad_plate", "udquad quad"),
    ("ring", "annulus"),
    ("cut_sphere", "hemisphere dome"),
    ("helix", "spring coil spiral"),
    ("star", "star4 star5 star6 pentagram"),
    ("oriented_rect", "orientedbox"),
    ("plus", "sdcross"),
    ("staircase", "sdstairs"),
    ("quadratic_bezier", "bezier"),
    ("heightfield", "terrain heightmap"),
    ("menger", "mengersponge sponge"),
    ("schwarz_p", "schwarz primitive"),
    ("text", "label letters glyphs"),
    // Operators.
    ("union", "add merge combine join unite together group opu"),
    ("difference", "subtract subtraction substraction cut minus hole ops"),
    ("intersection", "intersect common opi"),
    (
        "union(a, b, blend: smooth(0.1))",
        "smin smoothunion smoothmin unionsmooth blob blend metaballs polysmin opblend opsmooth",
    ),
    (
        "difference(a, b, blend: smooth(0.1))",
        "smoothdifference smoothsubtraction smoothsubtract smoothsubstraction",
    ),
    ("intersection(a, b, blend: smooth(0.1))", "smax smoothintersection smoothmax smoothintersect"),
    ("union(a, b, blend: fillet(0.1))", "unionround roundunion fopunionround"),
    ("union(a, b, blend: chamfer(0.1))", "unionchamfer chamferunion fopunionchamfer"),
    ("union(a, b, blend: stairs(0.1, 4))", "unionstairs stairsunion fopunionstairs"),
    ("translate", "move shift moved optx"),
    ("rotate", "rotation"),
    ("rotate(x: 30deg)", "rotatex"),
    ("rotate(y: 30deg)", "rotatey"),
    ("rotate(z: 30deg)", "rotatez"),
    ("spin", "rot rot2 rot2d rotate2d mat2"),
    ("scale", "resize zoom"),
    ("reflect", "flip mirrorimage mirrored"),
    ("mirror", "symmetric symmetry symx symy symz symxy symxz symyz"),
    ("repeat", "tile mod1 mod2 mod3 pmod1 pmod2 pmod3 domainrepetition repetition rep infarray"),
    (
        "limited_repeat",
        "array replim repeatlimited replimited limitedrepetition gridcopies lineararray \
         gridarray linearpattern rectangularpattern",
    ),
    (
        "polar_repeat",
        "radial modpolar pmodpolar circulararray polararray circularpattern \
         polarpattern repeatpolar rotcopies",
    ),
    ("extrude", "linearextrude extrusion"),
    ("revolve", "rotateextrude revolution lathe"),
    ("shell", "hollow annular outline stroke"),
    ("round", "rounded rounding"),
    ("offset", "dilate inset grow expand inflate"),
    ("displace", "displacement bump"),
    ("morph", "tween"),
    ("invert", "complement inverse"),
    ("twist", "twirl"),
    ("bend", "cheapbend"),
    ("slice", "section projection"),
    (
        "sweep(circle(0.1), points)",
        "curve spline polyline path rope wire cable hose polylinetube tubealong splinetube",
    ),
    // Mathematics.
    ("mix", "lerp interpolate"),
    ("fract", "frac"),
    ("inverseSqrt", "rsqrt invsqrt"),
    ("log", "ln logarithm"),
    ("length", "magnitude norm mag"),
    ("a % b", "mod fmod modulo"),
    ("x * 1deg", "radians degtorad"),
    ("x / 1deg", "degrees radtodeg"),
    ("hash", "random rand rnd"),
    ("gradient_noise", "noise perlin perlinnoise"),
    ("voronoi", "worley cellular"),
    ("time", "t itime seconds clock"),
    ("if c { a } else { b }", "select ternary cond where"),
    ("[for x in list: f(x)]", "map listcomprehension"),
    ("[for x in list: x, y]", "append push pushback concat cons"),
    ("len", "count numelements"),
    ("0..n", "range linspace"),
    ("iterate", "fold reduce loop while"),
    // Words that begin a line.
    ("fn name(x) = ...", "function def func lambda module"),
    ("let name = ...", "var const local define"),
    ("param name = 1 in 0..2", "slider uniform knob parametric"),
    ("import name from \"file.sdf\"", "include use require"),
    // Settings and materials.
    ("sun", "light directionallight dirlight directional"),
    ("point_light", "lamp bulb"),
    ("spot_light", "spot"),
    ("ambient", "ambientlight"),
    ("background", "backdrop bg bgcolor"),
    ("camera", "eye viewpoint"),
    ("color", "colour tint albedo diffuse shade fill"),
    ("material", "mat pbr"),
    ("emission", "glow emissive"),
    ("metallic", "metal metalness"),
    ("roughness", "specular shininess glossiness glossy"),
    ("sky(image: \"sky.hdr\")", "environment hdri hdr envmap environmentmap skybox"),
    ("exposure", "tonemap tonemapping tone"),
    ("camera(fov: 40deg)", "fov fieldofview"),
    ("checker", "checkerboard chequer"),
    ("ramp", "lineargradient radialgradient colorramp colorgradient gradientcolor"),
    // Types.
    ("number", "float double real f32 scalar"),
    ("bool", "boolean"),
    ("int", "integer i32"),
    // Colours of CSS.
    ("#ff0000", "red"),
    ("#00ff00", "lime"),
    ("#008000", "green"),
    ("#0000ff", "blue"),
    ("#ffff00", "yellow"),
    ("#00ffff", "cyan aqua"),
    ("#ff00ff", "magenta fuchsia"),
    ("#ffffff", "white"),
    ("#000000", "black"),
    ("#808080", "gray grey"),
    ("#c0c0c0", "silver"),
    ("#ffa500", "orange"),
    ("#800080", "purple"),
    ("#a52a2a", "brown"),
    ("#ffc0cb", "pink"),
    ("#000080", "navy"),
    ("#008080", "teal"),
    ("#ffd700", "gold"),
];

/// Operations of other tools that have no equivalent: their names, the message, and the expression
/// that comes nearest.
const ABSENT: &[(&str, &str, &str)] = &[
    (
        "hull",
        "there is no convex hull: `round_cone(a, b, r1, r2)` is that of two spheres, \
         `union(a, b, blend: smooth(0.2))` joins shapes smoothly",
        "union(a, b, blend: smooth(0.2))",
    ),
    (
        "minkowski",
        "there is no Minkowski sum: `a.round(0.1)` is that of a shape and a sphere",
        "a.round(0.1)",
    ),
    (
        "bevel",
        "there is no bevel of a shape's edges: `rounded_box` has round ones, `a.round(0.1)` rounds \
         those of any shape and makes it 0.1 larger on each side, `intersection(a, b, blend: \
         chamfer(0.1))` cuts the edges between two shapes",
        "a.round(0.1)",
    ),
    (
        "opacity alpha transparent transparency ior refraction refract",
        "solids are never transparent; the colour of a region may be, as in `#457b9d80`",
        "#457b9d80",
    ),
    (
        "gear",
        "there is no gear: `union(circle(0.5), rect([0.2, 0.1]).translate(x: 0.5).polar_repeat(12))` \
         has twelve teeth",
        "union(circle(0.5), rect([0.2, 0.1]).translate(x: 0.5).polar_repeat(12))",
    ),
    (
        "thread",
        "there is no screw thread: `union(cylinder(0.4, h: 2), helix(0.4, 0.05, pitch: 0.15, h: 2))` \
         has the shape of one",
        "union(cylinder(0.4, h: 2), helix(0.4, 0.05, pitch: 0.15, h: 2))",
    ),
];

/// A parameter, and the names that other tools have for such a parameter, spelt like those of
/// [`ROWS`].
const PARAMETERS: &[(&str, &str)] = &[
    ("r", "radius rad d diameter size"),
    ("r1", "ra radius1 rbottom"),
    ("r2", "rb radius2 rtop"),
    ("h", "height length tall"),
    ("size", "dimensions dimension extents sides lengths scale"),
    ("wall", "thickness thick"),
    ("width", "thickness wall thick"),
    ("eye", "position pos origin location from"),
    ("target", "lookat look center centre to at"),
    ("position", "pos at center centre"),
    ("direction", "dir axis normal"),
    ("fov", "angle fieldofview lens"),
    ("strength", "intensity brightness power energy"),
    ("color", "colour tint albedo"),
    ("zenith", "top up"),
    ("ground", "bottom down"),
    ("n", "count number sides times"),
    ("count", "n number times"),
    ("spacing", "period step distance every"),
    ("blend", "smooth smoothness radius r k"),
    ("by", "r radius amount distance"),
    ("major", "r radius"),
    ("minor", "wire wireradius tube"),
    ("samples", "count n"),
    ("stops", "ev value exposure"),
    ("tone", "curve tonemap mapping"),
];

/// The parameter among `names` that is meant by a parameter's name in another tool.
pub fn parameter<'n>(name: &str, names: &[&'n str]) -> Option<&'n str> {
    let name = plain(name);
    let meant = |(here, others): &&(&str, &str)| {
        names.contains(here) && others.split(' ').any(|other| other == name)
    };
    let (here, _) = PARAMETERS.iter().find(meant)?;
    names.iter().copied().find(|own| own == here)
}

/// The message about an operation of other tools that has no equivalent, and the expression that
/// comes nearest.
pub fn absent(name: &str) -> Option<[&'static str; 2]> {
    let name = plain(name);
    let (_, message, nearest) =
        ABSENT.iter().find(|(others, ..)| others.split(' ').any(|other| other == name))?;
    Some([message, nearest])
}

/// The blend that other tools mean by a number behind the operands of a union.
pub fn blend_of_width(width: &str) -> String {
    format!("smooth({width})")
}

/// The expression to write here for a name from another tool.
pub fn here(name: &str) -> Option<&'static str> {
    let name = plain(name);
    // Quilez's functions: sdSphere, opTwist.
    let bare = name.strip_prefix("sdf").or(name.strip_prefix("sd")).or(name.strip_prefix("op"));
    [Some(&name[..]), bare].into_iter().flatten().find_map(|name| {
        let row = ROWS.iter().find(|(_, others)| others.split(' ').any(|other| other == name));
        row.map(|(here, _)| *here)
    })
}

/// The kind of one of Quilez's functions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quilez {
    /// `sdSphere(p, r)`: its first argument is the point.
    Shape,
    /// `opRound(...)`.
    Operator,
}

/// The kind of the function with a name, if it is one of Quilez's: a prefix, then a capital.
pub fn quilez(name: &str) -> Option<Quilez> {
    let (kind, rest) = match (name.strip_prefix("sd").or(name.strip_prefix("ud")), name) {
        (Some(rest), _) => (Quilez::Shape, rest),
        (None, name) => (Quilez::Operator, name.strip_prefix("op")?),
    };
    let rest = rest.strip_prefix('_').unwrap_or(rest);
    let begins_a_word = rest.starts_with(|c: char| c.is_ascii_uppercase()) || name.contains('_');
    begins_a_word.then_some(kind)
}

/// The shape to write for one of Quilez's whose name without its prefix is that of something else
/// here: `cross` is a function of vectors.
pub fn of_quilez(name: &str) -> Option<&'static str> {
    quilez(name)?;
    let name = plain(name);
    let row = ROWS.iter().find(|(_, others)| others.split(' ').any(|other| other == name));
    row.map(|(here, _)| *here)
}

/// The name among `names` that differs only in capitals, underscores or the prefixes of Quilez's
/// functions. Among several it is the first in alphabetical order.
pub fn respelt<'n>(name: &str, names: &[&'n str]) -> Option<&'n str> {
    let name = plain(name);
    let bare = name.strip_prefix("sd").or(name.strip_prefix("op"));
    let same = |other: &&str| {
        let other = plain(other);
        other == name || Some(&other[..]) == bare
    };
    names.iter().copied().filter(same).min()
}

/// The name in lower case, without underscores.
fn plain(name: &str) -> String {
    name.chars().filter(|c| *c != '_').flat_map(char::to_lowercase).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reference;

    #[test]
    fn every_row_begins_with_a_known_name() {
        let entries = reference::entries();
        let known = ["a", "x", "0..n", "if", "[for", "fn", "let", "param", "import"];
        for (here, _) in ROWS.iter().filter(|(here, _)| !here.starts_with('#')) {
            let first = here.split([' ', '(']).next().unwrap_or_default();
            assert!(
                known.contains(&first) || entries.iter().any(|e| e.name == first),
                "unknown: {here}"
            );
        }
    }

    #[test]
    fn no_foreign_name_exists_here_or_appears_twice() {
        let entries = reference::entries();
        let mut all: Vec<&str> = ROWS.iter().flat_map(|(_, others)| others.split(' ')).collect();
        for name in &all {
            assert_eq!(plain(name), *name);
            // A clause, such as `intersect`, and a type are no names that a scene can call.
            let is_called = |kind: &str| !matches!(kind, "syntax" | "type");
            let mut names = entries.iter().filter(|entry| is_called(entry.kind));
            let is_free = names.all(|entry| plain(&entry.name) != *name);
            assert!(is_free, "`{name}` exists here now: remove it from the names of other tools");
        }
        let count = all.len();
        all.sort_unstable();
        all.dedup();
        assert_eq!(all.len(), count);
    }

    #[test]
    fn parameters_of_other_tools_are_known_where_they_have_an_equivalent() {
        assert_eq!(parameter("radius", &["r"]), Some("r"));
        assert_eq!(parameter("look_at", &["eye", "target"]), Some("target"));
        assert_eq!(parameter("height", &["size"]), None);
        let entries = reference::entries();
        let known = |name: &str| {
            entries.iter().any(|entry| {
                let (_, parameters) = entry.signature.split_once('(').unwrap_or_default();
                let mut words = parameters.split([' ', ',', ')', ':', '?']);
                words.any(|word| word == name)
            })
        };
        for (here, _) in PARAMETERS {
            assert!(known(here), "no entry has the parameter `{here}`");
        }
    }

    #[test]
    fn names_of_other_tools_are_known() {
        assert_eq!(here("cube"), Some("box"));
        assert_eq!(here("opSmoothUnion"), Some("union(a, b, blend: smooth(0.1))"));
        assert_eq!(here("linear_extrude"), Some("extrude"));
        assert_eq!(here("ln"), Some("log"));
        assert_eq!(here("teapot"), None);
        assert_eq!(of_quilez("sdCross"), Some("plus"));
        assert_eq!(of_quilez("sdSphere"), None);
        assert_eq!(quilez("udQuad"), Some(Quilez::Shape));
        assert_eq!(quilez("op_round"), Some(Quilez::Operator));
        assert_eq!([quilez("operate"), quilez("sdfc"), quilez("union")], [None; 3]);
        assert!(absent("hull").is_some_and(|[message, _]| message.contains("round_cone")));
        assert!(absent("minkowski").is_some_and(|[message, _]| message.contains("a.round(0.1)")));
        assert_eq!(absent("box"), None);
        // The two radii of a cone, in the order of Quilez's functions.
        assert_eq!(parameter("ra", &["a", "b", "r1", "r2"]), Some("r1"));
        assert_eq!(parameter("rb", &["a", "b", "r1", "r2"]), Some("r2"));
        let names = ["round_cone", "pi", "twist"];
        assert_eq!(respelt("sdRoundCone", &names), Some("round_cone"));
        assert_eq!(respelt("PI", &names), Some("pi"));
        assert_eq!(respelt("opTwist", &names), Some("twist"));
    }
}
