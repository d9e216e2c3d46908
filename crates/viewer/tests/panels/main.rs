//! The panels, laid out and clicked without a window, with the CPU renderer.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod camera;
mod commands;
mod find;
mod fixture;
mod handles;
mod layout;
mod lit_shapes;
mod tabs;
mod unsaved;

use std::collections::BTreeSet;
use std::fs::File;
use std::io::BufReader;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use eframe::egui::accesskit::Role;
use eframe::egui::{Context, DroppedFile, Event, Key, Modifiers, ViewportId};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use fixture::{Fixture, SCENE, TIMEOUT};
use image::AnimationDecoder;
use image::codecs::gif::GifDecoder;
use sdfc_viewer::app::App;
use sdfc_viewer::views::mode::ViewMode;

#[test]
fn errors_are_shown_as_on_the_command_line_and_disappear_when_fixed() {
    let mut fixture = Fixture::new();
    fixture.write("spere(1)\n");
    fixture.until(|harness| harness.query_by_label("error[E0201]").is_some());
    assert!(fixture.has("did you mean `sphere`?"));
    assert!(fixture.has("scene.sdf:1:1"));
    assert!(fixture.has("showing the last good scene"));
    fixture.write(SCENE);
    fixture.until(|harness| harness.query_by_label("error[E0201]").is_none());
}

#[test]
fn the_code_panel_is_open_and_params_can_be_reset() {
    let mut fixture = Fixture::new();
    fixture.click("Drag numbers");
    assert!(fixture.has("drag a number"));
    let changed = [0.4, 0.0, 0.0, 0.0];
    fixture.harness.state_mut().session().param_values.params.insert("wall".to_owned(), changed);
    fixture.harness.run_steps(2);
    fixture.click("Reset params");
    assert!(fixture.harness.state_mut().session().param_values.params.is_empty());
}

#[test]
fn a_literal_that_a_let_names_has_a_slider() {
    let mut fixture = Fixture::of("let k = 0.4\nsphere(k)\n");
    let slider = fixture.harness.get_by_role_and_label(Role::Slider, "k");
    slider.set_value_accesskit(0.6);
    fixture.harness.run_steps(3);
    // In the panels "Code" and "Controls".
    fixture.harness.get_all_by_label("Save to file").last().unwrap().click();
    let path = fixture.folder.path().join("scene.sdf");
    fixture.until(|_| std::fs::read_to_string(&path).unwrap() == "let k = 0.6\nsphere(k)\n");
}

#[test]
fn changed_numbers_are_saved_to_the_file() {
    let mut fixture = Fixture::new();
    fixture.change_a_number();
    fixture.click("Save to file");
    let text = SCENE.replace("sphere(1) ", "sphere(1.25) ");
    let path = fixture.folder.path().join("scene.sdf");
    fixture.until(|_| std::fs::read_to_string(&path).unwrap() == text);
}

#[test]
fn a_window_with_changed_numbers_asks_before_it_closes() {
    let mut fixture = Fixture::new();
    fixture.change_a_number();
    fixture.request_close();
    assert!(fixture.has("1 changed number is not saved"));
    fixture.click("Cancel");
    assert!(!fixture.has("1 changed number is not saved"));
    fixture.request_close();
    fixture.click("Save and close");
    let path = fixture.folder.path().join("scene.sdf");
    fixture.until(|_| std::fs::read_to_string(&path).unwrap().contains("sphere(1.25) "));
}

#[test]
fn if_saving_fails_the_window_stays_open_and_says_why() {
    let mut fixture = Fixture::new();
    fixture.change_a_number();
    fixture.request_close();
    // A folder has taken the place of the file.
    let path = fixture.folder.path().join("scene.sdf");
    std::fs::remove_file(&path).unwrap();
    std::fs::create_dir(&path).unwrap();
    fixture.harness.get_by_label("Save and close").click();
    assert!(!fixture.closes());
    // The words of the operating system.
    let why = std::fs::read_to_string(&path).unwrap_err().to_string();
    fixture.until(|harness| harness.query_all_by_label_contains(&why).next().is_some());
    assert!(!fixture.closes() && fixture.has("1 changed number is not saved"));
    fixture.harness.get_by_label("Close without saving").click();
    assert!(fixture.closes());
}

