"""What ``gears cache`` does."""

import argparse
from datetime import datetime

from fenics_gears.elasticity.cache import user_cache
from fenics_gears.system.console import print_rows


def cache(options: argparse.Namespace) -> int:
    kept = user_cache()
    if options.clear:
        removed = kept.clear()
        if not options.quiet:
            print(f"{len(removed)} entries, {_megabytes(removed):.3g} MB, removed from {kept.directory}")
        return 0
    entries = kept.entries()
    rows = [
        ("directory", str(kept.directory), ""),
        ("entries", len(entries), ""),
        ("size", _megabytes(entries), "MB"),
        ("limit", kept.limit / 1e6, "MB: beyond it entries go that were not used for the longest time"),
    ]
    if entries:
        rows += [("longest not used", _time(entries[0].used), ""), ("last used", _time(entries[-1].used), "")]
    print_rows("Cache of condensed gears", rows)
    return 0


def _megabytes(entries) -> float:
    return sum(entry.size for entry in entries) / 1e6


def _time(seconds: float) -> str:
    return datetime.fromtimestamp(seconds).isoformat(" ", "seconds")
