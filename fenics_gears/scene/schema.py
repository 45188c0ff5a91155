"""The sections and fields of a scene file, with what each allows; those of an effect are in its own module.

Ranges are generous: what is physically possible is allowed. ``geometry`` checks whether teeth and diameters make a gear.
"""

from __future__ import annotations

import functools
import re
from typing import Any, Literal, Optional

from pydantic import BaseModel, Field, create_model

from fenics_gears.effects import top_level
from fenics_gears.effects.tooth_elasticity import MaterialText, OwnMaterialText
from fenics_gears.elasticity.elements import ELEMENTS
from fenics_gears.inputs.fields import Allowed, Section, choice, number, quantity, refused, switch, text, whole_number
from fenics_gears.inputs.written import as_written
from fenics_gears.scene.data import HUNTING_TOOTH_PERIOD


def _diameter(example: str, meaning: str):
    return quantity("0.1 mm", "100 m", example, meaning=meaning)


def _face_width(meaning: str, otherwise: str):
    return quantity("0.01 mm", "100 m", "15 mm", meaning=meaning, otherwise=otherwise)


class Gear(Section):
    """``[gears.pinion]`` drives and ``[gears.wheel]`` is driven; an external pair."""

    teeth: int = whole_number(5, 1000, 16, meaning="number of teeth")
    profile_shift: float = number(0.196, meaning="profile shift coefficient, in modules", lowest=-5, highest=5)
    tip_diameter: float = _diameter("82.64 mm", "tip diameter")
    root_diameter: float = _diameter("62.50 mm", "root diameter; it gives the rack's dedendum")
    bore_diameter: float = _diameter("30 mm", "bore diameter; the bore is a rigid ring on the shaft")
    rack_tip_radius: float = number(
        0.38, meaning="tip radius of the generating rack, in modules; it shapes the fillet", lowest=0, highest=2, default=0.38
    )
    face_width: Optional[float] = _face_width("width of this gear", "that of `[gears]`")
    material: Optional[OwnMaterialText] = None


class Gears(Section):
    """``[gears]``: what both gears share."""

    module: float = quantity("0.01 mm", "1 m", "4.5 mm", meaning="module, in the plane of rotation")
    pressure_angle: float = quantity("10 deg", "35 deg", "20 deg", meaning="pressure angle of the generating rack")
    centre_distance: float = quantity("0.1 mm", "100 m", "91.5 mm", meaning="distance of the shafts' axes")
    face_width: Optional[float] = _face_width("width of both gears; they meet over the smaller width, centred", "from both gears' own")
    pinion: Gear
    wheel: Gear
    material: Optional[MaterialText] = None


class Load(Section):
    """``[load]``: a constant torque on the output shaft's end."""

    wheel_torque: float = quantity(
        "-1e12 N m",
        "1e12 N m",
        "437 N m",
        meaning="torque against the wheel's rotation; a negative one drives the pair from the wheel and needs `[coast_flanks]`",
    )


WHOLE_PERIOD = {HUNTING_TOOTH_PERIOD: None}


class Motion(Section):
    """``[motion]``: a speed, as one of the mesh frequency and the pinion's speed, and how long; without ``[inertia]`` nothing of it is needed."""

    mesh_frequency: Optional[float] = quantity(
        "1e-6 Hz",
        "1e6 Hz",
        "200 Hz",
        meaning="tooth pairs that enter the mesh in a second",
        otherwise="from `pinion_speed`; without `[inertia]` none is needed, and a mesh cycle counts as 1 s",
    )
    pinion_speed: Optional[float] = quantity(
        "1e-6 rpm", "1e6 rpm", "750 rpm", meaning="nominal speed of the pinion, also in 1/min", otherwise="from `mesh_frequency`"
    )
    mesh_cycles: Optional[int] = whole_number(
        1,
        1_000_000,
        30,
        meaning="how many mesh cycles are run",
        otherwise="without `[inertia]` one, after which all repeats, or `\"hunting tooth period\"` where teeth or torques differ from cycle to cycle; "
        "with it, it must be given",
        words=WHOLE_PERIOD,
    )
    recorded_cycles: Optional[int] = whole_number(
        1,
        1_000_000,
        2,
        meaning="of how many of them, the last, contact fields are stored and pictures show; curves and numbers are of all",
        otherwise="2; all of them with `[speed_ramp]`, or where `\"hunting tooth period\"` are run, contact fields of as many as 1 GB holds",
        words=WHOLE_PERIOD,
    )


# For a tooth pair.
MOST_CONTACT_NODES = 1000


