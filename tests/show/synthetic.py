"""A small made-up result with the names, units and shapes of a real one."""

import numpy as np
import xarray as xr

UNITS = {
    "transmission_error": "rad",
    "centre_y": "mm",
    "normal_force": "N",
    "friction_force": "N",
    "reaction_couple": "N mm",
    "pair_normal_force": "N",
    "contact_pressure": "MPa",
    "contact_roll_angle": "rad",
}
BARE = ("centre_y", "friction_force")


def made_up_run(*, steps=21, cycles=2.0, nodes=5, scene="", **attributes) -> xr.Dataset:
    """Every variable that a picture shows, over `cycles` mesh cycles from cycle 28 on; three tooth pairs in slots."""
    phase = 28.0 + np.linspace(0.0, cycles, steps)
    wave = np.sin(2 * np.pi * phase)
    pairs = np.arange(27, 29 + int(cycles))
    carries = (phase[:, None] >= pairs) & (phase[:, None] <= pairs + 1.47)
    force = np.where(carries, 4000.0 + 100.0 * wave[:, None], 0.0)
    centre = np.radians(7.0 + 22.5 * (phase[:, None] - pairs))
    place = centre[:, :, None] + np.radians(0.4) * (np.arange(nodes) - nodes // 2)
    pressure = np.where(carries[:, :, None], [0.0, *np.full(nodes - 2, 1500.0), 0.0], 0.0) * (
        1.0 + 0.1 * wave[:, None, None]
    )
    number = np.where(carries, pairs - pairs[0] + 1, 0)
    slots = int(carries.sum(axis=1).max())
    step, pair = np.nonzero(carries)

    def in_slots(of_pairs, absent):
        held = np.full((steps, slots, *of_pairs.shape[2:]), absent, dtype=of_pairs.dtype)
        held[step, number[step, pair] % slots] = of_pairs[step, pair]
        return held

    nodes_of_slots = ("contact_time", "slot", "contact_node")
    values = {
        "transmission_error": ("time", 3e-3 + 2e-4 * wave),
        "centre_y": (("time", "gear"), np.stack([-4e-3 * wave, 4e-3 * wave], axis=1)),
        "normal_force": ("time", force.sum(axis=1)),
        "friction_force": ("time", 900.0 * wave),
        "reaction_couple": (("time", "gear"), np.stack([-2.9e5 + 1e4 * wave, -4.4e5 + 2e4 * wave], axis=1)),
        "pair_normal_force": (("time", "slot"), in_slots(force, 0.0)),
        "contact_pressure": (nodes_of_slots, in_slots(pressure, 0.0)),
        "contact_roll_angle": (nodes_of_slots, in_slots(place, np.nan)),
    }
    variables = {name: (dims, data, {"units": UNITS[name]}) for name, (dims, data) in values.items()}
    time, held = phase / 200.0, in_slots(number, 0)
    coordinates = {"gear": ["pinion", "wheel"], "slot": np.arange(slots)}
    for prefix in ("", "contact_"):
        along = f"{prefix}time"
        coordinates |= {
            along: time,
            f"{prefix}mesh_phase": (along, phase),
            f"{prefix}pair_number": ((along, "slot"), held, {"number_at_phase_0": int(1 - pairs[0])}),
        }
    given = {"title": "A made-up run", "scene": scene, "complete": 1, "base_radius_wheel": 50.0}
    given["peak_to_peak_transmission_error"] = float(np.ptp(values["transmission_error"][1]))
    return xr.Dataset(variables, coordinates, given | attributes)


def words(axes) -> list[str]:
    return [text.get_text() for text in axes.texts]


def right_scale(axes) -> list[tuple[float, float]]:
    """Numbers of the second upright scale with the heights on the first."""
    return [
        (float(text.get_text().replace("−", "-")), text.get_position()[1])
        for text in axes.texts
        if text.get_ha() == "left" and text.get_position()[0] > 1.0
    ]
