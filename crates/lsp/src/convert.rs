//! The answers of `sdfc-ide` as the protocol writes them.

use std::collections::BTreeMap;

use sdfc_ide::{
    ActionKind, Analysis, Completion, CompletionKind, Edit, FoldKind, Found, HintKind, Location,
    Severity, Symbol, SymbolKind, TokenRole, TokenSpan,
};
use serde_json::{Map, Value, json};

use crate::documents::Documents;
use crate::lines::{Encoding, Lines};
use crate::uri::uri;

/// The names of the kinds of semantic tokens, by index.
pub const TOKEN_TYPES: [&str; 12] = [
    "comment",
    "keyword",
    "number",
    "string",
    "operator",
    "function",
    "class",
    "macro",
    "type",
    "parameter",
    "variable",
    "property",
];

/// The names of the modifiers of semantic tokens, by bit.
pub const TOKEN_MODIFIERS: [&str; 4] =
    ["declaration", "defaultLibrary", "documentation", "readonly"];

/// A location in any file.
pub fn location(
    documents: &Documents<'_>,
    scene: &Analysis,
    at: &Location,
    encoding: Encoding,
) -> Value {
    let path = documents.path_of(&at.file);
    let text = scene.text_of(&at.file).map(str::to_owned).or_else(|| documents.text(&path));
    let range = Lines::new(&text.unwrap_or_default(), encoding).range(at.range());
    json!({ "uri": uri(&path), "range": range })
}

/// A diagnostic.
pub fn diagnostic(
    documents: &Documents<'_>,
    scene: &Analysis,
    lines: &Lines<'_>,
    it: &Found,
    encoding: Encoding,
) -> Value {
    let related = it.related.iter().map(|note| {
        json!({
            "location": location(documents, scene, &note.at, encoding),
            "message": note.message,
        })
    });
    json!({
        "range": lines.range(it.range.clone()),
        "severity": match it.severity { Severity::Error => 1, Severity::Warning => 2 },
        "code": it.code,
        "source": "sdfc",
        "message": it.message,
        "relatedInformation": related.collect::<Vec<_>>(),
        "tags": if it.unused { vec![1] } else { Vec::new() },
    })
}

/// Changes of several files.
pub fn workspace_edit(documents: &Documents<'_>, edits: &[Edit], encoding: Encoding) -> Value {
    let mut files: BTreeMap<&str, Vec<&Edit>> = BTreeMap::new();
    for edit in edits {
        files.entry(&edit.at.file).or_default().push(edit);
    }
    let changes = files.into_iter().map(|(file, edits)| {
        let path = documents.path_of(file);
        let text = documents.text(&path).unwrap_or_default();
        let lines = Lines::new(&text, encoding);
        let edits = edits
            .into_iter()
            .map(|edit| json!({ "range": lines.range(edit.at.range()), "newText": edit.text }));
        (uri(&path), edits.collect::<Value>())
    });
    json!({ "changes": changes.collect::<Map<String, Value>>() })
}

/// A completion. Gaps to fill in are only for editors that know snippets.
pub fn completion(it: &Completion, lines: &Lines<'_>, snippets: bool) -> Value {
    let has_gaps = it.insert.contains('$');
    let text = match (snippets, has_gaps) {
        (true, _) | (false, false) => it.insert.clone(),
        (false, true) => it.label.trim_end_matches("(...)").to_owned(),
    };
    let kind = match it.kind {
        CompletionKind::Variable => 6,
        CompletionKind::Param => 21,
        CompletionKind::Function => 3,
        CompletionKind::Shape => 7,
        CompletionKind::Setting => 2,
        CompletionKind::Type => 25,
        CompletionKind::Argument => 5,
        CompletionKind::Property => 10,
        CompletionKind::Keyword => 14,
        CompletionKind::Snippet => 15,
        CompletionKind::File => 17,
        CompletionKind::Choice => 12,
    };
    json!({
        "label": it.label,
        "kind": kind,
        "detail": it.detail,
        "documentation": { "kind": "markdown", "value": it.docs },
        "sortText": format!("{}{}", it.rank, it.label),
        "filterText": it.label,
        "insertTextFormat": if snippets && has_gaps { 2 } else { 1 },
        "textEdit": { "range": lines.range(it.replace.clone()), "newText": text },
    })
}

/// The kind of a symbol.
pub fn symbol_kind(kind: SymbolKind) -> u8 {
    match kind {
        SymbolKind::Function => 12,
        SymbolKind::Shape => 5,
        SymbolKind::Param => 14,
        SymbolKind::Let => 13,
        SymbolKind::Setting => 7,
        SymbolKind::Drawn => 19,
    }
}

/// A symbol of the outline.
pub fn symbol(it: &Symbol, lines: &Lines<'_>) -> Value {
    json!({
        "name": it.name,
        "detail": it.detail,
        "kind": symbol_kind(it.kind),
        "range": lines.range(it.range.clone()),
        "selectionRange": lines.range(it.name_range.clone()),
    })
}

/// The kinds of actions.
pub const ACTION_KINDS: [&str; 3] = ["quickfix", "refactor.extract", "refactor.rewrite"];

/// The kind of an action.
pub fn action_kind(kind: ActionKind) -> &'static str {
    let [fix, extract, rewrite] = ACTION_KINDS;
    match kind {
        ActionKind::Fix => fix,
        ActionKind::Extract => extract,
        ActionKind::Rewrite => rewrite,
    }
}

/// The number of a hint's kind; the protocol has none for uncertified shapes.
pub fn hint_kind(kind: HintKind) -> Option<u8> {
    match kind {
        HintKind::Type => Some(1),
        HintKind::Parameter => Some(2),
        HintKind::Uncertified => None,
    }
}

/// The kind of a range that can be folded.
pub fn fold_kind(kind: FoldKind) -> &'static str {
    match kind {
        FoldKind::Code => "region",
        FoldKind::Comment => "comment",
        FoldKind::Imports => "imports",
    }
}

/// Semantic tokens, each relative to the one before it. A token of several lines is left out.
pub fn semantic_tokens(tokens: &[TokenSpan], text: &str, lines: &Lines<'_>) -> Vec<usize> {
    let (mut data, mut last) = (Vec::new(), (0, 0));
    for token in tokens {
        let Some(word) = text.get(token.range.clone()).filter(|word| !word.contains('\n')) else {
            continue;
        };
        let (line, column) = lines.line_column(token.range.start);
        let start = if line == last.0 { column - last.1 } else { column };
        let (kind, modifiers) = token_kind(token);
        data.extend([line - last.0, start, lines.length(word), kind, modifiers]);
        last = (line, column);
    }
    data
}

fn token_kind(token: &TokenSpan) -> (usize, usize) {
    let kind = match token.role {
        TokenRole::Comment | TokenRole::Docs => 0,
        TokenRole::Keyword => 1,
        TokenRole::Number => 2,
        TokenRole::Text => 3,
        TokenRole::Operator => 4,
        TokenRole::Function => 5,
        TokenRole::Shape => 6,
        TokenRole::Setting => 7,
        TokenRole::Type => 8,
        TokenRole::Parameter => 9,
        TokenRole::Variable | TokenRole::Param => 10,
        TokenRole::Property => 11,
    };
    let flag = |set: bool, bit: usize| usize::from(set) << bit;
    let modifiers = flag(token.declares, 0)
        | flag(token.built_in, 1)
        | flag(token.role == TokenRole::Docs, 2)
        | flag(token.role == TokenRole::Variable, 3);
    (kind, modifiers)
}
