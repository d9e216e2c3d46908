//! The charts in `docs/charts` name the device they were measured on, and `auto` is never
//! outperformed in them.

use std::path::PathBuf;

use serde_json::Value;

use sdfc_tests::repository;

/// Smaller errors count as none, as in a chart.
const MIN_ERROR: f64 = 1e-5;

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

/// Returns the operations per pixel, the pixels that failed, and the error in depth.
fn metrics(row: &Value) -> [f64; 3] {
    let number = |value: &Value| value.as_f64().unwrap();
    let failed = ["missed", "false_hits", "nan", "capped"].map(|what| number(&row[what]));
    let depth = number(&row["depth_px"]["p99"]).max(MIN_ERROR);
    [number(&row["ops_per_pixel"]), failed.iter().sum(), depth]
}

#[test]
fn no_method_in_a_chart_is_cheaper_and_more_accurate_than_auto() {
    let charts = charts();
    assert!(charts.len() >= 8, "{} charts", charts.len());
    for (path, chart) in charts {
        let rows = chart["methods"].as_array().unwrap();
        let is_auto = |row: &&Value| row["method"] == "auto";
        let auto = rows.iter().find(|row| is_auto(row) && row["default"] == true).unwrap();
        let [operations, failed, depth] = metrics(auto);
        for row in rows.iter().filter(|row| !is_auto(row)) {
            let [other_operations, other_failed, other_depth] = metrics(row);
            let is_more_accurate = other_failed <= failed
                && other_depth <= depth
                && (other_failed < failed || other_depth < depth);
            assert!(
                other_operations >= operations || !is_more_accurate,
                "{}: {row}",
                path.display()
            );
        }
    }
}

#[test]
fn charts_name_device_driver_and_date() {
    for (path, chart) in charts() {
        for key in ["adapter", "driver", "made", "scene"] {
            let value = chart[key].as_str().unwrap_or_default();
            assert!(!value.is_empty(), "{}: no {key}", path.display());
        }
    }
}
