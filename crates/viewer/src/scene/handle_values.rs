//! The values that a handle in the picture changes: a param, a number, or a vector of three.

use std::ops::Range;

use sdfc_graph::ParamKind;
use sdfc_ide::{TokenRole, TokenSpan};
use sdfc_syntax::Class;

use crate::scene::model::Model;
use crate::scene::number_text::Unit;
use crate::scene::param_values::ParamValues;
use crate::scene::source_numbers::{SourceNumber, Token, tokens};

/// The most tokens between the brackets of a vector: three signs, three values, two commas.
const MAX_INSIDE: usize = 8;

/// A value of the scene that can be changed without compiling it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum HandleValue {
    /// A param, by its name.
    Param(String),
    /// A number of the scene's text, by the first byte of its literal.
    Number(usize),
}

/// The param of the compiled scene that has a value, and the sign of the value in it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LiveParam {
    /// The index of the param.
    pub index: usize,
    /// -1 if the param is the negative value, else 1.
    pub sign: f64,
}

impl HandleValue {
    /// The param that has the value. `None` if it cannot change without a compilation, or is
    /// neither a number nor an angle.
    pub fn live_param(&self, model: &Model) -> Option<LiveParam> {
        match self {
            Self::Param(name) => {
                let index = model.declared().iter().position(|param| param.name == *name)?;
                let param = model.declared().get(index)?;
                let is_number = matches!(param.kind, ParamKind::Number | ParamKind::Angle);
                (is_number && param.fixed.is_none()).then_some(LiveParam { index, sign: 1.0 })
            }
            Self::Number(start) => {
                let (index, sign) = model.number_at(*start)?.param_value(1.0);
                Some(LiveParam { index, sign })
            }
        }
    }

    /// The current value.
    pub fn get(&self, model: &Model, values: &ParamValues) -> Option<f64> {
        match self {
            Self::Param(_) => {
                let index = self.live_param(model)?.index;
                values.frame(model, 0.0, 0.0).params.get(index).map(|lanes| lanes[0])
            }
            Self::Number(start) => model.number_at(*start).map(|number| values.number(number)),
        }
    }

    /// The unit in which the scene's text has the value when it is saved.
    pub fn unit(&self, model: &Model) -> Unit {
        match self {
            Self::Param(name) => {
                let mut declared = model.declared().iter();
                let param = declared.find(|param| param.name == *name);
                let is_angle = param.is_some_and(|param| param.kind == ParamKind::Angle);
                if is_angle { Unit::Degrees } else { Unit::One }
            }
            Self::Number(start) => model.number_at(*start).map_or(Unit::One, SourceNumber::unit),
        }
    }

    /// Changes the value, within its range.
    pub fn set(&self, model: &Model, values: &mut ParamValues, value: f64) {
        let clamped = |range: Option<[f64; 2]>| match range {
            Some([low, high]) => value.max(low).min(high),
            None => value,
        };
        match self {
            Self::Param(name) => {
                let mut declared = model.declared().iter();
                if let Some(param) = declared.find(|param| param.name == *name) {
                    let lanes = [clamped(param.range), 0.0, 0.0, 0.0];
                    values.params.insert(name.clone(), lanes);
                }
            }
            Self::Number(start) => {
                if let Some(number) = model.number_at(*start) {
                    values.set_number(number, clamped(number.range));
                }
            }
        }
    }
}

/// The values at an offset of the scene's text: those of the vector `[x, y, z]` around it if each
/// is a param or a number, else the param or the number there. `roles` are those of the text.
pub fn values_at(model: &Model, roles: &[TokenSpan], offset: usize) -> Vec<HandleValue> {
    let text = model.source.as_str();
    let tokens = tokens(text);
    let value = |(class, range): &Token| {
        let value = match class {
            Class::Number => HandleValue::Number(range.start),
            Class::Name if is_param(roles, range) => {
                HandleValue::Param(text.get(range.clone())?.to_owned())
            }
            Class::Name
            | Class::Comment
            | Class::Docs
            | Class::Keyword
            | Class::Color
            | Class::Text
            | Class::Operator
            | Class::Open
            | Class::Close
            | Class::Punctuation
            | Class::Unknown => return None,
        };
        value.live_param(model).map(|_| value)
    };
    if let Some([x, y, z]) = vector_around(text, &tokens, offset)
        && let (Some(x), Some(y), Some(z)) = (value(x), value(y), value(z))
    {
        return vec![x, y, z];
    }
    let near = tokens.iter().filter(|(_, range)| (range.start..=range.end).contains(&offset));
    near.filter_map(value).take(1).collect()
}

/// True if a name is that of a param. A label, a component or a variable can have the same name.
fn is_param(roles: &[TokenSpan], name: &Range<usize>) -> bool {
    let at = roles.binary_search_by_key(&name.start, |token| token.range.start);
    at.ok().and_then(|at| roles.get(at)).is_some_and(|token| token.role == TokenRole::Param)
}

