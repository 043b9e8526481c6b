fn main() {
    for a in std::env::args().skip(1) {
        slipfront_family::transition::probe(a.parse().unwrap());
    }
}
