use super::*;

#[test]
fn the_default_reads_back() {
    let text = CaseFile::default().to_toml().unwrap();
    println!("{text}");
    assert_eq!(
        CaseFile::parse(&text, "default", &[]).unwrap(),
        CaseFile::default()
    );
    assert_eq!(CaseFile::parse("", "empty", &[]).unwrap(), CaseFile::default());
}

#[test]
fn probe_try() {
    for (text, sets) in [
        ("[load]\npressur = \"1 kPa\"", vec![]),
        ("[load]\nv_star = 0.1", vec![]),
        ("[load]\npressure = 100", vec![]),
        ("[load]\npressure = \"3 mm/s\"", vec![]),
        ("[load]\npressure = \"3 mm/s\"\npressure = 3", vec![]),
        ("[load\n", vec![]),
        ("[load]\nredistribute = \n", vec![]),
        ("load = 3", vec![]),
        ("load = [\"100 kPa\", true]", vec![]),
        ("[[load]]", vec![]),
        ("[laod]", vec![]),
        ("pressure=3", vec![]),
        ("[friction]\nlaw = \"literl\"", vec![]),
        ("[friction]\nlaw = { literal = {} }", vec![]),
        ("[slider]\nblocks = [25,25,3]", vec![]),
        ("[slider]\nblocks = [25,-3]", vec![]),
        ("[slider]\nblocks = 25", vec![]),
        ("[slider]\nblocks = [2.5, 3]", vec![]),
        ("[slider]\nedges = \"fre\"", vec![]),
        ("[slider]\nedges = { free = {} }", vec![]),
        ("[time]\nstep = \"atuo\"", vec![]),
        ("[time]\nstep = []", vec![]),
        ("[output]\nsnapshots = { evry = 3.0 }", vec![]),
        ("[output]\nfields = [\"tracton\"]", vec![]),
        ("[output]\nfields = [{traction=1}]", vec![]),
        ("[[texture]]\nshape = \"cavty\"", vec![]),
        ("[[texture]]\nshape = \"cavity\"", vec![]),
        ("[[texture]]\nshape = \"cavity\"\nwidth=\"3 um\"", vec![]),
        ("[[texture]]\nshape = \"cavity\"\ncoverage=3\ncentre=3", vec![]),
        (
            "[[texture]]\nshape = \"cavity\"\ncoverage=3\ncenter=[\"3 u\", \"3 um\"]",
            vec![],
        ),
        ("[[texture]]\nshape = \"mask\"", vec![]),
        ("[[texture]]\nshape = \"polygon\"\npoints=[[\"1 um\"]]", vec![]),
        ("[[texture]]\n", vec![]),
        ("[texture]\n", vec![]),
        ("texture = [3]\n", vec![]),
        ("[drive]\nv_star = 0.1\nspeed = \"1 m/s\"", vec![]),
        ("[drive]\nv_star = 0.1\n", vec!["drive.speed=1 mm/s"]),
        (
            "[drive]\nv_star = 0.1\n",
            vec!["drive.speed=1 mm/s", "drive.v_star=3"],
        ),
        ("[drive]\nv_star = 0.1\n", vec!["drive.v_star=-3"]),
        ("[drive]\nv_star = nan\n", vec![]),
        ("[drive]\nv_star = \"0.1\"\n", vec![]),
        ("", vec!["drive.speed=[1"]),
        ("", vec!["drive.sped=1"]),
        ("", vec!["drive.speed"]),
        ("", vec!["drive.speed="]),
        ("", vec!["a.b.c.d.e=3"]),
        ("", vec!["drive.speed.x=3", "drive.speed=2"]),
        ("", vec!["texture.0.coverage=3"]),
        ("", vec!["texture.1.coverage=3"]),
        ("", vec!["output.snapshots.every=-3"]),
        ("[output]\nsnapshots = { every = -3.0 }", vec![]),
        ("[friction]\nseed = -1", vec![]),
        ("[friction]\nseed = 9223372036854775808", vec![]),
        (
            "[friction]\nseed = 340282366920938463463374607431768211456",
            vec![],
        ),
    ] {
        let sets: Vec<String> = sets.into_iter().map(str::to_owned).collect();
        match CaseFile::parse(text, "case.toml", &sets) {
            Ok(_) => println!("OK?? {text} {sets:?}"),
            Err(e) => println!("{e}\n"),
        }
    }
}
