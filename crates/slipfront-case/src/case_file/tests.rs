//! Tests of the case file as a whole: its table of keys, its overrides and its defaults.

use super::*;

/// The table of keys has every key that the structs read, in the same order.
#[test]
fn the_table_has_the_keys_of_the_structs() {
    let pattern = names_of::<Pattern>();
    let read = [
        names_of::<Slider>(),
        names_of::<Load>(),
        names_of::<Drive>(),
        names_of::<Friction>(),
        names_of::<Initial>(),
        names_of::<Time>(),
        names_of::<Output>(),
        names_of::<Cavity>(),
        names_of::<Groove>(),
        names_of::<Polygon>(),
        names_of::<Mask>(),
        names_of::<HeightMap>(),
        names_of::<Drawing>(),
    ];
    for (section, own) in SECTIONS.iter().zip(read) {
        let listed: Vec<&str> = section.keys.iter().map(|key| key.name).collect();
        let of_all_shapes = if section.is_shape { pattern } else { &[] };
        assert_eq!(listed, [own, of_all_shapes].concat(), "{}", section.name);
    }
}

/// A case made from an already parsed one equals a newly read case, and is refused for the same reason at the
/// same place.
#[test]
fn tables_that_no_override_changes_are_read_once() {
    let text = "drive.v_star = 0.05\n[slider]\nblocks = [50, 40]\n[time]\nduration_star = 50\n[[texture]]\nshape = 'groove'\n\
                coverage = 10\n[[texture]]\nshape = 'cavity'\nlambda = '2 um'\n";
    let plain = ParsedCase::parse(text, "case").unwrap();
    let prepared = plain.prepared(&[]).unwrap();
    for sets in [
        "",
        "drive.v_star=0.1",
        "drive.speed='1 mm/s'",
        "drive.speed='1 mm/s';slider.omega_star=2;friction.seed=9",
        "texture.0.coverage=5;texture.1.coverage=7",
        "texture.2={shape='groove',width='1 um'}",
        "texture.0.width='3 um'",
        "slider={blocks=[3,3]}",
        "drive.v_star=-1",
        "time.step=2",
        "drive.v_sar=1",
        "driver.v_star=1",
        "texture.5.coverage=1",
        "drive.v_star=0.1;drive.speed='1 m/s'",
        "time.kinetic_from_star=-1",
        "output.fields=['none']",
    ] {
        let overrides = sets.split(';').filter(|set| !set.is_empty());
        let overrides: Vec<Override> = overrides.map(|set| Override::parse(set).unwrap()).collect();
        let overrides: Vec<&Override> = overrides.iter().collect();
        match (prepared.with(&overrides), plain.with(&overrides)) {
            (Ok(one), Ok(other)) => {
                assert_eq!(one, other, "{sets}");
                for key in [
                    "drive.v_star",
                    "drive.speed",
                    "slider.blocks",
                    "texture.0.coverage",
                    "texture",
                ] {
                    let place = |case: &CaseFile| case.source.error(key, "here").to_string();
                    assert_eq!(place(&one), place(&other), "{sets}: {key}");
                }
            }
            (Err(one), Err(other)) => assert_eq!(one.to_string(), other.to_string(), "{sets}"),
            (one, other) => panic!("{sets}: {one:?} and {other:?}"),
        }
    }
}

#[test]
fn the_default_reads_back() {
    let text = CaseFile::default().to_toml().unwrap();
    assert_eq!(
        CaseFile::parse(&text, "default", &[]).unwrap(),
        CaseFile::default()
    );
    assert_eq!(CaseFile::parse("", "empty", &[]).unwrap(), CaseFile::default());
}
