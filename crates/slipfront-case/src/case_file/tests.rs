use super::*;

/// The table of keys has every key that the structs read, in their order.
#[test]
fn the_table_has_the_keys_of_the_structs() {
    let read = [
        keys_of::<Slider>(),
        keys_of::<Load>(),
        keys_of::<Drive>(),
        keys_of::<Friction>(),
        keys_of::<Time>(),
        keys_of::<Output>(),
        keys_of::<Cavity>(),
        keys_of::<Groove>(),
        keys_of::<Polygon>(),
        keys_of::<Mask>(),
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
