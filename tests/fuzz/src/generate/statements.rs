//! The statements of a program: params, declarations, lets, what is drawn, and settings.

use super::numbers::{literal, round};
use super::{Generator, Rate, Variable, Want};
use crate::catalogue::{Callable, Parameter};
use crate::kernel::RIVAL_SETTINGS;
use crate::tree::{Program, Tree};
use crate::types::Ty;

/// The programs that draw regions, in percent.
const PLANAR: u8 = 12;

impl Generator<'_> {
    pub(super) fn statements(&mut self, shapes: usize) -> Vec<Tree> {
        let mut statements = Vec::new();
        for _ in 0..self.rng.u8(0..4) {
            statements.push(self.param());
        }
        for _ in 0..self.rng.u8(0..4) {
            let declaration =
                if self.chance(60) { self.shape_declaration() } else { self.fn_declaration() };
            statements.push(declaration);
        }
        let (lets, drawn) = (self.rng.usize(0..4), self.rng.usize(1..4));
        let share = (shapes / (lets + drawn)).max(1);
        for _ in 0..lets {
            statements.push(self.binding(share));
        }
        // A program draws solids or regions, never both.
        let ty = if self.chance(PLANAR) { Ty::Region } else { Ty::Solid };
        for _ in 0..drawn {
            let shape = self.shape(&ty, Want::new(Rate::Frame, share));
            statements.push(Tree::new(Ty::Statement, "{}", [shape]));
        }
        statements.extend(self.settings(ty == Ty::Region));
        statements
    }

    fn param(&mut self) -> Tree {
        let name = self.fresh("param");
        let want = Want { depth: 0, ..Want::new(Rate::Const, 0) };
        let (ty, range, texts, text) = match self.rng.u8(0..7) {
            0 => (Ty::Int, Some([1.0, 6.0]), Vec::new(), ": int = 3 in 1..6".to_owned()),
            1 => (Ty::Angle, Some([0.0, 90.0]), Vec::new(), " = 20deg in 0deg..90deg".to_owned()),
            2 => (Ty::Bool, None, Vec::new(), format!(" = {}", self.rng.bool())),
            3 => {
                let color = self.color(want);
                let statement = Tree::new(Ty::Statement, &format!("param {name} = {{}}"), [color]);
                self.declare_variable(name, Ty::Color, Rate::Frame, None, Vec::new());
                return statement;
            }
            4 => {
                let texts = ["round", "flat", "wide"].map(str::to_owned).to_vec();
                let text = " = \"flat\" in [\"round\", \"flat\", \"wide\"]".to_owned();
                (Ty::Text, None, texts, text)
            }
            5 => {
                let value = round(2.0 * self.rng.f64() - 1.0);
                (Ty::Number, None, Vec::new(), format!(" = {value}"))
            }
            _ => {
                let lo = round(0.05 + 0.5 * self.rng.f64());
                let hi = round(lo + 0.1 + self.rng.f64());
                let value = round(lo + (hi - lo) * self.rng.f64());
                (Ty::Number, Some([lo, hi]), Vec::new(), format!(" = {value} in {lo}..{hi}"))
            }
        };
        let statement = Tree::text(Ty::Statement, format!("param {name}{text}"));
        self.declare_variable(name, ty, Rate::Frame, range, texts);
        statement
    }

    fn declare_variable(
        &mut self,
        name: String,
        ty: Ty,
        rate: Rate,
        range: Option<[f64; 2]>,
        texts: Vec<String>,
    ) {
        self.scope.push(Variable { name, ty, rate, range, texts });
    }

    fn binding(&mut self, shapes: usize) -> Tree {
        let types = [
            Ty::Solid,
            Ty::Solid,
            Ty::Solid,
            Ty::Region,
            Ty::Number,
            Ty::Int,
            Ty::Angle,
            Ty::Bool,
            Ty::Vec(3),
            Ty::Color,
            Ty::Material,
            Ty::pattern(),
            Ty::blend(),
        ];
        let ty = self.pick(&types).cloned().unwrap_or(Ty::Solid);
        let rate = if self.rng.bool() { Rate::Const } else { Rate::Frame };
        let value = if matches!(ty, Ty::Fn(..)) {
            // Only a call or a name gives a value of the type itself here.
            self.call_for(&ty, Want::new(rate, 1))
        } else if ty == Ty::Number {
            // A literal without a point is an int.
            Tree::new(Ty::Number, "(0.5 + {})", [self.number(Want::new(rate, 0))])
        } else {
            self.value(&ty, Want::new(rate, shapes))
        };
        let name = self.fresh("name");
        let statement = Tree::new(Ty::Statement, &format!("let {name} = {{}}"), [value]);
        self.declare_variable(name, ty, rate, None, Vec::new());
        statement
    }

    /// Declares a function.
    fn fn_declaration(&mut self) -> Tree {
        let results = [Ty::Number, Ty::Vec(3), Ty::Color, Ty::Solid, Ty::Region, Ty::blend()];
        let result = self.pick(&results).cloned().unwrap_or(Ty::Number);
        let kinds = [Ty::Number, Ty::Vec(3), Ty::Angle, Ty::Color, Ty::Int, Ty::Bool, Ty::Solid];
        let parameters: Vec<Parameter> = (0..self.rng.u8(1..4))
            .map(|_| {
                let ty = self.pick(&kinds).cloned().unwrap_or(Ty::Number);
                self.parameter(ty)
            })
            .collect();
        let name = self.fresh("f");
        let variables = variables(&parameters);
        let body = self.with_names(variables, |this| {
            let want = Want::new(Rate::Point, 2);
            // The arguments of shapes are no points.
            let rate = if result.is_shape() { Rate::Frame } else { Rate::Point };
            this.value(&result, Want { rate, ..want })
        });
        let body =
            if result == Ty::Number { Tree::new(Ty::Number, "(0.1 + {})", [body]) } else { body };
        let arrow = match result.word() {
            Some(word) if result == Ty::blend() || self.rng.bool() => format!(" -> {word}"),
            _ => String::new(),
        };
        let statement = self.declaration("fn", &name, &parameters, &arrow, [body]);
        self.declared.push(Callable { name, parameters, result, positional: false });
        statement
    }

    /// Declares a solid, a region, or an operator for both.
    fn shape_declaration(&mut self) -> Tree {
        let dimensions = self.rng.u8(2..4);
        let ty = Ty::shape(dimensions);
        let name = self.fresh("shape");
        let mut parameters = vec![Parameter {
            name: self.fresh("r"),
            ty: Ty::Number,
            variadic: false,
            optional: true,
            range: Some([0.0, f64::INFINITY]),
        }];
        let is_operator = self.chance(60);
        if is_operator {
            let operand = Parameter {
                name: self.fresh("a"),
                ty: ty.clone(),
                variadic: false,
                optional: false,
                range: None,
            };
            parameters.insert(0, operand);
        }
        let operand = parameters[0].name.clone();
        let radius = parameters[parameters.len() - 1].name.clone();
        let point = Variable {
            name: "p".to_owned(),
            ty: Ty::Vec(dimensions),
            rate: Rate::Point,
            range: None,
            texts: Vec::new(),
        };
        let mut names = variables(&parameters);
        names.push(point);
        let want = Want::new(Rate::Point, 1);
        let number = |this: &mut Self| this.number(want);
        let vector = |this: &mut Self| this.vector(dimensions, want);
        let (clauses, format, parts) = self.with_names(names, |this| {
            let mut clauses = String::new();
            if is_operator && this.chance(20) {
                let color = this.color(Want::new(Rate::Point, 0));
                let color = Program { statements: vec![color] }.text();
                let color = color.trim();
                clauses = format!(" material material_at({operand}, p).with(color: {color})");
            }
            let (format, parts): (String, Vec<Tree>) = match (is_operator, this.rng.u8(0..6)) {
                (true, 0) => (format!("{operand}(p) - {radius}"), vec![]),
                (true, 1) => (format!("abs({operand}(p)) - 0.5 * {radius}"), vec![]),
                (true, 2) => {
                    (format!("max({operand}(p), {radius} - {operand}({{}}))"), vec![vector(this)])
                }
                (true, 3) => (
                    format!("min({operand}(p), {operand}(p + {{}}) + {radius})"),
                    vec![vector(this)],
                ),
                (true, 4) => (
                    format!("{{ let q = p + 0.1 * {{}}; {operand}(q) - 0.1 * {{}} }}"),
                    vec![vector(this), number(this)],
                ),
                (true, _) => (
                    format!("{operand}(p) + {radius} * length(gradient({operand}, p)) - {radius}"),
                    vec![],
                ),
                (false, 0) => {
                    clauses = format!(" exact bounds -{radius}..{radius}");
                    (format!("length(p) - {radius}"), vec![])
                }
                (false, 1) => (format!("length(p + 0.2 * {{}}) - {radius}"), vec![vector(this)]),
                (false, 2) => (format!("max(abs(p)) - {radius}"), vec![]),
                (false, 3) => {
                    (format!("length(p) - {radius} * (1 + 0.1 * {{}})"), vec![number(this)])
                }
                (false, 4) => (
                    format!(
                        "if p.x < {{}} {{ length(p) - {radius} }} else {{ max(abs(p)) - {{}} }}"
                    ),
                    vec![number(this), number(this)],
                ),
                (false, _) => (format!("length(p) - {radius} + 0.3 * {{}}"), vec![number(this)]),
            };
            (clauses, format, parts)
        });
        let word = if dimensions == 2 { "region" } else { "solid" };
        let body = Tree::new(Ty::Number, &format, parts);
        let statement = self.declaration(word, &name, &parameters, &clauses, [body]);
        self.declared.push(Callable { name, parameters, result: ty, positional: false });
        statement
    }

    fn declaration(
        &mut self,
        word: &str,
        name: &str,
        parameters: &[Parameter],
        clauses: &str,
        body: [Tree; 1],
    ) -> Tree {
        let parameters = parameters.iter().map(|parameter| {
            let word = parameter.ty.word().unwrap_or("number");
            let default = parameter.ty.simplest().filter(|_| parameter.optional);
            let default = default.map_or_else(String::new, |value| format!(" = {value}"));
            let range = parameter.range.map_or("", |_| " in 0..inf");
            format!("{}: {word}{default}{range}", parameter.name)
        });
        let parameters: Vec<String> = parameters.collect();
        let format = format!("{word} {name}({}){clauses} = {{}}", parameters.join(", "));
        Tree::new(Ty::Statement, &format, body)
    }

    fn parameter(&mut self, ty: Ty) -> Parameter {
        let optional = ty.simplest().is_some() && self.chance(30);
        Parameter { name: self.fresh("x"), ty, variadic: false, optional, range: None }
    }

    /// Chooses settings, each at most as often as a scene can have it.
    fn settings(&mut self, is_planar: bool) -> Vec<Tree> {
        let mut chosen: Vec<String> = Vec::new();
        let mut statements = Vec::new();
        for _ in 0..self.rng.u8(0..7) {
            let Some(setting) = self.pick(&self.catalogue.settings.clone()).cloned() else {
                continue;
            };
            let name = &setting.callable.name;
            let rival = |other: &String| {
                RIVAL_SETTINGS
                    .iter()
                    .any(|pair| pair.contains(&name.as_str()) && pair.contains(&other.as_str()))
            };
            // The generator's cameras look from all sides, which a planar picture does not allow.
            let is_aside = is_planar && name == "camera";
            if is_aside
                || chosen.iter().any(|other| (setting.once && other == name) || rival(other))
            {
                continue;
            }
            chosen.push(name.clone());
            let statement = match name.as_str() {
                "camera" => self.camera(&setting.callable),
                _ => self.call(&setting.callable, Want::new(Rate::Frame, 0)),
            };
            statements.push(statement);
        }
        statements
    }

    /// A camera that looks at the middle of the scene from outside.
    fn camera(&mut self, callable: &Callable) -> Tree {
        let mut call = self.call(callable, Want { depth: 0, ..Want::new(Rate::Const, 0) });
        let turn = std::f64::consts::TAU * self.rng.f64();
        let (distance, height) = (3.0 + 4.0 * self.rng.f64(), 3.0 * self.rng.f64() - 0.5);
        let eye = [distance * turn.cos(), height, distance * turn.sin()].map(round);
        let parts = eye.map(|value| literal(Ty::Number, value, ""));
        let eye = Tree::new(Ty::Vec(3), "[{}, {}, {}]", parts);
        if let Some(place) = call.at_mut(&[0]) {
            *place = eye;
        }
        call
    }
}

/// The parameters as names in a body. An argument can depend on a point.
fn variables(parameters: &[Parameter]) -> Vec<Variable> {
    let variable = |parameter: &Parameter| Variable {
        name: parameter.name.clone(),
        ty: parameter.ty.clone(),
        rate: if parameter.ty.is_shape() { Rate::Const } else { Rate::Point },
        range: parameter.range,
        texts: Vec::new(),
    };
    parameters.iter().map(variable).collect()
}
