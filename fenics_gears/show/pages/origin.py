"""The origin of a report: versions, the file, the scene's text."""

import datetime
from collections.abc import Sequence
from pathlib import Path

import fenics_gears
from fenics_gears.system.versions import versions

from .page import Facts, Listing, PageSection, Words

# Packages that compute and that draw and write a report.
PAGE_PACKAGES = ("numpy", "fenics-dolfinx", "petsc4py", "plotly", "matplotlib", "pyvista", "jinja2")


def version_section(attributes: dict, file: Path) -> PageSection:
    """Versions of what computed and of what made the page."""
    computed = str(attributes.get("fenics_gears_version", "unknown"))
    written = datetime.datetime.fromtimestamp(file.stat().st_mtime).astimezone()
    rows = [
        ("computed by", f"fenics_gears {computed}", ""),
        ("result", f"{file.name}, {file.stat().st_size / 1e6:.2f} MB, written {written:%Y-%m-%d %H:%M}", ""),
        ("this page by", versions(PAGE_PACKAGES), ""),
    ]
    blocks = [Facts(rows)]
    if computed != fenics_gears.__version__:
        made = f"The result was computed by version {computed}, this page is made by {fenics_gears.__version__}."
        blocks.append(Words(made, warns=True))
    return PageSection("versions", "Versions", blocks)


def scene_section(text: str, heading: str = "Scene", name: str = "scene", remarks: Sequence[str] = ()) -> PageSection:
    """A scene's or a study's text, after remarks on it."""
    listing = Listing(text) if text.strip() else Words("The result has no scene's text.", warns=True)
    return PageSection(name, heading, [*(Words(each, warns=True) for each in remarks), listing])


def made_by() -> str:
    """By what and when the page was made: below its title."""
    now = datetime.datetime.now().astimezone()
    made = f"Made by fenics_gears {fenics_gears.__version__} (gears report) on {now:%Y-%m-%d %H:%M}."
    return f"{made} One file, complete in itself; it loads nothing from a network."
