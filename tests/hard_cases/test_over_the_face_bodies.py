"""Rows 5 to 8, 13 and 27 over the face: bodies of finite elements, and what is made of them."""

import numpy as np
import pytest
from scipy import sparse
from scipy.sparse.linalg import spsolve
from tests.contact import test_face_mesh as stand_ins
from tests.contact.test_face_mesh import by_slice, errors, face_cycle, face_of, plane_cycle
from tests.contact.test_face_mesh import model as model  # a fixture
from tests.elasticity.face.swept import GEAR, TWIST, TWISTED, condense_swept, mesh, rigid_motions
from tests.elasticity.face.test_face_compliance import flank_nodes
from tests.elasticity.face.test_face_compliance import sector as sector  # a fixture
from tests.elasticity.test_coast_flank import difference
from tests.hard_cases.test_over_the_face_on_elements import TEETH, accuracy
from tests.hard_cases.test_over_the_face_on_elements import run as run  # a fixture
from tests.hard_cases.test_over_the_face_static import misaligned
from tests.hard_cases.test_row_05_schur_complement import check_kernel
from tests.hard_cases.test_row_13_unit_systems import SYSTEMS, in_units
from tests.helical import CROWNED, FRICTION, helical_scene
from tests.whole_gear import whole_gear_mesh

from fenics_gears import model_of, simulate
from fenics_gears.elasticity.condensation import by_radius, without
from fenics_gears.elasticity.element_nodes import dofs_of
from fenics_gears.elasticity.face.condensed import parts_of_ring
from fenics_gears.elasticity.face.layers import Sweep, swept_nodes
from fenics_gears.elasticity.face.swept_stiffness import ELEMENT, SectionForms, swept_stiffness
from fenics_gears.elasticity.ring import joined_blocks
from fenics_gears.geometry.outline import rotation
from fenics_gears.model.resolution import hertz_half_width, plane_contact_modulus
from fenics_gears.results.pairs import in_middle_slice


@pytest.mark.parametrize("twist", [0.0, TWIST])
def test_kernel_of_a_floating_sector_is_the_six_rigid_motions(twist, measured):
    """Row 5. Exact: norm(S R) / norm(S), symmetry, and the seventh eigenvalue."""
    hub = mesh().edge_nodes("hub", ELEMENT.order)
    lines = {"flank": by_radius(mesh().edge_nodes("flank", ELEMENT.order)), "hub": hub}
    lines |= {name: without(mesh().edge_nodes(f"{name} cut", ELEMENT.order), hub) for name in ("lower", "upper")}
    body = condense_swept(mesh(), Sweep(TWISTED.boundaries, twist), 0.3, lines)
    check_kernel(body.stiffness, rigid_motions(np.vstack([*body.points.values()]), twist), f"twist {twist:g}", measured)
    kept = np.delete(np.arange(len(body.stiffness)), body.dofs("hub"))
    assert np.linalg.eigvalsh(body.stiffness[np.ix_(kept, kept)])[0] > 0.0


def test_condensed_is_uncondensed(sector, measured):
    """Row 6. Brute force: a twisted sector with free cuts, its sparse stiffness solved by SuperLU."""
    whole = mesh(both_flanks=True)
    forms = SectionForms(whole, 0.3)
    nodes, heights = forms.nodes.points, len(TWISTED.heights)
    free = np.delete(
        np.arange(3 * heights * len(nodes)),
        dofs_of(swept_nodes(nodes, whole.edge_nodes("hub", ELEMENT.order), heights), 3),
    )
    flanks = np.searchsorted(
        free,
        dofs_of(
            np.concatenate([swept_nodes(nodes, flank_nodes(whole, side), heights) for side in ("flank", "coast")]), 3
        ),
    )
    loads = sparse.csc_matrix((np.ones(len(flanks)), (flanks, np.arange(len(flanks)))), shape=(len(free), len(flanks)))
    uncondensed = spsolve(swept_stiffness(forms, TWISTED)[free][:, free].tocsc(), loads).toarray()[flanks]
    size = len(flanks)
    stiffness = sector.stiffness
    coupling = stiffness[:size, size:]
    free_cuts = stiffness[:size, :size] - coupling @ np.linalg.solve(stiffness[size:, size:], coupling.T)
    apart = difference(np.linalg.inv(free_cuts), uncondensed)
    measured("condensed and uncondensed, twisted sector with both flanks: difference", apart, "1e-9", row=6)
    assert apart < 1e-9


