//! A finished picture as colours for the screen: shaded, or what its rays met and what that cost. Each view
//! is a function of the picture and, where it says so, of the field at the places that the picture shows.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::LazyLock;

use glam::DVec3;
use sdfc::graph::ShapeId;
use sdfc::graph::eval::Dual;
use sdfc::march::PixelBlock;
use sdfc::render::{CAPPED, EvaluationCounts, HIT, Image, View, is_finite, linear_to_srgb8};
use sdfc::{FrameValues, Scene};

use crate::identity::{Quality, Shapes};
use crate::legend::{Legend, Ramp, mix};
use crate::material::{Material, Materials};
use crate::mode::{Mode, Slice};
use crate::probe::Probe;

const ALARM: [u8; 3] = [255, 64, 129];
const NOTICE: [u8; 3] = [255, 193, 7];
const BROKEN: [u8; 3] = [0, 229, 255];
const FINE: [u8; 3] = [76, 175, 80];
const NOTHING: [u8; 3] = [24, 26, 30];
const INSIDE: [u8; 3] = [224, 122, 63];
const OUTSIDE: [u8; 3] = [58, 124, 165];
/// Of a pixel's width: where a ray must not be deeper inside.
const QUARTER: f64 = 0.25;
/// So many of all hits are at most as far away as what is darkest.
const FAR_SHARE: f64 = 0.9;
/// Lines of a legend.
const MOST_KEYS: usize = 12;

/// What a view is made from.
#[derive(Clone, Copy, Debug)]
pub struct Seen<'a> {
    /// Colours, averaged over samples.
    pub colors: &'a Image,
    /// Depths, ends and counts of one ray a pixel.
    pub image: &'a Image,
    /// The rays.
    pub view: &'a View,
    /// The field.
    pub probe: &'a Probe,
    /// The scene.
    pub scene: &'a Scene,
    /// Its shapes.
    pub shapes: &'a Shapes,
    /// The frame's values.
    pub frame: &'a FrameValues,
    /// The plane of [`Mode::Slice`].
    pub slice: Slice,
    /// Where in the scene the rays and the field count from.
    pub origin: [f64; 3],
}

/// Red, green, blue, alpha of each pixel in sRGB, and what they mean.
pub fn paint(mode: Mode, seen: Seen<'_>) -> (Vec<u8>, Legend) {
    match mode {
        Mode::Shaded => (seen.each(|_, pixel| shaded(pixel)), Legend::None),
        Mode::Normals => seen.normals(),
        Mode::Depth => seen.depth(),
        Mode::Evaluations => seen.evaluations(),
        Mode::Capped => seen.capped(),
        Mode::Overshoot => seen.overshoot(),
        Mode::Slope => seen.slope(),
        Mode::Shapes => seen.shapes(),
        Mode::Materials => seen.materials(),
        Mode::Quality => seen.quality(),
        Mode::Slice => seen.slice(),
    }
}

