//! What the editor does beside typing: numbers, colours, layout, pictures.

use eframe::egui::accesskit::Role;
use eframe::egui::{Event, Key, MissingGlyphPolicy, Modifiers, PointerButton, Pos2, vec2};
use egui_kittest::kittest::Queryable;
use sdfc_viewer::session::tabs::TabFile;

use crate::fixture::{CTRL, Fixture};

const SCENE: &str = "sphere(0.5).color(rgb(0.2, 0.4, 0.6))\n\
                     camera(eye: [0, 0, 8], target: [0, 0, 0], fov: 40deg)\n";

/// The middle of a character of the text.
fn position(fixture: &Fixture, line: usize, column: usize) -> Pos2 {
    let rect = fixture.harness.get_by_role(Role::MultilineTextInput).rect();
    // The size of a character of the font.
    rect.min + vec2(7.52 * (column as f32 + 0.5), 15.0 * (line as f32 + 0.5))
}

fn text(fixture: &Fixture) -> String {
    fixture.harness.state().opened().text().to_string()
}

fn button(fixture: &mut Fixture, at: Pos2, pressed: bool) {
    let (button, modifiers) = (PointerButton::Primary, Modifiers::ALT);
    fixture.harness.event(Event::PointerButton { pos: at, button, pressed, modifiers });
    fixture.harness.run_steps(2);
}

#[test]
fn a_number_is_dragged_with_alt_in_one_step_to_undo() {
    let mut fixture = Fixture::of(SCENE);
    let at = position(&fixture, 0, "sphere(0.".len());
    fixture.harness.event(Event::ModifiersChanged(Modifiers::ALT));
    fixture.harness.hover_at(at);
    fixture.harness.run_steps(2);
    button(&mut fixture, at, true);
    for points in [10.0, 20.0, 40.0] {
        fixture.harness.hover_at(at + vec2(points, 0.0));
        fixture.harness.run_steps(2);
    }
    button(&mut fixture, at + vec2(40.0, 0.0), false);
    fixture.harness.event(Event::ModifiersChanged(Modifiers::NONE));
    let dragged = text(&fixture);
    let value = dragged.split(['(', ')']).nth(1).unwrap();
    assert!((0.52..=0.541).contains(&value.parse::<f64>().unwrap()), "{dragged}");
    assert_eq!(dragged.replacen(value, "0.5", 1), SCENE);
    fixture.key(Modifiers::COMMAND, Key::Z);
    assert_eq!(text(&fixture), SCENE);
}

/// Presses the number at a column of the first line while Alt is held, and drags it a little.
fn start_drag(fixture: &mut Fixture, column: usize) -> Pos2 {
    let at = position(fixture, 0, column);
    fixture.harness.event(Event::ModifiersChanged(Modifiers::ALT));
    fixture.harness.hover_at(at);
    fixture.harness.run_steps(2);
    button(fixture, at, true);
    drag_to(fixture, at + vec2(10.0, 0.0));
    at
}

fn drag_to(fixture: &mut Fixture, at: Pos2) {
    fixture.harness.hover_at(at);
    fixture.harness.run_steps(2);
}

#[test]
fn a_drag_of_a_number_ends_when_the_text_changes() {
    let mut fixture = Fixture::of(SCENE);
    let at = start_drag(&mut fixture, "sphere(0.".len());
    let dragged = text(&fixture);
    assert_ne!(dragged, SCENE);
    let edited = format!("{dragged}// typed\n");
    fixture.harness.state_mut().session().edit_shown(|draft| draft.set_text(&edited));
    drag_to(&mut fixture, at + vec2(40.0, 0.0));
    button(&mut fixture, at + vec2(40.0, 0.0), false);
    assert_eq!(text(&fixture), edited);
}

#[test]
fn a_drag_of_a_number_ends_when_another_file_is_shown() {
    let mut fixture = Fixture::of(SCENE);
    let part = "solid part() = sphere(2)(p)\n";
    std::fs::write(fixture.folder.path().join("part.sdf"), part).unwrap();
    let importing = format!("{SCENE}import part from \"part.sdf\"\n");
    fixture.write(&importing);
    let import = TabFile::Import("part.sdf".to_owned());
    fixture.until(|harness| harness.state().opened().text_of(&import).is_some());
    fixture.harness.run_steps(2);
    let at = start_drag(&mut fixture, "sphere(0.".len());
    assert_ne!(text(&fixture), importing);
    fixture.harness.state_mut().session().show_file(import.clone());
    fixture.harness.run_steps(2);
    drag_to(&mut fixture, at + vec2(40.0, 0.0));
    button(&mut fixture, at + vec2(40.0, 0.0), false);
    assert_eq!(**fixture.harness.state().opened().text_of(&import).unwrap(), *part);
}

