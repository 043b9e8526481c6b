#!/usr/bin/env python3
"""Tests of deny.py and notices.py that need no cargo, on crates that are made up: python3 tests/licences/tests.py"""

import doctest
import tempfile
import unittest
from pathlib import Path

import crates
import deny
import notices

CRATES_IO = "registry+https://github.com/rust-lang/crates.io-index"


def package(licence="MIT", name="made-up", version="1.0.0", source=CRATES_IO, needs=()):
    return {
        "name": name,
        "version": version,
        "license": licence,
        "license_file": None,
        "authors": ["Jane Doe", "Li Wei"],
        "source": source,
        "dependencies": [{"name": "other", "req": req} for req in needs],
    }


def judged(*packages, **config):
    return deny.judge(packages, deny.rules(config))


class Expressions(unittest.TestCase):
    def test_and_binds_more_than_or(self):
        sets = [set(licences) for licences in crates.alternatives("MIT OR Apache-2.0 AND (BSD-3-Clause OR (ISC AND Zlib))")]
        self.assertEqual(sets, [{"MIT"}, {"Apache-2.0", "BSD-3-Clause"}, {"Apache-2.0", "ISC", "Zlib"}])

    def test_what_is_no_expression_is_told(self):
        for text in ["", "MIT OR", "(MIT", "MIT)", "MIT Apache-2.0", "AND MIT", "GPL-2.0 WITH", "()", "MIT or Apache-2.0"]:
            with self.assertRaisesRegex(ValueError, "no SPDX expression", msg=text):
                crates.alternatives(text)


class Rules(unittest.TestCase):
    LICENCES = {"allow": ["MIT", "Apache-2.0"], "exceptions": [{"crate": "fuzzer", "allow": ["NCSA"]}]}

    def test_licences_that_bind_are_refused(self):
        allowed = ["MIT", "GPL-3.0 OR MIT", "MIT/GPL-3.0", "(GPL-3.0 OR MIT) AND Apache-2.0"]
        refused = ["GPL-3.0", "MIT AND GPL-3.0", "Apache-2.0 WITH LLVM-exception", "NCSA", "MIT+", "mit", None, "", "MIT,ISC"]
        for licence in allowed:
            self.assertEqual(judged(package(licence), licenses=self.LICENCES), [], licence)
        for licence in refused:
            [wrong] = judged(package(licence), licenses=self.LICENCES)
            self.assertRegex(wrong, "^made-up 1.0.0 (has the licence|declares no licence)", licence)

    def test_an_exception_is_for_its_crate_alone(self):
        self.assertEqual(judged(package("MIT AND NCSA", "fuzzer"), licenses=self.LICENCES), [])
        self.assertEqual(len(judged(package("MIT AND NCSA", "fuzzer2"), licenses=self.LICENCES)), 1)

    def test_banned_crates_and_any_version_are_refused(self):
        licences = {"allow": ["MIT"]}
        bans = {"deny": [{"crate": "made-up", "reason": "it is"}], "wildcards": "deny"}
        found = [package(), package(name="other", needs=["^1.2"]), package(name="loose", needs=["^1", "*"])]
        said = ["made-up 1.0.0 is banned: it is", "loose 1.0.0 asks for any version of other"]
        self.assertEqual(judged(*found, licenses=licences, bans=bans), said)
        self.assertEqual(judged(*found, licenses=licences), [])

    def test_any_version_of_a_folder_is_for_tests_alone(self):
        bans = {"wildcards": "deny", "allow-wildcard-paths": True}
        for kind, path, is_refused in [("dev", "/a", False), (None, "/a", True), ("build", "/a", True), ("dev", None, True)]:
            needed = {"name": "other", "req": "*", "kind": kind} | ({"path": path} if path else {})
            found = package() | {"dependencies": [needed]}
            said = judged(found, licenses={"allow": ["MIT"]}, bans=bans)
            self.assertEqual(said, ["made-up 1.0.0 asks for any version of other"] if is_refused else [], needed)

    def test_several_versions_are_refused_where_that_is_asked(self):
        found = [package(), package(version="2.0.0"), package(name="other")]
        bans = {"multiple-versions": "deny"}
        said = ["made-up is there in versions 1.0.0, 2.0.0"]
        self.assertEqual(judged(*found, licenses={"allow": ["MIT"]}, bans=bans), said)

    def test_other_sources_are_refused(self):
        sources = {"unknown-registry": "deny", "unknown-git": "deny", "allow-git": ["https://example.org/known"]}
        allowed = [None, CRATES_IO, "git+https://example.org/known?rev=1#1"]
        refused = ["registry+https://example.org/index", "sparse+https://example.org/", "git+https://example.org/other", "new+x"]
        for source in allowed + refused:
            wrong = judged(package(source=source), licenses={"allow": ["MIT"]}, sources=sources)
            self.assertEqual(bool(wrong), source in refused, source)

    def test_a_rule_that_is_not_held_here_fails(self):
        for config, said in [
            ({"licenses": {"deny": ["GPL-3.0"]}}, r"\[licenses\] deny"),
            ({"output": {"feature-depth": 1}}, r"\[output\] feature-depth"),
            ({"bans": {"wildcards": "denny"}}, "denny"),
            ({"bans": {"deny": ["openssl"]}}, "openssl"),
            ({"bans": {"deny": [{"crate": "openssl@1"}]}}, "openssl@1"),
            ({"licenses": {"exceptions": [{"name": "x", "allow": []}]}}, "exception"),
        ]:
            with self.assertRaisesRegex(ValueError, said):
                deny.rules(config)


