use super::*;

#[test]
fn the_default_reads_back() {
    let text = CaseFile::default().to_toml().unwrap();
    assert_eq!(
        CaseFile::parse(&text, "default", &[]).unwrap(),
        CaseFile::default()
    );
    assert_eq!(CaseFile::parse("", "empty", &[]).unwrap(), CaseFile::default());
}
