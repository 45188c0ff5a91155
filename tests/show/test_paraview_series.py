"""A turn for ParaView, read by other readers than the writers."""

import base64
import struct
import zlib
from xml.etree import ElementTree

import numpy as np
import pytest
from tests.paper_text import coarse_text

from fenics_gears import results, scene_from_text
from fenics_gears.commands.cli import main
from fenics_gears.results.pairs import contact_times
from fenics_gears.show.stress_animation import frame_steps
from fenics_gears.show.stress_grid import PLANE_STRESSES, in_plane, in_tooth_order
from fenics_gears.simulation.run_stresses import RunStresses

pyvista = pytest.importorskip("pyvista")


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """Two stored mesh cycles, four steps each, and its scene as in the file."""
    from fenics_gears.runs.simulate import simulate

    directory = tmp_path_factory.mktemp("run")
    coarse = (
        '[accuracy]\nelement = "P1"\nflank_element_size = "0.3 mm"\nbody_element_size = "3 mm"\ncontact_length = "4'
        ' mm"\ncontact_nodes = 14\nsteps_per_mesh_cycle = 4\n'
    )
    effects = ("shafts", "bearings", "inertia", "damping", "friction")
    scene = scene_from_text(coarse_text(*effects, accuracy=coarse))
    results.save(simulate(scene), directory / "run.nc")
    return directory, scene


@pytest.fixture(scope="module")
def series(run, tmp_path_factory):
    collection = tmp_path_factory.mktemp("paraview") / "turn.pvd"
    assert main(["picture", str(run[0]), "--pvd", str(collection), "--quiet"]) == 0
    return collection


def array(file, name, section="PointData"):
    """An array of a .vtu file by its published format (inline binary, zlib blocks, 32-bit header), without VTK."""
    root = ElementTree.parse(file).getroot()
    assert (
        root.attrib["header_type"] == "UInt32"
        and root.attrib["compressor"] == "vtkZLibDataCompressor"
        and root.attrib["byte_order"] == "LittleEndian"
    )
    found = next(
        each for each in root.find(f"UnstructuredGrid/Piece/{section}") if each.get("Name") == name or name is None
    )
    assert found.get("format") == "binary"
    text = "".join(found.text.split())
    count = struct.unpack("<I", base64.b64decode(text[:8])[:4])[0]
    header = 4 * ((4 * (3 + count) + 2) // 3)
    sizes = np.frombuffer(base64.b64decode(text[:header]), dtype="<u4")[3 : 3 + count]
    packed, blocks = base64.b64decode(text[header:]), []
    for size in sizes:
        blocks.append(zlib.decompress(packed[:size]))
        packed = packed[size:]
    values = np.frombuffer(
        b"".join(blocks), dtype={"Float32": "<f4", "Int32": "<i4", "Int64": "<i8", "UInt8": "u1"}[found.get("type")]
    )
    return values.reshape(-1, int(found.get("NumberOfComponents", 1)))


def test_collection_lists_the_steps_with_their_times(run, series):
    """ParaView's format."""
    result = results.load(run[0] / "run.nc")
    root = ElementTree.parse(series).getroot()
    assert (root.tag, root.get("type")) == ("VTKFile", "Collection")
    listed = root.findall("Collection/DataSet")
    steps = frame_steps(result)
    assert len(steps) == 8 and [float(each.get("timestep")) for each in listed] == list(result.time.values[steps])
    assert sorted(path.name for path in series.parent.iterdir()) == [
        "turn.pvd",
        *(f"turn_{n:04d}.vtu" for n in range(8)),
    ]
    assert [each.get("file") for each in listed] == [f"turn_{n:04d}.vtu" for n in range(8)]
    reader = pyvista.PVDReader(str(series))
    assert reader.time_values == [float(each.get("timestep")) for each in listed]
    reader.set_active_time_value(reader.time_values[3])
    assert reader.read()[0].n_points == len(array(series.with_name("turn_0003.vtu"), "gear"))


def test_fields_survive(run, series):
    """Those of the recovery, to single precision, without VTK."""
    result, scene = results.load(run[0] / "run.nc"), run[1]
    with RunStresses(result, scene) as runs:
        mesh = runs.at(frame_steps(result)[5])
        bodies = [in_tooth_order(mesh, gear) for gear in (0, 1)]
    file = series.with_name("turn_0005.vtu")
    expected = {
        "displacement": np.vstack([in_plane(body.displacement) for body in bodies]),
        "elastic_displacement": np.vstack([in_plane(body.elastic) for body in bodies]),
        "von_mises_stress": np.concatenate([body.von_mises.ravel() for body in bodies])[:, None],
        **{
            f"stress_{name}": np.concatenate([body.stress[..., i, j].ravel() for body in bodies])[:, None]
            for name, (i, j) in PLANE_STRESSES.items()
        },
    }
    for name, values in expected.items():
        np.testing.assert_allclose(
            array(file, name)[:, : values.shape[1]], values, rtol=1e-6, atol=1e-7 * np.abs(values).max(), err_msg=name
        )
    np.testing.assert_allclose(
        array(file, None, "Points")[:, :2], np.vstack([in_plane(body.points) for body in bodies]), atol=1e-4
    )
    connectivity = array(file, "connectivity", "Cells")[:, 0]
    assert connectivity.max() + 1 == len(expected["displacement"]) and len(connectivity) % 3 == 0


def test_tooth_is_the_pair_that_loads_it(run, series):
    """The loaded pairs' teeth, and no others, have flanks under pressure."""
    result = contact_times(results.load(run[0] / "run.nc"))
    first = result["contact_pair_number"].attrs["number_at_phase_0"]
    for place, step in enumerate(frame_steps(result)):
        file = series.with_name(f"turn_{place:04d}.vtu")
        gear, tooth, stress = (array(file, name)[:, 0] for name in ("gear", "tooth", "von_mises_stress"))
        force = result.pair_normal_force.isel(time=step)
        loaded = {
            int(pair) - first
            for pair in force.pair_number.values[np.nan_to_num(force.values) > 0.15 * float(np.nansum(force))]
        }
        for number, teeth in ((1, 16), (2, 24)):
            largest = [stress[(gear == number) & (tooth == each)].max() for each in range(teeth)]
            assert {int(each) for each in np.argsort(largest)[-len(loaded) :]} == {pair % teeth for pair in loaded}
