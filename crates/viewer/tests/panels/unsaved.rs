//! Texts that are not saved, when the window is lost or replaced.

use std::path::Path;

use eframe::egui::{Context, Key, Modifiers};
use egui_kittest::kittest::Queryable;
use sdfc_viewer::app::App;

use crate::fixture::{Fixture, SCENE};

/// An app with the scene and the settings of a folder.
fn app_in(folder: &Path) -> App {
    let settings = Some(folder.join("view.json"));
    let mut app = App::new(&Context::default(), &folder.join("scene.sdf"), settings).unwrap();
    app.session().update_build(|build| build.on_cpu = true);
    app
}

/// Another window of the same scene and settings.
fn reopened(mut fixture: Fixture, rescues: bool) -> Fixture {
    if rescues {
        fixture.harness.state_mut().rescue();
    }
    let Fixture { harness, folder } = fixture;
    drop(harness);
    let app = app_in(folder.path());
    let mut fixture = Fixture::shown(app, folder);
    fixture.until(|harness| harness.state().picture_is_finished());
    fixture
}

#[test]
fn text_and_numbers_survive_the_loss_of_the_window() {
    let mut fixture = Fixture::new();
    fixture.type_at_end("box(0.1)\n");
    fixture.until(|harness| {
        let model = harness.state().opened().model.as_ref();
        model.is_some_and(|model| model.source.ends_with("box(0.1)\n"))
    });
    fixture.change_a_number();
    let expected = format!("{}box(0.1)\n", SCENE.replace("sphere(1) ", "sphere(1.25) "));
    let mut again = reopened(fixture, true);
    let text = |fixture: &Fixture| fixture.harness.state().opened().text().to_string();
    assert_eq!(text(&again), expected);
    assert!(again.has("not saved"));
    assert_eq!(again.harness.state().opened().model.as_ref().unwrap().source, expected);
    // Given up on purpose, and therefore gone.
    again.click("Revert");
    let again = reopened(again, true);
    assert_eq!(text(&again), SCENE);
}

#[test]
fn undo_does_not_bring_back_the_text_of_another_scene() {
    let mut fixture = Fixture::new();
    fixture.type_at_end("// first\n");
    fixture.key(Modifiers::COMMAND, Key::Z);
    let other = fixture.folder.path().join("other.sdf");
    std::fs::write(&other, "box(1)\n").unwrap();
    fixture.harness.state_mut().session().open_other(other);
    fixture.until(|harness| **harness.state().opened().text() == *"box(1)\n");
    fixture.type_at_end("// second\n");
    for _ in 0..3 {
        fixture.key(Modifiers::COMMAND, Key::Z);
    }
    assert_eq!(**fixture.harness.state().opened().text(), *"box(1)\n");
}

#[test]
fn a_rescued_text_does_not_overwrite_a_file_that_was_changed_since() {
    let mut fixture = Fixture::new();
    fixture.type_at_end("// mine\n");
    fixture.harness.state_mut().rescue();
    fixture.write(&format!("// theirs\n{SCENE}"));
    let mut again = reopened(fixture, false);
    again.until(|harness| harness.query_by_label("Keep this text").is_some());
    again.key(Modifiers::COMMAND, Key::S);
    assert!(again.has("not saved"));
    assert!(again.harness.state().opened().text().ends_with("// mine\n"));
}

#[test]
fn text_survives_a_window_that_closes_unasked() {
    let mut fixture = Fixture::new();
    fixture.type_at_end("// typed\n");
    // As when its device is lost.
    fixture.harness.state_mut().close();
    let mut again = reopened(fixture, false);
    assert!(again.harness.state().opened().text().ends_with("// typed\n"));
    again.request_close();
    again.harness.get_by_label("Close without saving").click();
    assert!(again.closes());
    again.harness.state_mut().close();
    let again = reopened(again, false);
    assert_eq!(**again.harness.state().opened().text(), *SCENE);
}

#[test]
fn a_second_window_without_edits_does_not_forget_the_texts_of_the_first() {
    let mut fixture = Fixture::new();
    let mut second = app_in(fixture.folder.path());
    fixture.type_at_end("// typed\n");
    fixture.harness.state_mut().rescue();
    second.close();
    let again = reopened(fixture, false);
    assert!(again.harness.state().opened().text().ends_with("// typed\n"));
}

#[test]
fn undo_brings_back_a_restored_text_that_was_reverted() {
    let mut fixture = Fixture::new();
    fixture.type_at_end("// typed\n");
    let mut again = reopened(fixture, true);
    again.click("Revert");
    assert_eq!(**again.harness.state().opened().text(), *SCENE);
    again.key(Modifiers::COMMAND, Key::Z);
    assert_eq!(**again.harness.state().opened().text(), *format!("{SCENE}// typed\n"));
}
