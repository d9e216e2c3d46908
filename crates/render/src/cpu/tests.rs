//! The CPU's ray methods and the shaders state the same constants.

use std::collections::BTreeMap;

use sdfc_march::{Features, Method, source};

use super::method::CpuMethod;

/// Returns the name and the number of a constant that a line of Rust or WGSL states. A vector of
/// equal numbers counts as one.
fn constant(line: &str) -> Option<(&str, f64)> {
    let (declared, value) = line.strip_prefix("const ")?.split_once('=')?;
    let name = declared.split(':').next()?.trim();
    let value = value.trim().trim_end_matches(';');
    let value = value.split_once('(').map_or(value, |(_, inner)| inner.trim_end_matches(')'));
    Some((name, value.trim_end_matches('u').parse().ok()?))
}

fn constants(text: &str) -> BTreeMap<&str, f64> {
    text.lines().filter_map(constant).collect()
}

/// Returns the text of a method's shader.
fn shader(method: Method) -> String {
    source(method.definition(), Features { materials: true, ..Features::default() })
}

#[test]
fn constants_of_the_cpu_are_those_of_the_shader() {
    let auto: [(&str, &[&str]); 5] = [
        (include_str!("ray.rs"), &["ROUNDING"]),
        (include_str!("shade.rs"), &["DEFAULT_COLOR", "DIELECTRIC", "MIN_COSINE", "MIN_ROUGHNESS"]),
        (include_str!("trace.rs"), &["HIT_FRACTION"]),
        (
            include_str!("trace/auto.rs"),
            &[
                "MAX_RELAXATION",
                "MIN_FINAL_SLOPE",
                "MIN_SLOPE",
                "MIN_STEP_FRACTION",
                "SLOPE_WEIGHT",
            ],
        ),
        (include_str!("wave.rs"), &["OCCLUSION_SAMPLES", "SHADOW_TOLERANCE", "STEEP"]),
    ];
    let interval: [(&str, &[&str]); 1] = [(
        include_str!("trace/interval.rs"),
        &[
            "APPROACH",
            "BRACKET_STEPS",
            "COARSEST",
            "FINEST",
            "MAX_FRACTION",
            "MIN_FRACTION",
            "SLOPE_MEMORY",
            "START_FRACTION",
            "STEP_GROWTH",
        ],
    )];
    for (method, files) in [(Method::Auto, &auto[..]), (Method::Interval, &interval[..])] {
        let text = shader(method);
        let of_shader = constants(&text);
        for &(file, names) in files {
            let mut of_cpu = constants(file);
            of_cpu.retain(|name, _| of_shader.contains_key(name));
            for (name, value) in &of_cpu {
                assert_eq!(of_shader.get(name), Some(value), "{name}");
            }
            // A constant that is renamed on one side alone is missing here.
            assert_eq!(of_cpu.into_keys().collect::<Vec<_>>(), names);
        }
    }
}

#[test]
fn budgets_and_the_end_of_rays_are_those_of_the_shader() {
    let of = |method: Method, name: &str| constants(&shader(method)).get(name).copied();
    let factor = |method: CpuMethod| f64::from(method.step_budget_factor());
    assert_eq!(of(Method::Auto, "STEP_BUDGET_FACTOR"), Some(factor(CpuMethod::Auto)));
    let samples = Some(factor(CpuMethod::Interval) - 1.0);
    assert_eq!(of(Method::Interval, "SAMPLE_BUDGET_FACTOR"), samples);
    assert_eq!(of(Method::Auto, "FAR"), Some(sdfc_graph::FAR));
}
