//! Tests of views.

use sdfc_graph::{Camera, Lens, Light, LightSource, March, Reflections, Shadow};
use sdfc_march::{SHADOW_HARD, SUN};

use super::*;

/// A program that has only settings.
#[derive(Default)]
struct Fixture(Program);

impl Fixture {
    fn new() -> Self {
        Self::default()
    }

    fn vec3(&mut self, v: [f64; 3]) -> NodeId {
        self.0.graph.constant(sdfc_graph::Type::Vec3, &v)
    }

    fn with_camera(eye: [f64; 3], target: [f64; 3], up: [f64; 3], degrees: f64) -> Self {
        let mut fixture = Self::new();
        let camera = Camera {
            eye: fixture.vec3(eye),
            target: fixture.vec3(target),
            up: fixture.vec3(up),
            lens: Lens::Fov(fixture.0.graph.number(degrees.to_radians())),
        };
        fixture.0.settings.camera = Some(camera);
        fixture
    }

    fn light(&mut self, direction: [f64; 3], shadow: Shadow) {
        let light = Light {
            source: LightSource::Sun { direction: self.vec3(direction) },
            color: self.vec3([1.0, 0.5, 0.25]),
            shadow,
        };
        self.0.settings.lights.push(light);
    }

    fn view(&self, bounds: Option<Bounds>, size: [u32; 2]) -> Result<View, ViewError> {
        View::new(&self.0, &FrameValues::default(), bounds, size)
    }
}

const UNIT: Bounds = [[-1.0; 3], [1.0; 3]];

fn close(a: DVec3, b: [f64; 3]) {
    assert!((a - DVec3::from(b)).length() < 1e-12, "{a} is not {b:?}");
}

#[test]
fn a_camera_on_z_sees_x_to_the_right_and_y_up() {
    let fixture = Fixture::with_camera([0.0, 0.0, 5.0], [0.0; 3], [0.0, 1.0, 0.0], 90.0);
    let view = fixture.view(None, [200, 100]).unwrap();
    close(view.forward, [0.0, 0.0, -1.0]);
    close(view.right, [2.0, 0.0, 0.0]);
    close(view.up, [0.0, 1.0, 0.0]);
    assert!((view.footprint().at(3.0) - 0.03).abs() < 1e-12);
    // The centre of the topmost left pixel is 0.99 of the way to the corner.
    let expected = DVec3::new(-1.99, 0.99, -1.0).normalize();
    close(view.ray(0, 0)[1], expected.to_array());
}

#[test]
fn a_view_shifted_by_a_pixel_sees_what_the_next_pixel_saw() {
    let fixture = Fixture::with_camera([1.0, 2.0, 5.0], [0.0; 3], [0.0, 1.0, 0.0], 50.0);
    let view = fixture.view(None, [20, 10]).unwrap();
    close(view.shifted([1.0, 0.0]).ray(4, 7)[1], view.ray(5, 7)[1].to_array());
    close(view.shifted([-2.0, 3.0]).ray(4, 6)[1], view.ray(2, 9)[1].to_array());
    assert_eq!(view.shifted([0.0, 0.0]), view);
}

#[test]
fn looking_along_up_keeps_a_right_handed_basis() {
    for eye in [[0.0, 5.0, 0.0], [0.0, -5.0, 0.0]] {
        let fixture = Fixture::with_camera(eye, [0.0; 3], [0.0, 1.0, 0.0], 60.0);
        let view = fixture.view(None, [10, 10]).unwrap();
        let [right, up] = [view.right.normalize(), view.up.normalize()];
        close(right.cross(up), (-view.forward).to_array());
        close(right, [1.0, 0.0, 0.0]);
    }
    let above = Fixture::with_camera([0.0, 5.0, 0.0], [0.0; 3], [0.0, 1.0, 0.0], 60.0);
    close(above.view(None, [10, 10]).unwrap().up.normalize(), [0.0, 0.0, -1.0]);
    let zero = Fixture::with_camera([0.0, 0.0, 5.0], [0.0; 3], [0.0; 3], 60.0);
    close(zero.view(None, [10, 10]).unwrap().up.normalize(), [0.0, 1.0, 0.0]);
}

