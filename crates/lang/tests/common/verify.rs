//! Verifies the guarantees of the checker to the elaborator on a whole program.

use sdfc_graph::Dim;
use sdfc_lang::hir::*;

/// Panics unless every expression of a program is well formed: variables are declared before they
/// are used, arguments have the types of their parameters, and no type is unknown.
pub fn verify(program: &Program) {
    let verifier = Verifier { program, globals: program.globals.len() as u32 };
    for function in &program.functions {
        let mut frame = Frame::new(function.locals);
        verifier.parameters(&function.parameters, &mut frame);
        verifier.requires(&function.requires, &mut frame);
        verifier.optional(function.lipschitz.as_ref(), &Type::Number, &mut frame);
        verifier.expr(&function.body, &mut frame);
    }
    for shape in &program.shapes {
        let mut frame = Frame::new(shape.locals);
        verifier.parameters(&shape.parameters, &mut frame);
        verifier.requires(&shape.requires, &mut frame);
        for promise in &shape.promises {
            verifier.optional(promise.condition.as_ref(), &Type::Bool, &mut frame);
        }
        verifier.optional(shape.lipschitz.as_ref(), &Type::Number, &mut frame);
        let bounds = Type::Range(Box::new(point(shape.dim)));
        verifier.optional(shape.bounds.as_ref(), &bounds, &mut frame);
        frame.set(LocalId(shape.parameters.len() as u32), &point(shape.dim));
        if let Some(material) = &shape.material {
            verifier.expr(material, &mut frame);
            assert!(material.ty == Type::Material || plain(&material.ty) == Type::Number);
        }
        verifier.wants(&shape.body, &Type::Number, &mut frame);
    }
    for (at, global) in program.globals.iter().enumerate() {
        let verifier = Verifier { program, globals: at as u32 };
        verifier.expr(&global.value, &mut Frame::new(global.locals));
    }
    let top = |e: &Expr, ty: &Type| verifier.wants(e, ty, &mut Frame::new(program.locals));
    for param in &program.params {
        top(&param.default, &param.ty);
        let ends = plain(&param.ty);
        param.range.iter().for_each(|range| top(range, &Type::Range(Box::new(ends.clone()))));
    }
    let drawn = Type::Shape(if program.is_planar() { Dim::Two } else { Dim::Three });
    program.drawn.iter().for_each(|e| top(e, &drawn));
    for setting in &program.settings {
        let row = sdfc_lang::settings::table().into_iter().find(|row| row.kind == setting.kind);
        let row = row.expect("a row for every setting");
        assert_eq!(row.parameters.len(), setting.args.len());
        for (parameter, value) in row.parameters.iter().zip(&setting.args) {
            assert!(parameter.optional || value.is_some());
            value.iter().for_each(|value| top(value, &parameter.ty));
        }
    }
}

fn point(dim: Dim) -> Type {
    if dim == Dim::Two { Type::Vec(2) } else { Type::Vec(3) }
}

/// The type with ints and angles replaced by numbers.
fn plain(ty: &Type) -> Type {
    match ty {
        Type::Int | Type::Angle => Type::Number,
        Type::List(of) => Type::List(Box::new(plain(of))),
        Type::Range(of) => Type::Range(Box::new(plain(of))),
        Type::Record(fields) => {
            Type::Record(fields.iter().map(|(name, ty)| (name.clone(), plain(ty))).collect())
        }
        Type::Fn(parameters, result) => {
            Type::Fn(parameters.iter().map(plain).collect(), Box::new(plain(result)))
        }
        other => other.clone(),
    }
}

struct Frame {
    locals: Vec<Option<Type>>,
}

impl Frame {
    fn new(locals: u32) -> Self {
        Self { locals: vec![None; locals as usize] }
    }

    fn set(&mut self, local: LocalId, ty: &Type) {
        assert!((local.0 as usize) < self.locals.len(), "{local:?} of {}", self.locals.len());
        self.locals[local.0 as usize] = Some(plain(ty));
    }

    fn get(&self, local: LocalId) -> &Type {
        self.locals[local.0 as usize].as_ref().expect("a variable is set before it is mentioned")
    }
}

