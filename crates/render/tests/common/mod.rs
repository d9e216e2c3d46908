//! Small programs built by hand, and the views of the tests.
#![allow(dead_code, reason = "each test target uses some of them")]
#![allow(clippy::unwrap_used, reason = "a test that cannot be set up fails")]

use sdfc_graph::{
    Camera, Dim, Fog, FrameInput, Graph, Lens, Light, LightSource, NodeId, Occlusion, Param,
    ParamKind, Program, Reflections, Shadow, Sky, Type, Unary, best_gradient, eval::FrameValues,
};
use sdfc_render::{Bounds, View};

/// Distance and gradient in a graph under construction.
struct Field {
    distance: NodeId,
    gradient: NodeId,
}

fn point(graph: &mut Graph) -> NodeId {
    graph.point(0, Dim::Three)
}

fn sphere_field(graph: &mut Graph, center: [f64; 3], radius: f64) -> Field {
    let (p, center) = (point(graph), graph.constant(Type::Vec3, &center));
    let offset = graph.sub(p, center);
    let (length, radius) = (graph.length(offset), graph.number(radius));
    let distance = graph.sub(length, radius);
    Field { distance, gradient: graph.unary(Unary::Normalize, offset) }
}

fn floor_field(graph: &mut Graph, height: f64) -> Field {
    let (p, height) = (point(graph), graph.number(height));
    let y = graph.component(p, 1);
    let distance = graph.sub(y, height);
    Field { distance, gradient: graph.constant(Type::Vec3, &[0.0, 1.0, 0.0]) }
}

fn program(build: impl FnOnce(&mut Graph) -> Field) -> Program {
    let mut program = Program::default();
    let field = build(&mut program.graph);
    program.distance = Some(field.distance);
    program.gradient = Some(field.gradient);
    program
}

/// A program with a distance only.
pub fn program_of(build: impl FnOnce(&mut Graph, NodeId) -> NodeId) -> Program {
    let mut program = Program::default();
    let p = point(&mut program.graph);
    program.distance = Some(build(&mut program.graph, p));
    program
}

/// A unit sphere around the origin, seen from [0, 0, 5] with 40 degrees.
pub fn sphere() -> Program {
    let mut program = program(|graph| sphere_field(graph, [0.0; 3], 1.0));
    look_from(&mut program, [0.0, 0.0, 5.0]);
    program
}

/// A unit sphere above a floor at -1, a light overhead that casts shadows, some ambient light.
pub fn sphere_above_floor() -> Program {
    let mut program = program(|graph| {
        let (sphere, floor) = (sphere_field(graph, [0.0, 0.5, 0.0], 1.0), floor_field(graph, -1.0));
        let nearer = graph.le(sphere.distance, floor.distance);
        Field {
            distance: graph.min(sphere.distance, floor.distance),
            gradient: graph.select(nearer, sphere.gradient, floor.gradient),
        }
    });
    look_from(&mut program, [1.0, 1.0, 5.0]);
    let graph = &mut program.graph;
    let light = Light {
        source: LightSource::Sun { direction: graph.constant(Type::Vec3, &[0.0, 1.0, 0.0]) },
        color: graph.constant(Type::Vec3, &[1.0, 0.5, 0.25]),
        shadow: Shadow::Hard,
    };
    program.settings.ambient = Some(graph.constant(Type::Vec3, &[0.1; 3]));
    program.settings.background = Some(graph.constant(Type::Vec3, &[0.0, 0.0, 1.0]));
    program.settings.lights.push(light);
    program
}

/// The same scene, every surface a mirror of half the light.
pub fn mirrors() -> Program {
    let mut program = sphere_above_floor();
    let strength = program.graph.number(0.5);
    program.settings.reflections = Some(Reflections { count: 1, strength });
    program
}

/// The same scene with a soft shadow.
pub fn soft_shadow(sharpness: f64) -> Program {
    let mut program = sphere_above_floor();
    let sharpness = program.graph.number(sharpness);
    for light in &mut program.settings.lights {
        light.shadow = Shadow::Soft(sharpness);
    }
    program
}