#[test]
fn changed_numbers_are_kept_when_the_file_is_edited() {
    let mut fixture = Fixture::new();
    fixture.change_a_number();
    let edited = format!("// A new line.\n{}", SCENE.replace("0.1 in", "0.2 in"));
    fixture.write(&edited);
    fixture.until(|harness| {
        harness.state().opened().model.as_ref().is_some_and(|model| model.source == edited)
    });
    let session = fixture.harness.state_mut().session();
    assert_eq!(session.param_values.changed_numbers(), 1);
    let expected = edited.replace("sphere(1) ", "sphere(1.25) ");
    assert_eq!(session.param_values.source_with_values(&edited), expected);
    // The number itself is edited: the file has the newer one.
    let edited = edited.replace("sphere(1) ", "sphere(0.75) ");
    fixture.write(&edited);
    fixture.until(|harness| {
        harness.query_all_by_label_contains("had changed: 1 -> 1.25").next().is_some()
    });
    assert_eq!(fixture.harness.state_mut().session().param_values.changed_numbers(), 0);
}

#[test]
fn opening_another_scene_asks_before_changed_numbers_are_lost() {
    let mut fixture = Fixture::new();
    let other = fixture.folder.path().join("other.sdf");
    std::fs::write(&other, "param rind = 0.5\nsphere(rind)\n").unwrap();
    let drop = |fixture: &mut Fixture| {
        fixture.harness.input_mut().dropped_files.push(Arc::new(Dropped(other.clone())));
        fixture.harness.run_steps(1);
        fixture.harness.input_mut().dropped_files.clear();
        fixture.harness.run_steps(2);
    };
    fixture.change_a_number();
    drop(&mut fixture);
    fixture.click("Cancel");
    assert!(fixture.harness.state_mut().session().path().ends_with("scene.sdf"));
    drop(&mut fixture);
    fixture.click("Save and open");
    fixture.until(|harness| harness.query_all_by_label("rind").next().is_some());
    let saved = std::fs::read_to_string(fixture.folder.path().join("scene.sdf")).unwrap();
    assert!(saved.contains("sphere(1.25) "), "{saved}");
}

#[test]
fn the_menu_of_scenes_asks_before_changed_numbers_are_lost() {
    let mut fixture = Fixture::new();
    std::fs::write(fixture.folder.path().join("other.sdf"), "sphere(2)\n").unwrap();
    fixture.change_a_number();
    fixture.click("scene.sdf");
    fixture.click("In this folder");
    fixture.click("other.sdf");
    assert!(fixture.has("1 changed number is not saved"));
    assert!(fixture.harness.state().opened().path().ends_with("scene.sdf"));
    fixture.click("Open without saving");
    assert!(fixture.harness.state().opened().path().ends_with("other.sdf"));
}

#[test]
fn params_are_saved_as_defaults() {
    let mut fixture = Fixture::new();
    let changed = [0.4, 0.0, 0.0, 0.0];
    fixture.harness.state_mut().session().param_values.params.insert("wall".to_owned(), changed);
    fixture.harness.run_steps(2);
    fixture.click("Save params");
    let text = SCENE.replace("0.1 in", "0.4 in");
    let path = fixture.folder.path().join("scene.sdf");
    fixture.until(|_| std::fs::read_to_string(&path).unwrap() == text);
    fixture.until(|harness| harness.state().opened().model.as_ref().unwrap().source == text);
    assert!(fixture.harness.state_mut().session().param_values.params.is_empty());
}

#[test]
fn a_picture_and_a_shader_are_saved_beside_the_scene() {
    let mut fixture = Fixture::new();
    let in_folder = |name: &str| fixture.folder.path().join(name);
    let (picture, shader) = (in_folder("scene.png"), in_folder("scene.wgsl"));
    fixture.click("Export");
    fixture.click("square");
    fixture.harness.get_all_by_label("1").last().unwrap().click();
    fixture.harness.run_steps(3);
    fixture.harness.get_all_by_label("Save").last().unwrap().click();
    fixture.until(|_| picture.exists());
    assert_eq!(image::open(&picture).unwrap().width(), 2048);
    fixture.click("Shader");
    fixture.harness.get_all_by_label("Save").last().unwrap().click();
    fixture.until(|_| shader.exists());
    assert!(std::fs::read_to_string(&shader).unwrap().contains("fn sdf_distance"));
}

