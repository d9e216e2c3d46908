//! The top level of a file: imports, params, lets, shapes to draw and settings, in order.

use sdfc_diagnostics::{Code, Diagnostic, FileId, Span, has_errors};
use sdfc_graph::Dim;
use sdfc_syntax::ast::{self, ExprKind as Ast, Item};

use super::body::Body;
use super::call::{Callee, Given};
use super::coerce::region_for_solid;
use super::decl::{ParameterSignature, Target};
use super::names::{Entry, Found, ImportedName, is_private};
use super::types::{self, describe};
use super::{Checker, LetIndex, ParamIndex};
use crate::hir::{Expr, Setting, SettingKind, Type};
use crate::import;
use crate::settings::SettingParameter;
use crate::spelling::{ask, nearest};

/// An item that is evaluated at the top level.
enum TopLevel<'a> {
    Let(LetIndex),
    Param(ParamIndex),
    Expr(&'a ast::Expr),
}

impl<'a> Checker<'a> {
    /// Checks the scene's file.
    pub(super) fn check_scene(&mut self, module: usize, file: FileId, ast: &'a ast::File) {
        self.import(module, ast);
        self.find_union(Dim::Three);
        for item in self.named_items(module, ast) {
            match item {
                TopLevel::Let(index) => self.check_let(index),
                TopLevel::Param(index) => self.check_param(index),
                TopLevel::Expr(e) => self.check_top_level(module, e),
            }
        }
        self.check_dimensions();
        self.check_declarations(module);
        self.program.params = self.params.iter_mut().filter_map(|p| p.checked.take()).collect();
        self.warn_unused(module);
        if self.program.drawn.is_empty() && !has_errors(&self.diagnostics) {
            let message = "this file draws nothing";
            self.report(
                Diagnostic::warning(Code::NOTHING_DRAWN, Span::new(file, 0, 0), message)
                    .help("a shape on a line of its own is drawn: sphere(1)"),
            );
        }
    }

    /// Adds the settings of the default look to a scene that does not light itself, except those
    /// that the scene states. They are about light, so a planar scene gets none.
    pub(super) fn check_look(&mut self, module: usize, look: &'a ast::File) {
        if self.program.is_planar() {
            return;
        }
        let stated: Vec<SettingKind> = self.program.settings.iter().map(|s| s.kind).collect();
        if stated.iter().any(|kind| kind.is_light()) {
            return;
        }
        // A picture of the surroundings takes the place of all light of the look.
        let has_image = self.program.settings.iter().any(|setting| self.is_image(setting));
        for item in &look.items {
            let Item::Expr(e) = item else { continue };
            let outer = std::mem::replace(&mut self.body, Body::new(module, e.span.start));
            if let Some((row, callee, args)) = self.as_setting(e)
                && !stated.iter().any(|&kind| replaces(kind, self.settings[row].kind))
                && !(has_image && self.settings[row].kind.is_light())
            {
                self.setting(row, callee, args);
            }
            self.leave_top_level(outer);
        }
    }

    /// True if a setting is a sky with a picture.
    fn is_image(&self, setting: &Setting) -> bool {
        let row = self.settings.iter().find(|row| row.kind == setting.kind);
        let image = row.and_then(|row| row.parameters.iter().position(|it| it.name == "image"));
        image.is_some_and(|image| matches!(setting.args.get(image), Some(Some(_))))
    }

    /// Replaces the camera of the scene by the one of another file, which sees the scene's names.
    pub(super) fn replace_camera(&mut self, module: usize, camera: &'a ast::File) {
        self.program.settings.retain(|setting| setting.kind != SettingKind::Camera);
        for item in &camera.items {
            let Item::Expr(e) = item else { continue };
            let outer = std::mem::replace(&mut self.body, Body::new(module, u32::MAX));
            if let Some((row, callee, args)) = self.as_setting(e) {
                self.setting(row, callee, args);
            }
            self.leave_top_level(outer);
        }
        self.drain();
    }

    /// Checks the declarations of an imported file, but not what it draws or its settings.
    pub(super) fn check_imported(&mut self, module: usize, ast: &'a ast::File) {
        self.import(module, ast);
        for item in self.named_items(module, ast) {
            match item {
                TopLevel::Let(index) => self.check_let(index),
                TopLevel::Param(index) => self.check_param(index),
                TopLevel::Expr(_) => {}
            }
        }
        self.check_declarations(module);
    }

