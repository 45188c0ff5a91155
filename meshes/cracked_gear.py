"""The mesh of a whole gear of a scene, one of its teeth cracked at the root, for the scene's section [body_meshes].

    python -m meshes.cracked_gear SCENE FILE.msh [--gear wheel] [--depth "3 mm"] [--angle "45 deg"] [--tooth 8] ...

Teeth are counted counter-clockwise. Tooth 0 points downwards and is the first to mesh; after it the pinion's teeth come
one after the other clockwise (15, 14, ... of 16), the wheel's counter-clockwise (1, 2, ...). Without --depth no tooth
is cracked.
"""

from __future__ import annotations

import argparse
import sys
from dataclasses import replace
from pathlib import Path

from fenics_gears.elasticity.elements import element_named
from fenics_gears.errors import GearsError, SceneError
from fenics_gears.inputs.units import QuantityError, quantity
from fenics_gears.model.model import model_of
from fenics_gears.scene.read import load_scene
from meshes.mesh_file import write_body_mesh
from meshes.root_crack import RootCrack, cracked_gear_mesh

GEARS = ("pinion", "wheel")


def _of_kind(kind: str):
    def read(written: str) -> float:
        try:
            number, found = quantity(written)
        except QuantityError as error:
            raise argparse.ArgumentTypeError(f"'{written}' {error}") from None
        if found != kind:
            raise argparse.ArgumentTypeError(f"'{written}' is {found}, not {kind}")
        return number

    return read


def arguments() -> argparse.ArgumentParser:
    """What the command takes."""
    parser = argparse.ArgumentParser(
        prog="python -m meshes.cracked_gear", description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    length, angle = _of_kind("a length"), _of_kind("an angle")
    parser.add_argument("scene", type=Path, help="a scene file, whose gear is meshed")
    parser.add_argument("file", type=Path, help="the mesh file to write (.msh)")
    parser.add_argument("--gear", choices=GEARS, default="pinion")
    parser.add_argument("--depth", type=length, help='length of the crack, such as "3 mm"; no crack without it')
    parser.add_argument(
        "--angle", type=angle, default="45 deg", help="between crack and the tooth's centreline (default: 45 deg)"
    )
    parser.add_argument(
        "--mouth",
        type=angle,
        default="30 deg",
        help="where it begins: angle of the fillet to the centreline (default: 30 deg)",
    )
    parser.add_argument("--tooth", type=int, default=0, help="the cracked tooth (default: 0)")
    parser.add_argument(
        "--flank-size", type=length, help="elements along the drive flanks (default: what the scene's contact asks for)"
    )
    return parser


def _check_elements(model) -> None:
    """Raise SceneError for a scene whose gears are not of triangles."""
    if not model.scene.resolves_contact or element_named(model.resolution.element).quadrilateral:
        raise SceneError(
            f"the scene computes its teeth as {model.resolution.element}; meshes of cracked gears have triangles. Take"
            " accuracy.element P2 or P1"
        )


def main(words: list[str] | None = None) -> int:
    """Write the mesh and say what is in it."""
    options = arguments().parse_args(words)
    if options.file.suffix != ".msh":
        print(f"{options.file}: must end in .msh, gmsh's own format", file=sys.stderr)
        return 2
    try:
        model = model_of(load_scene(options.scene))
        _check_elements(model)
        gear, resolution = getattr(model.pair, options.gear), model.resolution
        discretisation = resolution.discretisation(GEARS.index(options.gear))
        sizes = replace(discretisation, flank_element_size=options.flank_size or resolution.flank_element_size).sizes(
            gear
        )
        cracks = (
            {} if options.depth is None else {options.tooth: RootCrack(options.depth, options.angle, options.mouth)}
        )
        mesh = cracked_gear_mesh(gear, sizes, cracks)
        write_body_mesh(mesh, options.file)
    except GearsError as error:
        print(error, file=sys.stderr)
        return error.exit_code
    print(
        f"{options.file}: {len(mesh.points)} points, {len(mesh.cells)} triangles, {sizes.flank:.3g} mm along the drive"
        " flanks"
    )
    return 0


if __name__ == "__main__":
    sys.exit(main())
