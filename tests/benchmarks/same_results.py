"""Compare the results of every demonstration scene between an old checkout and this one.

    python -m tests.benchmarks.same_results OLD_CHECKOUT [SCENE ...]

Prints, for each scene, the variables and attributes that differ most, relative to the largest value of that variable;
what is nothing but round-off (the defect of the energy account, displacements below 1e-12 mm) by what it is the
difference of. Wall times and versions are left out. Exit code 1 where anything differs by more than 1e-12 or is
missing.
"""

import os
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import xarray as xr

HERE = Path(__file__).resolve().parents[2]
TOLERANCE = 1e-12
# Saves the result of a scene; run in the old and in the new checkout alike.
RUN = """
import sys
from fenics_gears import load_scene, simulate
from fenics_gears.results import save
save(simulate(load_scene(sys.argv[1])), sys.argv[2])
"""
# Differences of large numbers, and what they are differences of.
DIFFERENCES = {
    "energy_defect": "work_input",
    "rms_normal_force": "normal_force",
    "work_contact_changes": "work_input",
    "drive_flank_opening": 1e-3,
    "centre_y": "centre_x",
}
PRINTED = 4
VARIES = ("time_", "wall_time", "fenics_gears_version")


def result_of(checkout: Path, scene: Path, directory: Path) -> xr.Dataset:
    target = directory / f"{abs(hash((checkout, scene)))}.nc"
    environment = {**os.environ, "PYTHONPATH": str(checkout), "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    subprocess.run(
        [sys.executable, "-P", "-c", RUN, str(scene), str(target)], check=True, env=environment, cwd=directory
    )
    sys.path.insert(0, str(HERE))
    with xr.open_dataset(target, engine="h5netcdf") as opened:
        return opened.load()


def differences(old: xr.Dataset, new: xr.Dataset) -> dict[str, float]:
    """Largest difference of each variable and numeric attribute over its largest value; infinite where one is
    missing."""
    found = {}
    for name in sorted({*old.variables, *new.variables}):
        if name not in old.variables or name not in new.variables:
            found[name] = np.inf
            continue
        scale = DIFFERENCES.get(name, 0.0)
        least = float(np.abs(old[scale].values).max()) if isinstance(scale, str) else scale
        found[name] = _difference(old[name].values, new[name].values, least)
    names = {name for name in {*old.attrs, *new.attrs} if not name.startswith(VARIES)}
    for name in sorted(names):
        if name not in old.attrs or name not in new.attrs:
            found[name] = np.inf
        elif isinstance(old.attrs[name], str):
            found[name] = 0.0 if old.attrs[name] == new.attrs[name] else np.inf
        else:
            found[name] = _difference(np.asarray(old.attrs[name]), np.asarray(new.attrs[name]))
    return found


def _difference(old: np.ndarray, new: np.ndarray, least: float = 0.0) -> float:
    if old.shape != new.shape:
        return np.inf
    if old.dtype.kind not in "fiu":
        return 0.0 if np.array_equal(old, new) else np.inf
    if not np.array_equal(np.isnan(old), np.isnan(new)):
        return np.inf
    largest = max(np.nanmax(np.abs(old), initial=0.0), least)
    difference = np.nanmax(np.abs(new.astype(float) - old), initial=0.0)
    return float(difference / largest) if largest else float(difference)


def main(arguments: list[str]) -> int:
    """Compare all scenes, or those named; 1 where results differ."""
    old_checkout = Path(arguments[0]).resolve()
    scenes = [Path(each) for each in arguments[1:]] or sorted(
        path for path in (HERE / "demos").rglob("*.toml") if "\n[gears]" in path.read_text(encoding="utf-8")
    )
    failed = False
    with tempfile.TemporaryDirectory() as directory:
        for scene in scenes:
            scene = scene.resolve()
            old, new = (result_of(checkout, scene, Path(directory)) for checkout in (old_checkout, HERE))
            found = differences(old, new)
            most = sorted(found.items(), key=lambda each: -each[1])[:PRINTED]
            failed |= most[0][1] > TOLERANCE
            print(
                f"{scene.name}: {len(found)} values, largest differences "
                + ", ".join(f"{name} {value:.1e}" for name, value in most),
                flush=True,
            )
    return int(failed)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
