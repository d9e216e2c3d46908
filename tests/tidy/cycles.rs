//! Finds cycles between the modules of a crate.
//!
//! A module depends on the modules that its `use` declarations and its paths with `crate` or
//! `super` name. A path to a re-exported item counts as a path to the module that defines the item,
//! so an import through the crate's root hides no cycle. Test modules do not count.

use std::collections::{BTreeMap, BTreeSet};

use crate::tokens::{Token, tokens, without_tests};

/// The names that lead from the crate's root to a module; empty for the root.
pub type ModulePath = Vec<String>;

/// The most re-exports that lead from a path to the item's module.
const MAX_REEXPORTS: usize = 10;

/// Returns the groups of modules of which each depends on all others of its group.
///
/// `sources` holds the Rust source of every module.
pub fn cycles(sources: &BTreeMap<ModulePath, String>) -> Vec<BTreeSet<ModulePath>> {
    let krate = Crate::new(sources);
    let reachable: BTreeMap<&ModulePath, BTreeSet<ModulePath>> =
        krate.modules.keys().map(|module| (module, krate.reachable(module))).collect();
    let mut groups = BTreeSet::new();
    for (module, targets) in &reachable {
        let is_mutual = |other: &&ModulePath| reachable[other].contains(*module);
        let group: BTreeSet<_> = targets.iter().filter(is_mutual).cloned().collect();
        if group.len() > 1 {
            groups.insert(group);
        }
    }
    groups.into_iter().collect()
}

/// A path in a module's source.
struct Import {
    /// The path as it is written, such as `crate::a::B`; `*` for everything of a module.
    path: Vec<String>,
    /// The name that the module has the item by, if the path belongs to a `use` declaration.
    name: Option<String>,
    /// True for `pub use` and `pub(crate) use`.
    is_reexport: bool,
}

struct Module {
    imports: Vec<Import>,
    /// The items that the module itself defines.
    items: BTreeSet<String>,
}

struct Crate {
    modules: BTreeMap<ModulePath, Module>,
}

impl Crate {
    fn new(sources: &BTreeMap<ModulePath, String>) -> Self {
        let module = |source| {
            let tokens = without_tests(tokens(source));
            Module { imports: imports(&tokens), items: items(&tokens) }
        };
        let modules = sources.iter().map(|(path, source)| (path.clone(), module(source)));
        Self { modules: modules.collect() }
    }

    /// Returns every module that `start` depends on, directly or not.
    fn reachable(&self, start: &ModulePath) -> BTreeSet<ModulePath> {
        let mut reached = BTreeSet::new();
        let mut open = vec![start.clone()];
        while let Some(module) = open.pop() {
            for target in self.dependencies(&module) {
                if reached.insert(target.clone()) {
                    open.push(target);
                }
            }
        }
        reached
    }

    /// Returns the modules that the imports of a module lead to.
    fn dependencies(&self, module: &ModulePath) -> BTreeSet<ModulePath> {
        let mut targets = BTreeSet::new();
        for import in &self.modules[module].imports {
            let Some(path) = self.absolute(module, &import.path) else { continue };
            let Some(target) = self.resolved(&path, 0) else { continue };
            // A parent that re-exports an item of its child does not depend on the child, and the
            // root re-exports items of all modules.
            let is_facade = import.is_reexport && target.starts_with(module);
            if target != *module && !is_facade {
                targets.insert(target);
            }
        }
        targets
    }

    /// Returns a path from the crate's root, or `None` if it leads to another crate.
    fn absolute(&self, module: &ModulePath, path: &[String]) -> Option<Vec<String>> {
        let join = |base: &[String], rest: &[String]| Some([base, rest].concat());
        match path[0].as_str() {
            "crate" => join(&[], &path[1..]),
            "self" => join(module, &path[1..]),
            "super" => {
                let levels = path.iter().take_while(|name| *name == "super").count();
                join(&module[..module.len().saturating_sub(levels)], &path[levels..])
            }
            first => {
                let is_child = self.modules.contains_key(&join(module, &[first.to_owned()])?);
                if is_child { join(module, path) } else { None }
            }
        }
    }

