"""Damaged pickles: refused, or the same as undamaged."""

import pickle
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import slipfront as sf

DAMAGE = '''
import collections, pickle, resource, signal, sys
import numpy as np
import slipfront as sf

def state(made):
    """All that an object holds, as text that can be compared, NaN too; none of what is no object of slipfront."""
    held = held_by(made)
    return None if held is None else repr(held)

def held_by(made):
    if isinstance(made, sf.Case):
        return made.name, made.to_toml(), made._hashes()
    if isinstance(made, sf.Run):
        return state(made.case), made.summary, [made.series.to_dict(), made.fields.to_dict(), made.kymograph.to_dict()]
    if isinstance(made, sf.Simulation):
        return state(made.case), made.checkpoint(), made.recipe(), made.time_s, made.displacement.tolist(), made.series.to_dict()
    if isinstance(made, sf.Convergence):
        return made.to_dict(), made.text, made.runs.to_csv(), made.points.to_csv(), made.failures, made.folder
    if isinstance(made, sf.StudyResults):
        return made.runs.to_csv(), made.points.to_csv(), made.failures, made.folder
    if isinstance(made, sf.InterruptedRun):
        return made.folder, state(made.case), state(made.simulation)
    if isinstance(made, sf.PaperResults):
        return made.folder
    return None

def damaged(whole, rng):
    """Bytes that are not those of `whole`: every bit of what frames the contents, then damages of every kind anywhere."""
    frame = [*range(min(90, len(whole))), *range(max(len(whole) - 50, 0), len(whole))]
    for place in frame:
        for bit in range(8):
            changed = bytearray(whole)
            changed[place] ^= 1 << bit
            yield "flip", bytes(changed)
    for turn in range(400):
        # One half of them is in the frame, in which most of the bytes of a pickle are not.
        one, other = (int(rng.choice(frame)) if turn % 2 else int(rng.integers(len(whole))) for _ in range(2))
        first, last = sorted((one, other))
        changed = bytearray(whole)
        kind = ["flip", "set", "cut", "end", "exchange", "insert", "zero", "repeat"][turn // 2 % 8]
        if kind == "flip":
            changed[one] ^= 1 << int(rng.integers(8))
        elif kind == "set":
            changed[one] = int(rng.integers(256))
        elif kind == "cut":
            del changed[first : first + int(rng.integers(1, 40))]
        elif kind == "end":
            del changed[one:]
        elif kind == "exchange":
            changed[one], changed[other] = changed[other], changed[one]
        elif kind == "insert":
            changed[one:one] = rng.bytes(int(rng.integers(1, 9)))
        elif kind == "zero":
            changed[first : first + 16] = bytes(len(changed[first : first + 16]))
        else:
            changed[last:last] = changed[first : first + 16]
        if changed != whole:
            yield kind, bytes(changed)

def try_all(name, whole):
    rng = np.random.default_rng(20)
    expected, found = state(pickle.loads(whole)), collections.Counter()
    assert expected is not None
    for kind, changed in damaged(whole, rng):
        # Processor time: others may keep the machine busy.
        signal.setitimer(signal.ITIMER_PROF, 20)
        try:
            made = pickle.loads(changed)
        except Exception:
            found["refused"] += 1
            continue
        if state(made) is None:
            found["no object of slipfront"] += 1
        elif type(made) is type(pickle.loads(whole)) and state(made) == expected:
            found["the same"] += 1
        else:
            found["WRONG"] += 1
            print(name, kind, repr(made), file=sys.stderr)
    signal.setitimer(signal.ITIMER_PROF, 0)
    print(name, dict(found))
    return found

# What a damaged length asks for is not there to be had.
resource.setrlimit(resource.RLIMIT_AS, (4 << 30, 4 << 30))
total = collections.Counter()
for path in sys.argv[1:]:
    with open(path, "rb") as file:
        total += try_all(path, file.read())
print("total", dict(total))
sys.exit(total["WRONG"] > 0)
'''


def stopped(folder: Path) -> sf.InterruptedRun:
    """A run that the command was told to stop."""
    text = "slider.blocks = [6, 5]\ntime.duration_star = 1e6\n"
    (folder / "stopped.toml").write_text(text)
    run = subprocess.Popen([sys.executable, "-m", "slipfront", "run", "stopped.toml", "-o", "stopped", "--quiet"], cwd=folder)
    while not (folder / "stopped" / "case.toml").exists():
        assert run.poll() is None
    run.terminate()
    assert run.wait() == 143
    opened = sf.open(folder / "stopped")
    assert isinstance(opened, sf.InterruptedRun)
    return opened