#[test]
fn an_animation_lasts_until_the_end_of_the_clock_unless_another_length_is_given() {
    let mut fixture = Fixture::of("sphere(1 + 0.1 * sin(time))\n");
    let path = fixture.folder.path().join("scene.gif");
    fixture.click("Export");
    fixture.click("Animation");
    assert!(fixture.harness.query_by_value("10 s").is_some());
    // An animation has many pictures: they are small, unless the user wants other ones.
    for side in ["640", "360"] {
        assert!(fixture.harness.query_by_value(side).is_some(), "{side}");
    }
    fixture.harness.state_mut().session().clock.end = 0.12;
    fixture.harness.run_steps(2);
    fixture.harness.get_all_by_label("Save").last().unwrap().click();
    fixture.until(|_| path.exists());
    let decoder = GifDecoder::new(BufReader::new(File::open(&path).unwrap())).unwrap();
    assert_eq!(decoder.into_frames().count(), 3);
    fixture.harness.get_by_value("0.12 s").set_value_accesskit(3.0);
    fixture.harness.run_steps(3);
    fixture.harness.state_mut().session().clock.end = 5.0;
    fixture.harness.run_steps(2);
    assert!(fixture.harness.query_by_value("3 s").is_some());
}

#[test]
fn the_picture_is_compared_with_the_oracle() {
    let mut fixture = Fixture::new();
    assert!(fixture.has("proven ray by ray"));
    fixture.click("Check accuracy");
    fixture.until(|harness| harness.query_by_label("99th percentile").is_some());
    fixture.until(|harness| harness.query_by_label("Check accuracy").is_some());
    let session = fixture.harness.state_mut().session();
    assert!(session.accuracy_is_current());
    assert_eq!(session.accuracy.result.as_ref().unwrap().shown.failed(), 0);
    fixture.click("Top");
    assert!(fixture.has("of another picture"));
    // Compared automatically from now on.
    fixture.click("check each picture");
    fixture.until(|harness| harness.query_by_label_contains("of another picture").is_none());
}

/// Params of all kinds, a named literal, and time.
const ALL_KINDS: &str = "param width = 0.5 in 0..1\nparam count: int = 2 in 1..5\nparam lean = 10deg\n\
                         param red: color = #d94f30\nparam whole = true\nparam kind = \"ball\" in [\"ball\", \"box\"]\n\
                         let k = 0.25\nsphere(width + k + 0.1 * sin(time)).color(red)\n";

#[test]
fn every_widget_has_a_hover_text() {
    let mut fixture = Fixture::of(ALL_KINDS);
    fixture.click("Export");
    fixture.harness.state_mut().session().mode = ViewMode::Slice;
    let mut without_hover_text = BTreeSet::new();
    for what in ["Picture", "Animation", "Shader", "render", "Screenshot"] {
        fixture.click(what);
        without_hover_text.extend(fixture.without_hover_text());
    }
    for menu in ["scene.sdf", "Examples…"] {
        fixture.click(menu);
        without_hover_text.extend(fixture.without_hover_text());
    }
    fixture.harness.key_press(Key::Escape);
    fixture.harness.run_steps(3);
    for (list, entry) in [
        ("The view: what the picture shows (V for the next).", "Overshoot"),
        ("The ray method: how the surface is found along each ray.", "segment"),
    ] {
        fixture.harness.get_by_role_and_label(Role::ComboBox, list).click();
        fixture.harness.run_steps(3);
        assert!(fixture.has(entry));
        without_hover_text.extend(fixture.without_hover_text());
    }
    assert_eq!(without_hover_text, BTreeSet::new());
}

#[test]
fn escape_closes_menus_and_dialogs_and_nothing_else() {
    let mut fixture = Fixture::new();
    let refines = |fixture: &mut Fixture| fixture.harness.state_mut().session().refine;
    let escape = |fixture: &mut Fixture| {
        fixture.harness.key_press(Key::Escape);
        fixture.harness.run_steps(3);
    };
    fixture.click("scene.sdf");
    assert!(fixture.has("Examples…"));
    escape(&mut fixture);
    assert!(!fixture.has("Examples…") && refines(&mut fixture));
    fixture.change_a_number();
    fixture.request_close();
    escape(&mut fixture);
    assert!(!fixture.has("1 changed number is not saved") && refines(&mut fixture));
    fixture.click("Export");
    escape(&mut fixture);
    escape(&mut fixture);
    assert!(refines(&mut fixture) && !fixture.has("length"));
    fixture.harness.key_press(Key::R);
    fixture.harness.run_steps(3);
    assert!(!refines(&mut fixture));
    fixture.click("Resume");
    assert!(refines(&mut fixture));
}

