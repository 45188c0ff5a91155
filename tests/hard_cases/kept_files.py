"""What the tests of row 27 share: a cache entry, and what a directory holds under final names and unfinished."""

from pathlib import Path

import numpy as np

from fenics_gears.elasticity.cache import content_key

KEY = content_key({"gear": {"teeth": 16}, "size": 0.06})
ARRAYS = {"blocks": np.arange(24.0).reshape(2, 3, 4) / 7.0, "unknowns": np.array(17)}


def left_over(directory):
    files = [each for each in Path(directory).rglob("*") if each.is_file()] if Path(directory).exists() else []
    unfinished = [each for each in files if each.name.endswith(".part") or ".unfinished" in str(each)]
    return [each.name for each in files if each not in unfinished], unfinished
