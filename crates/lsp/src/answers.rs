//! The answer to each request.

use std::ops::Range;
use std::path::Path;
use std::rc::Rc;

use data_encoding::BASE64;
use sdfc_ide::{
    Analysis, HintKind, Hover, SymbolKind, actions, color_presentations, colors, complete,
    definition, folds, format, highlights, hints, hover, lenses, prepare_rename, references,
    rename, selection, signature_help, symbols, tokens,
};
use serde_json::{Value, json};

use crate::client::Client;
use crate::convert::{
    action_kind, completion, fold_kind, hint_kind, location, semantic_tokens, symbol, symbol_kind,
    workspace_edit,
};
use crate::documents::Documents;
use crate::lines::Lines;
use crate::uri::path;

/// A request about one file.
struct About<'a, 'd> {
    documents: &'a mut Documents<'d>,
    client: Client,
    file: &'a Path,
    params: &'a Value,
}

/// Answers a request; `None` if there is no such method.
pub fn answer(
    documents: &mut Documents<'_>,
    client: Client,
    method: &str,
    params: &Value,
) -> Option<Result<Value, String>> {
    let file = path(params["textDocument"]["uri"].as_str().unwrap_or_default());
    let mut about = About { documents, client, file: &file, params };
    if method == "workspace/symbol" {
        return Some(Ok(about.workspace_symbols()));
    }
    let name = method.strip_prefix("textDocument/")?;
    if name == "completion" {
        return Some(Ok(about.completions()));
    }
    if name == "colorPresentation" {
        return Some(Ok(about.color_presentations()));
    }
    let answers: fn(&mut About<'_, '_>, &Analysis) -> Result<Value, String> = match name {
        "hover" => |it, scene| Ok(it.hover(scene)),
        "signatureHelp" => |it, scene| Ok(it.signature_help(scene)),
        "definition" => |it, scene| Ok(it.definition(scene)),
        "references" => |it, scene| Ok(it.references(scene)),
        "documentHighlight" => |it, scene| Ok(it.highlights(scene)),
        "documentSymbol" => |it, scene| Ok(it.symbols(scene)),
        "codeAction" => |it, scene| Ok(it.actions(scene)),
        "formatting" => |it, scene| Ok(it.formatting(scene)),
        "prepareRename" => |it, scene| it.prepare_rename(scene),
        "rename" => |it, scene| it.rename(scene),
        "foldingRange" => |it, scene| Ok(it.folds(scene)),
        "selectionRange" => |it, scene| Ok(it.selections(scene)),
        "codeLens" => |it, scene| Ok(it.lenses(scene)),
        "documentColor" => |it, scene| Ok(it.colors(scene)),
        "inlayHint" => |it, scene| Ok(it.hints(scene)),
        "semanticTokens/full" => |it, scene| Ok(it.tokens(scene)),
        _ => return None,
    };
    let Some(scene) = about.documents.analysis(&file) else {
        return Some(Err(format!("{} cannot be read", file.display())));
    };
    Some(answers(&mut about, &scene))
}

