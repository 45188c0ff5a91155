"""``[body_meshes]``: gears meshed as a whole by the user, whose teeth need not be alike (``elasticity.whole_body``)."""

import hashlib
import os
from dataclasses import dataclass, replace
from math import lcm
from pathlib import Path

from fenics_gears.dynamics.crack_openings import closed_cracks, crack_openings
from fenics_gears.elasticity.element_nodes import element_nodes
from fenics_gears.elasticity.elements import element_named
from fenics_gears.inputs.fields import file_name
from fenics_gears.inputs.problem import Broken
from fenics_gears.inputs.section import Section
from fenics_gears.inputs.tree import GEARS, PerGear, Tree, table, value_at
from fenics_gears.inputs.written import as_written
from fenics_gears.system import user_file

from .effect import Effect

# A flank of elements this much longer than those the contact asks for does not resolve it.
COARSE = 1.5


@dataclass(frozen=True)
class MeshFile:
    """A mesh file, and a hash of what it held when the scene was read; empty where it could not be read."""

    path: str
    digest: str = ""


@dataclass(frozen=True)
class BodyMeshes(Section, PerGear):
    """``[body_meshes]``: gmsh files, relative to the folder of the scene file; lengths in mm."""

    empty = 'names no file. Add pinion = "gear.msh" or wheel = "gear.msh", or leave the section out.'

    pinion: MeshFile | None = file_name(
        ".msh",
        "pinion.msh",
        meaning="mesh file of the whole pinion",
        otherwise="a ring of equal sectors",
        made=MeshFile,
    )
    wheel: MeshFile | None = file_name(
        ".msh", "wheel.msh", meaning="mesh file of the whole wheel", otherwise="a ring of equal sectors", made=MeshFile
    )

    def body_of(self, name: str, pair, element: str):
        """The checked mesh of a gear with its flanks."""
        from fenics_gears.elasticity.whole_body.given import given_body

        file = getattr(self, name)
        written = f"body_meshes.{name} = {as_written(file.path)}"
        return given_body(file.path, file.digest, getattr(pair, name), element, written)

    def unknowns_of(self, name: str, pair, element: str) -> int | None:
        """Unknowns of a gear with a mesh of its own; None for the other."""
        if getattr(self, name) is None:
            return None
        return 2 * len(element_nodes(self.body_of(name, pair, element).mesh, element_named(element)).points)


def located(meshes: BodyMeshes, directory: Path) -> BodyMeshes:
    return meshes.changed(lambda file: file and _located(file, directory))


def _located(file: MeshFile, directory: Path) -> MeshFile:
    path = os.path.realpath(directory / file.path)
    try:
        user_file.check_file(path, user_file.LARGEST_MESH)
        with open(path, "rb") as opened:
            return replace(file, path=path, digest=hashlib.file_digest(opened, "sha256").hexdigest())
    except (OSError, user_file.Unreadable):
        # `check` says why; a scene that is only looked at needs no mesh.
        return replace(file, path=path)


def files(meshes: BodyMeshes) -> dict[str, str]:
    return {each.path: each.digest for each in meshes.of_gears if each is not None}


def meshes_are_given_and_used(tree: Tree) -> Broken:
    """Only the elastic model, condensed once, can have teeth that are not alike."""
    section = table(tree, "body_meshes")
    if section is None:
        return
    for gear in GEARS:
        if gear in section and value_at(tree, "gears", gear, "web") is not None:
            message = f"cannot be combined with body_meshes.{gear}, which says where the body is. Leave one out."
            yield ("gears", gear, "web"), message
    yield from only_teeth_that_differ(tree, "body_meshes")


def only_teeth_that_differ(tree: Tree, section: str) -> Broken:
    """What cannot stand beside a section by which teeth are not alike."""
    beside = f"cannot be combined with [{section}]"
    for name, allowed in (("model", "elastic"), ("condensation", "once")):
        written = value_at(tree, "accuracy", name)
        if written != allowed and isinstance(written, str):
            yield ("accuracy", name), f'{beside}. Take "{allowed}", or leave one of the two out.'
    if value_at(tree, "accuracy", "elastic_teeth") is not None:
        message = f"{beside}, where all teeth feel each other. Leave one of the two out."
        yield ("accuracy", "elastic_teeth"), message
    if value_at(tree, "output", "root_stress") is True:
        yield ("output", "root_stress"), f"knows equal teeth only and {beside}. Leave one of the two out."


def check(meshes: BodyMeshes, scene, pair) -> None:
    for name in GEARS:
        if getattr(meshes, name) is not None:
            meshes.body_of(name, pair, scene.accuracy.element or "P2")


def warnings(meshes: BodyMeshes, model) -> list[str]:
    wanted = model.resolution.flank_element_size
    sentences = []
    for name in GEARS:
        if getattr(meshes, name) is None:
            continue
        size = meshes.body_of(name, model.pair, model.resolution.element).coarsest_flank
        if size > COARSE * wanted:
            sentences.append(
                f"body_meshes.{name}: elements along its flanks are up to {size:.3g} mm long, the contact asks for"
                f" {wanted:.3g} mm (accuracy.flank_element_size): it is not resolved"
            )
    return sentences


def elasticity(meshes: BodyMeshes, model, name: str, reach, cache):
    """Flank compliance of a gear with a mesh of its own, over the teeth within `reach`; None for the other."""
    if getattr(meshes, name) is None:
        return None
    from fenics_gears.elasticity.whole_body.condensed import whole_body_compliance

    gear = getattr(model.pair, name)
    material = model.scene.gears.material_of(name)
    element = model.resolution.element
    mesh = meshes.body_of(name, model.pair, element).mesh
    # Forces one tooth beyond those that interact still open or close a crack.
    offsets = reach.same + 1
    return whole_body_compliance(mesh, gear, material, element=element, tooth_offsets=offsets, cache=cache)


def watched(meshes: BodyMeshes, cycle, steps) -> dict:
    """Smallest and largest openings (steps,), mm, of the cracks of either gear."""
    return crack_openings(cycle, steps.records)


def findings(meshes: BodyMeshes, watched) -> list[str]:
    return closed_cracks(watched)


def period(meshes: BodyMeshes, scene) -> int:
    """Mesh cycles of whole turns of the gears meshed as a whole."""
    return lcm(*(getattr(scene.gears, name).teeth for name in GEARS if getattr(meshes, name) is not None))


EFFECT = Effect(
    section="body_meshes",
    description="gears meshed as a whole by the user, with teeth that may differ",
    absent="each gear is a ring of equal sectors",
    fields=BodyMeshes,
    terms=("a flank compliance for each tooth", "contact equations that change with the teeth in mesh"),
    needs=("tooth_elasticity",),
    excludes=("coast_flanks",),
    located=located,
    files=files,
    rules=meshes_are_given_and_used,
    check=check,
    warnings=warnings,
    elasticity=elasticity,
    watched=watched,
    findings=findings,
    period=period,
)