/// The sphere and the floor under a point light.
pub fn point_light(position: [f64; 3], strength: f64, shadow: Shadow) -> Program {
    let mut program = sphere_above_floor();
    let graph = &mut program.graph;
    let source = LightSource::Point { position: graph.constant(Type::Vec3, &position) };
    let color = graph.constant(Type::Vec3, &[strength; 3]);
    program.settings.lights = vec![Light { source, color, shadow }];
    program
}

/// A floor at -1 and a ceiling at 1, with a point light close below the ceiling.
pub fn light_at_ceiling(position: [f64; 3], shadow: Shadow) -> Program {
    let mut program = program(|graph| {
        let floor = floor_field(graph, -1.0);
        let (p, one) = (point(graph), graph.number(1.0));
        let height = graph.swizzle(p, &[1]);
        let ceiling = graph.sub(one, height);
        let down = graph.constant(Type::Vec3, &[0.0, -1.0, 0.0]);
        let nearer = graph.le(floor.distance, ceiling);
        Field {
            distance: graph.min(floor.distance, ceiling),
            gradient: graph.select(nearer, floor.gradient, down),
        }
    });
    look_from(&mut program, [0.0, 0.0, 5.0]);
    let graph = &mut program.graph;
    let source = LightSource::Point { position: graph.constant(Type::Vec3, &position) };
    let color = graph.constant(Type::Vec3, &[1.0; 3]);
    program.settings.lights = vec![Light { source, color, shadow }];
    program
}

/// The sphere and the floor in fog, under a sky.
pub fn foggy(density: f64) -> Program {
    let mut program = sphere_above_floor();
    let graph = &mut program.graph;
    let [zenith, horizon] =
        [[0.0, 0.0, 1.0], [1.0, 1.0, 1.0]].map(|color| graph.constant(Type::Vec3, &color));
    program.settings.sky = Some(Sky { zenith, horizon, ground: None });
    program.settings.fog = Some(Fog { density: graph.number(density), color: None });
    program
}

/// The sphere and the floor without the light, the distance written twice as large.
pub fn occluded(radius: f64) -> Program {
    let mut program = sphere_above_floor();
    let graph = &mut program.graph;
    let two = graph.number(2.0);
    program.distance = program.distance.map(|distance| graph.mul(distance, two));
    program.gradient = program.gradient.map(|gradient| graph.mul(gradient, two));
    program.settings.lights[0].color = graph.constant(Type::Vec3, &[0.0; 3]);
    program.settings.ambient = Some(graph.constant(Type::Vec3, &[1.0; 3]));
    let (radius, strength) = (Some(graph.number(radius)), graph.number(1.0));
    program.settings.occlusion = Some(Occlusion { radius, strength });
    program
}

/// The unit sphere seen by parallel rays, in a picture of this height.
pub fn parallel(height: f64) -> Program {
    let mut program = sphere();
    let height = program.graph.number(height);
    if let Some(camera) = &mut program.settings.camera {
        camera.lens = Lens::Height(height);
    }
    program
}

/// The unit sphere with a red material, half reflecting.
pub fn sphere_with_material() -> Program {
    let mut program = sphere();
    let graph = &mut program.graph;
    let red = graph.constant(Type::Vec3, &[0.8, 0.1, 0.1]);
    let black = graph.constant(Type::Vec3, &[0.0; 3]);
    let [one, half, third] = [1.0, 0.5, 0.3].map(|value| graph.number(value));
    program.material = Some([red, one, third, half, black, one]);
    program
}

/// The unit sphere with an overestimated distance, so that rays step through the surface.
pub fn steep_sphere() -> Program {
    let mut program = sphere();
    let factor = program.graph.number(1.2);
    program.distance = program.distance.map(|distance| program.graph.mul(distance, factor));
    program
}

/// Two hundred spheres in a ball, seen from [0, 0, 5], with a shadow: a formula of over a thousand
/// operations, of which a few matter at each point. `steepness` multiplies the field.
pub fn crowd(steepness: f64) -> Program {
    crowd_of(|graph, distance| {
        let steepness = graph.number(steepness);
        graph.mul(distance, steepness)
    })
}

