//! Imported files and the library in tabs of the panel "Code".

use eframe::egui::accesskit::Role;
use eframe::egui::{Event, Key, Modifiers};
use egui_kittest::kittest::Queryable;
use sdfc_viewer::session::Session;
use sdfc_viewer::session::tabs::TabFile;

use crate::fixture::{CTRL, Fixture};

const SCENE: &str = "import gear from \"parts/gear.sdf\"\ngear(1) | box(0.1)\n\
                     camera(eye: [0, 0, 5], target: [0, 0, 0], fov: 40deg)\n";
const GEAR: &str = "import tooth from \"tooth.sdf\"\n\
                    solid gear(r: length) = min(sphere(r)(p), tooth()(p))\n";
const TOOTH: &str = "solid tooth() = box(0.2)(p)\n";

fn with_imports() -> Fixture {
    let mut fixture = Fixture::new();
    let parts = fixture.folder.path().join("parts");
    std::fs::create_dir(&parts).unwrap();
    std::fs::write(parts.join("gear.sdf"), GEAR).unwrap();
    std::fs::write(parts.join("tooth.sdf"), TOOTH).unwrap();
    fixture.write(SCENE);
    fixture.until(|harness| {
        let session = harness.state().opened();
        session.tabs().len() == 3 && session.model.as_ref().is_some_and(|it| it.source == SCENE)
    });
    fixture.harness.run_steps(2);
    fixture
}

fn import(path: &str) -> TabFile {
    TabFile::Import(path.to_owned())
}

/// Where the surface is on the z axis.
fn distance(session: &Session) -> f64 {
    session.model.as_ref().map_or(f64::NAN, |it| it.scene.distance([0.0, 0.0, 3.0]).unwrap())
}

/// Moves the cursor to a text of the shown file.
fn cursor_to(fixture: &mut Fixture, found: &str) {
    fixture.type_at_end("");
    let text = fixture.harness.state().opened().shown_text().to_string();
    fixture.key(CTRL, Key::Home);
    for _ in 0..text.find(found).unwrap() {
        fixture.harness.key_press(Key::ArrowRight);
    }
    fixture.harness.run_steps(3);
    let wanted = text.clone();
    fixture.until(|harness| {
        let answer = harness.state().opened().answer_about_text();
        answer.is_some_and(|answer| *answer.request.text == *wanted)
    });
}

#[test]
fn an_edited_import_compiles_the_scene_and_is_saved_to_its_own_file() {
    let mut fixture = with_imports();
    fixture.click("parts/gear.sdf");
    assert_eq!(**fixture.harness.state().opened().shown_text(), *GEAR);
    let edited = GEAR.replace("sphere(r)", "sphere(2 * r)");
    let session = fixture.harness.state_mut().session();
    session.edit_shown(|draft| draft.set_text(&edited));
    fixture.until(|harness| distance(harness.state().opened()) == 1.0);
    assert!(fixture.has("parts/gear.sdf •") && fixture.has("not saved"));
    let path = fixture.folder.path().join("parts").join("gear.sdf");
    assert_eq!(std::fs::read_to_string(&path).unwrap(), GEAR);
    fixture.request_close();
    assert!(fixture.has("The edited text of parts/gear.sdf is not saved"));
    fixture.click("Cancel");
    fixture.key(Modifiers::COMMAND, Key::S);
    fixture.until(|_| std::fs::read_to_string(&path).unwrap() == edited);
    fixture.until(|harness| !harness.state().opened().has_unsaved_changes());
    let scene = fixture.folder.path().join("scene.sdf");
    assert_eq!(std::fs::read_to_string(scene).unwrap(), SCENE);
}

