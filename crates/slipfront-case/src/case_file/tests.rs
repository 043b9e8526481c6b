use super::*;

/// The table of keys has every key that the structs read, in their order.
#[test]
fn the_table_has_the_keys_of_the_structs() {
    let read = [
        names_of::<Slider>(),
        names_of::<Load>(),
        names_of::<Drive>(),
        names_of::<Friction>(),
        names_of::<Time>(),
        names_of::<Output>(),
        names_of::<Cavity>(),
        names_of::<Groove>(),
        names_of::<Polygon>(),
        names_of::<Mask>(),
    ];
    for (section, read) in SECTIONS.iter().zip(read) {
        let listed: Vec<&str> = section.keys.iter().map(|key| key.name).collect();
        assert_eq!(listed, read, "{}", section.name);
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
