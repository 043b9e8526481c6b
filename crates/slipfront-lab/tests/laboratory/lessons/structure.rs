//! Lessons, steps and buttons are consistent, and their cases run.

use std::collections::BTreeSet;
use std::fs;

use super::content::{Keys, Lesson, LessonWords, Step, case, lessons, web, words};

/// Largest side of a slider, blocks, so that each case runs within some seconds.
const MAX_SIDE: u32 = 100;
/// Reading speed, words per minute.
const WORDS_PER_MINUTE: f64 = 150.0;
/// Longest lesson, minutes.
const MAX_MINUTES: f64 = 5.0;

fn runs(step: &Step) -> impl Iterator<Item = (Keys, f64)> {
    let buttons = step.set.iter().filter(|button| !button.keys.is_empty());
    let changed = buttons.map(|button| (button.keys.clone(), button.view.pace.unwrap_or(step.view.pace)));
    std::iter::once((Keys::new(), step.view.pace)).chain(changed)
}

#[test]
fn ids_are_unique_and_have_words() {
    let (lessons, words) = (lessons(), words());
    assert_eq!(lessons.len(), 9);
    let ids: BTreeSet<&String> = lessons.iter().map(|lesson| &lesson.id).collect();
    assert_eq!(ids.len(), lessons.len());
    assert_eq!(ids, words.keys().collect());
    for lesson in &lessons {
        let words = &words[&lesson.id];
        let steps: BTreeSet<&String> = lesson.steps.iter().map(|step| &step.id).collect();
        assert!((3..=5).contains(&lesson.steps.len()), "{}", lesson.id);
        assert_eq!(steps.len(), lesson.steps.len(), "{}", lesson.id);
        assert_eq!(steps, words.steps.keys().collect(), "{}", lesson.id);
        for step in &lesson.steps {
            let buttons: BTreeSet<&String> = step.set.iter().map(|button| &button.id).collect();
            assert_eq!(buttons.len(), step.set.len(), "{}", step.id);
            assert_eq!(buttons, words.steps[&step.id].set.keys().collect(), "{}", step.id);
        }
    }
}

#[test]
fn what_a_button_shows_does_not_depend_on_the_one_pressed_before() {
    for step in lessons().iter().flat_map(|lesson| &lesson.steps) {
        let of_case = step.set.iter().filter(|button| !button.keys.is_empty());
        let changes: BTreeSet<_> = of_case
            .map(|button| {
                let keys: BTreeSet<&String> = button.keys.keys().collect();
                (keys, button.view.field.is_some(), button.view.pace.is_some())
            })
            .collect();
        assert!(changes.len() <= 1, "{}: {changes:?}", step.id);
        for button in &step.set {
            let changes_view = button.view.field.is_some() || button.view.pace.is_some();
            assert!(
                changes_view || !button.keys.is_empty(),
                "{}: {}",
                step.id,
                button.id
            );
        }
    }
}

#[test]
fn cases_are_small_and_each_is_used() {
    let lessons = lessons();
    let steps = || lessons.iter().flat_map(|lesson| &lesson.steps);
    for step in steps() {
        for (keys, _) in runs(step) {
            let blocks = case(&step.case, &keys).file.slider.blocks;
            assert!(
                blocks.iter().all(|count| *count <= MAX_SIDE),
                "{}: {blocks:?}",
                step.id
            );
        }
    }
    let records = steps().filter_map(|step| step.record.clone());
    let used: BTreeSet<String> = steps().map(|step| step.case.clone()).chain(records).collect();
    let files = fs::read_dir(web().join("lessons")).unwrap();
    let files = files.map(|file| format!("lessons/{}", file.unwrap().file_name().display()));
    assert_eq!(used, files.collect());
}

/// Duration of a lesson that is read once, with each of its cases run once, minutes.
fn minutes(lesson: &Lesson, said: &LessonWords) -> f64 {
    let count = |text: &String| text.split_whitespace().count();
    let mut n_words = count(&said.title) + count(&said.summary);
    let mut seconds = 0.0;
    for step in &lesson.steps {
        let said = &said.steps[&step.id];
        let texts = said.paragraphs().chain(said.set.values());
        n_words += count(&said.title) + texts.map(count).sum::<usize>();
        for (keys, pace) in runs(step) {
            assert!(pace > 0.0, "{}: a pace is needed", step.id);
            let plan = case(&step.case, &keys).time_plan;
            seconds += plan.last_step as f64 * plan.dt_star / pace;
        }
    }
    n_words as f64 / WORDS_PER_MINUTE + seconds / 60.0
}

#[test]
fn a_lesson_takes_the_minutes_that_it_says_and_at_most_five() {
    let words = words();
    let wrong: Vec<String> = lessons()
        .iter()
        .filter_map(|lesson| {
            let said = &words[&lesson.id];
            let minutes = minutes(lesson, said);
            let is_right = minutes <= MAX_MINUTES && said.minutes == minutes.ceil() as u32;
            (!is_right).then(|| format!("{} says {}, and takes {minutes:.2}", lesson.id, said.minutes))
        })
        .collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
