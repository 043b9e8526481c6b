"""Processes that are forked, by hand and by pools: what needs the threads of the engine is refused there or works, and never hangs."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

import slipfront as sf

pytestmark = pytest.mark.skipif(not hasattr(os, "fork"), reason="this system does not fork")

PREAMBLE = '''
import copy, multiprocessing, os, pickle, signal, sys, threading, warnings
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

# From 3.12 on, Python warns of a fork beside threads.
warnings.simplefilter("ignore", DeprecationWarning)
import slipfront as sf
from slipfront import _slipfront

def small(speed=0.05):
    tables = {"slider": {"blocks": [12, 10]}, "time": {"duration_star": 100}, "drive": {"v_star": speed}}
    return sf.Case(tables, name="small")

def friction(case):
    return sf.run(case, progress=False).static_friction_star

def step(simulation):
    return simulation.step(5)

def in_child(work):
    """Result of `work` in a child, as a word, or the name of its exception; `hung` for one that takes 10 s."""
    read, write = os.pipe()
    child = os.fork()
    if child == 0:
        signal.alarm(10)
        try:
            found = repr(work())
        except BaseException as error:
            found = type(error).__name__
        os.write(write, found.encode())
        os._exit(0)
    os.close(write)
    with os.fdopen(read, "rb") as answer:
        found = answer.read().decode()
    os.waitpid(child, 0)
    return found or "hung"
'''


def script(tmp_path: Path, text: str) -> list[str]:
    """Output of a program, which must end by itself."""
    path = tmp_path / "program.py"
    path.write_text(PREAMBLE + text)
    done = subprocess.run([sys.executable, path], capture_output=True, text=True, timeout=100, check=False, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    return done.stdout.splitlines()


def test_what_needs_threads_is_refused_after_a_fork_and_what_does_not_works(tmp_path: Path) -> None:
    told = script(
        tmp_path,
        """
case = small()
run = sf.run(case, progress=False)
run.save("run")
study = sf.Study(case, axes={"drive.v_star": [0.05]})
study.run("study", progress=False)
simulation = sf.Simulation(case)
simulation.step(10)
checkpoint, pickled = simulation.checkpoint(), pickle.dumps(case)
refused = {
    "load": lambda: sf.Case.load("run/case.toml"),
    "parse": lambda: sf.Case.parse(case.to_toml()),
    "tables": small,
    "replace": lambda: case.replace({"drive.v_star": 0.1}),
    "run": lambda: friction(case),
    "Simulation": lambda: sf.Simulation(case),
    "resume": lambda: sf.Simulation.resume(case, checkpoint),
    "step": lambda: simulation.step(),
    "run_until": lambda: simulation.run_until(time_star=5),
    "run of a simulation": lambda: simulation.run(progress=False),
    "mu_star": lambda: simulation.mu_star,
    "displacement": lambda: simulation.displacement,
    "field": lambda: simulation.field("traction"),
    "series": lambda: simulation.series,
    "recipe": lambda: simulation.recipe(),
    "checkpoint": lambda: simulation.checkpoint(),
    "change": lambda: simulation.change({"drive.v_star": 0.1}),
    "copy": lambda: copy.copy(simulation),
    "pickle": lambda: pickle.dumps(simulation),
    "repr": lambda: repr(simulation),
    "save": lambda: run.save("again"),
    "open": lambda: sf.open("run"),
    "open without a check": lambda: sf.open("run", verify=False),
    "open a study": lambda: sf.open("study"),
    "Study": lambda: sf.Study(case, axes={"drive.v_star": [0.05]}),
    "converge": lambda: sf.converge(case, progress=False),
    "case of a study": lambda: study.case(0),
    "run of a study": lambda: study.run("study", progress=False),
    "command": lambda: _slipfront.command(["slipfront", "check", "run/case.toml"], Path()),
    "unpickled case": lambda: friction(pickle.loads(pickled)),
    "in a thread": lambda: (lambda found: (t := threading.Thread(target=lambda: found.append(in_child(small)))).start() or t.join() or found)([]),
}
for name, use in refused.items():
    print(name, in_child(use), sep=": ")
