"""``python -m railride …`` is ``railride …``."""

from __future__ import annotations

from railride.cli import main

if __name__ == "__main__":
    main()