struct Verifier<'p> {
    program: &'p Program,
    /// The number of globals that can be used.
    globals: u32,
}

impl Verifier<'_> {
    fn parameters(&self, parameters: &[Parameter], frame: &mut Frame) {
        for (at, parameter) in parameters.iter().enumerate() {
            if let Some(default) = &parameter.default {
                self.wants(default, &parameter.ty, frame);
            }
            frame.set(LocalId(at as u32), &parameter.ty);
            let ends = Type::Range(Box::new(plain(&parameter.ty)));
            self.optional(parameter.range.as_ref(), &ends, frame);
        }
    }

    fn requires(&self, requires: &[Require], frame: &mut Frame) {
        requires.iter().for_each(|require| self.wants(&require.condition, &Type::Bool, frame));
    }

    fn optional(&self, e: Option<&Expr>, ty: &Type, frame: &mut Frame) {
        e.iter().for_each(|e| self.wants(e, ty, frame));
    }

    fn wants(&self, e: &Expr, ty: &Type, frame: &mut Frame) {
        self.expr(e, frame);
        assert_eq!(plain(&e.ty), plain(ty), "{e:?}");
    }

    fn given(&self, parameters: &[Parameter], arguments: &[Option<Expr>], frame: &mut Frame) {
        assert_eq!(parameters.len(), arguments.len());
        for (parameter, argument) in parameters.iter().zip(arguments) {
            match argument {
                Some(argument) => self.wants(argument, &parameter.ty, frame),
                None => assert!(parameter.default.is_some(), "{}", parameter.name),
            }
        }
    }

    fn element(&self, element: &Element, of: &Type, frame: &mut Frame) {
        match element {
            Element::One(e) => self.wants(e, of, frame),
            Element::Spread(e) => self.wants(e, &Type::List(Box::new(of.clone())), frame),
            Element::For(each) => {
                self.expr(&each.over, frame);
                let item = match plain(&each.over.ty) {
                    Type::List(of) | Type::Range(of) => *of,
                    Type::Vec(_) => Type::Number,
                    other => panic!("a sequence of {other:?}"),
                };
                frame.set(each.local, &item);
                self.optional(each.condition.as_ref(), &Type::Bool, frame);
                self.element(&each.body, of, frame);
            }
        }
    }

    fn expr(&self, e: &Expr, frame: &mut Frame) {
        stacker::maybe_grow(128 * 1024, 1024 * 1024, || self.form(e, frame));
    }

    fn form(&self, e: &Expr, frame: &mut Frame) {
        let ty = plain(&e.ty);
        match &e.kind {
            ExprKind::SurfaceVector(_) => assert_eq!(ty, Type::Vec(3)),
            ExprKind::Number(_) | ExprKind::Time | ExprKind::Frame => assert_eq!(ty, Type::Number),
            ExprKind::Color(_) => assert_eq!(ty, Type::Color),
            ExprKind::Text(_) => assert_eq!(ty, Type::Text),
            ExprKind::Bool(_) => assert_eq!(ty, Type::Bool),
            ExprKind::Local(local) => assert_eq!(ty, *frame.get(*local)),
            ExprKind::Param(id) => {
                assert_eq!(ty, plain(&self.program.params[id.0 as usize].ty));
            }
            ExprKind::Global(id) => {
                assert!(id.0 < self.globals, "{id:?} is mentioned too early");
                assert_eq!(ty, plain(&self.program.globals[id.0 as usize].value.ty));
            }
            ExprKind::List(elements) => {
                let Type::List(of) = ty else { panic!("{e:?}") };
                elements.iter().for_each(|element| self.element(element, &of, frame));
            }
            ExprKind::Record(fields) => {
                let Type::Record(of) = ty else { panic!("{e:?}") };
                assert_eq!(fields.len(), of.len());
                fields.iter().zip(&of).for_each(|(field, (_, ty))| self.wants(field, ty, frame));
            }
            ExprKind::Field(base, at) => {
                self.expr(base, frame);
                let Type::Record(of) = plain(&base.ty) else { panic!("{e:?}") };
                assert_eq!(ty, of[*at].1);
            }
            ExprKind::MaterialField(base, _) => self.wants(base, &Type::Material, frame),
            ExprKind::Range(lo, hi) => {
                let Type::Range(of) = ty else { panic!("{e:?}") };
                self.wants(lo, &of, frame);
                self.wants(hi, &of, frame);
            }
            ExprKind::Vector(parts) => {
                parts.iter().for_each(|part| self.expr(part, frame));
                let total: u8 = parts.iter().map(|part| width(&part.ty)).sum();
                assert_eq!(total, width(&ty));
            }
            ExprKind::Swizzle(base, picked) => {
                self.expr(base, frame);
                assert!(picked.iter().all(|at| *at < width(&base.ty)));
                assert_eq!(picked.len(), usize::from(width(&ty)));
            }
            ExprKind::RangeEnd(base, _) => self.wants(base, &Type::Range(Box::new(ty)), frame),
            ExprKind::Index(base, index) => {
                self.expr(base, frame);
                self.wants(index, &Type::Int, frame);
            }
            ExprKind::Slice(base, range) => {
                self.wants(base, &ty, frame);
                self.wants(range, &Type::Range(Box::new(Type::Number)), frame);
            }
            ExprKind::Block(lets, result) => {
                for (local, _, value) in lets {
                    self.expr(value, frame);
                    frame.set(*local, &value.ty);
                }
                self.wants(result, &ty, frame);
            }
            ExprKind::If(condition, yes, no) => {
                self.wants(condition, &Type::Bool, frame);
                self.wants(yes, &ty, frame);
                self.wants(no, &ty, frame);
            }
            ExprKind::Lambda(lambda) => self.lambda(lambda, &ty, frame),
            ExprKind::FnValue(id) => {
                let function = &self.program.functions[id.0 as usize];
                let parameters = function.parameters.iter().map(|p| plain(&p.ty)).collect();
                assert_eq!(ty, Type::Fn(parameters, Box::new(plain(&function.body.ty))));
            }
            ExprKind::Call(id, arguments) => {
                let function = &self.program.functions[id.0 as usize];
                self.given(&function.parameters, arguments, frame);
                assert_eq!(ty, plain(&function.body.ty));
            }
            ExprKind::Build(id, arguments) => {
                let shape = &self.program.shapes[id.0 as usize];
                self.given(&shape.parameters, arguments, frame);
                assert_eq!(ty, Type::Shape(shape.dim));
            }
            ExprKind::Sample(shape, at) => {
                self.expr(shape, frame);
                let Type::Shape(dim) = shape.ty else { panic!("{e:?}") };
                self.wants(at, &point(dim), frame);
                assert_eq!(ty, Type::Number);
            }
            ExprKind::Apply(function, arguments) => {
                self.expr(function, frame);
                let Type::Fn(parameters, result) = &function.ty else { panic!("{e:?}") };
                assert_eq!(parameters.len(), arguments.len());
                for (want, argument) in parameters.iter().zip(arguments) {
                    self.wants(argument, want, frame);
                }
                assert_eq!(ty, plain(result));
            }
            ExprKind::Kernel(kernel, arguments) => self.kernel(*kernel, arguments, &ty, frame),
            ExprKind::With(base, changes) => {
                self.wants(base, &Type::Material, frame);
                changes.iter().for_each(|(_, value)| self.expr(value, frame));
            }
            ExprKind::Splat(value) => {
                self.wants(value, &Type::Number, frame);
                assert!(matches!(ty, Type::Vec(_) | Type::Color));
            }
            ExprKind::Constant(value) => {
                let Type::Fn(_, result) = ty else { panic!("{e:?}") };
                self.wants(value, &result, frame);
            }
            ExprKind::Error => panic!("an error was not reported: {e:?}"),
        }
    }

    fn lambda(&self, lambda: &Lambda, ty: &Type, outer: &mut Frame) {
        let mut frame = Frame::new(lambda.locals);
        for (at, captured) in lambda.captures.iter().enumerate() {
            let ty = outer.get(*captured).clone();
            frame.set(LocalId(at as u32), &ty);
        }
        for (at, parameter) in lambda.parameters.iter().enumerate() {
            frame.set(LocalId((lambda.captures.len() + at) as u32), parameter);
        }
        assert_eq!(lambda.parameters.len(), lambda.names.len());
        self.requires(&lambda.requires, &mut frame);
        self.optional(lambda.lipschitz.as_ref(), &Type::Number, &mut frame);
        self.expr(&lambda.body, &mut frame);
        let parameters = lambda.parameters.iter().map(plain).collect();
        assert_eq!(*ty, Type::Fn(parameters, Box::new(plain(&lambda.body.ty))));
    }

    fn kernel(&self, kernel: Kernel, arguments: &[Expr], ty: &Type, frame: &mut Frame) {
        arguments.iter().for_each(|argument| self.expr(argument, frame));
        let types: Vec<Type> = arguments.iter().map(|argument| plain(&argument.ty)).collect();
        match kernel {
            Kernel::Eq | Kernel::Ne | Kernel::Lt | Kernel::Le | Kernel::Gt | Kernel::Ge => {
                assert_eq!((types[0].clone(), ty), (types[1].clone(), &Type::Bool));
            }
            Kernel::Not | Kernel::And | Kernel::Or => {
                assert!(types.iter().all(|ty| *ty == Type::Bool));
            }
            Kernel::Min | Kernel::Max if matches!(types[0], Type::List(_)) => {
                assert_eq!(types, [Type::List(Box::new(ty.clone()))]);
            }
            Kernel::Length | Kernel::Distance | Kernel::Dot => {
                assert!(types.iter().all(|t| matches!(t, Type::Vec(_)) && *t == types[0]));
                assert_eq!(*ty, Type::Number);
            }
            Kernel::Lift | Kernel::Hash | Kernel::Hash3 | Kernel::Len => {}
            Kernel::Iterate => {
                assert_eq!(types[1], *ty);
                let Type::Fn(takes, gives) = &types[2] else { panic!("{types:?}") };
                assert_eq!((&takes[0], &**gives), (ty, ty));
                if let Some(item) = takes.get(1) {
                    let expected = match &types[0] {
                        Type::List(of) | Type::Range(of) => (**of).clone(),
                        other => other.clone(),
                    };
                    assert_eq!(*item, expected);
                }
                if let Some(goes_on) = types.get(3) {
                    assert_eq!(*goes_on, Type::Fn(vec![ty.clone()], Box::new(Type::Bool)));
                }
            }
            Kernel::Bounds | Kernel::Gradient | Kernel::MaterialAt => {}
            Kernel::Material => {
                assert_eq!(
                    types,
                    [Type::Color, Type::Number, Type::Number, Type::Color, Type::Number]
                );
            }
            Kernel::Rgb | Kernel::Hsv | Kernel::Oklch => {
                assert_eq!((types.len(), ty), (4, &Type::Color));
                assert!(types.iter().all(|ty| *ty == Type::Number));
            }
            Kernel::Hard => assert!(types.is_empty()),
            Kernel::Soft => assert_eq!(types, [Type::Number]),
            Kernel::GlyphCurves => {
                assert_eq!(types, [Type::Text, Type::Text, Type::Text, Type::Number, Type::Number]);
            }
            Kernel::PolygonEdges => {
                assert_eq!(types, [Type::List(Box::new(Type::Vec(2)))]);
            }
            Kernel::OutlineCells => {
                let pieces = Type::List(Box::new(Type::List(Box::new(Type::Vec(2)))));
                assert_eq!(types, [pieces, Type::Vec(2), Type::Number, Type::Vec(2)]);
            }
            // All others are componentwise or map vectors to vectors.
            _ => assert!(types.iter().all(|other| other == ty), "{kernel:?} {types:?} {ty:?}"),
        }
    }
}

fn width(ty: &Type) -> u8 {
    match ty {
        Type::Vec(width) => *width,
        Type::Color => 4,
        _ => 1,
    }
}
