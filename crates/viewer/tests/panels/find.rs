//! Find and replace in the panel "Code".

use eframe::egui::accesskit::Role;
use eframe::egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable;

use crate::fixture::{CTRL, Fixture};

const BOXES: &str = "box(1) | Box(2)\nboxes(3) // box\n";

/// The editor with the keyboard, and the bar opened by a key.
fn searching(text: &str, key: Key) -> Fixture {
    let mut fixture = Fixture::with_text(text);
    fixture.type_at_end("");
    fixture.key(Modifiers::COMMAND, key);
    fixture
}

fn type_into(fixture: &mut Fixture, field: &str, text: &str) {
    let field = |fixture: &Fixture| {
        fixture.harness.get_by_role_and_label(Role::TextInput, field).focus();
    };
    field(fixture);
    fixture.harness.run_steps(2);
    fixture.harness.event(eframe::egui::Event::Text(text.to_owned()));
    fixture.harness.run_steps(3);
}

#[test]
fn matches_are_counted_and_stepped_through() {
    let mut fixture = searching(BOXES, Key::F);
    type_into(&mut fixture, "find", "box");
    assert!(fixture.has("1 of 4"));
    fixture.key(Modifiers::NONE, Key::Enter);
    assert!(fixture.has("2 of 4"));
    fixture.key(Modifiers::SHIFT, Key::Enter);
    fixture.key(Modifiers::SHIFT, Key::F3);
    assert!(fixture.has("4 of 4"));
    fixture.click("Aa");
    assert!(fixture.has("of 3"));
    fixture.click("word");
    assert!(fixture.has("of 2"));
    type_into(&mut fixture, "find", "nothing");
    assert!(fixture.has("no match"));
}

#[test]
fn replacing_all_is_one_step_to_undo() {
    let mut fixture = searching(BOXES, Key::H);
    type_into(&mut fixture, "find", "box");
    type_into(&mut fixture, "replace with", "torus");
    fixture.click("Replace all");
    let text = |fixture: &Fixture| fixture.harness.state().opened().text().to_string();
    assert_eq!(text(&fixture), "torus(1) | torus(2)\ntoruses(3) // torus\n");
    // Esc gives the keyboard back to the editor.
    fixture.key(Modifiers::NONE, Key::Escape);
    assert!(fixture.harness.query_by_label("Replace all").is_none());
    fixture.key(Modifiers::COMMAND, Key::Z);
    assert_eq!(text(&fixture), BOXES);
    fixture.key(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    assert!(text(&fixture).starts_with("torus(1) | torus(2)"));
}

#[test]
fn one_match_is_replaced_after_the_other() {
    let mut fixture = searching(BOXES, Key::H);
    type_into(&mut fixture, "find", "box");
    type_into(&mut fixture, "replace with", "torus");
    fixture.click("Replace");
    let text = |fixture: &Fixture| fixture.harness.state().opened().text().to_string();
    assert_eq!(text(&fixture), BOXES.replacen("box", "torus", 1));
    assert!(fixture.has("1 of 3"));
    fixture.click("Replace");
    assert_eq!(text(&fixture), "torus(1) | torus(2)\nboxes(3) // box\n");
}

#[test]
fn a_selection_becomes_the_search_text() {
    let mut fixture = Fixture::with_text(BOXES);
    fixture.type_at_end("");
    fixture.key(CTRL, Key::Home);
    for _ in 0.."box(1".len() {
        fixture.key(Modifiers::SHIFT, Key::ArrowRight);
    }
    fixture.key(Modifiers::COMMAND, Key::F);
    assert!(fixture.has("1 of 1"));
    fixture.key(Modifiers::NONE, Key::Escape);
    // The match is selected: typing replaces it.
    fixture.harness.event(eframe::egui::Event::Text("cube(1".to_owned()));
    fixture.harness.run_steps(3);
    let text = fixture.harness.state().opened().text().to_string();
    assert_eq!(text, BOXES.replace("box(1", "cube(1"));
}

#[test]
fn the_search_opens_while_numbers_are_dragged() {
    let mut fixture = Fixture::with_text(BOXES);
    fixture.click("Drag numbers");
    assert!(fixture.harness.query_by_role(Role::MultilineTextInput).is_none());
    fixture.key(Modifiers::COMMAND, Key::F);
    type_into(&mut fixture, "find", "box");
    assert!(fixture.has("1 of 4"));
}