print("in a grandchild", in_child(lambda: in_child(small)), sep=": ")
works = {
    "name": lambda: case.name,
    "text": lambda: case.to_toml(),
    "numbers": lambda: case.numbers,
    "physics": lambda: repr(case),
    "coefficients": lambda: case.mu_static.sum(),
    "summary": lambda: run.summary,
    "curve": lambda: float(run.series["mu_star"].max()),
    "first slips": lambda: run.front.tolist(),
    "kymograph": lambda: float(run.kymograph["sliding_share"].sum()),
    "kept run": lambda: pickle.loads(pickle.dumps(run)).summary,
}
for name, use in works.items():
    print("works", name, in_child(use) == repr(use()))
""",
    )
    refused = [line.split(": ", 1) for line in told if not line.startswith("works")]
    assert len(refused) == 32
    wrong = {name: found for name, found in refused if found.strip("[]'\"") != "ForkError"}
    assert not wrong
    works = [line for line in told if line.startswith("works")]
    assert len(works) == 10 and all(line.endswith(" True") for line in works), works


def test_a_fork_before_the_first_use_works(tmp_path: Path) -> None:
    children, here = script(
        tmp_path,
        """
print([in_child(lambda: friction(small())) for _ in range(2)])
print(repr(friction(small())))
""",
    )
    assert children == repr([here] * 2)


@pytest.mark.parametrize("pool", ["Pool(2).map", "ProcessPoolExecutor(2).map"])
@pytest.mark.parametrize("method", ["fork", "spawn", "forkserver"])
@pytest.mark.parametrize("work", ["friction", "step"])
def test_pools_of_processes_give_the_numbers_or_the_exception(tmp_path: Path, pool: str, method: str, work: str) -> None:
    """Where reading a task raised, its worker would die, and multiprocessing.Pool wait for the answer for ever."""
    told = script(
        tmp_path,
        f"""
if __name__ == "__main__":
    multiprocessing.set_start_method("{method}")
    tasks = [small(0.05), small(0.1)]
    expected = [friction(case) for case in tasks]
    if "{work}" == "step":
        tasks, expected = [sf.Simulation(case) for case in tasks], [5, 5]
    try:
        found = list({"multiprocessing." if "Executor" not in pool else ""}{pool}({work}, tasks))
        print(found == expected)
    except sf.ForkError as error:
        print(error)
""",
    )
    assert len(told) == 1
    if method == "fork":
        assert "was forked" in told[0] and '"spawn"' in told[0]
    else:
        assert told == ["True"]


def test_a_process_that_is_forked_is_told_so(tmp_path: Path) -> None:
    told = script(
        tmp_path,
        """
if __name__ == "__main__":
    case, answers = small(), multiprocessing.get_context("fork").Queue()
    def work():
        try:
            answers.put(friction(case))
        except RuntimeError as error:
            answers.put(type(error).__name__)
    child = multiprocessing.get_context("fork").Process(target=work)
    child.start()
    print(answers.get(timeout=30))
    child.join()
""",
    )
    assert told == ["ForkError"]


def test_a_fork_while_another_thread_steps_is_told_so(tmp_path: Path) -> None:
    """The child inherits the lock of a thread that it does not have."""
    told = script(
        tmp_path,
        """
tables = {"slider": {"blocks": [40, 40]}, "time": {"duration_star": 1e6}}
simulation = sf.Simulation(sf.Case(tables))
thread = threading.Thread(target=simulation.step, args=(30_000,))
thread.start()
print({in_child(lambda: simulation.step()) for _ in range(5)}, thread.is_alive())
thread.join()
""",
    )
    assert told == ["{'ForkError'} True"]


def test_a_child_that_ends_leaves_the_files_of_the_case(tmp_path: Path) -> None:
    told = script(
        tmp_path,
        """
import numpy as np
mask = np.eye(10, 12, dtype=bool)
case = sf.Case({"slider": {"blocks": [12, 10]}, "texture": [{"shape": "mask", "file": mask}]})
child = os.fork()
if child == 0:
    del case
    sys.exit()
os.waitpid(child, 0)
print(case.replace({"drive.v_star": 0.1}).textured.sum())
""",
    )
    assert told == ["10"]


def test_the_error_is_a_runtime_error() -> None:
    assert issubclass(sf.ForkError, RuntimeError) and not issubclass(sf.RunError, sf.ForkError)
