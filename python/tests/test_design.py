"""Designs in Python: the search, and another one in its place."""

import json
import pickle
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import slipfront as sf

SLIDER = {"slider": {"blocks": [16, 16]}, "drive": {"v_star": 0.1}}


def design(**keys: Any) -> sf.Design:
    limits: dict[str, Any] = {"feature_blocks": 2, "gap_blocks": 2, "runs": 120, **keys}
    return sf.Design(SLIDER, wish=sf.Least("static_friction"), coverage=(0, 15), **limits)


def test_a_design_has_the_bytes_of_the_command(tmp_path: Path) -> None:
    shown: list[tuple[int, int, float]] = []
    found = design().run(tmp_path / "one", progress=lambda *now: shown.append(now), threads=2)
    assert shown and shown[-1][0] <= shown[-1][1]
    (tmp_path / "wish.toml").write_bytes((tmp_path / "one/design.toml").read_bytes())
    command = [sys.executable, "-m", "slipfront", "design", "wish.toml", "-o", "two", "--quiet", "--threads", "1"]
    subprocess.run(command, cwd=tmp_path, check=True)
    for name in ("mask.npy", "design.json", "evaluations.csv", "mask.dxf", "friction.png"):
        assert (tmp_path / "one" / name).read_bytes() == (tmp_path / "two" / name).read_bytes(), name
    assert found.to_dict() == json.loads((tmp_path / "two/design.json").read_text())
    assert found.mask.sum() == round(found.coverage * 2.56)
    assert sf.run(found.case, progress=False).summary["texture_percent"] == found.coverage
    opened = sf.open(tmp_path / "one")
    assert isinstance(opened, sf.DesignResults) and opened.to_dict() == found.to_dict()
    (tmp_path / "two/mask.npy").write_bytes((tmp_path / "two/mask.npy").read_bytes()[:-1] + b"\2")
    with pytest.raises(sf.FolderError, match=r"mask\.npy differs"):
        sf.open(tmp_path / "two")
    in_memory = design().run(progress=False)
    assert (in_memory.mask == found.mask).all() and in_memory.loss == found.loss
    with pytest.raises(LookupError, match="in memory"):
        _ = in_memory.case
    assert repr(pickle.loads(pickle.dumps(in_memory))) == repr(in_memory)


def test_another_search_in_its_place() -> None:
    asked = design()
    masks = asked.ask(6)
    assert len(masks) == 6 and all(asked.illegal(mask) is None for mask in masks)
    losses = asked.evaluate(masks)
    assert losses == asked.evaluate(masks, threads=1)
    # A texture drawn by hand, and one that is too narrow.
    groove = np.zeros((16, 16), dtype=bool)
    groove[:, 7:9] = True
    narrow = np.zeros((16, 16), dtype=bool)
    narrow[:, 0] = True
    assert asked.illegal(narrow) == "a feature is 1 block wide; the minimum is 2"
    by_hand = asked.evaluate([groove, narrow], surfaces=2, coarse=False)
    assert by_hand[1] == float("inf") and 0.5 < by_hand[0] < 1
    asked.tell([*masks, groove], [*losses, 0.0])
    mask, loss = asked.best
    assert loss == 0.0 and (mask == groove).all()
    # What comes next begins with it, too.
    assert len(asked.ask(40)) == 40
    with pytest.raises(ValueError, match=r"shape \(16, 16\)"):
        asked.evaluate([np.zeros((2, 3))])
    with pytest.raises(ValueError, match="one for each"):
        asked.tell([groove], [])
    with pytest.raises(LookupError):
        _ = design().best


def test_masks_may_be_arrays() -> None:
    clamps = np.zeros((16, 16), dtype=bool)
    clamps[:4] = True
    found = design(forbidden=[{"shape": "mask", "file": clamps}], runs=60).run(progress=False)
    assert not found.mask[:4].any() and found.mask.any()


def test_what_cannot_be_is_told() -> None:
    with pytest.raises(sf.CaseError, match="friction_of"):
        sf.Design(SLIDER, wish=sf.Least("friction_of"), coverage=(0, 15))
    with pytest.raises(sf.CaseError, match="out of reach|limits"):
        sf.Design(SLIDER, wish=sf.Value(0.3), coverage=(1, 3), feature_blocks=4, runs=5).run(progress=False)
    with pytest.raises(ValueError, match="path of a design file alone"):
        sf.Design(SLIDER)


def test_an_exception_in_progress_ends_it(tmp_path: Path) -> None:
    def stop(*_: object) -> None:
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        design().run(tmp_path / "out", progress=stop)
    # The same call goes on.
    assert design().run(tmp_path / "out", progress=False).loss < 1