#[test]
fn a_fitted_camera_has_the_whole_box_in_the_picture() {
    for (bounds, size) in [
        (UNIT, [100, 100]),
        (UNIT, [30, 200]),
        ([[2.0, -7.0, 0.0], [9.0, -6.0, 0.5]], [320, 200]),
        ([[3.0; 3], [3.0; 3]], [10, 10]),
    ] {
        let view = Fixture::new().view(Some(bounds), size).unwrap();
        for corner in 0..8 {
            let pick = |axis: usize| bounds[(corner >> axis) & 1][axis];
            let offset = DVec3::new(pick(0), pick(1), pick(2)) - view.eye;
            let depth = offset.dot(view.forward);
            assert!(depth > 0.0 && offset.length() <= view.t_max, "{bounds:?}");
            for half in [view.right, view.up] {
                let place = offset.dot(half) / half.length_squared() / depth;
                assert!(place.abs() < 1.0, "{bounds:?}: {place}");
            }
        }
    }
}

#[test]
fn limits_are_the_scenes_or_follow_from_bounds_and_camera() {
    let camera = || Fixture::with_camera([0.0, 0.0, 5.0], [0.0; 3], [0.0, 1.0, 0.0], 60.0);
    let derived = camera().view(Some(UNIT), [10, 10]).unwrap();
    let corner = DVec3::new(1.0, 1.0, 6.0).length();
    assert!((derived.t_max - corner * 1.01).abs() < 1e-12);
    assert!((derived.epsilon - 2.5e-4).abs() < 1e-12);
    assert_eq!(camera().view(None, [10, 10]).unwrap().t_max, 1000.0);

    let mut stated = camera();
    stated.0.settings.march = March {
        steps: Some(50),
        epsilon: Some(0.01),
        tolerance: Some(0.5),
        distance: Some(20.0),
        method: None,
    };
    let stated = stated.view(Some(UNIT), [10, 10]).unwrap();
    assert_eq!((stated.steps, stated.epsilon), (50, 0.01));
    assert_eq!((stated.tolerance, stated.t_max), (0.5, 20.0));
}

#[test]
fn settings_that_make_no_picture_are_errors() {
    let error = |fixture: &Fixture| fixture.view(None, [10, 10]).unwrap_err();
    let camera = |eye, fov| Fixture::with_camera(eye, [0.0; 3], [0.0, 1.0, 0.0], fov);
    assert_eq!(error(&camera([0.0; 3], 60.0)), ViewError::EyeIsTarget([0.0; 3]));
    assert!(matches!(error(&camera([1.0; 3], 180.0)), ViewError::Fov(_)));
    assert!(matches!(error(&camera([1.0; 3], -1.0)), ViewError::Fov(_)));
    assert!(matches!(error(&camera([1.0; 3], f64::NAN)), ViewError::Fov(_)));
    assert!(matches!(error(&camera([f64::INFINITY; 3], 60.0)), ViewError::NotFinite(_)));

    let mut fixture = Fixture::new();
    fixture.light([0.0; 3], Shadow::Off);
    assert_eq!(error(&fixture), ViewError::LightDirection);
    let mut fixture = Fixture::new();
    (0..=MAX_LIGHTS).for_each(|_| fixture.light([0.0, 1.0, 0.0], Shadow::Off));
    assert_eq!(error(&fixture), ViewError::TooManyLights(MAX_LIGHTS + 1));

    let mut fixture = Fixture::new();
    let strength = fixture.0.graph.number(1.5);
    fixture.0.settings.reflections = Some(Reflections { count: 1, strength });
    assert_eq!(error(&fixture), ViewError::NotShare("the strength of reflections", 1.5));

    let mut fixture = Fixture::new();
    fixture.0.settings.march.distance = Some(-3.0);
    assert_eq!(error(&fixture), ViewError::NotPositive("march's distance", -3.0));
    fixture.0.settings.march = March { steps: Some(0), ..March::default() };
    assert_eq!(error(&fixture), ViewError::NotPositive("march's steps", 0.0));
}

#[test]
fn without_lights_there_is_one_at_the_camera() {
    let mut fixture = Fixture::with_camera([0.0, 0.0, 5.0], [0.0; 3], [0.0, 1.0, 0.0], 60.0);
    let view = fixture.view(None, [10, 10]).unwrap();
    assert_eq!(view.lights.len(), 1);
    assert_eq!(view.lights[0].source, ViewSource::Sun(DVec3::Z));

    fixture.light([0.0, 3.0, 0.0], Shadow::Hard);
    let tile = Tile { origin: [4, 2], size: [3, 1] };
    let block = fixture.view(None, [10, 10]).unwrap().block(tile);
    assert_eq!(block.light_count, 1);
    assert_eq!((block.lights[0].position, block.lights[0].kind), ([0.0, 1.0, 0.0], SUN));
    assert_eq!(block.lights[0].color, [1.0, 0.5, 0.25]);
    assert_eq!(block.lights[0].shadow, SHADOW_HARD);
    assert_eq!((block.tile_origin, block.tile_size), ([4, 2], [3, 1]));
}
