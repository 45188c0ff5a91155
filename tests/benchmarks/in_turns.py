"""Measurements of checkouts that take turns, so that what else the machine does meets all of them."""

import json
import os
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any


def answers_in_turns(script: str, checkouts: Sequence[Path], arguments: Sequence[str], turns: int) -> list[list[Any]]:
    """What a script answers, by checkout and turn: started once for each checkout, on one thread, with `--serve`, it
    answers each line that it is given with a line of JSON."""
    processes = []
    for checkout in checkouts:
        environment = {**os.environ, "PYTHONPATH": str(checkout), "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
        processes.append(subprocess.Popen(
            [sys.executable, "-P", script, *arguments, "--serve"], env=environment, text=True,
            stdin=subprocess.PIPE, stdout=subprocess.PIPE,
        ))  # fmt: skip
    found: list[list[Any]] = [[] for _ in processes]
    for _ in range(turns):
        for process, answers in zip(processes, found):
            process.stdin.write("\n")
            process.stdin.flush()
            answers.append(json.loads(process.stdout.readline()))
    for process in processes:
        process.stdin.close()
        process.wait()
    return found
