//! Makes a text short while a fault stays.

/// Returns a shorter text that still fails. `fails` is asked at most `most` times.
///
/// First lines are left out, then runs of characters, half of what is left at first and single
/// characters at last.
pub fn shrink(text: &str, most: usize, fails: &mut dyn FnMut(&str) -> bool) -> String {
    let mut tries = 0;
    let mut keep = |candidate: &str| {
        tries += 1;
        tries <= most && fails(candidate)
    };
    let lines = text.split_inclusive('\n').map(str::to_owned).collect();
    let lines = without_runs(lines, &mut keep);
    let letters = lines.concat().chars().map(String::from).collect();
    without_runs(letters, &mut keep).concat()
}

/// Leaves out runs of parts, from long ones to single parts.
fn without_runs(mut parts: Vec<String>, keep: &mut dyn FnMut(&str) -> bool) -> Vec<String> {
    let mut run = parts.len().div_ceil(2);
    while run > 0 {
        let mut end = parts.len();
        while end > 0 {
            let start = end.saturating_sub(run);
            let candidate = [&parts[..start], &parts[end..]].concat();
            if keep(&candidate.concat()) {
                parts = candidate;
            }
            end = start.min(parts.len());
        }
        run /= 2;
    }
    parts
}
