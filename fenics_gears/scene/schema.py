"""The sections and fields of a scene file, with what each allows; those of an effect are in its own module.

Ranges are generous: what is physically possible is allowed. ``geometry`` checks whether teeth and diameters make a
    gear.
"""

from __future__ import annotations

import functools
import re
from typing import Any, Literal, Optional

from pydantic import BaseModel, Field, create_model

from fenics_gears.effects import top_level
from fenics_gears.elasticity.elements import ELEMENTS
from fenics_gears.inputs.fields import (
    Allowed,
    Section,
    choice,
    quantity,
    refused,
    section_within,
    switch,
    text,
    whole_number,
)
from fenics_gears.inputs.written import as_written
from fenics_gears.scene import defaults
from fenics_gears.scene.data import HUNTING_TOOTH_PERIOD
from fenics_gears.scene.gear_schema import Gears


class Load(Section):
    """``[load]``: the mean torque on the end of the output shaft, by exactly one of these fields; the gears pass it on
    without losses."""

    wheel_torque: Optional[float] = quantity(
        "-1e12 N m",
        "1e12 N m",
        "437 N m",
        meaning=(
            "torque that resists the wheel's rotation; where it is negative, the wheel drives, which needs"
            " `[coast_flanks]`"
        ),
        otherwise="from `pinion_torque` or `power`",
    )
    pinion_torque: Optional[float] = quantity(
        "-1e12 N m",
        "1e12 N m",
        "291 N m",
        meaning="torque that drives the pinion; the wheel has it times z2/z1",
        otherwise="`wheel_torque` or `power` is given",
    )
    power: Optional[float] = quantity(
        "-1e9 kW",
        "1e9 kW",
        "20 kW",
        meaning="power that goes through the pair at the speed of `[motion]`, which is then required",
        otherwise="`wheel_torque` or `pinion_torque` is given",
    )


WHOLE_PERIOD = {HUNTING_TOOTH_PERIOD: None}


class Motion(Section):
    """``[motion]``: the speed, given as mesh frequency or as pinion speed, and the length of the run. A scene without
    ``[inertia]`` needs none of it."""

    mesh_frequency: Optional[float] = quantity(
        "1e-6 Hz",
        "1e6 Hz",
        "200 Hz",
        meaning="mesh frequency (pinion speed times number of teeth)",
        otherwise="from `pinion_speed`. With `[inertia]` one of the two is required; otherwise a mesh cycle lasts 1 s",
    )
    pinion_speed: Optional[float] = quantity(
        "1e-6 rpm",
        "1e6 rpm",
        "750 rpm",
        meaning="nominal speed of the pinion, also in 1/min",
        otherwise="from `mesh_frequency`",
    )
    mesh_cycles: Optional[int] = whole_number(
        1,
        1_000_000,
        30,
        meaning="number of mesh cycles of the run",
        otherwise=(
            'required with `[inertia]`, or `settling_time` in its place; without it 1, or `"hunting tooth period"`'
            " where mesh cycles differ"
        ),
        words=WHOLE_PERIOD,
    )
    settling_time: Optional[float] = quantity(
        "0 s",
        "1e6 s",
        "25 ms",
        meaning=(
            "time for the start to die down, in place of `mesh_cycles`: as many mesh cycles as it has at the mesh"
            " frequency are run, rounded up, and the recorded ones after them; a sweep of the speed then runs no longer"
            " than each speed needs"
        ),
        otherwise="`mesh_cycles` says how long",
    )
    recorded_cycles: Optional[int] = whole_number(
        1,
        1_000_000,
        2,
        meaning=(
            "number of mesh cycles at the end of the run whose contact fields are stored and which pictures show;"
            " curves are stored for the whole run"
        ),
        otherwise=(
            '2; all with `[speed_ramp]` or `mesh_cycles = "hunting tooth period"`, but contact fields of no more than'
            " 1 GB"
        ),
        words=WHOLE_PERIOD,
    )


# For a tooth pair.
MOST_CONTACT_NODES = 1000


