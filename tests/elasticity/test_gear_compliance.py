"""From gear data to flank compliance."""

from dataclasses import replace

import gmsh
import numpy as np
import pytest
from tests.whole_gear import whole_gear_compliance, whole_gear_mesh

from fenics_gears import ComputationError, SceneError
from fenics_gears.elasticity.body_mesh_file import read_body_mesh
from fenics_gears.elasticity.cache import Cache
from fenics_gears.elasticity.compliance import Reach
from fenics_gears.elasticity.element_sizes import DEFAULT_SIZES, Discretisation, element_sizes
from fenics_gears.elasticity.elements import ELEMENTS, Element, element_named
from fenics_gears.elasticity.gear_compliance import flank_compliance
from fenics_gears.elasticity.gmsh_session import start
from fenics_gears.elasticity.ring import condensed_sector, ring_compliance
from fenics_gears.elasticity.sector_mesh import sector_mesh
from fenics_gears.geometry.involute import arc_length, canonical_normal

COARSE, REACH = Discretisation("P2", 0.5, 2.5), Reach(1)


def test_default_body_mesh_is_fine_enough(pinion):
    """Refining all but the flank moves the mean compliance under 1 mm of pressure by less than 0.1 %."""
    element = ELEMENTS["P2"]
    sizes = element_sizes(pinion, element, 0.12)
    finer = replace(
        sizes,
        fillet=sizes.fillet / 2,
        coast=sizes.coast / 2,
        body=sizes.body / 2,
        depth=2 * sizes.depth,
        growth=sizes.growth / 2,
    )
    for centre in (0.15, 0.5, 0.85):
        default, fine = (mean_compliance(pinion, element, choice, centre) for choice in (sizes, finer))
        assert default == pytest.approx(fine, rel=1e-3)


def mean_compliance(gear, element, sizes, centre):
    """Per unit load spread evenly over 1 mm about a fraction of the flank's length."""
    sector = condensed_sector(sector_mesh(gear, sizes), element, 0.3)
    ends = arc_length(gear.base_radius, np.array([gear.form_roll_angle, gear.tip_roll_angle]))
    nodes = np.linspace(*ends, len(sector.points["flank"]))
    length = ends[0] + centre * (ends[1] - ends[0]) + np.linspace(-0.5, 0.5, 4001)
    first = 2 * np.minimum(((length - ends[0]) / (nodes[2] - nodes[0])).astype(int), len(nodes) // 2 - 1)
    x = (length - nodes[first]) / (nodes[2] - nodes[0])
    normal = canonical_normal(np.sqrt(2.0 * length / gear.base_radius)) / len(length)
    force = np.zeros((len(nodes), 2))
    for ahead, shape in enumerate(((1 - x) * (1 - 2 * x), 4 * x * (1 - x), x * (2 * x - 1))):
        np.add.at(force, first + ahead, shape[:, None] * normal)
    return force.ravel() @ ring_compliance(sector, gear.teeth, 0)[0] @ force.ravel()


@pytest.fixture(scope="module")
def own_cache(pinion, steel, tmp_path_factory):
    cache = Cache(tmp_path_factory.mktemp("cache"))
    flank_compliance(pinion, steel, COARSE, REACH, cache)
    assert flank_compliance(pinion, steel, COARSE, REACH, cache).timings["from_cache"]
    return cache


@pytest.mark.parametrize(
    ("kind", "change"),
    [
        ("discretisation", {"element": "P1"}),
        ("discretisation", {"flank_element_size": 0.51}),
        ("discretisation", {"body_element_size": 1.2}),
        ("reach", {"same": 2}),
        ("gear", {"bore_radius": 15.1}),
        ("material", {"poissons_ratio": 0.29}),
    ],
)
def test_every_input_has_its_own_cache_entry(kind, change, pinion, steel, own_cache):
    """Definition: another input is another body."""
    inputs = {"gear": pinion, "material": steel, "discretisation": COARSE, "reach": REACH}
    inputs[kind] = replace(inputs[kind], **change)
    assert not flank_compliance(**inputs, cache=own_cache).timings["from_cache"]


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"discretisation": replace(COARSE, element="Q3")}, "element 'Q3'"),
        ({"discretisation": replace(COARSE, flank_element_size=0.0)}, "flank_element_size is 0.0 mm"),
        ({"discretisation": replace(COARSE, body_element_size=float("nan"))}, "body_element_size"),
        ({"reach": Reach(16)}, "between 0 and 15"),
    ],
)
def test_impossible_inputs_are_refused(change, message, pinion, steel):
    """Field, value and what is allowed."""
    with pytest.raises(SceneError, match=message):
        flank_compliance(pinion, steel, **{"discretisation": COARSE, "reach": REACH, **change})


