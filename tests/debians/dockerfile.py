"""The steps of a Dockerfile, as far as ours goes: enough to carry them out where there is no Docker."""

import json
import re
import shlex
from dataclasses import dataclass
from pathlib import Path

KNOWN = ("FROM", "COPY", "RUN", "ENV", "WORKDIR", "ENTRYPOINT")


@dataclass(frozen=True)
class Dockerfile:
    """suite: that of the Debian it starts from. copied_to: where the checkout goes. commands: of the shell, in their
    order.
    environment, folder and entry_point: of whoever runs the image."""

    suite: str
    copied_to: str
    commands: tuple[str, ...]
    environment: dict[str, str]
    folder: str
    entry_point: list[str]


def read_dockerfile(path: Path) -> Dockerfile:
    """Read it. Raises ValueError for a step that only Docker could carry out."""
    steps = _steps(Path(path).read_text(encoding="utf-8"))
    unknown = [name for name, _ in steps if name not in KNOWN]
    if unknown:
        raise ValueError(
            f"{path}: {unknown[0]} is not among the steps that can be carried out without Docker: {', '.join(KNOWN)}"
        )
    image = _last(steps, "FROM")
    suite = re.fullmatch(r"debian:(\w+)-slim", image)
    if not suite:
        raise ValueError(f"{path}: it must start from debian:SUITE-slim, not from {image}")
    source, target = _last(steps, "COPY").split()
    if source != ".":
        raise ValueError(f"{path}: the whole checkout is copied (COPY . FOLDER), not {source}")
    environment = {}
    for name, rest in steps:
        if name == "ENV":
            environment.update(pair.split("=", 1) for pair in shlex.split(rest))
    commands = tuple(rest for name, rest in steps if name == "RUN")
    return Dockerfile(
        suite[1], target, commands, environment, _last(steps, "WORKDIR"), json.loads(_last(steps, "ENTRYPOINT"))
    )


def _steps(text):
    """Name and rest of each step; a backslash at the end of a line goes on in the next."""
    lines = [line for line in text.splitlines() if line.strip() and not line.startswith("#")]
    joined = "\n".join(lines).replace("\\\n", " ")
    return [(name.upper(), rest.strip()) for name, rest in (line.split(None, 1) for line in joined.splitlines())]


def _last(steps, wanted):
    rests = [rest for name, rest in steps if name == wanted]
    if len(rests) != 1:
        raise ValueError(f"Dockerfile: {wanted} must stand once, it stands {len(rests)} times")
    return rests[0]
