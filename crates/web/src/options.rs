//! The options of a page.

use std::collections::BTreeMap;

use sdfc::{CompileValues, Emit, Method, Resolver, ShaderOptions, Stage, Target};
use serde::{Deserialize, Deserializer, de::Error};

/// The options, with the defaults of `sdfc compile`.
#[derive(Debug, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(crate) struct Options {
    /// The name of the scene in messages.
    pub name: String,
    #[serde(deserialize_with = "target")]
    target: Target,
    emit: Option<Part>,
    stage: Option<Form>,
    #[serde(deserialize_with = "method")]
    march: Option<Method>,
    prefix: Option<String>,
    group: Option<u32>,
    binding: Option<u32>,
    pub live_literals: bool,
    /// Values of params by name, written as in a scene.
    pub set: BTreeMap<String, String>,
    /// Values of params by name, as the reflection states them: a number, or one for each lane.
    #[serde(deserialize_with = "values")]
    pub values: CompileValues,
    /// The sources that the scene may import, by path.
    pub files: BTreeMap<String, String>,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            name: "scene.sdf".to_owned(),
            target: Target::Wgsl,
            emit: None,
            stage: None,
            march: None,
            prefix: None,
            group: None,
            binding: None,
            live_literals: false,
            set: BTreeMap::new(),
            values: CompileValues::new(),
            files: BTreeMap::new(),
        }
    }
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Part {
    Field,
    March,
    Render,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Form {
    Compute,
    Fragment,
}

impl Options {
    pub fn shader(&self) -> ShaderOptions {
        let target = self.target;
        let emit = match self.emit {
            Some(Part::Field) => Emit::Field,
            Some(Part::March) => Emit::March,
            Some(Part::Render) => Emit::Render,
            None if target == Target::Shadertoy => Emit::Render,
            None => Emit::Field,
        };
        let stage = match self.stage {
            Some(Form::Compute) => Stage::Compute,
            Some(Form::Fragment) => Stage::Fragment,
            None if target.has_stage(Stage::Compute) => Stage::Compute,
            None => Stage::Fragment,
        };
        let standard = ShaderOptions::default();
        ShaderOptions::new()
            .target(target)
            .emit(emit)
            .stage(stage)
            .method(self.march)
            .prefix(self.prefix.clone().unwrap_or(standard.prefix))
            .group(self.group.unwrap_or(standard.group))
            .binding(self.binding.unwrap_or(standard.binding))
    }
}

/// One value of a page: a number, or one for each lane.
#[derive(Deserialize)]
#[serde(untagged)]
enum Lanes {
    One(f64),
    Each(Vec<f64>),
}

/// Reads values of params. Lanes that a value does not state are 0; it has at most four.
fn values<'a, D: Deserializer<'a>>(deserializer: D) -> Result<CompileValues, D::Error> {
    let found = BTreeMap::<String, Lanes>::deserialize(deserializer)?;
    let lanes = |(name, lanes): (String, Lanes)| {
        let stated = match lanes {
            Lanes::One(number) => vec![number],
            Lanes::Each(numbers) => numbers,
        };
        let mut all = [0.0; 4];
        let Some(places) = all.get_mut(..stated.len()) else {
            let count = stated.len();
            return Err(D::Error::custom(format!(
                "the value of `{name}` has {count} numbers; a value has one to four"
            )));
        };
        places.copy_from_slice(&stated);
        Ok((name, all))
    };
    found.into_iter().map(lanes).collect()
}

fn method<'a, D: Deserializer<'a>>(deserializer: D) -> Result<Option<Method>, D::Error> {
    let name = Option::<String>::deserialize(deserializer)?;
    name.map(|name| name.parse().map_err(D::Error::custom)).transpose()
}

fn target<'a, D: Deserializer<'a>>(deserializer: D) -> Result<Target, D::Error> {
    let name = String::deserialize(deserializer)?;
    let names = Target::ALL.map(Target::name);
    let found = Target::ALL.into_iter().find(|target| target.name() == name);
    found.ok_or_else(|| {
        D::Error::custom(format!("unknown target `{name}`; the targets are {}", names.join(", ")))
    })
}

/// The files in the options of a page.
pub(crate) struct Files(pub BTreeMap<String, String>);

impl Resolver for Files {
    fn read(&self, path: &str) -> Result<String, String> {
        self.0.get(path).cloned().ok_or_else(|| "the options have no such file".to_owned())
    }
}
