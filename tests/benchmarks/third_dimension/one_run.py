"""A run's numbers and what it took, of the checkout that PYTHONPATH names: `python one_run.py < scene.toml`. Imports
nothing of the tests, so that old checkouts can run it. `--whole-cuts`: bodies keep all nodes of the cuts between their
sectors."""

import json
import resource
import sys

from fenics_gears import scene_from_text, simulate

NUMBERS = (
    "mean_transmission_error",
    "peak_to_peak_transmission_error",
    "face_load_factor",
    "largest_line_load_factor",
    "peak_contact_pressure",
)


def main() -> None:
    """Transmission errors in um along the line of action, pressure in MPa; processor seconds from the start of this
    process, and its memory in GB."""
    if "--whole-cuts" in sys.argv:
        from fenics_gears.elasticity.face import coarse_cuts

        coarse_cuts.THICKEST = 0.0
    result = simulate(scene_from_text(sys.stdin.read()))
    found = {name: float(result.attrs[name]) for name in NUMBERS}
    for name in NUMBERS[:2]:
        found[name] *= 1e3 * result.attrs["base_radius_wheel"]
    taken = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    found["seconds"] = sum(each.ru_utime + each.ru_stime for each in taken)
    found["memory"] = 1024e-9 * max(each.ru_maxrss for each in taken)
    print(json.dumps(found))


if __name__ == "__main__":
    main()
