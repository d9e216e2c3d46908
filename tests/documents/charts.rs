//! Charts in `docs/charts` say what they were measured on, and what is said of all of them is so.

use std::path::PathBuf;

use serde_json::Value;

use sdfc_tests::repository;

/// Below this an error is none, as in a chart.
const LEAST_ERROR: f64 = 1e-5;

fn charts() -> Vec<(PathBuf, Value)> {
    let files = std::fs::read_dir(repository().join("docs/charts")).unwrap();
    let paths = files.map(|file| file.unwrap().path());
    let json = paths.filter(|path| path.extension().is_some_and(|extension| extension == "json"));
    json.map(|path| {
        let text = std::fs::read_to_string(&path).unwrap();
        (path, serde_json::from_str(&text).unwrap())
    })
    .collect()
}

/// Operations per pixel, pixels that failed, and error in depth.
fn figures(row: &Value) -> [f64; 3] {
    let number = |value: &Value| value.as_f64().unwrap();
    let failed = ["missed", "false_hits", "nan", "capped"].map(|what| number(&row[what]));
    let depth = number(&row["depth_px"]["p99"]).max(LEAST_ERROR);
    [number(&row["ops_per_pixel"]), failed.iter().sum(), depth]
}

#[test]
fn nothing_in_a_chart_is_cheaper_and_nearer_than_auto() {
    let charts = charts();
    assert!(charts.len() >= 8, "{} charts", charts.len());
    for (path, chart) in charts {
        let rows = chart["methods"].as_array().unwrap();
        let is_auto = |row: &&Value| row["method"] == "auto";
        let auto = rows.iter().find(|row| is_auto(row) && row["default"] == true).unwrap();
        let [operations, failed, depth] = figures(auto);
        for row in rows.iter().filter(|row| !is_auto(row)) {
            let [others_operations, others_failed, others_depth] = figures(row);
            let errs_less = others_failed <= failed
                && others_depth <= depth
                && (others_failed < failed || others_depth < depth);
            assert!(others_operations >= operations || !errs_less, "{}: {row}", path.display());
        }
    }
}

#[test]
fn charts_name_device_driver_and_date() {
    for (path, chart) in charts() {
        for key in ["adapter", "driver", "made", "scene"] {
            let said = chart[key].as_str().unwrap_or_default();
            assert!(!said.is_empty(), "{}: no {key}", path.display());
        }
    }
}
