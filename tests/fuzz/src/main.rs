//! Prints the program of a seed: `cargo run -p sdfc-fuzz -- SEED`.

#![allow(clippy::print_stdout, clippy::print_stderr, reason = "a program prints")]

use std::process::ExitCode;

use sdfc_fuzz::catalogue::Catalogue;
use sdfc_fuzz::{generate, repair};

fn main() -> ExitCode {
    let seed = std::env::args().nth(1).and_then(|word| word.parse().ok()).unwrap_or(0);
    let catalogue = match Catalogue::read() {
        Ok(catalogue) => catalogue,
        Err(error) => {
            eprintln!("{error}");
            return ExitCode::FAILURE;
        }
    };
    match repair(generate(&catalogue, seed)) {
        Ok(accepted) => {
            print!("{}", accepted.program.text());
            ExitCode::SUCCESS
        }
        Err((program, errors)) => {
            print!("{}", program.text());
            eprintln!("{errors}");
            ExitCode::FAILURE
        }
    }
}
