"""The command: ``python -m slipfront`` works like ``slipfront``."""

import signal
import sys
from pathlib import Path

from ._slipfront import command


def main() -> int:
    """Run the command with the arguments of this process; return its exit status."""
    # The command stops at signals itself, with checkpoints; Python would only record them.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    return command(["slipfront", *sys.argv[1:]], Path(__file__).parent)


if __name__ == "__main__":
    sys.exit(main())
