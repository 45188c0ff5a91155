"""``[misalignment]``: axes that are not parallel (``geometry.face``)."""

from fenics_gears.geometry.misalignment import Misalignment

from .effect import Effect

EFFECT = Effect(
    section="misalignment",
    description="axes that are not parallel",
    absent="parallel axes",
    fields=Misalignment,
    terms=("gaps between the flanks that vary along the face",),
    needs=("tooth_elasticity",),
    excludes=("body_meshes",),
)