def test_body_mesh_from_a_gmsh_file(pinion, steel, coarse_sector, tmp_path):
    """Exact identity: from memory and from a gmsh file with named curves."""
    whole = whole_gear_mesh(coarse_sector("P1"), pinion.teeth)
    write_gmsh_file(whole, tmp_path / "body.msh")
    read = read_body_mesh(tmp_path / "body.msh")
    expected = whole_gear_compliance(whole, pinion, steel, loaded_tooth=2, tooth_offsets=1)
    found = whole_gear_compliance(read, pinion, steel, loaded_tooth=2, tooth_offsets=1)
    assert np.abs(found.blocks - expected.blocks).max() < 1e-10 * np.abs(expected.blocks).max()
    with pytest.raises(ComputationError, match="no boundary part 'flank 99'"):
        read.edge_points("flank 99")


def write_gmsh_file(mesh, path):
    start(gmsh)
    gmsh.option.setNumber("General.Terminal", 0)
    surface = gmsh.model.addDiscreteEntity(2)
    coordinates = np.column_stack([mesh.points, np.zeros(len(mesh.points))])
    gmsh.model.mesh.addNodes(2, surface, np.arange(1, len(mesh.points) + 1), coordinates.ravel())
    gmsh.model.mesh.addElementsByType(surface, 2, [], (mesh.cells + 1).ravel())
    gmsh.model.addPhysicalGroup(2, [surface])
    for name, lines in mesh.edges.items():
        curve = gmsh.model.addDiscreteEntity(1)
        gmsh.model.mesh.addElementsByType(curve, 1, [], (lines + 1).ravel())
        gmsh.model.setPhysicalName(1, gmsh.model.addPhysicalGroup(1, [curve]), name)
    gmsh.write(str(path))
    gmsh.finalize()


@pytest.mark.parametrize("content", [None, "not a mesh", ""])
def test_unreadable_body_mesh_is_refused(content, tmp_path):
    """House rule: what a user gives is refused by its name."""
    path = tmp_path / "body.msh"
    if content is not None:
        path.write_text(content)
    with pytest.raises(SceneError, match="body.msh"):
        read_body_mesh(path)


FLANK = 0.3


def stretched(gear, steel, element, factor):
    """Mean displacement along x under a force spread over the whole flank, mm per N/mm."""
    order = element_named(element).order
    body = gear.module * DEFAULT_SIZES[order].body * factor
    found = flank_compliance(gear, steel, Discretisation(element, FLANK, body), Reach(0))
    elements = (found.nodes - 1) // order
    shares = np.zeros(found.nodes)
    for first in range(elements):
        shares[order * first : order * (first + 1) + 1] += (
            np.array([1.0, 4.0, 1.0]) / 6.0 if order == 2 else 0.5
        ) / elements
    return shares @ found.blocks[0][::2, ::2] @ shares


@pytest.mark.parametrize("element, factors", [("P2", (2.0, 1.0, 0.5, 0.25)), ("Q2", (2.0, 1.0, 0.5))])
def test_the_error_falls_with_the_square_of_the_size(pinion, steel, element, factors):
    """Strang and Berger 1973: straight sides along a curved outline leave h^2."""
    changes = np.diff([stretched(pinion, steel, element, factor) for factor in factors])
    assert (changes > 0.0).all()
    orders = np.log2(changes[:-1] / changes[1:])
    assert np.abs(orders - 2.0).max() < 0.5


def test_an_element_of_third_order_is_refused():
    """House rule 7: nodes are numbered at corners and middles of sides only."""
    with pytest.raises(ValueError, match="order = 3.*Allowed: 1 or 2"):
        Element("P3", 3, 3, 4)
