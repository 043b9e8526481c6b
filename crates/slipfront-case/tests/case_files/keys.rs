use std::collections::BTreeSet;

use slipfront_case::case_file::{CaseFile, KeyKind, SECTIONS, Section};

/// A case with a texture of this shape, and the prefix of its keys.
fn base(section: &Section) -> (String, String) {
    if !section.is_shape {
        return (String::new(), section.name.to_owned());
    }
    let needed = match section.name {
        "cavity" | "groove" => "coverage = 10",
        "mask" => "file = 'mask.png'",
        "drawing" => "file = 'cavity.svg'",
        "height_map" => "file = 'map.gsf'\nbearing_percent = 50",
        _ => "points = [['0 um', '0 um'], ['1 um', '0 um'], ['0 um', '1 um']]",
    };
    let text = format!("[[texture]]\nshape = '{}'\n{needed}", section.name);
    (text, "texture.0".to_owned())
}

fn with(section: &Section, key: &str, value: &str) -> Result<CaseFile, String> {
    let (text, table) = base(section);
    let set = format!("{table}.{key}={value}");
    CaseFile::parse(&text, "case.toml", &[set]).map_err(|error| error.to_string())
}

/// The default in the table is the value for a file without the key.
#[test]
fn defaults_are_those_of_an_empty_file() {
    for section in &SECTIONS {
        let without = CaseFile::parse(&base(section).0, "case.toml", &[]).unwrap();
        for key in section.keys.iter().filter(|key| !key.default.is_empty()) {
            let case = with(section, key.name, key.default).unwrap();
            assert_eq!(case, without, "{}.{}", section.name, key.name);
        }
    }
}

/// Every struct checks all bounds of its keys.
#[test]
fn every_bound_of_the_table_is_checked() {
    for section in &SECTIONS {
        for key in section.keys {
            let absurd = match key.kind {
                KeyKind::Number { bounds, .. } if bounds.1 == std::ops::Bound::Unbounded => {
                    "-1e300".to_owned()
                }
                KeyKind::Number { .. } => "1e300".to_owned(),
                KeyKind::Quantity { unit, .. } => format!("1e300 {unit}"),
                KeyKind::Whole { most, .. } if most > u64::from(u32::MAX) => continue,
                KeyKind::Whole { most, .. } if key.default.starts_with('[') => format!("[1, {}]", most + 1),
                KeyKind::Whole { most, .. } => (most + 1).to_string(),
                KeyKind::File(_) => "mask.unknown".to_owned(),
                KeyKind::Words(_) | KeyKind::Switch | KeyKind::Table(..) | KeyKind::Special(_) => {
                    "unknown".to_owned()
                }
            };
            let said = with(section, key.name, &absurd).expect_err(key.name);
            assert!(said.contains(&format!(".{}`", key.name)), "{said}");
        }
    }
}

/// Partners are mutual: each partner of a key lists the key and all its other partners.
#[test]
fn partners_are_mutual() {
    for section in &SECTIONS {
        for key in section.keys {
            for partner in key.partners() {
                let of_partner = section.key(partner).unwrap().partners();
                let of_both = |name: &str| name != key.name && name != partner;
                let others: BTreeSet<_> = key.partners().filter(|name| of_both(name)).collect();
                let mut its: BTreeSet<_> = of_partner.collect();
                assert!(its.remove(key.name), "{partner} does not know {}", key.name);
                assert_eq!(its, others, "{}, {partner}", key.name);
            }
        }
    }
}
