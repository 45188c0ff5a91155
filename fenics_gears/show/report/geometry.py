"""The pair in numbers and as a drawing."""

from __future__ import annotations

from math import degrees

from fenics_gears.geometry.characteristics import characteristics
from fenics_gears.show.report.page import Beside, Facts, Section, Table, Words
from fenics_gears.show.report.pair_drawing import drawings
from fenics_gears.show.run import NO_SCENE, Run

GEARS = ("pinion", "wheel")


def geometry(run: Run) -> Section:
    """What the scene gives of the gears, what follows, and both gears drawn in mesh."""
    if run.pair is None:
        return Section("geometry", "Geometry", [Words(NO_SCENE, warns=True)])
    given, rows = run.scene.gears, characteristics(run.pair)
    normal = "normal " if given.helix_angle else ""
    of_pair: list[tuple[str, object, str]] = [
        (f"{normal}module", given.module, "mm"), (f"{normal}pressure angle", degrees(given.pressure_angle), "deg"),
        ("centre distance", given.centre_distance, "mm"), ("face width", given.face_width, "mm"),
    ]  # fmt: skip
    of_pair += [row for row in rows if not row[0].startswith(GEARS)]
    return Section("geometry", "Geometry of the pair", [Beside([_both(run, rows), Facts(of_pair, "Both gears together")]), *drawings(run.pair, run.on_coast_flanks)])


def _both(run: Run, rows: list[tuple[str, float, str]]) -> Table:
    """A row for each number that either gear has, one column a gear."""
    given = run.scene.gears
    names = {"teeth": "", "profile_shift": "modules", "tip_diameter": "mm", "root_diameter": "mm", "bore_diameter": "mm", "rack_tip_radius": "modules"}
    found: dict[tuple[str, str], dict[str, float]] = {}
    for name, unit in names.items():
        found[name.replace("_", " "), unit] = {gear: getattr(getattr(given, gear), name) for gear in GEARS}
    for label, value, unit in rows:
        gear, _, what = label.partition(" ")
        if gear in GEARS:
            found.setdefault((what, unit), {})[gear] = value
    cells = [(f"{what} ({unit})" if unit else what, *(f"{values[gear]:.6g}" if gear in values else "" for gear in GEARS)) for (what, unit), values in found.items()]
    return Table(("", "Pinion", "Wheel"), cells, "Either gear")