class Accuracy(Section):
    """``[accuracy]``: element sizes, contact nodes, time steps and the model of the mesh. Fields that are left out are
    derived from the scene."""

    target: Optional[float] = quantity(
        "0.05 %",
        "50 %",
        "1 %",
        meaning=(
            "largest numerical error allowed in the curve and in the peak-to-peak value of the transmission error, in"
            " three dimensions also in line load and load factors; test runs find the cheapest settings of this section"
            " that keep it"
        ),
        otherwise="no test runs; each setting has its given or default value",
    )
    element: Optional[Literal[tuple(ELEMENTS)]] = choice(
        *ELEMENTS,
        meaning=(
            "finite element: triangle (P) or quadrilateral (Q) of first or second order; `Q1 incompatible`, with"
            " Wilson's incompatible modes, is the paper's"
        ),
        otherwise="`P2`",
    )
    flank_element_size: Optional[float] = quantity(
        "1e-6 mm",
        "1 m",
        "0.08 mm",
        meaning="size of the elements on the flank",
        otherwise=(
            f"1/{defaults.ELEMENTS_PER_HALF_WIDTH:g} of the smallest Hertz half-width of one pair under the whole load,"
            f" 1/{defaults.ELEMENTS_PER_HALF_WIDTH_ON_FACE:g} of it in three-dimensional scenes, but at least"
            f" 1/{1.0 / defaults.FINEST_ELEMENT:g} and at most 1/{1.0 / defaults.COARSEST_ELEMENT:g} of the module"
        ),
    )
    body_element_size: Optional[float] = quantity(
        "1e-6 mm",
        "10 m",
        "1.3 mm",
        meaning=(
            "size of the largest elements in tooth and rim; the elements of fillets, coast flank and bore are scaled"
            " with it"
        ),
        otherwise="a fixed fraction of the module for each order of element",
    )
    contact_length: Optional[float] = quantity(
        "1e-6 mm",
        "10 m",
        "1.5 mm",
        meaning="length, across the line of action, over which the contact nodes of a tooth pair are spread",
        otherwise="so long that beyond it the gap is larger than the deflection of the teeth",
    )
    contact_nodes: Optional[int] = whole_number(
        2,
        MOST_CONTACT_NODES,
        20,
        meaning="number of contact nodes of a tooth pair",
        otherwise=f"a spacing of {defaults.NODE_SPACING:g} flank elements, or of 1 flank element of first order",
    )
    interpolation: Optional[Literal["averaged", "collocated"]] = choice(
        "averaged",
        "collocated",
        meaning=(
            "displacement of the flank at a contact node: averaged with the node's own function, or taken at the node"
            " alone (collocation)"
        ),
        otherwise="`averaged`",
    )
    elastic_teeth: Optional[int] = whole_number(
        1,
        1000,
        2,
        meaning="teeth that the load on a tooth deflects: 1 that tooth alone, 2 its neighbours too, and so on",
        otherwise="all teeth that can be loaded at the same time",
    )
    steps_per_mesh_cycle: Optional[int] = whole_number(
        2,
        1_000_000,
        100,
        meaning="time steps of a mesh cycle",
        otherwise=(
            f"{defaults.STEPS_PER_MESH_CYCLE}, in three-dimensional scenes {defaults.STEPS_PER_MESH_CYCLE_ON_FACE};"
            f" with `[inertia]` as many as give the highest natural frequency {defaults.STEPS_PER_PERIOD} steps per"
            f" period, at most {defaults.MOST_STEPS_PER_MESH_CYCLE}; with `[inertia]` and rigid flanks"
            f" {defaults.MOST_STEPS_PER_MESH_CYCLE}"
        ),
    )
    slices: Optional[int] = whole_number(
        2,
        1000,
        40,
        meaning=(
            "slices of the common face in which contact is resolved, best a multiple of `layers`; of three-dimensional"
            " scenes"
        ),
        otherwise=(
            f"{defaults.SLICES_OF_A_LAYER} for each of the default layers; with `layers`, the multiple of it nearest to"
            " that number"
        ),
    )
    layers: Optional[int] = whole_number(
        1,
        1000,
        12,
        meaning=(
            "layers of elements of either gear over the common face, of which four or more have the outermost cut in"
            " two; a gear that is wider has more beyond it; of three-dimensional scenes"
        ),
        otherwise=(
            f"a thickness of {defaults.LAYER_THICKNESS:g} modules, in helical pairs at most so thick that the line of"
            f" contact moves by {defaults.LAYER_TURN:g} of the base pitch along the path of contact within a layer,"
            f" {defaults.LAYER_TURN_RELIEVED:g} where both gears have tip relief; at least {defaults.FEWEST_LAYERS}"
            f" layers. With `slices`, {defaults.SLICES_OF_A_LAYER} slices to a layer or fewer, if possible so that"
            " slices end where layers do"
        ),
    )
    condensation: Optional[Literal["once", "every step"]] = choice(
        "once",
        "every step",
        meaning=(
            "`once`: each gear is meshed and condensed once; `every step`: both gears are meshed anew at every"
            " position, as in the paper, which is slow and serves for comparison"
        ),
        otherwise="`once`",
    )
    model: Optional[Literal["elastic", "rigid teeth", "stiffness table", "ISO 6336-1"]] = choice(
        "elastic",
        "rigid teeth",
        "stiffness table",
        "ISO 6336-1",
        meaning=(
            "model of the tooth contact: elastic contact, rigid teeth, a table of the elastic mesh stiffness over phase"
            " and load (quasi-static, frictionless), or c' and c_gamma of ISO 6336-1"
        ),
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
    """``[output]``: results that take additional time or storage."""

    root_stress: bool = switch(
        meaning=(
            "stress along the fillets of the loaded teeth over time, and dynamic factors by force and by stress; see"
            " [stress](stress.md)"
        )
    )
    contact_fields: Optional[bool | int] = Field(
        None,
        json_schema_extra={
            "allowed": AllowedContactFields(
                'true, false, or "last N cycles", such as "last 3 cycles"',
                meaning=(
                    "steps at which pressure, traction and place of every contact node are stored: all, none, or those"
                    " of the last mesh cycles. Stress pictures and pressure maps need them. Replaces"
                    " `motion.recorded_cycles`"
                ),
                otherwise="the last `motion.recorded_cycles`",
            )
        },
    )


class _AlwaysThere(Section):
    title: Optional[str] = text(500, meaning="title in summaries and pictures", otherwise="the name of the file")
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


@functools.cache
def known_paths(section: type[BaseModel] = SceneText, home: tuple[str, ...] = ()) -> dict[tuple[str, ...], bool]:
    """Every path of a scene; True for a section, False for a field."""
    found: dict[tuple[str, ...], bool] = {}
    for name in section.model_fields:
        inner, path = section_within(section, name), (*home, name)
        found |= {path: inner is not None} | (known_paths(inner, path) if inner is not None else {})
    return found