    /// Returns the module in which the item at an absolute path is defined.
    fn resolved(&self, path: &[String], reexports: usize) -> Option<ModulePath> {
        if reexports > MAX_REEXPORTS {
            return None;
        }
        let length = (0..=path.len()).rev().find(|&n| self.modules.contains_key(&path[..n]))?;
        let (module, rest) = path.split_at(length);
        let module = module.to_vec();
        let Some(name) = rest.first().filter(|name| *name != "*") else { return Some(module) };
        if self.modules[&module].items.contains(name) {
            return Some(module);
        }
        for import in &self.modules[&module].imports {
            let Some(target) = self.absolute(&module, &import.path) else { continue };
            let next = if import.name.as_ref() == Some(name) {
                [&target, &rest[1..]].concat()
            } else if import.name.as_deref() == Some("*") && self.has_item(&target, name) {
                [&target[..target.len() - 1], rest].concat()
            } else {
                continue;
            };
            if next != path {
                return self.resolved(&next, reexports + 1);
            }
        }
        Some(module)
    }

    /// Returns true if a path such as `crate::a::*` leads to a module that defines `name`.
    fn has_item(&self, glob: &[String], name: &str) -> bool {
        let module = self.modules.get(&glob[..glob.len() - 1]);
        module.is_some_and(|module| module.items.contains(name))
    }
}