    /// The lets, params and expressions of a file, in order.
    fn named_items(&self, module: usize, ast: &'a ast::File) -> Vec<TopLevel<'a>> {
        let lets = (0..self.lets.len()).filter(|at| self.lets[*at].module == module);
        let params = (0..self.params.len()).filter(|at| self.params[*at].module == module);
        let (mut lets, mut params) = (lets.map(LetIndex), params.map(ParamIndex));
        let item = |item: &'a Item| match item {
            Item::Import(_) | Item::Decl(_) => None,
            Item::Let(_) => lets.next().map(TopLevel::Let),
            Item::Param(_) => params.next().map(TopLevel::Param),
            Item::Expr(e) => Some(TopLevel::Expr(e)),
        };
        ast.items.iter().filter_map(item).collect()
    }

    /// Brings the imported names of a file into its scope. Files that could not be read, or
    /// that import each other in a circle, were reported when they were loaded.
    fn import(&mut self, module: usize, ast: &'a ast::File) {
        self.body.module = module;
        for item in &ast.items {
            let Item::Import(import) = item else { continue };
            let path = self.modules[module].path.filter(|path| !path.is_empty());
            let from = path.unwrap_or(self.scene_path);
            let path = import::locate(from, &import.path.text).ok();
            // A file comes after those that it imports, so an import of a later file is circular.
            let earlier = &self.modules[..module];
            let source = path.and_then(|path| {
                earlier.iter().position(|module| module.path == Some(path.as_str()))
            });
            for (name, renamed) in &import.names {
                let entry = source.and_then(|source| self.exported(source, name));
                if let Some(entry) = &entry {
                    let declared = self.entry_span(entry);
                    for name in [Some(name), renamed.as_ref()].into_iter().flatten() {
                        self.note_declared(name.span, declared);
                    }
                }
                self.import_name(module, renamed.as_ref().unwrap_or(name), entry);
            }
        }
    }

    fn exported(&mut self, source: usize, name: &'a ast::Name) -> Option<Entry> {
        let names = &self.modules[source].names;
        let file = self.modules[source].path.unwrap_or("");
        let entry = names.get(name.text.as_str()).cloned();
        let found = match &entry {
            Some(_) if is_private(&name.text) => {
                let message = format!("`{}` is private to `{file}`", name.text);
                Diagnostic::error(Code::IMPORT, name.span, message)
                    .help("to export it, remove the leading `_` from its name")
            }
            Some(_) => return entry,
            None if !self.modules[source].whole => return None,
            None => {
                let message = format!("`{file}` does not declare `{}`", name.text);
                let found = Diagnostic::error(Code::IMPORT, name.span, message);
                let public = names.keys().copied().filter(|name| !is_private(name));
                match nearest(&name.text, public) {
                    Some(near) => ask(near).add_to(found),
                    None => found,
                }
            }
        };
        self.report(found);
        None
    }

    fn import_name(&mut self, module: usize, name: &'a ast::Name, entry: Option<Entry>) {
        let imported = ImportedName { used: entry.is_none(), entry, span: name.span };
        if let Some(first) = self.modules[module].imports.insert(&name.text, imported) {
            let message = format!("`{}` is imported twice", name.text);
            self.report(
                Diagnostic::error(Code::DECLARED_TWICE, name.span, message)
                    .note_at(first.span, "first imported here")
                    .help(format!("rename one of them: {} as other", name.text)),
            );
        }
    }

    /// Reports scenes that draw both regions and solids, and settings without effect on the shapes
    /// that are drawn.
    fn check_dimensions(&mut self) {
        let is_region = |drawn: &Expr| drawn.ty == Type::Shape(Dim::Two);
        let solid = self.program.drawn.iter().find(|drawn| !is_region(drawn));
        let regions = self.program.drawn.iter().filter(|drawn| is_region(drawn));
        let regions: Vec<Span> = regions.map(|region| region.span).collect();
        if let Some(solid) = solid.map(|solid| solid.span)
            && !regions.is_empty()
        {
            for region in regions {
                let wanted = "a scene draws either regions or solids, and this one draws solids";
                let found = region_for_solid(region, wanted);
                self.report(found.note_at(solid, "this is a solid (3D)"));
            }
            return;
        }
        if self.program.is_planar() {
            self.find_union(Dim::Two);
            self.check_planar_camera();
        }
        self.warn_idle_settings();
    }