#[test]
fn until_a_view_is_computed_the_window_says_which_one_it_shows() {
    let mut fixture = Fixture::new();
    fixture.harness.state_mut().session().mode = ViewMode::Normals;
    fixture.harness.step();
    assert!(fixture.draws_text("computing Normals…  (this is Shaded)"));
    let view = "The view: what the picture shows (V for the next).";
    let view = fixture.harness.get_by_role_and_label(Role::ComboBox, view);
    assert_eq!(view.value().as_deref(), Some("View: Normals, computing…"));
    fixture.until(|harness| !harness.state().opened().is_view_pending());
    fixture.harness.step();
    assert!(!fixture.draws_text("computing Normals…  (this is Shaded)"));
    let picture = fixture.harness.state().opened().picture.as_ref().unwrap();
    assert_eq!(picture.request.mode, ViewMode::Normals);
}

#[test]
fn v_chooses_the_next_view_as_often_as_it_is_pressed_in_a_slow_frame() {
    let mut fixture = Fixture::new();
    let press = |pressed| Event::Key {
        key: Key::V,
        physical_key: None,
        pressed,
        repeat: false,
        modifiers: Modifiers::NONE,
    };
    let events = [true, false, true, false, true, false].map(press);
    fixture.harness.input_mut().events.extend(events);
    fixture.harness.step();
    let third = ViewMode::Shaded.next().next().next();
    assert_eq!(fixture.harness.state().opened().mode, third);
}

#[test]
fn before_the_first_picture_of_a_scene_the_window_says_that_it_is_being_drawn() {
    let mut fixture = Fixture::new();
    let other = fixture.folder.path().join("other.sdf");
    std::fs::write(&other, "sphere(2)\n").unwrap();
    fixture.harness.state_mut().session().open_other(other);
    fixture.until(|harness| harness.state().opened().model.is_some());
    assert!(fixture.harness.state().opened().picture.is_none());
    assert!(fixture.draws_text("drawing the first picture…"));
}

#[test]
fn the_code_panel_shows_the_file_with_its_errors() {
    let mut fixture = Fixture::new();
    fixture.click("Drag numbers");
    fixture.write("// new\nlet own_name = spere(1)\n");
    fixture.until(|harness| harness.query_by_label("error[E0201]").is_some());
    assert!(fixture.has("let own_name = "));
    assert!(!fixture.has("How thick"));
    // The marked word.
    assert!(fixture.harness.query_by_label("spere").is_some());
}

#[test]
fn the_code_panel_shows_a_file_that_has_errors_from_the_start() {
    let folder = tempfile::tempdir().unwrap();
    let (path, text) = (folder.path().join("scene.sdf"), "let own_name = spere(1)\n");
    std::fs::write(&path, text).unwrap();
    let app = App::new(&Context::default(), &path, None).unwrap();
    let mut fixture = Fixture::shown(app, folder);
    fixture.until(|harness| harness.query_by_label("error[E0201]").is_some());
    let editor = fixture.harness.get_by_role(Role::MultilineTextInput);
    assert_eq!(editor.value().as_deref(), Some(text));
    fixture.click("Drag numbers");
    assert!(fixture.has("let own_name = "));
}

#[test]
fn typing_edits_the_scene_and_ctrl_s_saves_it() {
    let mut fixture = Fixture::new();
    let path = fixture.folder.path().join("scene.sdf");
    let on_disk = || std::fs::read_to_string(&path).unwrap();
    fixture.type_at_end("box(0.1)\n");
    let edited = format!("{SCENE}box(0.1)\n");
    let shows = |text: &str| {
        let text = text.to_owned();
        move |harness: &Harness<'_, App>| {
            harness.state().opened().model.as_ref().is_some_and(|model| model.source == text)
        }
    };
    fixture.until(shows(&edited));
    assert_eq!(on_disk(), SCENE);
    fixture.key(Modifiers::COMMAND, Key::Z);
    fixture.until(shows(SCENE));
    assert!(!fixture.harness.state().opened().has_unsaved_changes());
    fixture.key(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    fixture.until(shows(&edited));
    // A changed number is saved with the text.
    let session = fixture.harness.state_mut().session();
    let model = session.model.clone().unwrap();
    session.param_values.set_number(model.number_at(edited.find("40deg").unwrap()).unwrap(), 0.5);
    let expected = session.current_text();
    assert_ne!(expected, edited);
    fixture.key(Modifiers::COMMAND, Key::S);
    fixture.until(|_| on_disk() == expected);
    fixture.until(shows(&expected));
    assert!(!fixture.harness.state().opened().has_unsaved_changes());
    // The file is followed again.
    fixture.write(SCENE);
    fixture.until(shows(SCENE));
}