def test_ring_of_sectors_is_the_whole_gear(sector, measured):
    """Row 6. Brute force: the section copied around the gear, condensed as one body."""
    whole, offsets = whole_gear_mesh(mesh(both_flanks=True), GEAR.teeth), 2
    flanks = {f"flank {tooth}": flank_nodes(whole, f"flank {tooth}") for tooth in range(offsets + 1)}
    body = condense_swept(whole, TWISTED, 0.3, flanks, held=whole.edge_nodes("hub", ELEMENT.order))
    compliance, size, worst = np.linalg.inv(body.stiffness), len(body.dofs("flank 0")), 0.0
    for offset, block in enumerate(
        joined_blocks(*parts_of_ring(sector, GEAR.teeth), GEAR.teeth, offsets)[:, :size, :size]
    ):
        frame = np.kron(np.eye(size // 3), rotation(offset * GEAR.angular_pitch, 3))
        worst = max(worst, difference(block, frame.T @ compliance[offset * size : (offset + 1) * size, :size]))
    measured("ring of twisted sectors and whole gear: difference", worst, "1e-10", row=6)
    assert worst < 1e-10


@pytest.mark.parametrize("slices", [1, pytest.param(4, marks=pytest.mark.nightly)])
def test_a_spur_pair_is_the_plane_one(model, slices, measured):
    """Row 7. Identity: where nothing varies along the face, slices are the plane pair side by side."""
    face = stand_ins.marched(model, face_cycle(model, face_of(slices)))
    plane = stand_ins.marched(model, plane_cycle(model))
    apart = difference(errors(face), errors(plane))
    whole = plane[7].solution.forces[: plane[7].position.operator.nodes].sum()
    uneven = difference(by_slice(face[7], slices), np.full(slices, whole / slices))
    measured(
        f"aligned spur pair in {slices} slices: transmission error, line loads, from the plane",
        f"{apart:.1g}, {uneven:.1g}",
        "1e-12",
        row=7,
    )
    assert apart <= 1e-12 and uneven <= 1e-12


@pytest.mark.nightly
@pytest.mark.parametrize(("elements", "limit"), [(2, 0.04), (4, 0.01)])
def test_peak_pressure_in_a_slice(run, elements, limit, measured):
    """Row 8. Hertz's pressure (K. L. Johnson, Contact Mechanics, 4.2) under the line load of the middle slice, where
    one pair of a crowned spur pair carries."""
    half_width, width = 0.13, 24.0
    accuracy_of = (
        f'slices = 6\nlayers = 3\nbody_element_size = "1.5 mm"\nflank_element_size = "{half_width / elements} mm"\n'
        'element = "P2"\nsteps_per_mesh_cycle = 20'
    )
    found = in_middle_slice(run(CROWNED, helix=0.0, width=width, accuracy=accuracy_of))
    model = model_of(helical_scene(CROWNED, helix=0.0, width=width, teeth=TEETH, accuracy=accuracy_of))
    pair, modulus, errors_of_peak = model.pair, plane_contact_modulus(model.scene), []
    for step in range(found.sizes["contact_time"]):
        at = found.isel(contact_time=step)
        loads = at["line_load"].values.ravel()
        if np.count_nonzero(loads > 0.0) != 1:
            continue
        slot = int(np.argmax(loads))
        pressures, rolls = (at[name].isel(slot=slot).values for name in ("contact_pressure", "contact_roll_angle"))
        xi = pair.pinion.base_radius * rolls[np.nanargmax(pressures)]
        radius = xi * (pair.line_of_action_length - xi) / pair.line_of_action_length
        peak = 2.0 * loads[slot] / (np.pi * hertz_half_width(loads[slot], radius, modulus))
        errors_of_peak.append(abs(np.nanmax(pressures) / peak - 1.0))
    worst = max(errors_of_peak)
    measured(
        f"middle slice, b/h = {elements}: nodal peak pressure in {len(errors_of_peak)} steps",
        100 * worst,
        f"{100 * limit:g} %",
        "%",
        row=8,
    )
    assert worst <= limit


@pytest.mark.nightly
@pytest.mark.parametrize("system", SYSTEMS)
def test_units_scale_out(system, measured):
    """Row 13. Exact identity (dimensional analysis) of a misaligned helical pair."""
    scene = helical_scene(CROWNED + misaligned(0.01) + FRICTION, teeth=TEETH, accuracy=accuracy())
    length, force, _ = SYSTEMS[system]
    here, there = simulate(scene), simulate(in_units(scene, *SYSTEMS[system]))
    change = max(
        difference(there[name].values / unit, here[name].values)
        for name, unit in (("transmission_error", 1.0), ("normal_force", force), ("line_load", force / length))
    )
    iterations = int(np.abs(there.newton_iterations.values - here.newton_iterations.values).max())
    measured(
        f"{system}: largest change, change of the number of iterations",
        f"{change:.1g}, {iterations}",
        "1e-9, 0",
        row=13,
    )
    assert change <= 1e-9 and iterations == 0
