"""The head of the report: key numbers, summary, warnings."""

import math
from collections.abc import Iterator

from fenics_gears.pages import PageSection, Tile, Tiles, Words, counted, sentence
from fenics_gears.shown import ShownRun, digits, factor, largest_normal_force, load_in_words


def summary(run: ShownRun) -> PageSection:
    """The key numbers as tiles, the others below."""
    if not run.steps:
        said = "No step is stored: the run ended before its recorded mesh cycles began."
        return sentence("summary", "Summary", said, True)
    return PageSection("summary", "Summary", [Tiles([*_tiles(run), *_conditions(run)])])


def warnings(run: ShownRun) -> PageSection:
    """The warnings of the run."""
    said = str(run.dataset.attrs.get("warnings", "")).splitlines()
    blocks = [Words(as_sentence(each), warns=True) for each in said]
    return PageSection("warnings", "Warnings", blocks or [Words("None: the run stayed within what the model assumes.")])


def as_sentence(words: str) -> str:
    """What a warning says, as a sentence."""
    if "." in words.split(maxsplit=1)[0]:
        # The name of a field.
        words = f"`{words}".replace(" ", "` ", 1)
    return words[:1].upper() + words[1:] + ("" if words.endswith(".") else ".")


def _tiles(run: ShownRun) -> Iterator[Tile]:
    attributes = run.dataset.attrs
    dataset = run.dataset
    part = "" if run.complete else " of what is stored"
    for name, label in (
        ("peak_to_peak_transmission_error", "Transmission error, peak to peak"),
        ("mean_transmission_error", "Transmission error, mean"),
    ):
        angle = attributes.get(name, math.nan)
        if math.isfinite(angle) and math.isfinite(run.micrometres):
            note = f"{digits(angle * factor('rad', 'µrad'))} µrad of the wheel"
            yield Tile(label + part, digits(angle * run.micrometres), "µm", note)
    if "normal_force" in dataset:
        largest = largest_normal_force(dataset)
        note = ""
        # Both along the contact normal, which leans by the base helix angle from the transverse line of action.
        if run.pair is not None and run.scene.load.wheel_torque:
            nominal = run.pair.force_of(run.scene.load.wheel_torque) / run.pair.cosine
            note = f"{largest / nominal:.3f} times that of the torque without friction, {digits(nominal)} N"
        yield Tile("Largest mesh force", digits(largest), "N", note)
    if "peak_contact_pressure" in attributes:
        end = attributes.get("peak_contact_pressure_beside")
        where = f"near the {end} of the pinion's active profile, where lines of contact end" if end else ""
        yield Tile("Peak contact pressure", digits(attributes["peak_contact_pressure"]), "MPa", where)
    if "root_stress_maximum" in dataset:
        largest = dataset["root_stress_maximum"].max(["time", "slot"]).values
        note = f"pinion {digits(largest[0])}, wheel {digits(largest[1])}"
        yield Tile("Largest root stress", digits(float(largest.max())), "MPa", note)
    if "dynamic_factor_by_force" in attributes:
        yield Tile("Dynamic factor", f"{attributes['dynamic_factor_by_force']:.3f}", "", "by force of a tooth pair")
    if "friction_loss" in attributes:
        yield Tile("Friction loss", f"{100.0 * attributes['friction_loss']:.3g}", "%")
    if "mean_mesh_stiffness_tangent" in attributes:
        yield Tile("Mesh stiffness, mean", digits(attributes["mean_mesh_stiffness_tangent"]), "N/(mm µm)", "tangent")
    if run.pair is not None:
        yield Tile("Contact ratio", f"{run.pair.contact_ratio:.3f}", "", "transverse" if run.pair.overlap_ratio else "")
    if "face_load_factor" in attributes:
        yield Tile("Face load factor", f"{attributes['face_load_factor']:.3f}")
    if attributes.get("contact_loss_count"):
        share = 100.0 * attributes["contact_loss_share"]
        opening = 1e3 * attributes["contact_loss_opening"]
        note = f"{share:.3g} % of the time{_longest(run)}, by up to {opening:.3g} µm"
        if run.scene is not None and run.scene.load.wheel_torque < 0.0:
            note += "; the wheel drives, on the coast flanks"
        label = "Contact of the drive flanks lost" if "coast_normal_force" in dataset else "Contact lost"
        yield Tile(label, *counted(attributes["contact_loss_count"], "time").split(), note)


def _longest(run: ShownRun) -> str:
    timed = run.scene is not None and run.scene.motion.speed_given and "contact_loss_longest" in run.dataset.attrs
    return f", for up to {run.dataset.attrs['contact_loss_longest']:.3g} s" if timed else ""


def _conditions(run: ShownRun) -> Iterator[Tile]:
    if run.scene is None:
        return
    gears = run.scene.gears
    motion = run.scene.motion
    ramp = run.scene.speed_ramp
    teeth = gears.teeth
    torque = run.scene.load.wheel_torque * factor("N mm", "N m")
    power = f", {load_in_words(run.scene)}" if run.scene.load.given == "power" else ""
    note = f"{digits(torque * teeth[0] / teeth[1])} N m on the pinion{power}"
    yield Tile("Torque on the wheel", digits(torque), "N m", note)
    if ramp is not None:
        yield Tile("Mesh frequency", f"{digits(motion.mesh_frequency)} to {digits(ramp.end_frequency)}", "Hz")
    elif motion.speed_given:
        turns = [digits(motion.mesh_frequency / count * factor("1/s", "1/min")) for count in teeth]
        note = f"pinion {turns[0]} rpm, wheel {turns[1]} rpm"
        yield Tile("Mesh frequency", digits(motion.mesh_frequency), "Hz", note)
