//! The options of a page.

use std::collections::BTreeMap;
use std::fmt::Display;
use std::str::FromStr;

use sdfc::{CompileValues, Emit, Method, Resolver, ShaderOptions, Stage, Target};
use serde::{Deserialize, Deserializer, de::Error};

/// The options, with the defaults of `sdfc compile`.
#[derive(Debug, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(crate) struct Options {
    /// The name of the scene in messages.
    pub name: String,
    #[serde(deserialize_with = "named")]
    target: Option<Target>,
    #[serde(deserialize_with = "named")]
    emit: Option<Emit>,
    #[serde(deserialize_with = "named")]
    stage: Option<Stage>,
    #[serde(deserialize_with = "named")]
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
            target: None,
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

impl Options {
    pub fn shader(&self) -> ShaderOptions {
        let standard = ShaderOptions::default();
        let target = self.target.unwrap_or(standard.target);
        ShaderOptions::new()
            .target(target)
            .emit(self.emit.unwrap_or(Emit::default_for(target)))
            .stage(self.stage.unwrap_or(target.default_stage()))
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

/// Reads the name of a value; null is none.
fn named<'a, T, D>(deserializer: D) -> Result<Option<T>, D::Error>
where
    T: FromStr<Err: Display>,
    D: Deserializer<'a>,
{
    let name = Option::<String>::deserialize(deserializer)?;
    name.map(|name| name.parse().map_err(D::Error::custom)).transpose()
}

/// The files in the options of a page.
pub(crate) struct Files(pub BTreeMap<String, String>);

impl Resolver for Files {
    fn read(&self, path: &str) -> Result<String, String> {
        self.0.get(path).cloned().ok_or_else(|| "the options have no such file".to_owned())
    }
}
