#!/usr/bin/env python3
"""Tests of the onset challenge: problems are what their script writes, the scorer passes stored answers and names what is wrong with
others, the solvers find the exact answers again.

    tests.py

Needs NumPy and a C compiler; with SciPy it computes the exact answers anew, and with the command slipfront, whose path is
SLIPFRONT of the environment, its answers to short problems. Takes less than half a minute.
"""

import doctest
import filecmp
import importlib.util
import json
import os
import shutil
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE / "solvers")]
import lattice
import lattice_c
import make_pdf
import make_problems
import onset
import rank_designs
import score


def tree(folder):
    return sorted(path.relative_to(folder) for path in Path(folder).rglob("*") if path.is_file())


class Scratch(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)


class Problems(Scratch):
    def test_the_problems_are_what_the_script_writes(self):
        make_problems.main(self.folder)
        self.assertEqual(tree(HERE / "problems"), tree(self.folder))
        for name in tree(self.folder):
            self.assertTrue(filecmp.cmp(HERE / "problems" / name, self.folder / name, shallow=False), f"{name}: run make_problems.py")

    def test_the_pdf_is_made_of_the_readme(self):
        self.assertIn(make_pdf.definition()[1].encode(), (HERE / "definition.pdf").read_bytes(), "run make_pdf.py")

    def test_examples_in_comments(self):
        self.assertEqual(doctest.testmod(make_problems).failed, 0)

    def test_every_problem_has_a_reference_and_answers_of_three_solvers(self):
        reference = json.loads((HERE / "reference.json").read_text())["problems"]
        names = sorted(path.name for path in (HERE / "problems").iterdir())
        self.assertEqual(sorted(reference), names)
        for solver in ("lattice.py", "lattice.c", "slipfront"):
            given = sorted(path.parts[-3] for path in (HERE / "answers" / solver).glob("P*/half/answers.json"))
            self.assertEqual(given, [name for name in names if name != "P12"], solver)

    @unittest.skipUnless(importlib.util.find_spec("scipy"), "SciPy is not installed")
    def test_references_follow_from_formulas(self):
        import exact

        exact.main(check=True)


class Scorer(Scratch):
    """The stored answers, and deliberate mistakes in copies of them."""

    SOLVER = "lattice.py"

    def setUp(self):
        super().setUp()
        shutil.copytree(HERE / "answers", self.folder / "answers")
        self.answers = self.folder / "answers"

    def change(self, problem, edit, part=""):
        path = self.answers / self.SOLVER / problem / part / "answers.json"
        given = json.loads(path.read_text())
        edit(given)
        path.write_text(json.dumps(given))

    def cell(self, problem, answer):
        return score.score(self.answers)[problem][answer][self.SOLVER]

    def test_stored_answers_pass_and_results_are_theirs(self):
        verdicts = score.score(self.answers)
        wrong = [(problem, name, solver, cell) for problem, rows in verdicts.items() for name, cells in rows.items()
                 for solver, cell in cells.items() if cell["verdict"] not in ("pass", "open")]
        self.assertEqual(wrong, [])
        self.assertIn(score.markdown(verdicts), (HERE / "RESULTS.md").read_text(), "RESULTS.md is not that of the answers: run results.sh")

    def test_another_unit_is_named(self):
        for wrong, named in ((2 / 3, "2/3"), (3.14159265, "1/(1/pi)"), (0.75, "3/4")):
            self.change("P02", lambda given: given.update(first_slip=45.15 * wrong))
            cell = self.cell("P02", "first_slip")
            self.assertEqual(cell["verdict"], "fail")
            self.assertIn(f"factor {named} =", cell["why"])

    def test_a_list_in_another_unit_is_named(self):
        for part in ("", "half"):
            self.change("P05c", lambda given: given.update(front=[1.98 / 3**0.5 * 2]), part)
        self.assertIn("factor 1/(sqrt(3/4))", self.cell("P05c", "front")["why"])

    def test_a_wrong_answer_has_the_reason_of_its_tolerance(self):
        self.change("P02", lambda given: given.update(first_slip=45.5))
        self.assertRegex(self.cell("P02", "first_slip")["why"], "times the tolerance off.*next step")

    def test_an_open_answer_off_the_median_fails(self):
        self.change("P03", lambda given: given.update(static=given["static"] * 1.003), "half")
        self.assertEqual(self.cell("P03", "static")["verdict"], "fail")

    def test_open_answers_need_two_runs(self):
        shutil.rmtree(self.answers / self.SOLVER / "P03/half")
        self.assertIn("second run", self.cell("P03", "static")["why"])
        self.assertEqual(self.cell("P03", "first_slip")["verdict"], "pass")

    def test_the_second_step_is_half_of_the_first(self):
        self.change("P03", lambda given: given.update(dt=0.04), "half")
        self.assertIn("half of the first", self.cell("P03", "static")["why"])

    def test_a_front_may_not_break_an_exact_bound(self):
        for part in ("", "half"):
            self.change("P08b", lambda given: given.update(front=[x and 1.1 * x for x in given["front"]]), part)
        self.assertIn("Rayleigh", self.cell("P08b", "front")["why"])

    def test_a_map_with_one_block_in_ten_off_fails(self):
        path = self.answers / self.SOLVER / "P03/half/first_slip_map.csv"
        slips = np.genfromtxt(path, delimiter=",")
        slips[::2, ::5] += 1
        np.savetxt(path, slips, delimiter=",")
        self.assertEqual(self.cell("P03", "first_slip_map")["verdict"], "fail")

    def refused(self, problem, answer, pattern):
        cell = self.cell(problem, answer)
        self.assertEqual(cell["verdict"], "refused")
        self.assertRegex(cell["why"], pattern)

    def test_what_is_no_answer_is_refused_with_a_sentence(self):
        self.change("P02", lambda given: given.update(first_slip="45.1 s"))
        self.refused("P02", "first_slip", "without a unit")
        self.change("P05a", lambda given: given.update(front=[0.88, 0.88]))
        self.refused("P05a", "front", "has 2 numbers, and needs 1")
        self.change("P09", lambda given: given.update(format="onset-0"))
        self.refused("P09", "first_slip", "'onset-0'")
        self.change("P10", lambda given: given.update(dt=1))
        self.refused("P10", "period", "at most 0.1")
        (self.answers / self.SOLVER / "P03/first_slip_map.csv").unlink()
        self.refused("P03", "first_slip_map", "name a CSV file")
        (self.answers / self.SOLVER / "P01/answers.json").unlink()
        self.refused("P01", "slip_begins", "there is no answers.json")
        (self.answers / self.SOLVER / "P06/answers.json").write_text("{")
        self.refused("P06", "curve_rms", "no JSON")

    def test_masks_of_another_size_are_refused(self):
        for path in self.answers.iterdir():
            if path.name != "design_disc":
                shutil.rmtree(path)
        mask = self.answers / "design_disc/P12/mask.csv"
        mask.write_text(mask.read_text().replace("1", "0", 1))
        [row] = rank_designs.ranked(self.answers, 1)
        self.assertIn("1250 of them 1", row["why"])