class Notices(unittest.TestCase):
    MIT = notices.read(crates.REPOSITORY / "LICENSE-MIT")

    def texts(self, licence="MIT", **files):
        with tempfile.TemporaryDirectory() as folder:
            for name, text in files.items():
                file = Path(folder, name.replace("__", "/"))
                file.parent.mkdir(exist_ok=True)
                file.write_text(text, "utf-8")
            return notices.texts(package(licence), Path(folder))

    def test_every_text_of_a_crate_is_taken(self):
        files = dict.fromkeys(["LICENSE", "Notice", "UNLICENSE", "COPYING", "LICENSES__MIT"], self.MIT)
        self.assertEqual(self.texts(**files, README=self.MIT), {name.replace("__", "/"): self.MIT for name in files})

    def test_a_crate_without_a_text_has_that_of_its_licence_with_its_authors(self):
        pointer = {"LICENSE": "../LICENSE-MIT", "NOTICE": "Copyright 2020 " + "word " * 20}
        for files in [{}, pointer]:
            [text] = (text for name, text in self.texts("Apache-2.0 OR MIT", **files).items() if name.startswith("MIT"))
            self.assertTrue(text.startswith("Copyright (c) Jane Doe, Li Wei\n\nPermission is hereby granted"), text)
        self.assertIn("Apache License", self.texts("Apache-2.0")["Apache-2.0, standard text"])
        self.assertEqual(len(self.texts("MIT AND Apache-2.0")), 2)

    def test_a_licence_without_a_known_text_fails_with_a_sentence(self):
        for licence in ["GPL-3.0", "MIT AND Zlib", None]:
            with self.assertRaisesRegex(SystemExit, f"made-up 1.0.0 has the licence {licence} and no file with its text"):
                self.texts(licence)

    def test_a_text_that_would_steer_a_terminal_is_refused(self):
        with self.assertRaisesRegex(ValueError, "LICENSE: .* cannot be printed"):
            self.texts(LICENSE="MIT \x1b[2J " + self.MIT)

    def test_terms_of_apache_are_left_out_where_they_are_those_alone(self):
        apache = notices.read(crates.REPOSITORY / "LICENSE-APACHE")
        ours = notices.without_apache_terms("Copyright 2019 Jane Doe\n" + apache.replace("  ", " ") + "\nLLVM exceptions")
        self.assertRegex(ours, r"(?s)^Copyright 2019 Jane Doe.*\[Terms 1 to 9 as in LICENSE-APACHE.*LLVM exceptions$")
        self.assertLess(len(ours), len(apache) / 4)
        changed = apache.replace("irrevocable", "revocable", 1)
        self.assertEqual(notices.without_apache_terms(changed), changed)


def load_tests(loader, tests, pattern):
    for module in (crates, notices):
        tests.addTests(doctest.DocTestSuite(module))
    return tests


if __name__ == "__main__":
    unittest.main()
