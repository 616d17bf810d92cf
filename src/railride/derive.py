"""``python -m railride.derive …`` is ``railride derive …``."""

from __future__ import annotations

import sys

from railride.cli import main

if __name__ == "__main__":
    main(["derive", *sys.argv[1:]])
