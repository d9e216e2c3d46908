//! GPU, CPU in f32 and CPU in f64 render the same surface for every scene under `examples`. The
//! test `library` checks the same for every entry of the library.

#![allow(clippy::expect_used, reason = "a test stops where it fails")]

use libtest_mimic::{Arguments, Trial};
use sdfc_render::testing;
use sdfc_test_support::example_sources;
use sdfc_tests::agree;

fn main() {
    let mut trials = Vec::new();
    let without_gpu = testing::without_gpu();
    for (name, text) in example_sources().expect("the examples can be read") {
        let (again, source) = (name.clone(), text.clone());
        let cpu = move || Ok(agree::precisions(&agree::scene(&again, &source)?).map(drop)?);
        trials.push(Trial::test(format!("cpu/{name}"), cpu));
        let title = format!("gpu/{name}");
        let gpu = move || Ok(agree::devices(&agree::scene(&name, &text)?).map(drop)?);
        trials.push(Trial::test(title, gpu).with_ignored_flag(without_gpu));
    }
    libtest_mimic::run(&Arguments::from_args(), trials).exit();
}