#[test]
fn errors_cover_the_picture_only_when_typing_pauses() {
    let mut fixture = Fixture::new();
    fixture.type_at_end("spere(1)");
    let is_compiled =
        |harness: &Harness<'_, App>| harness.state().opened().diagnostics.errors() > 0;
    // A frame of the harness is a quarter of a second.
    fixture.harness.get_by_role(Role::MultilineTextInput).type_text("\n");
    while !is_compiled(&fixture.harness) {
        fixture.harness.get_by_role(Role::MultilineTextInput).type_text(" ");
        fixture.harness.step();
        assert!(!fixture.has("error[E0201]"));
    }
    fixture.harness.run_steps(1);
    assert!(!fixture.has("error[E0201]"));
    fixture.harness.run_steps(5);
    assert!(fixture.has("error[E0201]"));
    // They stay while the text is edited.
    fixture.harness.get_by_role(Role::MultilineTextInput).type_text(" ");
    fixture.harness.run_steps(1);
    assert!(fixture.has("error[E0201]"));
}

#[test]
fn examples_are_chosen_by_their_pictures() {
    let mut fixture = Fixture::new();
    fixture.click("scene.sdf");
    fixture.click("Examples…");
    fixture.until(|harness| harness.query_by_label("welcome").is_some());
    fixture.harness.key_press(Key::Escape);
    fixture.harness.run_steps(3);
    assert!(fixture.harness.query_by_label("welcome").is_none());
}

