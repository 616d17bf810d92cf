"""What a worker may die of, in a module that is quick to load."""

import os
from pathlib import Path


def die(chunk, deaths):
    """End this process while there are deaths left for the chunk; else its number squared."""
    tokens = sorted(Path(deaths).glob(f"{chunk}-*"))
    if tokens:
        tokens[0].unlink()
        os._exit(3)
    return chunk**2