impl Seen<'_> {
    fn each(&self, color: impl Fn(usize, &PixelBlock) -> [u8; 3]) -> Vec<u8> {
        let mut out = Vec::with_capacity(self.colors.pixels().len() * 4);
        for (index, pixel) in self.colors.pixels().iter().enumerate() {
            let [red, green, blue] = color(index, pixel);
            out.extend([red, green, blue, 255]);
        }
        out
    }

    fn ray(&self, index: usize) -> [DVec3; 2] {
        let columns = self.image.size()[0].max(1) as usize;
        self.view.ray((index % columns) as u32, (index / columns) as u32)
    }

    /// Where rays met something.
    fn hits(&self) -> Vec<Option<[f64; 3]>> {
        let point = |(index, pixel): (usize, &PixelBlock)| {
            let [start, direction] = self.ray(index);
            let hit = pixel.status == HIT && pixel.depth.is_finite();
            hit.then(|| (start + direction * f64::from(pixel.depth)).to_array())
        };
        self.image.pixels().iter().enumerate().map(point).collect()
    }

    /// The field there.
    fn at_hits(&self) -> Vec<Option<Dual>> {
        self.probe.at_all(self.frame, &self.hits())
    }

    fn normals(&self) -> (Vec<u8>, Legend) {
        let fields = self.at_hits();
        let color = |index: usize, _: &PixelBlock| match fields[index] {
            Some(field) => {
                let normal = DVec3::from(field.partials).normalize_or_zero();
                normal.to_array().map(|lane| ((lane * 0.5 + 0.5) * 255.0).round() as u8)
            }
            None => NOTHING,
        };
        (self.each(color), Legend::None)
    }

    fn depth(&self) -> (Vec<u8>, Legend) {
        let hits = self.image.pixels().iter().filter(|it| it.status == HIT);
        let mut depths: Vec<f32> = hits.map(|it| it.depth).collect();
        depths.sort_by(f32::total_cmp);
        // A floor goes so far that all that stands on it would be one grey.
        let at = |share: f64| depths.get((depths.len() as f64 * share) as usize).copied();
        let [near, far] = [0.0, FAR_SHARE].map(|share| f64::from(at(share).unwrap_or_default()));
        let color = |index: usize, _: &PixelBlock| match self.image.pixels()[index] {
            PixelBlock { status: HIT, depth, .. } => {
                Ramp::Grey.color((f64::from(depth) - near) / (far - near).max(1e-12))
            }
            _ => NOTHING,
        };
        let label = "length of the ray, up to the 90th percentile";
        (self.each(color), Legend::Scale { label, ends: [near, far], ramp: Ramp::Grey })
    }

    fn evaluations(&self) -> (Vec<u8>, Legend) {
        let most = EvaluationCounts::of(self.image).p99.max(1);
        let color = |index: usize, _: &PixelBlock| {
            let count = self.image.pixels()[index].evaluations;
            Ramp::Heat.color(f64::from(count) / f64::from(most))
        };
        let label = "evaluations a pixel, up to the 99th percentile";
        let ends = [0.0, f64::from(most)];
        (self.each(color), Legend::Scale { label, ends, ramp: Ramp::Heat })
    }

    fn capped(&self) -> (Vec<u8>, Legend) {
        let color = |index: usize, shown: &PixelBlock| {
            let pixel = &self.image.pixels()[index];
            match pixel.status {
                _ if !is_finite(pixel) => BROKEN,
                CAPPED => ALARM,
                _ => dimmed(shaded(shown)),
            }
        };
        let counts = self.image.counts();
        let keys = vec![
            (ALARM, format!("out of steps: {}", counts.capped)),
            (BROKEN, format!("no number: {}", counts.nan)),
        ];
        (self.each(color), Legend::Keys(keys))
    }

    fn overshoot(&self) -> (Vec<u8>, Legend) {
        let fields = self.at_hits();
        let how = |index: usize| {
            let field = fields[index]?;
            let width = f64::from(self.image.pixel_width(self.image.pixels()[index].depth));
            Some(match field.value / width.max(1e-300) {
                depth if depth < -QUARTER => ALARM,
                gap if gap > QUARTER => NOTICE,
                _ => FINE,
            })
        };
        let color = |index: usize, shown: &PixelBlock| match how(index) {
            Some(FINE) => mix(dimmed(shaded(shown)), FINE, 0.25),
            Some(found) => found,
            None => NOTHING,
        };
        let count = |which| (0..fields.len()).filter(|index| how(*index) == Some(which)).count();
        let keys = vec![
            (ALARM, format!("through the surface: {}", count(ALARM))),
            (NOTICE, format!("stopped short of it: {}", count(NOTICE))),
            (FINE, "within a quarter of a pixel".to_owned()),
        ];
        (self.each(color), Legend::Keys(keys))
    }

    fn slope(&self) -> (Vec<u8>, Legend) {
        let fields = self.at_hits();
        let color = |index: usize, _: &PixelBlock| match fields[index] {
            Some(field) => Ramp::Balance.color(DVec3::from(field.partials).length() / 2.0),
            None => NOTHING,
        };
        let label = "length of the gradient";
        (self.each(color), Legend::Scale { label, ends: [0.0, 2.0], ramp: Ramp::Balance })
    }

    fn shapes(&self) -> (Vec<u8>, Legend) {
        let identity = self.shapes.leaves(self.scene);
        let places = identity.at(self.frame, &self.hits());
        let label = |place: usize| self.shapes.label(self.scene, identity.shapes()[place]);
        (self.keyed(&places, own_color), self.most_seen(&places, own_color, label))
    }

    fn materials(&self) -> (Vec<u8>, Legend) {
        let found = Materials::new(self.scene.drawn()).at(self.frame, &self.hits());
        let kinds: BTreeSet<Material> = found.iter().flatten().copied().collect();
        let kinds: Vec<Material> = kinds.into_iter().collect();
        let numbers: Vec<Option<usize>> =
            found.iter().map(|it| it.and_then(|it| kinds.binary_search(&it).ok())).collect();
        let color = |index: usize, _: &PixelBlock| match found[index] {
            Some(material) => material.color,
            None => NOTHING,
        };
        let legend = self.most_seen(&numbers, |kind| kinds[kind].color, |kind| kinds[kind].text());
        (self.each(color), legend)
    }

    fn quality(&self) -> (Vec<u8>, Legend) {
        let identity = self.shapes.parts(self.scene);
        let places = identity.at(self.frame, &self.hits());
        let quality = |part: &ShapeId| Quality::of(self.scene, *part) as usize;
        let qualities: Vec<usize> = identity.shapes().iter().map(quality).collect();
        let kinds: Vec<_> =
            places.iter().map(|place| place.map(|place| qualities[place])).collect();
        let color = |kind: usize| [FINE, OUTSIDE, NOTICE, ALARM][kind];
        let names = ["the distance", "a bound", "a bound, divided by a constant", "uncertified"];
        let legend = self.most_seen(&kinds, color, |kind| names[kind].to_owned());
        (self.keyed(&kinds, color), legend)
    }

    /// A colour for each number, under the light of the picture.
    fn keyed(&self, numbers: &[Option<usize>], color: impl Fn(usize) -> [u8; 3]) -> Vec<u8> {
        self.each(|index, shown| match numbers[index] {
            Some(number) => {
                let [red, green, blue] = shaded(shown).map(f64::from);
                let light = (0.3 * red + 0.59 * green + 0.11 * blue) / 255.0;
                mix([0; 3], color(number), 0.45 + 0.55 * light)
            }
            None => NOTHING,
        })
    }

    /// The numbers that most pixels have.
    fn most_seen(
        &self,
        numbers: &[Option<usize>],
        color: impl Fn(usize) -> [u8; 3],
        label: impl Fn(usize) -> String,
    ) -> Legend {
        let mut counts: BTreeMap<usize, usize> = BTreeMap::new();
        for number in numbers.iter().flatten() {
            *counts.entry(*number).or_default() += 1;
        }
        let mut most: Vec<(usize, usize)> = counts.into_iter().collect();
        most.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
        most.truncate(MOST_KEYS);
        Legend::Keys(most.into_iter().map(|(number, _)| (color(number), label(number))).collect())
    }

    fn slice(&self) -> (Vec<u8>, Legend) {
        let Slice { axis, offset, spacing, over } = self.slice;
        let axis = axis.min(2);
        let point = |(index, pixel): (usize, &PixelBlock)| {
            let [start, direction] = self.ray(index);
            let t = (offset - self.origin[axis] - start[axis]) / direction[axis];
            let behind = !over && pixel.status == HIT && f64::from(pixel.depth) < t;
            (t.is_finite() && t > 0.0 && t < self.view.t_max && !behind)
                .then(|| ((start + direction * t).to_array(), t))
        };
        let places: Vec<_> = self.image.pixels().iter().enumerate().map(point).collect();
        let points: Vec<_> = places.iter().map(|place| place.map(|(point, _)| point)).collect();
        let fields = self.probe.at_all(self.frame, &points);
        let color = |index: usize, shown: &PixelBlock| match (fields[index], places[index]) {
            (Some(field), Some((_, t))) => {
                let width = f64::from(self.image.pixel_width(t as f32));
                mix(shaded(shown), isolines(field, spacing, width), 0.85)
            }
            _ => shaded(shown),
        };
        let keys = vec![
            (INSIDE, "inside".to_owned()),
            (OUTSIDE, "outside".to_owned()),
            ([235, 235, 235], format!("a line every {spacing}")),
        ];
        (self.each(color), Legend::Keys(keys))
    }
}