class Accuracy(Section):
    """``[accuracy]``: how a scene is computed, not what; what is left out is derived from the scene."""

    target: Optional[float] = quantity(
        "0.05 %",
        "50 %",
        "1 %",
        meaning="error in the transmission error's curve and its height that the settings of this section may cause, all together; the cheapest "
        "settings that reach it are chosen by test runs",
        otherwise="nothing is measured, and each setting is as given or by its own default",
    )
    element: Optional[Literal[tuple(ELEMENTS)]] = choice(
        *ELEMENTS,
        meaning="finite element: triangles or quadrilaterals of first or second order; `Q1 incompatible` is the paper's, with Wilson's modes",
        otherwise="`P2`",
    )
    flank_element_size: Optional[float] = quantity(
        "1e-6 mm",
        "1 m",
        "0.08 mm",
        meaning="size of the elements on the flank",
        otherwise="a quarter of the Hertz half-width at the whole load on one pair and the smallest relative radius; 1/200 to 1/25 of the module",
    )
    body_element_size: Optional[float] = quantity(
        "1e-6 mm",
        "10 m",
        "1.3 mm",
        meaning="largest element in tooth and rim; those of fillets, coast flank and bore are finer or coarser by as much as it is",
        otherwise="a part of the module, by the element's order",
    )
    contact_length: Optional[float] = quantity(
        "1e-6 mm",
        "10 m",
        "1.5 mm",
        meaning="length, across the line of action, in which the contact of a tooth pair is looked for",
        otherwise="so long that beyond it the flanks open more than the teeth deflect",
    )
    contact_nodes: Optional[int] = whole_number(
        2, MOST_CONTACT_NODES, 20, meaning="contact nodes of a tooth pair", otherwise="0.7 flank elements apart, 1 apart for elements of first order"
    )
    interpolation: Optional[Literal["averaged", "collocated"]] = choice(
        "averaged",
        "collocated",
        meaning="how contact nodes see the flanks: by averages over their hat functions, or at their own points",
        otherwise="`averaged`",
    )
    elastic_teeth: Optional[int] = whole_number(
        1,
        1000,
        2,
        meaning="how far the load of a tooth is felt: 1 by no other tooth, 2 by its neighbours, and so on",
        otherwise="by all teeth that are loaded together",
    )
    steps_per_mesh_cycle: Optional[int] = whole_number(
        2,
        1_000_000,
        100,
        meaning="time steps of a mesh cycle",
        otherwise="200; with `[inertia]` up to 1000, for 20 steps in the period of the drivetrain's highest frequency; 1000 where flanks are rigid too",
    )
    condensation: Optional[Literal["once", "every step"]] = choice(
        "once",
        "every step",
        meaning="`once`: the fast route; `every step`: the paper's own, which meshes both gears anew at every position, slow, the yardstick",
        otherwise="`once`",
    )
    model: Optional[Literal["elastic", "rigid teeth", "stiffness table", "ISO 6336-1"]] = choice(
        "elastic",
        "rigid teeth",
        "stiffness table",
        "ISO 6336-1",
        meaning="what the mesh is computed as: the full contact, rigid teeth, a table of one quasi-static, frictionless mesh cycle of the full "
        "contact over phase and load, or the standard's stiffness c' and c_gamma",
        otherwise="`elastic`",
    )


_LAST_CYCLES = re.compile(r"last ([1-9]\d{0,6}) cycles?")


class AllowedContactFields(Allowed):
    """True, false or "last N cycles"."""

    def convert(self, value: Any) -> bool | int:
        """A number of cycles for the text. Raises PydanticCustomError for anything else."""
        found = _LAST_CYCLES.fullmatch(value) if isinstance(value, str) else None
        if found is None and not isinstance(value, bool):
            raise refused(f"is {as_written(value)}.")
        return value if found is None else int(found[1])


class Output(Section):
    """``[output]``: results that cost something of their own."""

    root_stress: bool = switch(
        meaning="stress along the fillets of the loaded teeth over time, and dynamic factors by force and by stress; see [stress](stress.md)"
    )
    contact_fields: Optional[bool | int] = Field(
        None,
        json_schema_extra={
            "allowed": AllowedContactFields(
                'true, false, or "last N cycles", such as "last 3 cycles"',
                meaning="at which steps pressure, traction and place of every contact node are stored: at all, at none, or in the last mesh cycles of "
                "the run; pictures of stresses and of the pressure over the flank need them. It stands in place of `motion.recorded_cycles`",
                otherwise="in the last `motion.recorded_cycles`",
            )
        },
    )


class _AlwaysThere(Section):
    title: Optional[str] = text(500, meaning="what the scene is called in summaries and pictures", otherwise="the file's name")
    gears: Gears
    load: Load
    motion: Motion = Field(default_factory=Motion)
    accuracy: Accuracy = Field(default_factory=Accuracy)
    output: Output = Field(default_factory=Output)


SceneText = create_model(
    "SceneText",
    __base__=_AlwaysThere,
    __doc__="A whole scene file: the sections that are always there, and one optional section for each effect.",
    **{effect.section: (Optional[effect.text], None) for effect in top_level()},
)


def section_within(section: type[BaseModel], name: str) -> type[BaseModel] | None:
    """The schema of a section within a section; None where the name is a plain field."""
    annotation = section.model_fields[name].annotation
    kinds = (annotation, *getattr(annotation, "__args__", ()))
    return next((kind for kind in kinds if isinstance(kind, type) and issubclass(kind, BaseModel)), None)


@functools.cache
def known_paths(section: type[BaseModel] = SceneText, home: tuple[str, ...] = ()) -> dict[tuple[str, ...], bool]:
    """Every path of a scene; True for a section, False for a field."""
    found: dict[tuple[str, ...], bool] = {}
    for name in section.model_fields:
        inner, path = section_within(section, name), (*home, name)
        found |= {path: inner is not None} | (known_paths(inner, path) if inner is not None else {})
    return found
