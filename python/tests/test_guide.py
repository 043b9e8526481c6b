"""The examples of the guide."""

import doctest

import pytest

from .conftest import ROOT


def test_the_examples_of_the_guide_run() -> None:
    pytest.importorskip("xarray")
    pytest.importorskip("pandas")
    lines = (ROOT / "docs/guide/python.md").read_text(encoding="utf-8").splitlines()
    # The end of a block would be taken for what is printed.
    text = "\n".join("" if line.startswith("```") else line for line in lines)
    test = doctest.DocTestParser().get_doctest(text, {}, "python.md", None, 0)
    assert len(test.examples) > 15
    told: list[str] = []
    doctest.DocTestRunner().run(test, out=told.append)
    assert not told, "".join(told)
