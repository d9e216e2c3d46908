//! What the surface is made of at the places that a picture shows, without its light.

use sdfc::FrameValues;
use sdfc::graph::eval::Tape;
use sdfc::graph::{MaterialField, Program};
use sdfc::render::linear_to_srgb8;

use crate::probe::in_parallel;

/// A material as far as the eye tells it from others: colours in 8 bits of sRGB, the rest in hundredths.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Material {
    /// Red, green, blue.
    pub color: [u8; 3],
    /// 0 mirror to 100 matt.
    pub roughness: u8,
    /// 0 dielectric to 100 metal.
    pub metallic: u8,
    /// Light of its own: red, green, blue.
    pub emission: [u8; 3],
}

impl Material {
    fn of_fields(fields: &[[f64; 4]]) -> Self {
        let field = |field: MaterialField| fields.get(field.index()).copied().unwrap_or_default();
        let coverage = field(MaterialField::Coverage)[0];
        let bare = MaterialField::Color.default_value();
        let color = field(MaterialField::Color);
        let painted = |lane: usize| bare[lane] + (color[lane] - bare[lane]) * coverage;
        let byte = |linear: f64| linear_to_srgb8(linear as f32);
        let hundredths = |kind| (field(kind)[0] * 100.0).round() as u8;
        let emission = field(MaterialField::Emission);
        Self {
            color: [0, 1, 2].map(|lane| byte(painted(lane))),
            roughness: hundredths(MaterialField::Roughness),
            metallic: hundredths(MaterialField::Metallic),
            emission: [0, 1, 2].map(|lane| byte(emission[lane])),
        }
    }

    /// As a scene would write it.
    pub fn text(&self) -> String {
        let hex = |[red, green, blue]: [u8; 3]| format!("#{red:02x}{green:02x}{blue:02x}");
        let part = |hundredths: u8| f64::from(hundredths) / 100.0;
        let mut text = format!("{}, roughness {}", hex(self.color), part(self.roughness));
        if self.metallic > 0 {
            text += &format!(", metallic {}", part(self.metallic));
        }
        if self.emission != [0; 3] {
            text += &format!(", emission {}", hex(self.emission));
        }
        text
    }
}

/// The materials of a scene, in f64.
#[derive(Debug)]
pub struct Materials {
    tape: Option<Tape>,
}

impl Materials {
    /// Of a program, with points counted from its origin; one without materials has the unpainted one everywhere.
    pub fn new(program: &Program) -> Self {
        let tape = program.material.and_then(|fields| Tape::new(&program.graph, &fields).ok());
        Self { tape }
    }

    /// At points, by all threads; `None` stays `None`.
    pub fn at(&self, frame: &FrameValues, points: &[Option<[f64; 3]>]) -> Vec<Option<Material>> {
        let Some(tape) = &self.tape else {
            let bare = Material::of_fields(&MaterialField::ALL.map(MaterialField::default_value));
            return points.iter().map(|point| point.map(|_| bare)).collect();
        };
        in_parallel(points, || {
            let mut fields = tape.prepare::<f64>(frame);
            move |point: &Option<[f64; 3]>| {
                point.map(|point| Material::of_fields(fields.eval(point)))
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(text: &str, point: [f64; 3]) -> Material {
        let scene = sdfc::compile("a", text).scene.unwrap();
        let frame = FrameValues::defaults(scene.params());
        Materials::new(scene.program()).at(&frame, &[Some(point)])[0].unwrap()
    }

    #[test]
    fn materials_are_told_as_the_scene_writes_them() {
        let text = "sphere(1).color(#d94f30).metallic(0.5)\nsphere(1).translate(x: 4)\n";
        let painted = at(text, [0.0, 0.0, 1.0]);
        assert_eq!(painted.text(), "#d94f30, roughness 0.5, metallic 0.5");
        assert_eq!(at(text, [4.0, 0.0, 1.0]).color, [231; 3]);
        assert_eq!(at("sphere(1)", [0.0, 0.0, 1.0]).text(), "#e7e7e7, roughness 0.5");
    }
}
