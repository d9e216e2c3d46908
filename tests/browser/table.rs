//! The table in `docs/embedding-web.md`: the differences of pages from `sdfc render`.

use std::sync::{Mutex, PoisonError};

use libtest_mimic::Failed;
use sdfc_tests::repository;

use crate::pages::{EDGES, SCENES};

/// The environment variable that rewrites the rows.
const UPDATE: &str = "EMBEDDINGS_UPDATE";

/// The table belongs to one test at a time.
static TABLE: Mutex<()> = Mutex::new(());

/// Checks that a page has a valid row for the scenes in [`SCENES`]. The values differ between
/// machines and are not compared.
pub fn check(page: &str, found: &[f64]) -> Result<(), Failed> {
    let _table = TABLE.lock().unwrap_or_else(PoisonError::into_inner);
    let path = repository().join("docs/embedding-web.md");
    let text = std::fs::read_to_string(&path)?.replace("\r\n", "\n");
    let head = format!("| page | {} |", SCENES.join(" | "));
    if !text.contains(&head) {
        return Err(format!("docs/embedding-web.md has no table with the head {head}").into());
    }
    let start = format!("| {page} |");
    let row = text.lines().find(|line| line.starts_with(&start)).ok_or(format!("no row {page}"))?;
    if std::env::var_os(UPDATE).is_some() {
        let cells = SCENES.iter().enumerate().map(|(index, _)| {
            let cell = found.get(index).map(|value| format!("{}", (value * 100.0).round() / 100.0));
            format!(" {} |", cell.unwrap_or_default())
        });
        let fresh = format!("{start}{}", cells.collect::<String>());
        std::fs::write(&path, text.replace(row, &fresh))?;
        return Ok(());
    }
    let cells: Vec<f64> = row.split('|').filter_map(|cell| cell.trim().parse().ok()).collect();
    if cells.len() != found.len() || cells.iter().any(|value| *value > EDGES) {
        return Err(format!("the row {page} is out of date; rewrite it with {UPDATE}=1").into());
    }
    Ok(())
}