/// The elements of the vector around an offset if it has three, each one token or a minus and one
/// token.
fn vector_around<'a>(text: &str, tokens: &'a [Token], offset: usize) -> Option<[&'a Token; 3]> {
    let word = |token: &Token| text.get(token.1.clone()).unwrap_or_default();
    let before = tokens.partition_point(|(_, range)| range.end <= offset);
    let first = before.saturating_sub(MAX_INSIDE + 1);
    let open = (first..=before).rev().find(|at| tokens.get(*at).is_some_and(|it| word(it) == "["));
    let inside = tokens.get(open? + 1..)?;
    let length = inside.iter().take(MAX_INSIDE + 1).position(|token| word(token) == "]")?;
    inside.get(length).filter(|(_, close)| close.end >= offset)?;
    let mut elements = inside.get(..length)?.split(|token| word(token) == ",");
    let mut element = || match elements.next()? {
        [value] => Some(value),
        [minus, value] if word(minus) == "-" => Some(value),
        _ => None,
    };
    let vector = [element()?, element()?, element()?];
    elements.next().is_none().then_some(vector)
}

#[cfg(test)]
mod tests {
    use sdfc_ide::{Analysis, NoFiles};

    use super::*;
    use crate::test_support::model;

    /// The values at the first position of a text in the scene.
    fn at(model: &Model, found: &str) -> Vec<HandleValue> {
        let analysis = Analysis::new("a.sdf", &model.source, &NoFiles);
        values_at(model, &sdfc_ide::tokens(&analysis), model.source.find(found).unwrap())
    }

    #[test]
    fn only_three_values_between_commas_are_a_vector() {
        let text = "let p = [4, 5, 6]\nparam x = 1.5\nparam r = 1\n\
                    box([2 * r, 7, 1]).translate([p.x, 8, 9])\n\
                    sphere(r).translate([1 - 2, 3, 10]).translate([0.75, r, - 0.9])\n";
        let model = model(text);
        let count = |found: &str| at(&model, found).len();
        assert_eq!([count("[2 *"), count("r, 7"), count("7, 1")], [0, 1, 1]);
        assert_eq!([count("8, 9"), count("1 - 2"), count("3, 10"), count("0.75")], [1, 1, 1, 3]);
    }

    #[test]
    fn a_name_is_a_value_only_where_it_means_the_param() {
        let text = "param y = 0.5\nparam i = 2\nlet p = [1, 2, 3]\n\
                    sphere(p.y).rotate(y: 30deg).translate(x: y)\n\
                    union(for i in 0..3: sphere(0.1).translate(z: i / 3))\nsphere(i)\n";
        let model = model(text);
        let param = |name: &str| vec![HandleValue::Param(name.to_owned())];
        assert_eq!([at(&model, "y = "), at(&model, "y)\nunion")], [param("y"), param("y")]);
        assert_eq!([at(&model, "y)."), at(&model, "y: 30")], [vec![], vec![]]);
        assert_eq!([at(&model, "i / 3"), at(&model, "i in")], [vec![], vec![]]);
        assert_eq!(at(&model, "i)\n"), param("i"));
    }

    #[test]
    fn a_vector_of_three_values_is_changed_by_one_handle() {
        let text = "param r = 0.5 in 0.1..2\nparam n: int = 2\n\
                    sphere(r).translate([-0.25, r, 3]).rotate(y: 30deg)\n\
                    union(for i in 0..n: box(0.1).translate(x: i))\n";
        let model = model(text);
        let at = |found: &str| at(&model, found);
        let number = |found: &str| HandleValue::Number(text.find(found).unwrap());
        let param = HandleValue::Param("r".to_owned());
        let vector = [number("0.25"), param.clone(), number("3])")];
        assert_eq!(
            [at("-0.25"), at(" r, 3"), at("])")],
            [vector.clone(), vector.clone(), vector.clone()]
        );
        assert_eq!(at("r).tr"), std::slice::from_ref(&param));
        assert_eq!(at("30deg"), [number("30deg")]);
        assert_eq!(at("n: int"), []);
        // The sign is part of the number, and a range is kept.
        let mut values = ParamValues::default();
        assert_eq!(vector[0].get(&model, &values), Some(-0.25));
        vector[0].set(&model, &mut values, -0.5);
        param.set(&model, &mut values, 7.0);
        assert_eq!(vector[0].get(&model, &values), Some(-0.5));
        assert_eq!(param.get(&model, &values), Some(2.0));
        let frame = values.frame(&model, 0.0, 0.0);
        let live = vector[0].live_param(&model).unwrap();
        assert_eq!(frame.params[live.index][0] * live.sign, -0.5);
    }
}