impl About<'_, '_> {
    fn lines<'t>(&self, scene: &'t Analysis) -> Lines<'t> {
        Lines::new(scene.text(), self.client.encoding)
    }

    fn offset(&self, scene: &Analysis) -> usize {
        self.lines(scene).offset(&self.params["position"])
    }

    fn location(&self, scene: &Analysis, at: &sdfc_ide::Location) -> Value {
        location(self.documents, scene, at, self.client.encoding)
    }

    fn completions(&self) -> Value {
        let Some(text) = self.documents.text(self.file) else { return Value::Null };
        let lines = Lines::new(&text, self.client.encoding);
        let offset = lines.offset(&self.params["position"]);
        let name = self.file.display().to_string();
        let files = self.documents.importable(self.file);
        let found = self
            .documents
            .with_resolver(self.file, |resolver| complete(&name, &text, offset, resolver, &files));
        found.iter().map(|it| completion(it, &lines, self.client.snippets)).collect()
    }

    fn hover(&mut self, scene: &Analysis) -> Value {
        let offset = self.offset(scene);
        let found = hover(scene, offset, &mut |call| self.documents.facts(scene, call));
        let Some(Hover { range, mut markdown, example }) = found else { return Value::Null };
        if let Some(example) = example.filter(|_| self.client.pictures)
            && let Some(png) = self.documents.picture(example.clone())
        {
            let (name, png) = (example.name, BASE64.encode(png));
            markdown = format!("![{name}](data:image/png;base64,{png})\n\n{markdown}");
        }
        json!({
            "contents": { "kind": "markdown", "value": markdown },
            "range": self.lines(scene).range(range),
        })
    }

    fn signature_help(&self, scene: &Analysis) -> Value {
        let help = signature_help(scene, self.offset(scene));
        if help.is_empty() {
            return Value::Null;
        }
        let signatures = help.into_iter().map(|it| {
            let parameters = it
                .parameters
                .iter()
                .map(|(label, about)| json!({ "label": label, "documentation": about }));
            let parameters: Vec<Value> = parameters.collect();
            json!({
                "label": it.label,
                "documentation": { "kind": "markdown", "value": it.docs },
                "parameters": parameters,
                "activeParameter": it.active,
            })
        });
        let signatures: Vec<Value> = signatures.collect();
        let active = signatures[0]["activeParameter"].clone();
        json!({ "signatures": signatures, "activeSignature": 0, "activeParameter": active })
    }

    fn definition(&self, scene: &Analysis) -> Value {
        let found = definition(scene, self.offset(scene));
        found.map_or(Value::Null, |at| self.location(scene, &at))
    }

    fn references(&mut self, scene: &Analysis) -> Value {
        let offset = self.offset(scene);
        let others = self.documents.others(self.file);
        let others: Vec<&Analysis> = others.iter().map(Rc::as_ref).collect();
        let with_declaration = self.params["context"]["includeDeclaration"] == json!(true);
        let found = references(scene, &others, offset, with_declaration);
        found.iter().map(|at| self.location(scene, at)).collect()
    }

    fn highlights(&self, scene: &Analysis) -> Value {
        let lines = self.lines(scene);
        let found = highlights(scene, self.offset(scene)).into_iter();
        let shown = found.map(|(range, declares)| {
            json!({ "range": lines.range(range), "kind": if declares { 3 } else { 2 } })
        });
        shown.collect()
    }

    fn symbols(&self, scene: &Analysis) -> Value {
        let lines = self.lines(scene);
        symbols(scene).iter().map(|it| symbol(it, &lines)).collect()
    }

    fn lenses(&mut self, scene: &Analysis) -> Value {
        let found = lenses(scene, &mut |call| self.documents.facts(scene, call));
        let lines = self.lines(scene);
        let shown = found.into_iter().map(|it| {
            let command = json!({ "title": it.label, "command": "" });
            json!({ "range": lines.range(it.range), "command": command })
        });
        shown.collect()
    }

    fn workspace_symbols(&mut self) -> Value {
        let wanted = self.params["query"].as_str().unwrap_or_default().to_lowercase();
        let mut found = Vec::new();
        for scene in self.documents.workspace() {
            let file = scene.name().to_owned();
            let named = symbols(&scene).into_iter().filter(|it| {
                let has_name = !matches!(it.kind, SymbolKind::Setting | SymbolKind::Drawn);
                has_name && it.name.to_lowercase().contains(&wanted)
            });
            found.extend(named.map(|it| {
                let Range { start, end } = it.name_range;
                let at = sdfc_ide::Location { file: file.clone(), start, end };
                let location = self.location(&scene, &at);
                json!({ "name": it.name, "kind": symbol_kind(it.kind), "location": location })
            }));
        }
        Value::Array(found)
    }

    fn actions(&self, scene: &Analysis) -> Value {
        let range = self.lines(scene).bytes(&self.params["range"]);
        let shown = actions(scene, range).into_iter().map(|it| {
            json!({
                "title": it.title,
                "kind": action_kind(it.kind),
                "isPreferred": it.preferred,
                "edit": workspace_edit(self.documents, &it.edits, self.client.encoding),
            })
        });
        shown.collect()
    }

    fn formatting(&self, scene: &Analysis) -> Value {
        match format(scene.text()) {
            Some(text) if text != scene.text() => {
                let range = self.lines(scene).range(0..scene.text().len());
                json!([{ "range": range, "newText": text }])
            }
            Some(_) => json!([]),
            None => Value::Null,
        }
    }

    fn prepare_rename(&mut self, scene: &Analysis) -> Result<Value, String> {
        let range = prepare_rename(scene, self.offset(scene))?;
        Ok(self.lines(scene).range(range))
    }

    fn rename(&mut self, scene: &Analysis) -> Result<Value, String> {
        let offset = self.offset(scene);
        let others = self.documents.others(self.file);
        let others: Vec<&Analysis> = others.iter().map(Rc::as_ref).collect();
        let to = self.params["newName"].as_str().unwrap_or_default();
        let edits = rename(scene, &others, offset, to)?;
        Ok(workspace_edit(self.documents, &edits, self.client.encoding))
    }

    fn folds(&self, scene: &Analysis) -> Value {
        let lines = self.lines(scene);
        let shown = folds(scene).into_iter().map(|it| {
            let (start, end) =
                (lines.line_column(it.range.start).0, lines.line_column(it.range.end).0);
            json!({ "startLine": start, "endLine": end, "kind": fold_kind(it.kind) })
        });
        shown.collect()
    }

    fn selections(&self, scene: &Analysis) -> Value {
        let lines = self.lines(scene);
        let positions = self.params["positions"].as_array().into_iter().flatten();
        let shown = positions.map(|position| {
            let ranges = selection(scene, lines.offset(position));
            let around = ranges.into_iter().rev();
            around.fold(Value::Null, |parent, range| {
                let mut selected = json!({ "range": lines.range(range) });
                if !parent.is_null() {
                    selected["parent"] = parent;
                }
                selected
            })
        });
        shown.collect()
    }

    fn colors(&self, scene: &Analysis) -> Value {
        let lines = self.lines(scene);
        let shown = colors(scene).into_iter().map(|it| {
            let [red, green, blue, alpha] = it.rgba;
            let color = json!({ "red": red, "green": green, "blue": blue, "alpha": alpha });
            json!({ "range": lines.range(it.range), "color": color })
        });
        shown.collect()
    }

    fn color_presentations(&self) -> Value {
        let color = &self.params["color"];
        let parts = ["red", "green", "blue", "alpha"];
        let rgba = parts.map(|part| color[part].as_f64().unwrap_or(1.0));
        color_presentations(rgba).into_iter().map(|label| json!({ "label": label })).collect()
    }

    fn hints(&mut self, scene: &Analysis) -> Value {
        let uncertified = self.documents.uncertified(scene);
        let lines = self.lines(scene);
        let found = hints(scene, lines.bytes(&self.params["range"]), &uncertified).into_iter();
        let shown = found.map(|it| {
            let mut shown = json!({
                "position": lines.position(it.at),
                "label": it.label,
                "paddingLeft": it.kind == HintKind::Uncertified,
                "paddingRight": it.kind == HintKind::Parameter,
            });
            if let Some(kind) = hint_kind(it.kind) {
                shown["kind"] = json!(kind);
            }
            if !it.about.is_empty() {
                shown["tooltip"] = json!(it.about);
            }
            shown
        });
        shown.collect()
    }

    fn tokens(&self, scene: &Analysis) -> Value {
        let lines = self.lines(scene);
        json!({ "data": semantic_tokens(&tokens(scene), scene.text(), &lines) })
    }
}
