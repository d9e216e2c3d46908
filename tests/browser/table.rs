//! The table in `docs/embedding-web.md`: how far pages are from `sdfc render`.

use libtest_mimic::Failed;
use sdfc_tests::repository;

use crate::pages::{EDGES, SCENES};

/// The environment variable with which rows are written anew.
const UPDATE: &str = "EMBEDDINGS_UPDATE";

/// Holds a page's row against what was found, in the order of [`SCENES`]. Figures differ from one machine to another
/// and are not compared.
pub fn check(page: &str, found: &[f64]) -> Result<(), Failed> {
    let path = repository().join("docs/embedding-web.md");
    let text = std::fs::read_to_string(&path)?.replace("\r\n", "\n");
    let head = format!("| page | {} |", SCENES.join(" | "));
    if !text.contains(&head) {
        return Err(format!("docs/embedding-web.md has no table with the head {head}").into());
    }
    let start = format!("| {page} |");
    let row = text.lines().find(|line| line.starts_with(&start)).ok_or(format!("no row {page}"))?;
    if std::env::var_os(UPDATE).is_some() {
        let cells = SCENES.iter().enumerate().map(|(place, _)| {
            let cell = found.get(place).map(|share| format!("{}", (share * 100.0).round() / 100.0));
            format!(" {} |", cell.unwrap_or_default())
        });
        let fresh = format!("{start}{}", cells.collect::<String>());
        std::fs::write(&path, text.replace(row, &fresh))?;
        return Ok(());
    }
    let cells: Vec<f64> = row.split('|').filter_map(|cell| cell.trim().parse().ok()).collect();
    if cells.len() != found.len() || cells.iter().any(|share| *share > EDGES) {
        return Err(format!("the row {page} is not one of today; set {UPDATE}=1").into());
    }
    Ok(())
}
