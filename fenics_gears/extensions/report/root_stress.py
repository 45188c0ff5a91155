"""Root stress, where the run recorded it: over time, and along the fillets where it is largest."""

import numpy as np

from fenics_gears.charts import MARKED_LINES, PALETTE, Chart, Curve, span
from fenics_gears.pages import PageSection, sentence
from fenics_gears.shown import TOO_FEW, ShownRun, contact_times, factor, in_unit, over_time

HEADING = "Root stress"


def root_stress(run: ShownRun) -> PageSection:
    """Curves and numbers of the fillets' stress; a line on how to have it where it is not there."""
    if "root_stress_maximum" not in run.dataset:
        said = "Over time it was not recorded; `[output] root_stress = true` in the scene records it."
        return sentence("root-stress", HEADING, said)
    if not run.has_curves:
        return sentence("root-stress", HEADING, TOO_FEW, True)
    return PageSection("root-stress", HEADING, [*_over_time(run), *_along_fillets(run)])


def _over_time(run: ShownRun) -> list[Chart]:
    largest = run.dataset["root_stress_maximum"].transpose("time", "gear", "slot")
    values = in_unit(largest, "MPa")
    gears = [str(gear) for gear in run.dataset["gear"].values]
    envelope = [(gear, np.fmax.reduce(values[:, place], axis=1), PALETTE[place]) for place, gear in enumerate(gears)]
    least = span(envelope)
    plots = [over_time(run, "Largest tension in the fillets of either gear", "Stress (MPa)", envelope, least=least)]
    for gear in gears:
        curves = [
            (words, each, PALETTE[number % len(PALETTE)])
            for words, each, number in run.of_pairs("root_stress_maximum", "MPa", gear=gear)
        ]
        caption = f"Largest tension in the fillets of the {gear}, tooth by tooth"
        plots.append(over_time(run, caption, "Stress (MPa)", curves, least=least))
    section = run.dataset["root_stress_at_30_degrees"].transpose("time", "gear", "fillet", "slot")
    at_section = in_unit(section, "MPa")
    curves = [
        (f"{gear}, {side} side", np.fmax.reduce(at_section[:, i, j], axis=1), PALETTE[2 * i + j])
        for i, gear in enumerate(gears) for j, side in enumerate(run.dataset["fillet"].values.tolist())
        if np.isfinite(at_section[:, i, j]).any()
    ]  # fmt: skip
    if curves:
        note = (
            "The largest of the loaded teeth, where the fillet's tangent is at 30° to the tooth's centreline;"
            " tension positive."
        )
        plots.append(over_time(run, "Stress at the 30° tangent", "Stress (MPa)", curves, least=least, note=note))
    return plots


def _along_fillets(run: ShownRun) -> list[Chart]:
    """Stress along the fillet of the tooth that has the largest tension, at the time it has it."""
    plots = []
    if "root_stress" not in run.dataset:
        return []
    dataset = contact_times(run.dataset)
    for gear in dataset["gear"].values.tolist():
        own = dataset.sel(gear=gear)
        stress = own["root_stress_maximum"].transpose("time", "slot").values
        if not np.isfinite(stress).any():
            continue
        time, slot = np.unravel_index(np.nanargmax(stress), stress.shape)
        along = in_unit(own["root_stress"].transpose("contact_time", "slot", "fillet_point", ...)[time, slot], "MPa")
        where = ""
        if along.ndim > 1:
            largest = along.max(axis=0)
            plots.append(_over_face(run, gear, largest))
            z = run.dataset["face_position"].values[largest.argmax()]
            along = along[:, largest.argmax()]
            where = f", {z:.2f} mm from the middle of the face"
        angle = own["fillet_tangent_angle"].values * factor("rad", "deg")
        side = own["fillet_side"].values
        curves = [
            Curve(f"{name} side", angle[side == name], along[side == name], colour, mode=MARKED_LINES)
            for name, colour in zip(dict.fromkeys(side.tolist()), PALETTE)
        ]
        phase = float(own["mesh_phase"].values[time])
        caption = (
            f"Along the fillets of the {gear}, where its tension is largest: pair"
            f" {int(own['pair_number'].values[time, slot])}, mesh cycle {phase:.3f}{where}"
        )
        note = (
            "From the form circle, left, to the root circle, right, where the tangent lies across the tooth; tension"
            " positive."
        )
        title = "Angle between the fillet's tangent and the tooth's centreline (°)"
        plots.append(Chart(caption, curves, title, "Stress (MPa)", note=note))
    return plots


def _over_face(run: ShownRun, gear: str, largest: np.ndarray) -> Chart:
    """Largest tension in the roots of a tooth over the slices of the face (S,), at the time it is largest."""
    z = run.dataset["face_position"].values
    curve = Curve(gear, z, largest, PALETTE[0], mode=MARKED_LINES)
    caption = f"Over the face of the {gear}, of the tooth and at the time of its largest tension"
    note = "Of each slice of the face the largest in both fillets."
    return Chart(caption, [curve], "Place along the face, from its middle (mm)", "Tension (MPa)", note=note)
