"""Execute the notebooks of this folder; with --write keep their outputs, without parts that change from run to run."""

import argparse
import sys
import time
from pathlib import Path

import nbformat
from nbclient import NotebookClient
from nbclient.exceptions import CellExecutionError

HERE = Path(__file__).parent


def execute(path: Path) -> nbformat.NotebookNode:
    """The notebook with its outputs; a warning, or anything else on the error stream, is an error."""
    notebook = nbformat.read(path, as_version=4)
    for cell in notebook.cells:
        cell.metadata.pop("execution", None)
    NotebookClient(
        notebook, timeout=120, kernel_name="python3", record_timing=False, resources={"metadata": {"path": str(HERE)}}
    ).execute()
    notebook.metadata.get("language_info", {}).pop("version", None)
    for cell in notebook.cells:
        for output in cell.get("outputs", []):
            if output.get("name") == "stderr":
                raise RuntimeError(f"{path.name} writes to the error stream: {output['text']}")
    return notebook


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("notebooks", nargs="*", help="names such as first_run.ipynb; by default all of them")
    parser.add_argument("--write", action="store_true", help="keep the outputs")
    given = parser.parse_args()
    failed = 0
    for path in [HERE / name for name in given.notebooks] or sorted(HERE.glob("*.ipynb")):
        begin = time.monotonic()
        try:
            notebook = execute(path)
        except (CellExecutionError, RuntimeError) as error:
            print(f"{path.name}: {error}", file=sys.stderr)
            failed += 1
            continue
        if given.write:
            nbformat.write(notebook, path)
        print(f"{path.name}: {time.monotonic() - begin:.1f} s")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