/// The same spheres, larger by a tenth of the time.
pub fn swelling_crowd() -> Program {
    crowd_of(|graph, distance| {
        let (time, tenth) = (graph.frame_input(FrameInput::Time, Type::Scalar), graph.number(0.1));
        let growth = graph.mul(time, tenth);
        graph.sub(distance, growth)
    })
}

fn crowd_of(change: impl FnOnce(&mut Graph, NodeId) -> NodeId) -> Program {
    let mut program = Program::default();
    let graph = &mut program.graph;
    let p = point(graph);
    let mut distance = graph.number(100.0);
    for i in 0..200 {
        // Points of a spiral, evenly spread over the ball.
        let part = (f64::from(i) + 0.5) / 200.0;
        let (height, turn) = (1.0 - 2.0 * part, 2.399963 * f64::from(i));
        let (radius, aside) = (part.cbrt(), (1.0 - height * height).sqrt());
        let center = [aside * turn.cos(), height, aside * turn.sin()].map(|x| radius * x);
        let sphere = sphere_field(graph, center, 0.05 + 0.03 * part).distance;
        distance = graph.min(distance, sphere);
    }
    distance = change(graph, distance);
    let (gradient, _) = best_gradient(graph, distance, p);
    (program.distance, program.gradient) = (Some(distance), Some(gradient));
    look_from(&mut program, [0.0, 0.0, 5.0]);
    let graph = &mut program.graph;
    program.settings.lights.push(Light {
        source: LightSource::Sun { direction: graph.constant(Type::Vec3, &[0.0, 1.0, 0.0]) },
        color: graph.constant(Type::Vec3, &[1.0; 3]),
        shadow: Shadow::Hard,
    });
    program
}

/// A sphere whose radius is a param, 1 by default.
pub fn sphere_of_param() -> Program {
    let mut program = sphere();
    let graph = &mut program.graph;
    let radius = graph.frame_input(FrameInput::Param(0), Type::Scalar);
    let p = point(graph);
    let length = graph.length(p);
    program.distance = Some(graph.sub(length, radius));
    program.uniforms = vec![radius];
    program.params.push(Param {
        name: "radius".to_owned(),
        kind: ParamKind::Number,
        ty: Type::Scalar,
        default: [1.0, 0.0, 0.0, 0.0],
        fixed: None,
        range: None,
        choices: Vec::new(),
        summary: String::new(),
    });
    program
}

/// The unit sphere, whose distance is NaN where x is negative.
pub fn half_undefined() -> Program {
    let mut program = sphere();
    let graph = &mut program.graph;
    let p = point(graph);
    let x = graph.component(p, 0);
    let (root, little) = (graph.unary(Unary::Sqrt, x), graph.number(1e-9));
    let nothing = graph.mul(root, little);
    program.distance = program.distance.map(|distance| graph.add(distance, nothing));
    program
}

fn look_from(program: &mut Program, eye: [f64; 3]) {
    let graph = &mut program.graph;
    program.settings.camera = Some(Camera {
        eye: graph.constant(Type::Vec3, &eye),
        target: graph.constant(Type::Vec3, &[0.0; 3]),
        up: graph.constant(Type::Vec3, &[0.0, 1.0, 0.0]),
        lens: Lens::Fov(graph.number(40f64.to_radians())),
    });
}

/// Bounds of the unit sphere.
pub const UNIT: Bounds = [[-1.0; 3], [1.0; 3]];

/// The view of a program's first frame.
pub fn view(program: &Program, size: [u32; 2]) -> View {
    View::new(program, &FrameValues::default(), None, size).unwrap()
}

/// Distance from [0, 0, 5] to the unit sphere along a ray; `None` if it misses.
pub fn depth_of_sphere(view: &View, x: u32, y: u32) -> Option<f64> {
    let [_, direction] = view.ray(x, y);
    let along = -view.eye.dot(direction);
    let square = along * along - (view.eye.length_squared() - 1.0);
    (square >= 0.0).then(|| along - square.sqrt())
}