    /// Reports a camera that a planar picture cannot have.
    fn check_planar_camera(&mut self) {
        let camera = self.program.settings.iter().find(|s| s.kind == SettingKind::Camera);
        let Some(&Setting { ref args, span, .. }) = camera else { return };
        let row = self.settings.iter().find(|row| row.kind == SettingKind::Camera);
        let named = |name: &str| {
            let position = row?.parameters.iter().position(|it| it.name == name)?;
            args.get(position)?.as_ref()
        };
        if named("height").is_some() {
            return;
        }
        let at = named("fov").map_or(span, |fov| fov.span);
        let message = "a planar picture has no perspective, so its camera needs `height`";
        self.report(
            Diagnostic::error(Code::ARGUMENTS, at, message)
                .help("write camera(eye: [0, 0, 1], height: 4), without `fov`")
                .help("or draw solids: .extrude(0.2)"),
        );
    }

    /// Warns about settings that do not change the picture.
    fn warn_idle_settings(&mut self) {
        if self.program.drawn.is_empty() {
            return;
        }
        let is_planar = self.program.is_planar();
        let has_effect = |kind: SettingKind| match is_planar {
            true => kind.is_for_regions(),
            false => kind.is_for_solids(),
        };
        let idle = self.program.settings.iter().filter(|setting| !has_effect(setting.kind));
        let idle: Vec<(Span, SettingKind)> = idle.map(|it| (it.span, it.kind)).collect();
        for (span, kind) in idle {
            let name = self.settings.iter().find(|row| row.kind == kind).map_or("", |row| row.name);
            let (message, help) = if is_planar {
                let why = "the scene draws regions, as written and without light";
                (
                    format!("`{name}` has no effect: {why}"),
                    "remove it, or draw solids: .extrude(0.2)",
                )
            } else {
                (format!("`{name}` has no effect: the scene draws solids"), "remove it")
            };
            self.report(Diagnostic::warning(Code::IDLE_SETTING, span, message).help(help));
        }
    }

    /// Resolves the library's union, which joins the shapes that are drawn.
    fn find_union(&mut self, dim: Dim) {
        let Some(Found::Decls(decls)) = self.look_up_library("union") else { return };
        let first = decls[0];
        let span = self.decls[first.0].ast.name.span;
        let dim = self.decls[first.0].generic.then_some(dim);
        if let Some(signature) = self.instance(first, dim, span)
            && let Target::Shape(id) = signature.target
        {
            self.program.union = Some(id);
        }
    }

    /// Ends a top-level expression and restores the outer body.
    pub(super) fn leave_top_level(&mut self, outer: Body<'a>) {
        let body = std::mem::replace(&mut self.body, outer);
        let locals = body.frames.first().map_or(0, |frame| frame.locals);
        self.program.locals = self.program.locals.max(locals);
    }

    /// Checks a shape that is drawn, or a setting.
    fn check_top_level(&mut self, module: usize, e: &'a ast::Expr) {
        let outer = std::mem::replace(&mut self.body, Body::new(module, e.span.start));
        match self.as_setting(e) {
            Some((row, callee, args)) => self.setting(row, callee, args),
            None => self.drawing(e),
        }
        self.leave_top_level(outer);
    }

    /// The setting that a top-level call refers to.
    fn as_setting(&mut self, e: &'a ast::Expr) -> Option<(usize, Callee<'a>, &'a [ast::Arg])> {
        let Ast::Call(callee, args) = &e.kind else { return None };
        let Ast::Name(name) = &callee.kind else { return None };
        match self.look_up(name) {
            Some(found @ Found::Setting(row)) => {
                self.note_use(callee.span, name, &found);
                Some((row, Callee { name, at: callee.span, span: e.span }, args))
            }
            _ => None,
        }
    }

    fn drawing(&mut self, e: &'a ast::Expr) {
        if self.is_formula_of_point(e) {
            let message = "a formula of `p` is a shape only within a declaration";
            let help = "write `solid name() = ` before it, and `name()` in the next line";
            self.report(Diagnostic::error(Code::NO_POINT, e.span, message).help(help));
            return;
        }
        let value = self.infer(e);
        let found = match &value.ty {
            Type::Error => return,
            Type::Shape(_) => {
                self.program.drawn.push(value);
                return;
            }
            ty if types::poisoned(ty) => return,
            Type::List(of) if matches!(**of, Type::Shape(_)) => {
                unused(value.span, &value.ty).help("join them: union(...)")
            }
            Type::Fn(_, result) if matches!(**result, Type::Shape(_)) => {
                unused(value.span, &value.ty).help("call it, with its arguments in parentheses")
            }
            ty => unused(value.span, ty).help("give it a name: let a = ..."),
        };
        self.report(found);
    }