/// Neighbours in the list have hues far from each other: the golden angle apart.
fn own_color(number: usize) -> [u8; 3] {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    let hue = (number as f64 * GOLDEN).fract() * 6.0;
    let value = if number.is_multiple_of(2) { 250.0 } else { 205.0 };
    [0.0, 4.0, 2.0].map(|shift| {
        let part = ((hue + shift) % 6.0 - 3.0).abs() - 1.0;
        (value * (0.3 + 0.7 * part.clamp(0.0, 1.0))) as u8
    })
}

/// The colour of a value on the slice: by side, darker away from the surface, with a line at each multiple
/// of `spacing` and a strong one at 0, about a pixel wide.
fn isolines(field: Dual, spacing: f64, pixel: f64) -> [u8; 3] {
    let value = field.value;
    if !value.is_finite() {
        return BROKEN;
    }
    let side = if value < 0.0 { INSIDE } else { OUTSIDE };
    let base = mix(side, [18, 20, 24], (value.abs() / (spacing * 12.0)).min(0.75));
    let per_pixel = DVec3::from(field.partials).length().max(1e-9) * pixel;
    let to_line = (value / spacing - (value / spacing).round()).abs() * spacing / per_pixel;
    let is_surface = value.abs() < spacing / 2.0;
    let (line, strength, half) =
        if is_surface { ([255, 255, 255], 1.0, 1.2) } else { ([235, 235, 235], 0.45, 0.5) };
    // Lines closer than their width would be a grey without meaning.
    let room = (spacing / per_pixel / 4.0).min(1.0);
    mix(base, line, strength * room * (half + 0.5 - to_line).clamp(0.0, 1.0))
}