#[test]
fn typing_in_a_text_with_crlf_keeps_the_cursor_behind_what_was_typed() {
    let mut fixture = Fixture::with_text("sphere(1)\r\nbox(1)\r\n");
    fixture.type_at_end("");
    fixture.key(CTRL, Key::Home);
    for _ in 0.."sph".len() {
        fixture.harness.key_press(Key::ArrowRight);
    }
    fixture.harness.run_steps(3);
    fixture.key(Modifiers::NONE, Key::Enter);
    fixture.harness.event(Event::Text("ab".to_owned()));
    fixture.harness.run_steps(3);
    fixture.harness.event(Event::Paste("\n\n".to_owned()));
    fixture.harness.run_steps(3);
    fixture.harness.event(Event::Text("c".to_owned()));
    fixture.harness.run_steps(3);
    assert_eq!(text(&fixture), "sph\r\nab\r\n\r\ncere(1)\r\nbox(1)\r\n");
}

#[test]
fn the_button_that_saves_the_text_saves_params_as_the_key_does() {
    let mut fixture = Fixture::new();
    let path = fixture.folder.path().join("scene.sdf");
    fixture.type_at_end("// typed\n");
    fixture.until(|harness| {
        let session = harness.state().opened();
        session.model.as_ref().is_some_and(|model| model.source.ends_with("// typed\n"))
    });
    let session = fixture.harness.state_mut().session();
    session.param_values.params.insert("wall".to_owned(), [0.4, 0.0, 0.0, 0.0]);
    fixture.harness.run_steps(2);
    // The export dialog is closed, so this is the button of the panel.
    fixture.click("Save");
    let expected = format!("{}// typed\n", crate::fixture::SCENE.replace("0.1 in", "0.4 in"));
    fixture.until(|_| std::fs::read_to_string(&path).unwrap() == expected);
}

#[test]
fn a_call_of_rgb_has_a_colour_button_and_stays_a_call() {
    let mut fixture = Fixture::of(SCENE);
    fixture.type_at_end("");
    fixture.key(CTRL, Key::Home);
    for _ in 0.."sphere(0.5).color(rg".len() {
        fixture.harness.key_press(Key::ArrowRight);
    }
    fixture.until(|harness| harness.query_by_role(Role::ColorWell).is_some());
    // egui's picker has a button with a sign that its fonts lack.
    fixture.harness.ctx.set_missing_glyph_policy(MissingGlyphPolicy::Tofu);
    fixture.harness.get_by_role(Role::ColorWell).click();
    fixture.harness.run_steps(3);
    // The last fields are those of the picker: red, green, blue, alpha.
    let fields: Vec<_> = fixture.harness.get_all_by_role(Role::SpinButton).collect();
    fields[fields.len() - 4].set_value_accesskit(255.0);
    fixture.harness.run_steps(3);
    assert_eq!(text(&fixture), SCENE.replace("rgb(0.2,", "rgb(1,"));
}

#[test]
fn a_text_is_formatted_on_save_if_that_is_wanted() {
    let mut fixture = Fixture::of(SCENE);
    let path = fixture.folder.path().join("scene.sdf");
    fixture.type_at_end("box( 0.1 )\n");
    fixture.key(Modifiers::COMMAND, Key::S);
    fixture.until(|_| std::fs::read_to_string(&path).unwrap().ends_with("box( 0.1 )\n"));
    fixture.click("More");
    fixture.click("Format on save");
    fixture.key(Modifiers::NONE, Key::Escape);
    fixture.type_at_end("box( 0.2 )\n");
    fixture.key(Modifiers::COMMAND, Key::S);
    let expected = format!("{SCENE}box(0.1)\nbox(0.2)\n");
    fixture.until(|_| std::fs::read_to_string(&path).unwrap() == expected);
    fixture.until(|harness| **harness.state().opened().text() == *expected);
    assert!(!fixture.harness.state().opened().has_unsaved_changes());
    // A text with syntax errors is saved as it is.
    fixture.type_at_end("box( 0.3\n");
    fixture.key(Modifiers::COMMAND, Key::S);
    fixture.until(|_| std::fs::read_to_string(&path).unwrap().ends_with("box( 0.3\n"));
}

#[test]
fn the_description_of_a_library_entry_has_its_picture() {
    let mut fixture = Fixture::of(SCENE);
    fixture.until(|harness| harness.state().opened().answer_about_text().is_some());
    fixture.harness.hover_at(position(&fixture, 0, 2));
    fixture.until(|harness| harness.query_by_label("a picture of the entry").is_some());
    assert!(fixture.has("solid sphere("));
    assert!(fixture.has("• r: "));
}