class Solvers(unittest.TestCase):
    """Small problems in both solvers, against what is exact and against one another."""

    def found(self, name, dt, solver):
        p = onset.Problem(HERE / "problems" / name)
        return onset.answers(p, *solver.simulate(p, dt))

    def test_exact_answers(self):
        reference = json.loads((HERE / "reference.json").read_text())["problems"]
        for solver in (lattice, lattice_c):
            begins = self.found("P01", 0.1, solver)["events"][:, 0]
            row = reference["P01"]["slip_begins"]
            self.assertTrue(np.all(np.abs(begins - row["value"]) <= score.allowed(row, np.array(row["value"]), 0.1)), begins)
            row = reference["P02"]["first_slip"]
            first = self.found("P02", 0.1, solver)["first_slip"]
            self.assertLessEqual(abs(first - row["value"]), score.allowed(row, row["value"], 0.1))
            # Half the largest step is not needed for the 1 %: 200 steps take a block at this prestress.
            self.assertAlmostEqual(self.found("P05b", 0.005, solver)["front"][0], 1.0, delta=0.01)

    def test_both_solvers_step_alike(self):
        # They add forces in another order: rounding alone lies between them before motion is chaotic.
        for name in ("P03", "P09"):
            one, other = (self.found(name, 0.1, solver) for solver in (lattice, lattice_c))
            self.assertAlmostEqual(one["static"], other["static"], delta=1e-10)
            self.assertEqual(one["static_time"], other["static_time"])

    @unittest.skipUnless("SLIPFRONT" in os.environ and importlib.util.find_spec("scipy"), "neither SLIPFRONT nor SciPy, or one of them")
    def test_slipfront_gives_its_stored_answers(self):
        import slipfront_solver

        for name in ("P01", "P02", "P03", "P05b", "P09"):
            p = onset.Problem(HERE / "problems" / name)
            with tempfile.TemporaryDirectory() as folder:
                record = slipfront_solver.simulate(p, p.raw["step_max"], Path(os.environ["SLIPFRONT"]).resolve(), Path(folder))
            found = onset.answers(p, *record)
            stored = HERE / "answers/slipfront" / name
            given = json.loads((stored / "answers.json").read_text())
            for answer, value in found.items():
                if not isinstance(value, np.ndarray):
                    np.testing.assert_allclose(value, given[answer], atol=1e-9, err_msg=f"{name} {answer}")
                elif answer == "first_slip_map":
                    np.testing.assert_allclose(value, np.genfromtxt(stored / given[answer], delimiter=","), atol=1e-6)

    @unittest.skipUnless("SLIPFRONT" in os.environ and importlib.util.find_spec("scipy"), "neither SLIPFRONT nor SciPy, or one of them")
    def test_slipfront_slips_as_lattice_c_on_an_upright_sheet(self):
        import slipfront_solver

        # A quarter of P08a, in which some 50 blocks slip; slips are stamped with steps, of which there is one of room.
        p = onset.Problem(HERE / "problems/P08a")
        p.until = 75
        with tempfile.TemporaryDirectory() as folder:
            found = slipfront_solver.simulate(p, 0.25, Path(os.environ["SLIPFRONT"]).resolve(), Path(folder))[2][0]
        stored = np.genfromtxt(HERE / "answers/lattice.c/P08a/first_slip_map.csv", delimiter=",")
        early = stored < p.until
        self.assertGreater(early.sum(), 40)
        np.testing.assert_allclose(found[early], stored[early], rtol=0, atol=0.25)


if __name__ == "__main__":
    unittest.main()