/// sRGB of linear light by table: a view is repainted often, and a power for each channel takes longer than
/// all the rest. The step is a fifth of a level where the curve is steepest.
fn shaded(pixel: &PixelBlock) -> [u8; 3] {
    const STEPS: usize = 1 << 14;
    static TABLE: LazyLock<Vec<u8>> = LazyLock::new(|| {
        (0..=STEPS).map(|step| linear_to_srgb8(step as f32 / STEPS as f32)).collect()
    });
    let [red, green, blue, _] = pixel.color;
    // `as` saturates, and makes 0 of NaN.
    [red, green, blue].map(|light| {
        let step = (light * STEPS as f32 + 0.5) as usize;
        TABLE[step.min(STEPS)]
    })
}

fn dimmed(color: [u8; 3]) -> [u8; 3] {
    let [red, green, blue] = color.map(u32::from);
    let grey = ((red * 54 + green * 183 + blue * 19) / 256) as u8;
    mix([grey; 3], [0; 3], 0.45)
}

#[cfg(test)]
mod tests {
    use super::*;
    use sdfc::render::{CpuScene, RenderOptions, no_progress};

    const SIZE: [u32; 2] = [32, 24];

    fn painted(text: &str, mode: Mode, change: impl Fn(&mut Image)) -> (Vec<[u8; 3]>, Legend) {
        let scene = sdfc::compile("a", text).scene.unwrap();
        let frame = FrameValues::defaults(scene.params());
        let program = scene.program();
        let view = View::new(program, &frame, scene.bounds_at(&frame), SIZE).unwrap();
        let cpu = CpuScene::new(program).unwrap();
        let options = RenderOptions::default();
        let mut image =
            cpu.render(&view, &frame, "auto", &options, &mut no_progress).unwrap().image;
        change(&mut image);
        let probe = Probe::new(program);
        let slice = Slice::default();
        let (image, view, frame) = (&image, &view, &frame);
        let origin = program.origin;
        let (scene, shapes) = (&scene, &Shapes::default());
        let probe = &probe;
        let seen = Seen { colors: image, image, view, probe, scene, shapes, frame, slice, origin };
        let (bytes, legend) = paint(mode, seen);
        (bytes.chunks_exact(4).map(|it| [it[0], it[1], it[2]]).collect(), legend)
    }

    const BALL: &str = "sphere(1)\ncamera(eye: [0, 0, 5], target: [0, 0, 0], fov: 40deg)";
    const MIDDLE: usize = 12 * 32 + 16;

    #[test]
    fn the_shaded_view_is_that_of_a_file() {
        let scene = sdfc::compile("a", BALL).scene.unwrap();
        let options =
            sdfc::PictureOptions { size: SIZE, backend: sdfc::Backend::Cpu, ..Default::default() };
        let expected = scene.render(&options, &mut sdfc::no_progress).unwrap().image.to_srgb8();
        let (colors, _) = painted(BALL, Mode::Shaded, |_| {});
        for (color, expected) in colors.iter().flatten().zip(expected) {
            assert!(color.abs_diff(expected) <= 1, "{color} {expected}");
        }
    }

    #[test]
    fn normals_point_at_the_viewer_in_the_middle() {
        let (colors, _) = painted(BALL, Mode::Normals, |_| {});
        let [red, green, blue] = colors[MIDDLE];
        assert!(red.abs_diff(128) < 12 && green.abs_diff(128) < 12 && blue > 250, "{red} {green}");
        assert_eq!(colors[0], NOTHING);
    }

