//! Every number in a text is the one that the engine computes.

use slipfront_case::case::Case;

use super::content::{Button, Keys, Lesson, Number, Quantity, case, lessons, numbers, words};
use super::measured::Runs;
use super::said::Said;
use super::words::ids;

/// Value of a key of a case with all defaults filled in.
fn value_of_key(case: &Case, key: &str) -> toml::Value {
    let text = case.file.to_toml().expect("the case is within its bounds");
    let table: toml::Table = text.parse().expect("what is written can be read");
    let part = |value: &toml::Value, part: &str| match part.parse::<usize>() {
        Ok(index) => value.get(index).cloned(),
        Err(_) => value.get(part).cloned(),
    };
    let mut parts = key.split('.');
    let found = parts.try_fold(toml::Value::Table(table), |value, name| part(&value, name));
    found.unwrap_or_else(|| panic!("the case {} has no value of {key}", case.name))
}

/// Whether a text gives the value of a key, which is not rounded; quantities with a unit must match
/// literally.
fn says_key(says: &str, unit: &str, value: &toml::Value) -> bool {
    let is = |says: &str, value: f64| Said::parse(says, unit).is_some_and(|said| said.value == value);
    match value {
        toml::Value::String(text) => says == text,
        toml::Value::Integer(number) => is(says, *number as f64),
        toml::Value::Float(number) => is(says, *number),
        toml::Value::Array(values) => {
            let parts: Vec<&str> = says.split(" × ").collect();
            parts.len() == values.len()
                && parts
                    .iter()
                    .zip(values)
                    .all(|(says, value)| says_key(says, unit, value))
        }
        _ => false,
    }
}

/// Whether a text gives the value of a key in this case.
fn says_key_of(number: &Number, key: &str, case: &Case) -> bool {
    let unit = number.quantity.unit(Some(key));
    says_key(&number.says, unit, &value_of_key(case, key))
}

#[test]
fn what_is_said_is_what_is_computed() {
    let numbers = numbers();
    let runs = Runs::for_numbers(numbers.values());
    let wrong: Vec<String> = numbers
        .iter()
        .filter_map(|(id, number)| {
            let (says, key) = (&number.says, number.key.as_deref());
            let unit = number.quantity.unit(key);
            let (is, value) = if let Some(key) = key {
                let case = case(&number.case, &number.set);
                (
                    says_key_of(number, key, &case),
                    value_of_key(&case, key).to_string(),
                )
            } else {
                let value = runs.value(number);
                let is = Said::parse(says, unit).is_some_and(|said| said.is(value));
                (is, format!("{value:.5}"))
            };
            (!is).then(|| format!("{id} says {says:?}, and is {value} (unit {unit:?})"))
        })
        .collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn numbers_have_the_fields_that_their_quantity_needs() {
    for (id, number) in numbers() {
        let Number {
            quantity, against, ..
        } = &number;
        assert_eq!(number.key.is_some(), *quantity == Quantity::Key, "{id}: key");
        let is_relative = *quantity == Quantity::StaticReductionPercent;
        assert_eq!(against.is_some(), is_relative, "{id}: against");
        assert!(
            *quantity != Quantity::Key || number.seeds.is_empty(),
            "{id}: seeds"
        );
    }
}

/// The keys that are set by buttons of steps with this case.
fn buttons<'a>(lessons: &'a [Lesson], file: &str) -> Vec<&'a Keys> {
    let steps = lessons.iter().flat_map(|lesson| &lesson.steps);
    let buttons = steps.filter(|step| step.case == file).flat_map(|step| &step.set);
    buttons.map(|Button { keys, .. }| keys).collect()
}

#[test]
fn numbers_are_of_cases_that_the_reader_can_see() {
    let lessons = lessons();
    for (id, number) in numbers() {
        let is_shown = lessons.iter().any(|lesson| {
            let mut steps = lesson.steps.iter();
            steps.any(|step| step.case == number.case)
        });
        assert!(is_shown, "{id}: no step shows {}", number.case);
        // Each slider with a texture is shown next to its twin without one.
        let mut keys = number.set.clone();
        keys.remove("texture");
        let is_button = |button: &&Keys| {
            let mut button = (*button).clone();
            let texture = button.remove("texture");
            let set = number.set.get("texture");
            keys == button && (set == texture.as_ref() || set == Some(&serde_json::json!([])))
        };
        let is_seen = keys.is_empty()
            && number
                .set
                .get("texture")
                .is_none_or(|set| *set == serde_json::json!([]));
        assert!(
            is_seen || buttons(&lessons, &number.case).iter().any(is_button),
            "{id}: no button sets {:?} in {}",
            number.set,
            number.case
        );
    }
}

#[test]
fn the_label_of_a_button_says_what_it_sets() {
    let (words, numbers) = (words(), numbers());
    for lesson in lessons() {
        for step in &lesson.steps {
            for button in step.set.iter().filter(|button| !button.keys.is_empty()) {
                let case = case(&step.case, &button.keys);
                let label = &words[&lesson.id].steps[&step.id].set[&button.id];
                for id in ids(label).unwrap().0 {
                    let key = numbers[id].key.as_deref();
                    let is = key.is_some_and(|key| says_key_of(&numbers[id], key, &case));
                    assert!(is, "{}.{}.{}: {label}", lesson.id, step.id, button.id);
                }
            }
        }
    }
}