#[test]
fn each_tab_has_its_own_undo_and_its_own_conflict() {
    let mut fixture = with_imports();
    fixture.type_at_end("// scene\n");
    fixture.click("parts/gear.sdf");
    fixture.type_at_end("// gear\n");
    let text = |fixture: &Fixture, file: TabFile| {
        fixture.harness.state().opened().text_of(&file).unwrap().to_string()
    };
    fixture.key(Modifiers::COMMAND, Key::Z);
    assert_eq!(text(&fixture, import("parts/gear.sdf")), GEAR);
    assert!(text(&fixture, TabFile::Scene).ends_with("// scene\n"));
    fixture.key(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    assert!(text(&fixture, import("parts/gear.sdf")).contains("// gear"));
    fixture.click("scene.sdf •");
    fixture.type_at_end("");
    fixture.key(Modifiers::COMMAND, Key::Z);
    assert_eq!(text(&fixture, TabFile::Scene), SCENE);
    // The file of the import is changed outside.
    let path = fixture.folder.path().join("parts").join("gear.sdf");
    std::fs::write(&path, format!("// theirs\n{GEAR}")).unwrap();
    fixture.click("parts/gear.sdf •");
    fixture.until(|harness| harness.query_by_label("Load the file").is_some());
    fixture.click("Load the file");
    assert!(text(&fixture, import("parts/gear.sdf")).starts_with("// theirs"));
    assert!(!fixture.harness.state().opened().has_unsaved_changes());
}

#[test]
fn errors_of_an_import_are_shown_in_its_tab_and_fixed_there() {
    let mut fixture = with_imports();
    fixture.click("parts/tooth.sdf");
    let session = fixture.harness.state_mut().session();
    session.edit_shown(|draft| draft.set_text(&TOOTH.replace("box", "boxx")));
    fixture.until(|harness| harness.state().opened().diagnostics_of_text().count() > 0);
    fixture.harness.run_steps(2);
    let session = fixture.harness.state().opened();
    let fix = session.diagnostics_of_text().find_map(|it| it.fixes.first()).unwrap().clone();
    // Errors of a text that is being edited cover the picture a moment later.
    fixture.until(|harness| harness.query_by_label(&fix.title).is_some());
    fixture.click(&fix.title);
    fixture.until(|harness| harness.state().opened().diagnostics.errors() == 0);
    assert_eq!(**fixture.harness.state().opened().shown_text(), *TOOTH);
    // The text was never typed, and the correction can be undone.
    fixture.type_at_end("");
    fixture.key(Modifiers::COMMAND, Key::Z);
    assert_eq!(**fixture.harness.state().opened().shown_text(), *TOOTH.replace("box", "boxx"));
}

#[test]
fn f12_goes_to_a_definition_and_alt_left_back() {
    let mut fixture = with_imports();
    cursor_to(&mut fixture, "gear(1)");
    fixture.key(Modifiers::NONE, Key::F12);
    assert_eq!(*fixture.harness.state().opened().shown_file(), import("parts/gear.sdf"));
    // The name is selected: typing replaces it.
    fixture.harness.event(Event::Text("wheel".to_owned()));
    fixture.harness.run_steps(3);
    let text = fixture.harness.state().opened().shown_text().to_string();
    assert_eq!(text, GEAR.replace("solid gear", "solid wheel"));
    fixture.key(Modifiers::COMMAND, Key::Z);
    // From there into a file that only the import imports, and into the library.
    cursor_to(&mut fixture, "tooth()(p)");
    fixture.key(Modifiers::NONE, Key::F12);
    assert_eq!(*fixture.harness.state().opened().shown_file(), import("parts/tooth.sdf"));
    cursor_to(&mut fixture, "box");
    fixture.key(Modifiers::NONE, Key::F12);
    let TabFile::Library(_) = fixture.harness.state().opened().shown_file() else {
        panic!("the library is not shown");
    };
    let library = fixture.harness.state().opened().shown_text().to_string();
    fixture.harness.get_by_role(Role::MultilineTextInput).type_text("typed");
    fixture.harness.run_steps(3);
    assert_eq!(**fixture.harness.state().opened().shown_text(), *library);
    // And back, twice.
    fixture.key(Modifiers::ALT, Key::ArrowLeft);
    assert_eq!(*fixture.harness.state().opened().shown_file(), import("parts/tooth.sdf"));
    fixture.key(Modifiers::ALT, Key::ArrowLeft);
    assert_eq!(*fixture.harness.state().opened().shown_file(), import("parts/gear.sdf"));
    fixture.harness.event(Event::Text("1 + ".to_owned()));
    fixture.harness.run_steps(3);
    let text = fixture.harness.state().opened().shown_text().to_string();
    assert_eq!(text, GEAR.replace(", tooth()", ", 1 + tooth()"));
}