@pytest.fixture(scope="module")
def objects(tmp_path_factory: pytest.TempPathFactory) -> dict[str, object]:
    """One of everything that can be pickled."""
    pytest.importorskip("pandas")
    folder = tmp_path_factory.mktemp("pickles")
    mask = np.zeros((5, 6), dtype=bool)
    mask[2, 3] = True
    tables = {"slider": {"blocks": [6, 5]}, "time": {"duration_star": 60}, "texture": [{"shape": "mask", "file": mask}]}
    case = sf.Case(tables, name="small")
    simulation = sf.Simulation(case)
    simulation.step(20)
    simulation.change({"drive.v_star": 0.1})
    simulation.step(10)
    (folder / "claims.csv").write_text("number,claim\n1,it slips\n")
    (folder / "found").mkdir()
    return {
        "case": case,
        "run": sf.run(case, progress=False),
        "simulation": simulation,
        "study": sf.Study(case, axes={"drive.v_star": [0.05, 0.1]}).run(progress=False),
        "convergence": sf.converge(sf.Case({"slider.blocks": [6, 4], "drive.v_star": 0.1, "time.stop": "after_onset"}), replicates=1, progress=False),
        "stopped": stopped(folder),
        "paper": sf.open(folder, verify=False),
    }


def test_damage_is_refused_or_changes_nothing(objects: dict[str, object], tmp_path: Path) -> None:
    """The beginning of a pickle is not ours: from some damages there, pickle makes a tuple or bytes, which nobody takes for a case or a run."""
    protocols = {name: [pickle.DEFAULT_PROTOCOL] for name in objects} | {"case": list(range(pickle.HIGHEST_PROTOCOL + 1))}
    for name, of_name in protocols.items():
        for protocol in of_name:
            (tmp_path / f"{name}-{protocol}").write_bytes(pickle.dumps(objects[name], protocol))
    files = sorted(path.name for path in tmp_path.iterdir())
    assert len(files) == 6 + 6
    tried = subprocess.run([sys.executable, "-c", DAMAGE, *files], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert tried.returncode == 0, tried.stdout + tried.stderr
    print(tried.stdout)


def test_nearly_all_of_a_pickle_is_under_the_checksum(objects: dict[str, object]) -> None:
    for name, whole in objects.items():
        reduced = whole.__reduce__()
        assert isinstance(reduced, tuple)
        (sealed,) = reduced[1]
        # The function's name, the length of the bytes, and the marks of pickle between them.
        assert len(pickle.dumps(whole)) - len(sealed) < 80, name


def test_a_sentence_says_that_a_pickle_is_damaged(objects: dict[str, object]) -> None:
    for whole in objects.values():
        changed = bytearray(pickle.dumps(whole))
        changed[len(changed) // 2] ^= 4
        with pytest.raises(pickle.UnpicklingError, match="is damaged, its checksum is wrong: create it again"):
            pickle.loads(bytes(changed))


def test_damaged_checkpoints_and_those_of_other_cases_are_refused() -> None:
    """A checkpoint of another case of the same shape is refused: it would go on with a curve of two cases."""
    case = sf.Case({"slider": {"blocks": [6, 5]}, "time": {"duration_star": 60}})
    simulation = sf.Simulation(case)
    simulation.step(100)
    checkpoint = simulation.checkpoint()
    assert sf.Simulation.resume(case, checkpoint).checkpoint() == checkpoint
    for other in ({"drive.v_star": 0.05}, {"friction.seed": 2}, {"time.duration_star": 70}):
        with pytest.raises(ValueError, match="no checkpoint of a run of this case"):
            sf.Simulation.resume(case.replace(other), checkpoint)
    rng = np.random.default_rng(7)
    for _ in range(500):
        changed = bytearray(checkpoint)
        changed[int(rng.integers(len(changed)))] ^= 1 << int(rng.integers(8))
        with pytest.raises(ValueError, match="no checkpoint of a run of this case"):
            sf.Simulation.resume(case, bytes(changed))
