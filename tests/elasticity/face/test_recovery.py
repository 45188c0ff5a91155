"""The stiffness of a swept section, and displacement and stress recovered in swept sectors."""

from dataclasses import fields, replace
from math import radians, tan
from types import SimpleNamespace

import numpy as np
import pytest
from scipy import sparse
from scipy.sparse.linalg import spsolve
from tests.coarse_sector import PINION, STEEL
from tests.elasticity.face.swept import SIZES, TWIST, TWISTED, in_frame, in_place, mesh, section, swept_points

from fenics_gears.elasticity.compliance import Reach
from fenics_gears.elasticity.condensation import by_radius, condense, without
from fenics_gears.elasticity.element_nodes import dofs_of
from fenics_gears.elasticity.face import cut_motions
from fenics_gears.elasticity.face.compliance import face_compliance
from fenics_gears.elasticity.face.discretisation import FaceDiscretisation
from fenics_gears.elasticity.face.layers import Sweep, SweptWeb, swept_nodes
from fenics_gears.elasticity.face.swept_stiffness import ELEMENT, SectionForms, swept_stiffness
from fenics_gears.elasticity.face.web import webbed_section
from fenics_gears.elasticity.nodal_stress import NodalStress
from fenics_gears.elasticity.recovery import gear_recovery
from fenics_gears.geometry.gear_data import Web
from fenics_gears.geometry.outline import rotation
from fenics_gears.show.stress_grid import surface, wedges
from fenics_gears.simulation.run_stresses import GearInSpace, layers_of, outer_sides

PINION_BODY = FaceDiscretisation(2.7, 2, 15.0, tan(radians(15.0)) / PINION.reference_radius)


@pytest.fixture(scope="module")
def recovery():
    with gear_recovery(PINION, STEEL, PINION_BODY) as found:
        yield found


def test_flanks_move_as_their_compliance_says(recovery):
    """Identity: the condensed compliance times the forces, on the loaded tooth and its neighbours."""
    check_flanks(recovery, face_compliance(PINION, STEEL, PINION_BODY, Reach(1)))


@pytest.mark.nightly
@pytest.mark.parametrize("low", [-3.0, -7.5])
def test_flanks_beside_a_web_move_as_their_compliance_says(low, monkeypatch):
    """The same, of a web in the middle and of one at the left end, with all motions of the cuts."""
    monkeypatch.setattr(cut_motions, "FEW", 10_000)
    web, width = SweptWeb(18.0, 25.0, low, low + 6.0), PINION_BODY.face_width
    gear = replace(PINION, web=Web(18.0, 25.0, 6.0 / width, offset=(low + 3.0) / width))
    body = replace(PINION_BODY, web=web)
    with gear_recovery(gear, STEEL, body) as recovery:
        check_flanks(recovery, face_compliance(gear, STEEL, body, Reach(1)))


def check_flanks(recovery, compliance):
    flank = recovery.sector.flank_nodes("flank")
    forces = np.random.default_rng(1).normal(size=(1, len(compliance.heights), len(compliance.roll_angle), 3))
    found = recovery.recovered({0: forces}, range(-1, 2)).displacement.reshape(3, -1, 3)[:, flank].reshape(3, -1)
    for moved, block in zip(found, (compliance.blocks[1].T, compliance.blocks[0], compliance.blocks[1])):
        assert np.linalg.norm(moved - block @ forces.ravel()) < 1e-9 * np.linalg.norm(moved)


