"""What is printed of the result of a train or a planetary set: rows of label, value and unit."""

from collections.abc import Iterator, Mapping

import numpy as np
import xarray as xr

from .key_numbers import MICROMETRE
from .layout import OF_OUTPUTS, OVERALL, in_microradians
from .planetary import MEMBER, PLANET, kinds_of_meshes
from .sets_in_train import MESH, SET, set_runs
from .summary import four_digits

Rows = list[tuple[str, str, str]]
OF_SHAFTS = (
    ("largest_bearing_force", "largest force of a bearing"),
    ("largest_rolling_element_force", "largest force of a rolling element, under mean loads"),
)
OF_MESHES = (
    ("mean_mesh_stiffness", "mesh stiffness, mean", "N/(mm um)"),
    ("face_load_factor", "face load factor K_Hbeta", ""),
    ("largest_pair_force", "largest force of a tooth pair", "N"),
    ("peak_contact_pressure", "peak contact pressure", "MPa"),
)


def train_rows(found: xr.Dataset) -> Rows:
    """Of a train or a planetary set."""
    if SET not in found.dims:
        return _set_rows(found) if PLANET in found.dims else _rows_of_meshes(found)
    meshes = [str(each) for each in found[MESH].values]
    of_sets = {str(name): own for name, own in zip(found[SET].values, set_runs(found))}
    others = [place for place, mesh in enumerate(meshes) if mesh.split(":")[0] not in of_sets]
    rows = _rows_of_meshes(found.isel({MESH: others}))
    return rows + [(f"{name}: {row[0]}", *row[1:]) for name, own in of_sets.items() for row in _set_rows(own)]


def _rows_of_meshes(found: xr.Dataset) -> Rows:
    attrs = found.attrs
    rows = _of_the_whole(found, "urad")
    for own in found[f"peak_to_peak_{OF_OUTPUTS}"] if OF_OUTPUTS in found else ():
        rows.append((f"{own['output'].item()}: lag of its shaft, peak to peak", in_microradians(float(own)), "urad"))
    for name, label in OF_SHAFTS:
        if name in attrs:
            rows.append((label, f"{attrs[name]:.5g}", "N"))
    if "friction_loss" in attrs:
        rows.append(("friction loss, all meshes", f"{100.0 * attrs['friction_loss']:.4g}", "%"))
    numbers = _of_each_mesh(found)
    for place, name in enumerate(numbers[MESH]):
        own = {number: values[[place]] for number, values in numbers.items()}
        for number, label in (("peak_to_peak", "peak to peak"), ("mean", "mean")):
            angle = own[f"{number}_transmission_error"].item()
            said = f"{angle * own['base_radius_wheel'].item() / MICROMETRE:.4g} um = {angle:.5g} rad"
            rows.append((f"{name}: transmission error, {label}", said, ""))
        if "mean_path_share" in own:
            # What is left of a share of nothing is round-off; the sum takes the sign of a zero.
            shares = [100.0 * own[f"{each}_path_share"].item() for each in ("mean", "least", "largest")]
            mean, least, most = (f"{round(each, 6) + 0.0:.4g}" for each in shares)
            rows.append((f"{name}: share of the torque on its shaft", f"{mean} ({least} to {most})", "%"))
        rows += _of_meshes(str(name), own)
    return rows


def _set_rows(found: xr.Dataset) -> Rows:
    """Of a planetary set; of both kinds of meshes the largest of all planets."""
    attrs = found.attrs
    rows = _of_the_whole(found, "urad of the output")
    rows += [
        ("load sharing factor K_gamma, of the sun's meshes", f"{attrs['load_sharing_factor']:.6g}", ""),
        ("load sharing factor K_gamma, of the ring's meshes", f"{attrs['load_sharing_factor_ring']:.6g}", ""),
        ("largest force of a planet on its pin", f"{attrs['largest_pin_force']:.5g}", "N"),
    ]
    members = [str(each) for each in found[MEMBER].values]
    for place, member in enumerate(members):
        torque = 1e-3 * float(found["member_torque"][:-1, place].mean())
        rows.append((f"torque through the {member}, mean", f"{torque:.6g}", "N m"))
    for member in attrs.get("floating", "").split():
        place = members.index(member)
        radius = np.hypot(found["member_x"][:, place], found["member_y"][:, place])
        rows.append((f"centre of the {member}, farthest from its place", f"{1e3 * float(radius.max()):.4g}", "um"))
    for name, label in (("efficiency", "efficiency"), ("basic_efficiency", "efficiency with the carrier at rest")):
        if name in attrs:
            rows.append((label, f"{100.0 * attrs[name]:.5g}", "%"))
    numbers = _of_each_mesh(found)
    for name, places in kinds_of_meshes([str(each) for each in numbers[MESH]]).items():
        kind = name.partition(": ")[2]
        rows += _of_meshes(kind, {number: values[places] for number, values in numbers.items()})
    return rows


def _of_the_whole(found: xr.Dataset, unit: str) -> Rows:
    rows = [
        (f"overall transmission error, {label}", in_microradians(found.attrs[f"{name}_{OVERALL}"]), unit)
        for name, label in (("peak_to_peak", "peak to peak"), ("mean", "mean"))
    ]
    if "target" in found:
        error, target = (float(np.nanmax(found[name])) for name in ("estimated_error", "target"))
        rows.append(("estimated error of T_E and T_EPP, of the worst mesh", f"{error:.2%}, target {target:.3%}", ""))
    return rows


def _of_each_mesh(found: xr.Dataset) -> dict[str, np.ndarray]:
    """Values (meshes,) of each number of a mesh. To select them one by one takes xarray milliseconds."""
    return {str(name): variable.values for name, variable in found.variables.items() if variable.dims == (MESH,)}


def _of_meshes(name: str, own: Mapping[str, np.ndarray]) -> Iterator[tuple[str, str, str]]:
    """The largest numbers of one mesh, or of several alike."""
    for number, label, unit in OF_MESHES:
        if number in own and not np.isnan(own[number]).all():
            yield f"{name}: {label}", four_digits(np.nanmax(own[number])), unit
