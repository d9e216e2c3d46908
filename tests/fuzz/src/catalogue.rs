//! Everything that a program can call, read from the reference that `sdfc doc --json` prints.

use sdfc_diagnostics::Sources;
use sdfc_lang::library::Entry;
use sdfc_lang::{reference, settings};
use sdfc_syntax::ast::{self, DeclKind, ExprKind, Item, UnaryOp, Unit};

use crate::kernel;
use crate::types::Ty;

/// Something that can be called.
#[derive(Clone, Debug)]
pub struct Callable {
    /// The name.
    pub name: String,
    /// The parameters, in order.
    pub parameters: Vec<Parameter>,
    /// The type of the result; [`Ty::Statement`] for a setting.
    pub result: Ty,
    /// True if the arguments have no names.
    pub positional: bool,
}

/// A parameter.
#[derive(Clone, Debug)]
pub struct Parameter {
    /// The name.
    pub name: String,
    /// The type.
    pub ty: Ty,
    /// True if it takes any number of arguments.
    pub variadic: bool,
    /// True if it has a default.
    pub optional: bool,
    /// The least and the greatest value, in degrees for an angle.
    pub range: Option<[f64; 2]>,
}

/// All callables.
#[derive(Clone, Debug)]
pub struct Catalogue {
    /// The library and the functions of the kernel.
    pub functions: Vec<Callable>,
    /// The settings.
    pub settings: Vec<Setting>,
}

/// A setting.
#[derive(Clone, Debug)]
pub struct Setting {
    /// Its name and parameters.
    pub callable: Callable,
    /// True if a scene can contain it only once.
    pub once: bool,
}

/// Results that the signatures of the library leave to inference. All others are numbers.
const INFERRED: [(&str, Ty); 1] = [("spin", Ty::Vec(2))];

impl Catalogue {
    /// Reads the reference.
    ///
    /// # Errors
    ///
    /// A signature that the generator does not understand.
    pub fn read() -> Result<Self, String> {
        let mut functions = Vec::new();
        for entry in reference::entries() {
            match entry.kind {
                "fn" | "solid" | "region" | "shape" => functions.extend(library(&entry)?),
                _ => {}
            }
        }
        for row in kernel::SIGNATURES {
            let row = declared(&format!("fn {row} = 0"), 3)?;
            functions.push(Callable { positional: !kernel::is_named(&row.name), ..row });
        }
        let settings = settings::table().iter().map(setting).collect::<Result<_, _>>()?;
        Ok(Self { functions, settings })
    }
}

/// Returns the callables of an entry of the library: two for a shape of any dimension.
fn library(entry: &Entry) -> Result<Vec<Callable>, String> {
    let text = format!("{} {} = 0", entry.kind, entry.signature);
    let dimensions: &[u8] = match entry.kind {
        "shape" => &[2, 3],
        "region" => &[2],
        _ => &[3],
    };
    dimensions.iter().map(|dimensions| declared(&text, *dimensions)).collect()
}

fn declared(text: &str, dimensions: u8) -> Result<Callable, String> {
    let mut sources = Sources::new();
    let file = sources.add("signature", text);
    let (file, _) = sdfc_syntax::parse(&sources, file);
    let [Item::Decl(declaration)] = &file.items[..] else {
        return Err(format!("`{text}` is no declaration"));
    };
    let name = declaration.name.text.clone();
    let parameters = declaration.signature.parms.iter().map(|it| parameter(it, dimensions));
    let result = match (&declaration.kind, &declaration.signature.result) {
        (DeclKind::Fn, Some(result)) => Ty::written(result, dimensions)?,
        (DeclKind::Fn, None) => {
            let row = INFERRED.into_iter().find(|row| row.0 == name);
            row.map_or(Ty::Number, |row| row.1)
        }
        (DeclKind::Solid, _) => Ty::Solid,
        (DeclKind::Region, _) => Ty::Region,
        (DeclKind::Shape, _) => Ty::shape(dimensions),
    };
    let parameters = parameters.collect::<Result<_, _>>()?;
    Ok(Callable { name, parameters, result, positional: false })
}

fn parameter(parameter: &ast::Parm, dimensions: u8) -> Result<Parameter, String> {
    let ty = parameter.ty.as_ref().map(|ty| Ty::written(ty, dimensions));
    let range = parameter.range.as_ref().and_then(range);
    Ok(Parameter {
        name: parameter.name.text.clone(),
        ty: ty.transpose()?.unwrap_or(Ty::Number),
        variadic: parameter.variadic,
        optional: parameter.default.is_some(),
        range,
    })
}

/// Returns the ends of a range of literals.
fn range(expr: &ast::Expr) -> Option<[f64; 2]> {
    let ExprKind::Binary(ast::BinaryOp::Range, _, lo, hi) = &expr.kind else { return None };
    Some([literal(lo)?, literal(hi)?])
}

/// Returns the value of a literal, in degrees for an angle.
fn literal(expr: &ast::Expr) -> Option<f64> {
    if let ExprKind::Unary(UnaryOp::Neg, value) = &expr.kind {
        return Some(-literal(value)?);
    }
    if let ExprKind::Name(name) = &expr.kind {
        return (name == "inf").then_some(f64::INFINITY);
    }
    let ExprKind::Number { value, unit, .. } = &expr.kind else { return None };
    Some(match unit {
        None | Some(Unit::Deg) => *value,
        Some(Unit::Turn) => 360.0 * value,
        Some(Unit::Rad) => value.to_degrees(),
    })
}

fn setting(row: &settings::SettingRow) -> Result<Setting, String> {
    let known = row
        .parameters
        .iter()
        .filter(|parameter| !kernel::OF_PICTURES.contains(&[row.name, parameter.name]));
    let parameters = known.map(|parameter| {
        let key = (row.name, parameter.name);
        let range =
            kernel::SETTING_RANGES.iter().find(|(setting, name, _)| (*setting, *name) == key);
        Ok(Parameter {
            name: parameter.name.to_owned(),
            ty: Ty::of_setting(&parameter.ty)?,
            variadic: false,
            optional: parameter.optional,
            range: range.map(|row| row.2),
        })
    });
    let parameters = parameters.collect::<Result<_, String>>()?;
    let (name, result) = (row.name.to_owned(), Ty::Statement);
    Ok(Setting {
        callable: Callable { name, parameters, result, positional: false },
        once: row.once,
    })
}