def test_loads_of_several_teeth_superpose(recovery):
    """Linear: also where one tooth has the number of a tooth a whole turn on."""
    shape = (1, len(recovery.heights), len(recovery.sector.flank_nodes("flank")) // len(recovery.heights), 3)
    one, other = np.random.default_rng(2).normal(size=(2, *shape))
    together = recovery.recovered({0: one, 1 + PINION.teeth: other}, range(2))
    parts = [recovery.recovered(load, range(2)) for load in ({0: one}, {1: other})]
    for name in ("displacement", "stress"):
        alone = sum(getattr(part, name) for part in parts)
        assert np.abs(getattr(together, name) - alone).max() < 1e-10 * np.abs(alone).max()


def webbed():
    """The pinion of module one with a web from its one end, twisted."""
    gear = replace(PINION, web=Web(18.0, 25.0, 0.25)).of_module_one
    web = SweptWeb(gear.web.hub_radius, gear.web.rim_radius, -1.5, -0.5)
    mesh = webbed_section(gear, SIZES)
    return SectionForms(mesh, 0.3, web), mesh, Sweep(np.array([-1.5, -0.5, 1.5]), TWIST, web)


@pytest.mark.parametrize("with_web", [False, True])
def test_uniform_strain_has_its_stress(with_web):
    """Exact: Hooke's stress of a displacement linear in space, at all nodes, turned into each height's frame."""
    forms, _, sweep = webbed() if with_web else (section(), mesh(), TWISTED)
    there = forms.material(sweep)
    points = swept_points(forms.nodes.points, sweep)
    gradient = np.random.default_rng(3).normal(size=(3, 3))
    moved = in_frame((in_place(points, TWIST) @ gradient.T)[..., None], points, TWIST).reshape(
        len(sweep.heights), -1, 3
    )
    moved[~there] = 0.0
    strain, shear, lame = 0.5 * (gradient + gradient.T), 0.5 / 1.3, 0.3 / (1.3 * 0.4)
    stress = 2.0 * shear * strain + lame * np.trace(strain) * np.eye(3)
    found = NodalStress(forms.nodes, 0.3, sweep).at_nodes(moved)
    assert there.all() != with_web and not found[~there].any()
    for height, at_height, own in zip(sweep.heights, found, there):
        frame = rotation(TWIST * height, 3)
        assert np.abs(frame @ at_height[own] @ frame.T - stress).max() < 1e-9 * np.abs(stress).max()


def test_the_surface_beside_a_web_encloses_its_body():
    """Divergence theorem: the volume of the layers' cells; as many wedges as cells."""
    forms, mesh, sweep = webbed()
    nodes, sweep = forms.nodes, replace(sweep, twist=0.0)
    in_web, rim_and_hub = layers_of(SimpleNamespace(section=nodes, sweep=sweep, mesh=mesh))
    one = swept_points(nodes.points, sweep).reshape(len(sweep.heights), -1, 3)
    teeth = [one @ rotation(angle, 3).T for angle in PINION.angular_pitch * np.arange(PINION.teeth)]
    shown = dict(sectors=range(len(teeth)), points=np.array(teeth), section=nodes, outline=outer_sides(nodes, mesh))
    unused = {each.name: None for each in fields(GearInSpace) if each.name not in shown}
    gear = GearInSpace(**(unused | shown | {"in_web": in_web, "rim_and_hub": rim_and_hub}))
    a, b, c = np.moveaxis(gear.points.reshape(-1, 3)[surface(gear.points, gear)], 1, 0)
    along, across = (nodes.points[nodes.cells[:, corner]] - nodes.points[nodes.cells[:, 0]] for corner in (1, 2))
    area = 0.5 * np.cross(along, across)
    layers = [area.sum() if within else area[sweep.web.outside(nodes.middles)].sum() for within in in_web]
    volume = len(teeth) * (layers @ sweep.thicknesses)
    assert np.einsum("ki,ki->", a, np.cross(b, c)) / 6.0 == pytest.approx(volume, rel=1e-12)
    assert len(wedges(gear)) == len(teeth) * (len(nodes.cells) + len(rim_and_hub[0].cells))


def relative(difference, reference) -> float:
    return float(abs(difference).max() / abs(reference).max())


@pytest.mark.parametrize("twist", [0.0, TWIST])
def test_patch_test(twist):
    """Patch test, Irons and Razzaque 1972: a uniform strain leaves every inner node without force."""
    sweep, nodes = Sweep(np.linspace(-1.5, 1.5, 4), twist), section().nodes
    points = swept_points(nodes.points, sweep)
    gradient = np.random.default_rng(1).normal(size=(3, 3))
    forces = swept_stiffness(section(), sweep) @ in_frame(
        (in_place(points, twist) @ gradient.T)[:, :, None], points, twist
    )
    inner = np.setdiff1d(np.arange(len(nodes.points)), nodes.boundary_sides)
    assert abs(forces.reshape(-1, len(nodes.points), 3)[1:-1, inner]).max() < 1e-12 * abs(forces).max()


def test_body_without_variation_along_the_face_is_the_plane_section():
    """Exact identity: with u_z held and even loads, plane strain of the section's own mesh."""
    sweep, nodes = Sweep(np.array([-1.5, -1.0, 0.2, 1.5])), section().nodes.points
    hub = mesh().edge_nodes("hub", ELEMENT.order)
    flank = by_radius(without(mesh().edge_nodes("flank", ELEMENT.order), hub))
    plane = condense(mesh(), ELEMENT, 0.3, {"flank": flank, "hub": hub})
    expected = np.linalg.inv(plane.between("flank", "flank"))
    heights = len(sweep.heights)
    at = swept_nodes(nodes, flank, heights)
    # A load of 1 per length on a node of the section is, at the nodes' heights, the integral of each shape function.
    share = np.zeros(heights)
    for layer, thickness in enumerate(np.diff(sweep.boundaries)):
        share[2 * layer : 2 * layer + 3] += thickness * np.array([1.0, 4.0, 1.0]) / 6.0
    free = np.ones((heights * len(nodes), 3), dtype=bool)
    free[:, 2], free[swept_nodes(nodes, hub, heights)] = False, False
    free = np.flatnonzero(free.ravel())
    loads = np.zeros((3 * heights * len(nodes), 2 * len(flank)))
    loads[dofs_of(at, 3).reshape(heights, -1, 3)[:, :, :2].reshape(heights, -1)] = share[:, None, None] * np.eye(
        2 * len(flank)
    )
    solved = np.zeros_like(loads)
    solved[free] = spsolve(
        swept_stiffness(section(), sweep)[free][:, free].tocsc(), sparse.csc_matrix(loads[free])
    ).toarray()
    for height in solved[dofs_of(at, 3)].reshape(heights, len(flank), 3, -1)[:, :, :2]:
        assert relative(height.reshape(2 * len(flank), -1) - expected, expected) < 1e-8