#[test]
fn ctrl_z_undoes_an_edit_even_if_the_cursor_has_moved_since() {
    let mut fixture = Fixture::new();
    let text = |fixture: &Fixture| fixture.harness.state().opened().text().to_string();
    fixture.type_at_end("box(1)\n");
    // egui records a state that has rested for a second: four frames of the harness.
    fixture.harness.run_steps(6);
    for _ in 0..2 {
        fixture.key(Modifiers::NONE, Key::ArrowUp);
        fixture.harness.run_steps(6);
    }
    fixture.key(Modifiers::COMMAND, Key::Z);
    assert_eq!(text(&fixture), SCENE);
    fixture.key(Modifiers::COMMAND, Key::Z);
    assert_eq!(text(&fixture), SCENE);
    fixture.key(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    assert_eq!(text(&fixture), format!("{SCENE}box(1)\n"));
}

#[test]
fn completions_are_listed_and_inserted() {
    let mut fixture = Fixture::new();
    fixture.type_at_end("sph");
    fixture.until(|harness| harness.query_by_label("sphere").is_some());
    fixture.key(Modifiers::NONE, Key::Tab);
    let text = fixture.harness.state().opened().text().to_string();
    assert!(text.starts_with(&format!("{SCENE}sphere(")), "{text}");
    // The first gap is selected: typing replaces it.
    fixture.harness.get_by_role(Role::MultilineTextInput).type_text("0.25");
    fixture.harness.run_steps(3);
    let text = fixture.harness.state().opened().text().to_string();
    assert!(text.starts_with(&format!("{SCENE}sphere(0.25")), "{text}");
}

#[test]
fn a_clicked_shape_leads_to_its_code() {
    let mut fixture = Fixture::of("box(1).translate(x: 2)\nsphere(1)\n");
    fixture.until(|harness| {
        let session = harness.state().opened();
        let at = |index: u32| [index % 40, index / 40].map(|at| f64::from(at) / 40.0);
        let found = (0..1600).filter_map(|index| session.code_at(at(index)));
        let code: BTreeSet<&str> = found.map(|(_, range)| &session.text()[range]).collect();
        code == BTreeSet::from(["box(1)", "sphere(1)"])
    });
    assert_eq!(fixture.harness.state().opened().code_at([0.01, 0.01]), None);
}

#[test]
fn typed_text_is_kept_when_the_file_changes() {
    let mut fixture = Fixture::new();
    fixture.type_at_end("// mine\n");
    fixture.write(&format!("// theirs\n{SCENE}"));
    fixture
        .until(|harness| harness.query_all_by_label_contains("changed outside").next().is_some());
    let mine = format!("{SCENE}// mine\n");
    assert_eq!(**fixture.harness.state().opened().text(), *mine);
    fixture.key(Modifiers::COMMAND, Key::S);
    assert!(fixture.has("not saved"));
    fixture.request_close();
    assert!(fixture.has("The edited text of scene.sdf is not saved"));
    fixture.click("Cancel");
    fixture.click("Keep this text");
    fixture.key(Modifiers::COMMAND, Key::S);
    let path = fixture.folder.path().join("scene.sdf");
    fixture.until(|_| std::fs::read_to_string(&path).unwrap() == mine);
    // The file is followed again.
    fixture.write(&format!("{mine}// outside\n"));
    fixture.until(|harness| harness.state().opened().text().ends_with("// outside\n"));
    fixture.write(&mine);
    fixture.until(|harness| **harness.state().opened().text() == *mine);
    // Now the file wins.
    fixture.type_at_end("// again\n");
    fixture.write(SCENE);
    fixture.until(|harness| harness.query_by_label("Load the file").is_some());
    fixture.click("Load the file");
    assert_eq!(**fixture.harness.state().opened().text(), *SCENE);
}

#[test]
fn a_fix_changes_the_text_but_not_the_file() {
    let mut fixture = Fixture::new();
    fixture.write("spere(1)\n");
    fixture.until(|harness| harness.query_by_label("error[E0201]").is_some());
    let fix = fixture.harness.state().opened().diagnostics.all[0].fixes[0].clone();
    fixture.click(&fix.title);
    fixture.until(|harness| harness.state().opened().diagnostics.errors() == 0);
    assert_eq!(**fixture.harness.state().opened().text(), *"sphere(1)\n");
    let path = fixture.folder.path().join("scene.sdf");
    assert_eq!(std::fs::read_to_string(path).unwrap(), "spere(1)\n");
}

#[test]
fn errors_can_be_folded_away() {
    let mut fixture = Fixture::new();
    fixture.write("spere(1)\nspere(2)\n");
    fixture.until(|harness| harness.query_all_by_label("error[E0201]").count() == 2);
    fixture.click("hide 2 errors");
    assert!(fixture.harness.query_by_label("error[E0201]").is_none());
    fixture.click("show 2 errors");
    assert!(fixture.has("error[E0201]"));
}

#[test]
fn enter_in_a_size_field_does_not_save_and_an_existing_file_is_not_replaced_at_once() {
    let mut fixture = Fixture::new();
    let picture = fixture.folder.path().join("scene.png");
    std::fs::write(&picture, "mine").unwrap();
    fixture.click("Export");
    fixture.harness.get_by_value("1920").click();
    fixture.harness.run_steps(3);
    fixture.harness.key_press(Key::Enter);
    fixture.harness.run_steps(3);
    assert!(!fixture.has("replace it?"));
    fixture.harness.get_all_by_label("1").last().unwrap().click();
    fixture.harness.run_steps(3);
    fixture.click("Save");
    assert!(fixture.has("replace it?"));
    std::thread::sleep(Duration::from_millis(300));
    assert_eq!(std::fs::read(&picture).unwrap(), b"mine");
    fixture.click("Replace");
    fixture.until(|_| image::open(&picture).is_ok_and(|it| it.width() == 1920));
}

#[test]
fn a_move_to_another_monitor_is_reported() {
    let mut fixture = Fixture::new();
    for (width, scale) in [(1920.0, 1.0), (3840.0, 2.0)] {
        let viewports = &mut fixture.harness.input_mut().viewports;
        let viewport = viewports.entry(ViewportId::ROOT).or_default();
        viewport.monitor_size = Some([width / scale, 1080.0].into());
        viewport.native_pixels_per_point = Some(scale);
        fixture.harness.run_steps(2);
    }
    assert!(fixture.has("the window is now on a monitor of 3840 × 2160 pixels, scale 2"));
}

/// A file that is dropped on the window.
#[derive(Debug)]
struct Dropped(PathBuf);

impl DroppedFile for Dropped {
    fn path(&self) -> &Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        std::fs::read(&self.0).map_err(|error| error.to_string())
    }
}