/// Returns the names that follow a keyword of a definition.
fn items(tokens: &[Token<'_>]) -> BTreeSet<String> {
    const KEYWORDS: [&str; 9] =
        ["fn", "struct", "enum", "trait", "type", "const", "static", "union", "macro_rules"];
    let mut names = BTreeSet::new();
    for pair in tokens.windows(2) {
        if let [Token::Word(keyword), Token::Word(name)] = pair
            && KEYWORDS.contains(keyword)
        {
            names.insert((*name).to_owned());
        }
    }
    names
}

fn imports(tokens: &[Token<'_>]) -> Vec<Import> {
    let mut imports = Vec::new();
    let mut at = 0;
    while let Some(token) = tokens.get(at) {
        match token {
            Token::Word("use") => {
                let end = tokens[at..].iter().position(|token| *token == Token::Mark(';'));
                let end = at + end.unwrap_or(tokens.len() - at);
                let is_reexport = is_public(&tokens[..at]);
                for (path, name) in UseTree(&tokens[at + 1..end]).paths(&[]) {
                    imports.push(Import { path, name: Some(name), is_reexport });
                }
                at = end;
            }
            Token::Word("crate" | "super") => {
                let length = path_length(&tokens[at..]);
                let path = names(&tokens[at..at + length]);
                // `pub(crate)` and `pub(super)` are no paths.
                if path.len() > 1 {
                    imports.push(Import { path, name: None, is_reexport: false });
                }
                at += length;
            }
            Token::Word(_) | Token::Mark(_) => at += 1,
        }
    }
    imports
}

/// Returns true if the tokens end in `pub` or `pub(...)`.
fn is_public(tokens: &[Token<'_>]) -> bool {
    match tokens {
        [.., Token::Word("pub")] => true,
        [.., Token::Mark(')')] => {
            let open = tokens.iter().rposition(|token| *token == Token::Mark('('));
            open.is_some_and(|open| tokens[..open].last() == Some(&Token::Word("pub")))
        }
        _ => false,
    }
}

/// Returns how many tokens of the beginning form a path.
fn path_length(tokens: &[Token<'_>]) -> usize {
    let mut length = 1;
    while let [Token::Mark(':'), Token::Mark(':'), Token::Word(_), ..] = tokens[length..] {
        length += 3;
    }
    length
}

fn names(tokens: &[Token<'_>]) -> Vec<String> {
    let name = |token: &Token<'_>| match token {
        Token::Word(name) => Some((*name).to_owned()),
        Token::Mark('*') => Some("*".to_owned()),
        Token::Mark(_) => None,
    };
    tokens.iter().filter_map(name).collect()
}

/// The tokens of a `use` declaration between `use` and `;`, or of a part of its braces.
struct UseTree<'a>(&'a [Token<'a>]);

impl UseTree<'_> {
    /// Returns each path behind `prefix`, and the name by which the item is imported.
    fn paths(&self, prefix: &[String]) -> Vec<(Vec<String>, String)> {
        let open = self.0.iter().position(|token| *token == Token::Mark('{'));
        let Some(open) = open else { return self.path(prefix).into_iter().collect() };
        let prefix = [prefix, &names(&self.0[..open])].concat();
        let inner = &self.0[open + 1..self.0.len().saturating_sub(1).max(open + 1)];
        let (mut paths, mut depth, mut start) = (Vec::new(), 0, 0);
        for (at, token) in inner.iter().enumerate() {
            match token {
                Token::Mark('{') => depth += 1,
                Token::Mark('}') => depth -= 1,
                Token::Mark(',') if depth == 0 => {
                    paths.extend(UseTree(&inner[start..at]).paths(&prefix));
                    start = at + 1;
                }
                Token::Mark(_) | Token::Word(_) => {}
            }
        }
        paths.extend(UseTree(&inner[start..]).paths(&prefix));
        paths
    }

    fn path(&self, prefix: &[String]) -> Option<(Vec<String>, String)> {
        let alias = self.0.iter().position(|token| *token == Token::Word("as"));
        let (path, alias) = self.0.split_at(alias.unwrap_or(self.0.len()));
        let mut path = [prefix, &names(path)].concat();
        // `a::{self}` imports `a`.
        if path.len() > 1 && path.last().is_some_and(|name| name == "self") {
            path.pop();
        }
        let name = names(alias).pop().or_else(|| path.last().cloned())?;
        Some((path, name))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn groups(modules: &[(&str, &str)]) -> Vec<Vec<String>> {
        let path = |name: &str| -> ModulePath {
            name.split("::").filter(|name| !name.is_empty()).map(str::to_owned).collect()
        };
        let sources = modules.iter().map(|(name, source)| (path(name), (*source).to_owned()));
        let groups = cycles(&sources.collect());
        let name = |module: ModulePath| module.join("::");
        groups.into_iter().map(|group| group.into_iter().map(name).collect()).collect()
    }

    #[test]
    fn a_cycle_of_two_modules_is_found() {
        let modules = [
            ("", "mod a; mod b; mod c; pub use a::A;"),
            ("a", "use crate::b::B; pub struct A;"),
            ("b", "pub struct B; fn f() -> crate::a::A { crate::a::A }"),
            ("c", "use crate::a::A;"),
        ];
        assert_eq!(groups(&modules), [["a", "b"]]);
    }

    #[test]
    fn a_cycle_through_the_re_exports_of_the_root_is_found() {
        let modules = [
            ("", "mod a; mod b; pub use a::A as Renamed; pub(crate) use b::*;"),
            ("a", "use crate::{B, Other}; pub struct A;"),
            ("b", "use crate::Renamed; pub struct B;"),
        ];
        assert_eq!(groups(&modules), [["a", "b"]]);
    }

    #[test]
    fn a_cycle_of_parent_and_child_is_found() {
        let modules = [
            ("", "mod a;"),
            ("a", "mod b; use b::g; pub fn f() { g() }"),
            ("a::b", "pub fn g() { super::f() }"),
        ];
        assert_eq!(groups(&modules), [["a", "a::b"]]);
    }

    #[test]
    fn imports_in_tests_comments_and_strings_are_no_dependencies() {
        let modules = [
            ("", "mod a; mod b;"),
            ("a", "use super::b::{self, B}; pub struct A;"),
            (
                "b",
                "// use crate::a::A;\nconst S: &str = \"use crate::a::A;\";\npub struct B;\n\
                   #[cfg(test)]\nmod tests { use crate::a::A; }",
            ),
        ];
        assert_eq!(groups(&modules), Vec::<Vec<String>>::new());
    }

    #[test]
    fn re_exports_of_a_parent_are_no_dependencies() {
        let modules = [
            ("", "mod a; pub use a::{A, B};"),
            ("a", "mod b; pub use b::B; pub struct A;"),
            ("a::b", "use super::A; pub struct B(A);"),
        ];
        assert_eq!(groups(&modules), Vec::<Vec<String>>::new());
    }
}
