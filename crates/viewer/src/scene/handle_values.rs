//! The values that a handle in the picture changes: a param, a number, or a vector of three.

use sdfc_graph::ParamKind;
use sdfc_syntax::{Class, classes};

use crate::scene::model::Model;
use crate::scene::param_values::ParamValues;

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
/// is a param or a number, else the param or the number there.
pub fn values_at(model: &Model, offset: usize) -> Vec<HandleValue> {
    let text = model.source.as_str();
    let mut tokens = classes(text);
    tokens.retain(|(class, _)| !matches!(class, Class::Comment | Class::Docs));
    let value = |(class, range): &(Class, std::ops::Range<usize>)| {
        let value = match class {
            Class::Number => HandleValue::Number(range.start),
            Class::Name => HandleValue::Param(text.get(range.clone())?.to_owned()),
            Class::Comment
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
    let before = tokens.partition_point(|(_, range)| range.end <= offset);
    let word = |index: usize| tokens.get(index).map_or("", |(_, range)| &text[range.clone()]);
    // `[-1, -2, -3]` has the most tokens.
    let open =
        (before.saturating_sub(MAX_INSIDE + 1)..=before).rev().find(|index| word(*index) == "[");
    if let Some(open) = open {
        let close = (open..=open + MAX_INSIDE + 1).find(|index| word(*index) == "]");
        let inside = close.and_then(|close| tokens.get(open + 1..close));
        let is_around =
            close.and_then(|close| tokens.get(close)).is_some_and(|it| it.1.end >= offset);
        let elements = inside.filter(|_| is_around).into_iter().flatten();
        let elements: Vec<HandleValue> = elements.filter_map(value).collect();
        if elements.len() == 3 {
            return elements;
        }
    }
    let near = tokens.iter().filter(|(_, range)| (range.start..=range.end).contains(&offset));
    near.filter_map(value).take(1).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_support::model;

    #[test]
    fn a_vector_of_three_values_is_changed_by_one_handle() {
        let text = "param r = 0.5 in 0.1..2\nparam n: int = 2\n\
                    sphere(r).translate([-0.25, r, 3]).rotate(y: 30deg)\n\
                    union(for i in 0..n: box(0.1).translate(x: i))\n";
        let model = model(text);
        let at = |found: &str| values_at(&model, text.find(found).unwrap());
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