    fn setting(&mut self, row: usize, callee: Callee<'a>, args: &'a [ast::Arg]) {
        let row = self.settings[row].clone();
        let parameters: Vec<ParameterSignature> = row
            .parameters
            .iter()
            .map(|parameter| ParameterSignature {
                name: parameter.name,
                ty: parameter.ty.clone(),
                variadic: false,
                optional: parameter.optional,
                untyped: false,
                default: None,
            })
            .collect();
        let given = args.iter().map(Given::of).collect();
        let args = self.arguments(callee, &parameters, given);
        if let Some(first) = self.program.settings.iter().find(|s| s.kind == row.kind && row.once) {
            let message = format!("`{}` appears twice", row.name);
            let found = Diagnostic::error(Code::SETTING_TWICE, callee.at, message)
                .note_at(first.span, "the first one");
            self.report(found);
            return;
        }
        let rival = match row.kind {
            SettingKind::Sky => Some(SettingKind::Background),
            SettingKind::Background => Some(SettingKind::Sky),
            _ => None,
        };
        if let Some(first) = self.program.settings.iter().find(|s| Some(s.kind) == rival) {
            let message = "a scene can have `sky` or `background`, but not both";
            let found = Diagnostic::error(Code::SETTING_TWICE, callee.at, message)
                .note_at(first.span, "the other one")
                .help("both set the colour of rays that hit nothing: remove one");
            self.report(found);
        }
        let index_of = |name: &str| parameters.iter().position(|parameter| parameter.name == name);
        if row.kind == SettingKind::Camera
            && let (Some(fov), Some(height)) = (index_of("fov"), index_of("height"))
            && let (Some(_), Some(height)) = (&args[fov], &args[height])
        {
            let message = "a camera can have `fov` or `height`, but not both";
            let found = Diagnostic::error(Code::ARGUMENTS, height.span, message)
                .help("`fov` is for a perspective view, `height` for a parallel view");
            self.report(found);
        }
        if row.kind == SettingKind::Sky {
            self.check_sky(&row.parameters, &args);
        }
        self.program.settings.push(Setting { kind: row.kind, args, span: callee.span });
    }

    /// Reports arguments of a gradient beside a picture, and of a picture without one.
    fn check_sky(&mut self, parameters: &[SettingParameter], args: &[Option<Expr>]) {
        let given = |name: &str| {
            let position = parameters.iter().position(|parameter| parameter.name == name)?;
            Some((parameters[position].name, args.get(position)?.as_ref()?.span))
        };
        let of_gradient = ["zenith", "horizon", "ground"].into_iter().find_map(given);
        let of_image = ["turn", "strength"].into_iter().find_map(given);
        let (name, span, message, help) = match (given("image"), of_gradient, of_image) {
            (Some(_), Some((name, span)), _) => {
                (name, span, "is the colour of a gradient, but this sky is a picture", "remove it")
            }
            (None, _, Some((name, span))) => (
                name,
                span,
                "belongs to a picture, but this sky is a gradient",
                "remove it, or write image: \"studio.hdr\"",
            ),
            (Some(_) | None, _, _) => return,
        };
        let message = format!("`{name}` {message}");
        self.report(Diagnostic::error(Code::ARGUMENTS, span, message).help(help));
    }

    /// Warns about unused private names and imports.
    fn warn_unused(&mut self, module: usize) {
        let decls =
            self.decls.iter().filter(|d| d.module == module && !d.used).map(|d| &d.ast.name);
        let lets = self.lets.iter().filter(|l| l.module == module && !l.used).map(|l| &l.ast.name);
        let params =
            self.params.iter().filter(|p| p.module == module && !p.used).map(|p| &p.ast.name);
        let names = decls.chain(lets).chain(params).filter(|name| is_private(&name.text));
        let names = names.map(|name| (name.text.as_str(), name.span));
        let imports = self.modules[module].imports.iter().filter(|(_, import)| !import.used);
        let unused: Vec<(&str, Span)> =
            names.chain(imports.map(|(name, import)| (*name, import.span))).collect();
        for (name, span) in unused {
            let message = format!("`{name}` is never used");
            self.report(Diagnostic::warning(Code::UNUSED, span, message).help("remove it"));
        }
    }
}

/// True if a stated setting takes the place of a setting of the default look.
fn replaces(stated: SettingKind, of_look: SettingKind) -> bool {
    stated == of_look || (stated == SettingKind::Background && of_look == SettingKind::Sky)
}

fn unused(span: Span, ty: &Type) -> Diagnostic {
    let message = format!("this value is not used: it is {}", describe(ty));
    Diagnostic::error(Code::UNUSED_VALUE, span, message)
}
