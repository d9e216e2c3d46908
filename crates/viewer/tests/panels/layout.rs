//! Panels, texts and the picture keep their places: in small windows, at other scales, and while
//! something opens.

use eframe::egui::{Key, Modifiers, Rect, vec2};
use egui_kittest::kittest::Queryable;

use crate::fixture::{DrawnText, Fixture};

#[test]
fn in_a_small_window_the_menu_of_scenes_stays_and_no_texts_overlap() {
    let mut fixture = Fixture::new();
    for width in [690.0, 480.0] {
        let window = Rect::from_min_size(Default::default(), vec2(width, 320.0));
        fixture.harness.set_size(window.size());
        fixture.harness.state_mut().session().refine = true;
        fixture.harness.run_steps(3);
        fixture.until(|harness| harness.state().picture_is_finished());
        let session = fixture.harness.state_mut().session();
        session.refine = false;
        session.messages.push("a message for which there is no room ".repeat(4));
        fixture.harness.run_steps(2);
        let texts = fixture.drawn_texts();
        let name = texts.iter().find(|it| it.text == "scene.sdf" && it.rect.top() < 30.0);
        let name = name.unwrap_or_else(|| panic!("{width}: no menu of scenes"));
        assert!(window.contains_rect(name.seen) && name.seen.width() > 30.0, "{:?}", name.seen);
        for [top, bottom] in [[0.0, 30.0], [290.0, 320.0]] {
            let is_in_bar = |it: &&DrawnText| it.rect.top() >= top && it.rect.bottom() <= bottom;
            let bar: Vec<&DrawnText> = texts.iter().filter(is_in_bar).collect();
            assert!(bar.len() > 2, "{width}: {} texts", bar.len());
            for (index, one) in bar.iter().enumerate() {
                assert!(window.contains_rect(one.rect), "{width}: `{}` is cut off", one.text);
                for other in &bar[..index] {
                    let overlap = one.rect.intersect(other.rect);
                    assert!(!overlap.is_positive(), "{width}: `{}`, `{}`", one.text, other.text);
                }
            }
        }
        fixture.click("scene.sdf");
        assert!(fixture.has("Examples…"));
        fixture.key(Modifiers::NONE, Key::Escape);
    }
}

#[test]
fn at_twice_the_scale_the_pixel_info_stays_in_the_picture() {
    let mut fixture = Fixture::new();
    fixture.harness.set_pixels_per_point(2.0);
    fixture.harness.set_size(vec2(500.0, 320.0));
    fixture.harness.run_steps(3);
    fixture.until(|harness| harness.state().picture_is_finished());
    let picture = fixture.harness.state().picture_rect();
    fixture.harness.hover_at(picture.center());
    fixture.harness.run_steps(3);
    for start in ["point ", "normal ", "depth "] {
        let texts = fixture.drawn_texts();
        let line = texts.iter().find(|it| it.text.starts_with(start));
        let line = line.unwrap_or_else(|| panic!("no line `{start}`"));
        assert!(picture.contains_rect(line.rect), "{:?} is not in {picture:?}", line.rect);
    }
}

#[test]
fn many_errors_leave_more_than_half_of_the_picture_free() {
    let mut fixture = Fixture::new();
    fixture.write(&"spere(1)\n".repeat(12));
    fixture.until(|harness| harness.query_by_label("hide 12 errors").is_some());
    fixture.harness.run_steps(3);
    let picture = fixture.harness.state().picture_rect();
    let texts = fixture.drawn_texts();
    let errors = texts.iter().filter(|it| it.text == "error[E0201]").count();
    assert!((1..12).contains(&errors), "{errors} errors are seen at once");
    for DrawnText { text, seen, .. } in texts.iter().filter(|it| picture.contains_rect(it.seen)) {
        let covered = (seen.bottom() - picture.top()) / picture.height();
        assert!(covered < 0.5, "`{text}` is at {covered} of the height");
    }
}

#[test]
fn the_list_of_keys_is_whole_in_its_first_frame() {
    let mut fixture = Fixture::new();
    fixture.harness.key_down(Key::Questionmark);
    while !fixture.draws_text("Keys and mouse") {
        fixture.harness.step();
    }
    let first = fixture.drawn_texts();
    fixture.harness.run_steps(5);
    let later = fixture.drawn_texts();
    let from = later.iter().position(|it| it.text == "Keys and mouse").unwrap();
    // Behind the last row that fits, the list is scrolled.
    assert!(later.len() > from + 30, "{} texts", later.len() - from);
    for DrawnText { text, rect, seen } in &later[from..] {
        let before = first.iter().filter(|it| it.text == *text);
        let is_same = |it: &DrawnText| (it.rect, it.seen) == (*rect, *seen);
        assert!(before.clone().any(is_same), "`{text}` is elsewhere or cut off at first");
        assert_eq!(seen.x_range(), rect.x_range(), "`{text}` is cut off");
    }
}

#[test]
fn the_code_panel_keeps_its_width_in_another_scene() {
    for numbers in [false, true] {
        let long = format!("// {}\nsphere(1)\n", "a long line ".repeat(12));
        let mut fixture = Fixture::of(&long);
        if numbers {
            fixture.click("Drag numbers");
        }
        let before = fixture.harness.state().picture_rect().left();
        assert!(before > 250.0, "{before}");
        let other = fixture.folder.path().join("b.sdf");
        std::fs::write(&other, "box(1)\n").unwrap();
        fixture.harness.state_mut().session().open_other(other);
        let mut frames = 0;
        while !fixture.harness.state().picture_is_finished() || frames < 5 {
            fixture.harness.step();
            frames += 1;
            assert_eq!(fixture.harness.state().picture_rect().left(), before);
        }
    }
}

#[test]
fn the_last_picture_is_not_stretched_when_a_panel_closes() {
    let mut fixture = Fixture::new();
    let is_stretched = |fixture: &Fixture| {
        let [width, height] = fixture.harness.state().opened().shown_request().unwrap().size;
        let shown = fixture.drawn_picture().unwrap();
        (shown.aspect_ratio() / (width as f32 / height as f32) - 1.0).abs() > 0.01
    };
    let before = fixture.harness.state().opened().shown_request().unwrap().size;
    fixture.harness.key_down(Key::K);
    fixture.harness.step();
    let space = fixture.harness.state().picture_rect();
    assert!(space.width() > before[0] as f32 + 100.0, "the panel is still open");
    assert_eq!(fixture.harness.state().opened().shown_request().unwrap().size, before);
    assert!(!is_stretched(&fixture));
    fixture.until(|harness| harness.state().opened().shown_request().unwrap().size != before);
    assert!(!is_stretched(&fixture));
}
