"""The pair in numbers and as a drawing."""

from math import degrees

from fenics_gears.pages import Beside, Facts, PageSection, Table, sentence
from fenics_gears.scene_text import GEARS
from fenics_gears.shown import NO_SCENE, GearPairData, ShownRun, characteristics, drawings

# How labels of what a caliper reads end.
MEASURED = ("(W_k)", "(M_d)")


def geometry(run: ShownRun) -> PageSection:
    """What the scene gives of the gears, what follows, and both gears drawn in mesh."""
    if run.pair is None:
        return sentence("geometry", "Geometry", NO_SCENE, True)
    given = run.scene.gears
    rows = characteristics(run.pair, run.scene.measured_over)
    normal = "normal " if given.helix_angle else ""
    of_pair: list[tuple[str, object, str]] = [
        (f"{normal}module", given.module, "mm"), (f"{normal}pressure angle", degrees(given.pressure_angle), "deg"),
        ("centre distance", given.centre_distance, "mm"), ("face width in common", given.face_width, "mm"),
    ]  # fmt: skip
    of_pair = [
        (label, _figure(label, value, unit), unit)
        for label, value, unit in (*of_pair, *(row for row in rows if not row[0].startswith(GEARS)))
    ]
    tables = Beside([_both(run, rows), Facts(of_pair, "Both gears together")])
    return PageSection("geometry", "Geometry of the pair", [*drawings(run.pair, run.on_coast_flanks), tables])


def _both(run: ShownRun, rows: list[tuple[str, float, str]]) -> Table:
    given = run.scene.gears
    names = {"teeth": "", "tip_diameter": "mm", "root_diameter": "mm", "bore_diameter": "mm"}
    names["rack_tip_radius"] = "modules"
    rows_by_name: dict[tuple[str, str], dict[str, float]] = {}
    for name, unit in names.items():
        rows_by_name[name.replace("_", " "), unit] = {gear: getattr(getattr(given, gear), name) for gear in GEARS}
        if name == "teeth":
            rows_by_name |= _profile_shifts(given)
    for label, value, unit in rows:
        gear, _, what = label.partition(" ")
        if gear in GEARS:
            rows_by_name.setdefault((what, unit), {})[gear] = value
    cells = []
    for (what, unit), values in rows_by_name.items():
        of_gears = [_figure(what, values[gear], unit) if gear in values else "" for gear in GEARS]
        cells.append((f"{what} ({unit})" if unit else what, *of_gears))
    return Table(("", "Pinion", "Wheel"), cells, "Either gear")


def _profile_shifts(given: GearPairData) -> dict[tuple[str, str], dict[str, float]]:
    """x of the drawing, and x_E of the tooth thickness where that is another."""
    cut = {gear: getattr(given, gear).profile_shift for gear in GEARS}
    nominal = {
        gear: cut[gear] if (own := getattr(given, gear).nominal_profile_shift) is None else own for gear in GEARS
    }
    generating = {("generating profile shift x_E, of the tooth thickness", "modules"): cut} if cut != nominal else {}
    return {("profile shift x", "modules"): nominal} | generating


def _figure(label: str, value: float, unit: str) -> str:
    """Four digits; lengths at least to 0.01 mm, those that are measured to 0.001 mm."""
    if isinstance(value, int):
        return str(value)
    if label.endswith(MEASURED):
        return f"{value:.3f}"
    return f"{value:.2f}" if unit in ("mm", "deg") and abs(value) >= 10.0 else f"{value:.4g}"