#[test]
fn a_dropped_scene_is_opened_and_the_one_before_is_in_the_menu() {
    let mut fixture = Fixture::new();
    let other = fixture.folder.path().join("other.sdf");
    std::fs::write(&other, SCENE.replace("param wall", "param rind").replace("- wall", "- rind"))
        .unwrap();
    fixture.harness.input_mut().dropped_files.push(Arc::new(Dropped(other)));
    fixture.until(|harness| harness.query_all_by_label("rind").next().is_some());
    fixture.click("other.sdf");
    fixture.click("Open recent");
    fixture.click("scene.sdf");
    fixture.until(|harness| harness.query_all_by_label("wall").next().is_some());
}

#[test]
fn a_scene_is_opened_with_its_last_camera_and_params() {
    let mut fixture = Fixture::new();
    fixture.click("Top");
    let session = fixture.harness.state_mut().session();
    session.param_values.params.insert("wall".to_owned(), [0.4, 0.0, 0.0, 0.0]);
    let left = session.manual_camera().unwrap();
    let context = fixture.harness.ctx.clone();
    fixture.harness.state_mut().store_settings(&context);
    let folder = fixture.folder.path();
    let settings = Some(folder.join("view.json"));
    let mut again =
        App::new(&Context::default(), &folder.join("scene.sdf"), settings.clone()).unwrap();
    let session = again.session();
    session.update_build(|build| build.on_cpu = true);
    let start = Instant::now();
    while session.model.is_none() {
        assert!(start.elapsed() < TIMEOUT);
        std::thread::sleep(Duration::from_millis(5));
        session.poll();
        session.request_picture([30, 20], false);
    }
    session.request_picture([30, 20], false);
    let camera = session.manual_camera().unwrap();
    let near = |(a, b): (&f64, &f64)| (a - b).abs() < 1e-9;
    assert!(camera.eye.iter().zip(&left.eye).all(near), "{camera:?}, not {left:?}");
    assert_eq!(session.param_values.params["wall"][0], 0.4);
    // Another scene has its own settings.
    let other = folder.join("other.sdf");
    std::fs::write(&other, SCENE).unwrap();
    let mut other = App::new(&Context::default(), &other, settings).unwrap();
    assert_eq!(other.session().manual_camera(), None);
}

#[test]
fn a_missing_scene_can_be_created() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("new.sdf");
    let mut app = App::new(&Context::default(), &path, None).unwrap();
    app.session().update_build(|build| build.on_cpu = true);
    let mut fixture = Fixture::shown(app, folder);
    fixture.until(|harness| harness.query_by_label("Create new.sdf").is_some());
    fixture.click("Create new.sdf");
    fixture.until(|harness| harness.state().picture_is_finished());
    assert!(path.is_file());
}

#[test]
fn the_scene_is_saved_as_another_file_with_its_changed_numbers() {
    let mut fixture = Fixture::new();
    fixture.change_a_number();
    fixture.click("scene.sdf");
    fixture.click("Save as…");
    fixture.click("Save");
    let copy = fixture.folder.path().join("scene-copy.sdf");
    fixture.until(|harness| harness.state().opened().path() == copy);
    let text = std::fs::read_to_string(&copy).unwrap();
    assert_eq!(text, SCENE.replace("sphere(1) ", "sphere(1.25) "));
    assert_eq!(std::fs::read_to_string(copy.with_file_name("scene.sdf")).unwrap(), SCENE);
}

#[test]
fn a_new_scene_asks_before_changed_numbers_are_lost() {
    let mut fixture = Fixture::new();
    fixture.change_a_number();
    fixture.click("scene.sdf");
    fixture.click("New…");
    fixture.click("Create");
    fixture.click("Open without saving");
    fixture.until(|harness| harness.state().opened().path().ends_with("new.sdf"));
}

#[test]
fn stdin_two_files_and_a_file_in_a_missing_folder_are_refused() {
    for arguments in [&["-"][..], &["a.sdf", "b.sdf"], &["missing/a.sdf"], &["missing.txt"]] {
        let mut program = std::process::Command::new(env!("CARGO_BIN_EXE_sdfc-view"));
        let output = program.args(arguments).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {output:?}");
    }
}

#[test]
fn a_reader_that_closes_the_pipe_early_is_no_error() {
    for argument in ["--help", "--version"] {
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let mut program = std::process::Command::new(env!("CARGO_BIN_EXE_sdfc-view"));
        let program = program.arg(argument).stdout(writer).stderr(std::process::Stdio::piped());
        let output = program.spawn().unwrap().wait_with_output().unwrap();
        assert!(output.status.success() && output.stderr.is_empty(), "{argument}: {output:?}");
    }
}