    #[test]
    fn depth_is_lightest_where_it_is_nearest() {
        let (colors, legend) = painted(BALL, Mode::Depth, |_| {});
        assert!(colors[MIDDLE][0] > 240);
        let Legend::Scale { ends: [near, far], .. } = legend else { panic!("{legend:?}") };
        assert!((near - 4.0).abs() < 0.05 && far > 4.2 && far < 5.0, "{near} {far}");
    }

    #[test]
    fn what_ran_out_of_steps_or_is_no_number_stands_out_and_is_counted() {
        let (colors, legend) = painted(BALL, Mode::Capped, |image| {
            image.pixels_mut()[0].status = CAPPED;
            image.pixels_mut()[1].color[1] = f32::NAN;
        });
        assert_eq!((colors[0], colors[1]), (ALARM, BROKEN));
        assert!(colors.iter().skip(2).all(|color| ![ALARM, BROKEN].contains(color)));
        let Legend::Keys(keys) = legend else { panic!("{legend:?}") };
        assert!(keys.iter().all(|(_, text)| text.ends_with(": 1")), "{keys:?}");
    }

    #[test]
    fn a_ray_that_stopped_inside_is_an_alarm() {
        let (colors, _) = painted(BALL, Mode::Overshoot, |_| {});
        assert!(!colors.contains(&ALARM) && !colors.contains(&NOTICE));
        let (colors, _) = painted(BALL, Mode::Overshoot, |image| {
            image.pixels_mut()[MIDDLE].depth += 0.5;
            image.pixels_mut()[MIDDLE + 1].depth -= 0.5;
        });
        assert_eq!((colors[MIDDLE], colors[MIDDLE + 1]), (ALARM, NOTICE));
    }

    #[test]
    fn a_distance_has_a_gradient_of_length_1() {
        let (colors, _) = painted(BALL, Mode::Slope, |_| {});
        assert_eq!(colors[MIDDLE], Ramp::Balance.color(0.5));
    }

    #[test]
    fn evaluations_reach_the_end_of_the_scale() {
        let (colors, legend) = painted(BALL, Mode::Evaluations, |image| {
            for (index, pixel) in image.pixels_mut().iter_mut().enumerate() {
                pixel.evaluations = (index % 101) as u32;
            }
        });
        let Legend::Scale { ends, .. } = legend else { panic!("{legend:?}") };
        assert!((98.0..=100.0).contains(&ends[1]), "{ends:?}");
        assert_eq!(colors[0], Ramp::Heat.color(0.0));
        assert_eq!(colors[100], Ramp::Heat.color(1.0));
    }

    #[test]
    fn the_slice_is_warm_inside_and_cool_outside() {
        // The ball is in front of the plane through its middle, so its far side is seen from a place
        // inside it: the half in front is cut away by nothing, and hides the plane.
        let (colors, _) = painted(BALL, Mode::Slice, |image| {
            image.pixels_mut().iter_mut().for_each(|pixel| pixel.status = 0);
        });
        let [red, _, blue] = colors[MIDDLE];
        assert!(red > blue, "{:?}", colors[MIDDLE]);
        let [red, _, blue] = colors[0];
        assert!(blue > red, "{:?}", colors[0]);
    }

    #[test]
    fn shapes_and_what_their_fields_promise_have_colours_and_names() {
        let text = "sphere(0.8).translate(x: -1)\nbox(1).twist(40deg).translate(x: 1)\n\
                    camera(eye: [0, 0, 6], target: [0, 0, 0], fov: 40deg)";
        let (left, right) = (12 * 32 + 9, 12 * 32 + 22);
        let (colors, legend) = painted(text, Mode::Shapes, |_| {});
        assert!(colors[left] != colors[right] && colors[0] == NOTHING);
        let Legend::Keys(keys) = legend else { panic!("{legend:?}") };
        assert_eq!(keys.len(), 2);
        let (_, legend) = painted(text, Mode::Quality, |_| {});
        let Legend::Keys(mut keys) = legend else { panic!("{legend:?}") };
        keys.sort();
        let names: Vec<_> = keys.iter().map(|(color, name)| (*color, name.as_str())).collect();
        assert_eq!(names, [(FINE, "the distance"), (NOTICE, "a bound, divided by a constant")]);
    }
}
