"""The sections and fields of a scene file, with what each allows; those of an effect are in its own module.

Ranges are generous: what is physically possible is allowed. Whether teeth and diameters make a gear is for ``geometry`` to say.
"""

from __future__ import annotations

from typing import Literal, Optional

from pydantic import create_model

from fenics_gears.effects import top_level
from fenics_gears.effects.tooth_elasticity import MaterialText
from fenics_gears.scene.fields import Section, choice, number, quantity, switch, text, whole_number


def _diameter(example: str):
    return quantity("0.1 mm", "100 m", example)


class Gear(Section):
    """``[gears.pinion]`` and ``[gears.wheel]``; the rack's tip radius is in modules."""

    teeth: int = whole_number(5, 1000, 16)
    profile_shift: float = number(0.196, lowest=-5, highest=5)
    tip_diameter: float = _diameter("82.64 mm")
    root_diameter: float = _diameter("62.50 mm")
    bore_diameter: float = _diameter("30 mm")
    rack_tip_radius: float = number(0.38, lowest=0, highest=2, default=0.38)


class Gears(Section):
    """``[gears]``."""

    module: float = quantity("0.01 mm", "1 m", "4.5 mm")
    pressure_angle: float = quantity("10 deg", "35 deg", "20 deg")
    centre_distance: float = quantity("0.1 mm", "100 m", "91.5 mm")
    face_width: float = quantity("0.01 mm", "100 m", "15 mm")
    pinion: Gear
    wheel: Gear
    material: Optional[MaterialText] = None


class Load(Section):
    """``[load]``."""

    wheel_torque: float = quantity("-1e12 N m", "1e12 N m", "437 N m")


# As many mesh cycles as pass until every tooth has met every other; the number follows from the teeth.
HUNTING_TOOTH_PERIOD = "hunting tooth period"
WHOLE_PERIOD = {HUNTING_TOOTH_PERIOD: None}


class Motion(Section):
    """``[motion]``: exactly one of the mesh frequency and the pinion's speed."""

    mesh_frequency: Optional[float] = quantity("1e-6 Hz", "1e6 Hz", "200 Hz", optional=True)
    pinion_speed: Optional[float] = quantity("1e-6 rpm", "1e6 rpm", "750 rpm", optional=True)
    mesh_cycles: Optional[int] = whole_number(1, 1_000_000, 30, words=WHOLE_PERIOD)
    recorded_cycles: Optional[int] = whole_number(1, 1_000_000, 2, optional=True, words=WHOLE_PERIOD)


class Accuracy(Section):
    """``[accuracy]``: what is left out is derived from the scene."""

    element: Optional[Literal["P1", "P2", "Q1", "Q1 incompatible", "Q2"]] = choice("P1", "P2", "Q1", "Q1 incompatible", "Q2")
    flank_element_size: Optional[float] = quantity("1e-6 mm", "1 m", "0.08 mm", optional=True)
    body_element_size: Optional[float] = quantity("1e-6 mm", "10 m", "1.3 mm", optional=True)
    contact_length: Optional[float] = quantity("1e-6 mm", "10 m", "1.5 mm", optional=True)
    contact_nodes: Optional[int] = whole_number(2, 1000, 20, optional=True)
    interpolation: Optional[Literal["averaged", "collocated"]] = choice("averaged", "collocated")
    elastic_teeth: Optional[int] = whole_number(1, 1000, 2, optional=True)
    steps_per_mesh_cycle: Optional[int] = whole_number(2, 1_000_000, 100, optional=True)
    condensation: Optional[Literal["once", "every step"]] = choice("once", "every step")
    model: Optional[Literal["elastic", "rigid teeth", "stiffness table", "ISO 6336-1"]] = choice(
        "elastic", "rigid teeth", "stiffness table", "ISO 6336-1"
    )


class Output(Section):
    """``[output]``: results that cost something of their own."""

    root_stress: bool = switch()


class _AlwaysThere(Section):
    title: Optional[str] = text(500)
    gears: Gears
    load: Load
    motion: Motion
    accuracy: Accuracy = Accuracy()
    output: Output = Output()


SceneText = create_model(
    "SceneText",
    __base__=_AlwaysThere,
    __doc__="A whole scene file: the sections that are always there, and one optional section for each effect.",
    **{effect.section: (Optional[effect.text], None) for effect in top_level()},
)
