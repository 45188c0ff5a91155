"""Gearboxes as REXS models of version 1.4: shafts, gears and loads put together as JSON, and two stages as XML."""

import json
from math import cos, pi, sin

from tests.extensions.rexs import paper_model as rexs


def two_stages() -> str:
    """20/40 teeth of module 4 mm from shaft 2 to 3, again from 3 to 40; 100 N m and 1000 rpm on shaft 2."""
    sizes = [("normal_module", 4.0, "mm"), ("helix_angle_reference_diameter", 0.0, "deg"), ("face_width", 40.0, "mm")]
    flank = ("addendum_modification_coefficient", 0.0), ("normal_pressure_angle", 20.0, "deg")
    shafts = [(1, "gear_unit"), (2, "shaft", ("rotational_speed", 1000.0, "1 / min")), (3, "shaft"), (40, "shaft")]
    parts = [*shafts, (20, "external_load", ("torque_around_u_axis", 100.0, "N m"))]
    parts += [(number, "cylindrical_stage", ("center_distance", 120.0, "mm")) for number in (4, 50)]
    relations = [("assembly", {"assembly": 1, "part": part}) for part in (2, 3, 40, 4, 50)]
    relations += [("assembly", {"assembly": 2, "part": 20})]
    relations += [("stage", {"stage": stage, "gear_1": one, "gear_2": two}) for stage, one, two in STAGES]
    for number, teeth, shaft, left in ((5, 20, 2, 7), (6, 40, 3, 9), (51, 20, 3, 61), (52, 40, 40, 63)):
        parts.append((number, "cylindrical_gear", ("number_of_teeth", teeth), *sizes))
        parts += [(side, "cylindrical_gear_flank", *flank) for side in (left, left + 1)]
        relations.append(("assembly", {"assembly": shaft, "part": number}))
        relations.append(("flank", {"gear": number, "left": left, "right": left + 1}))
    model = {"version": "1.4", "applicationId": "tests", "applicationVersion": "", "date": "2026-11-28"}
    model["components"] = [rexs.new_component(*each) for each in parts]
    model["relations"] = [rexs.relation(place, kind, **roles) for place, (kind, roles) in enumerate(relations, 1)]
    # Tests put attributes behind the beginning of a component.
    return rexs.as_xml({"model": model}).decode().replace('type="shaft" />', 'type="shaft"></component>')


STAGES = (4, 5, 6), (50, 51, 52)


class Box:
    """Components and relations of a gearbox; gears are spur, of module 4 mm and 50 mm wide unless given."""

    def __init__(self):
        self.components, self.relations = [], []
        self.part(1, "gear_casing")

    def part(self, number, kind, **attributes):
        listed = [
            {"id": name, "unit": unit, "floating_point_array" if isinstance(value, list) else "value": value}
            for name, (value, unit) in attributes.items()
        ]
        self.components.append({"id": number, "type": kind, "attributes": listed})
        return self

    def relate(self, kind, **roles):
        refs = [{"role": role, "id": number} for role, number in roles.items()]
        self.relations.append({"id": len(self.relations) + 1, "type": kind, "refs": refs})
        return self

    def shaft(self, number, speed=None, **more):
        stated = {"rotational_speed": (speed, "1 / min")} if speed else {}
        return self.part(number, "shaft", **stated, **more)

    def load(self, number, shaft, torque=None, **more):
        stated = {"torque_around_u_axis": (torque, "N m")} if torque is not None else {}
        self.part(number, "external_load", transmits_torque=("true", "none"), **stated, **more)
        return self.relate("assembly", assembly=shaft, part=number)

    def gear(self, number, teeth, shaft, at=(0.0, 0.0), kind="cylindrical_gear", **more):
        """A gear on a shaft, its centre `at` v and w, mm."""
        sizes = {"normal_module": (4.0, "mm"), "face_width": (50.0, "mm"), "normal_pressure_angle": (20.0, "deg")}
        sizes |= {"addendum_modification_coefficient": (0.0, "none"), "number_of_teeth": (teeth, "none")}
        place = {"support_vector": ([0.0, *at], "mm"), "u_axis_vector": ([1.0, 0.0, 0.0], "mm")}
        self.part(number, kind, **{**sizes, **place, **more})
        return self.relate("assembly", assembly=shaft, part=number)

    def stage(self, number, one, other, distance):
        self.part(number, "cylindrical_stage", center_distance=(distance, "mm"))
        return self.relate("stage", stage=number, gear_1=one, gear_2=other)

    def couple(self, number, one, other, kind="coupling", **more):
        self.part(number, kind, **more)
        return self.relate("side", assembly=number, inner_part=one, outer_part=other)

    def planetary(self, home=900, angles=(0, 120, 240), teeth=(17, 22, 61), **of_planets):
        """A set of shafts `home` + 1 (sun), + 2 (ring) and + 3 (carrier) and gears + 11, + 12; planets from + 20 on."""
        distance = 2.0 * (teeth[0] + teeth[1])
        self.part(home, "planetary_stage").part(home + 4, "planet_carrier")
        for number in (1, 2, 3):
            self.shaft(home + number)
        self.gear(home + 11, teeth[0], home + 1)
        self.gear(home + 12, teeth[2], home + 2, kind="ring_gear", outer_diameter=(280.0, "mm"))
        self.relate("assembly", assembly=home, part=home + 4)
        self.relate("assembly", assembly=home + 4, part=home + 3)
        self.relate("planet_carrier_shaft", planetary_stage=home, shaft=home + 3)
        for place, degrees in enumerate(angles):
            angle = degrees * pi / 180.0
            first = home + 20 + 10 * place
            self.shaft(first)
            own = {name: values[place] for name, values in of_planets.items()}
            self.gear(first + 1, teeth[1], first, (distance * sin(angle), distance * cos(angle)), **own)
            self.relate("planet_shaft", planetary_stage=home, shaft=first)
            self.stage(first + 2, home + 11, first + 1, distance).stage(first + 3, first + 1, home + 12, distance)
            for each in (2, 3):
                self.relate("assembly", assembly=home, part=first + each)
        return self

    def pair(self, number, shafts, teeth, places, **more):
        """A stage with the gears `number` + 1 and + 2; `places` of their centres."""
        for which, (shaft, count, at) in enumerate(zip(shafts, teeth, places), start=1):
            self.gear(number + which, count, shaft, at, **more)
        return self.stage(number, number + 1, number + 2, 2.0 * sum(teeth))

    def __str__(self):
        tree = {"version": "1.4", "applicationId": "tests", "date": "2026-11-30"}
        return json.dumps({"model": {**tree, "relations": self.relations, "components": self.components}})
