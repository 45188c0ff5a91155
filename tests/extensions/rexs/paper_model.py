"""The paper's pair as a REXS model, and models as files of each form, written here from the specification's description
of them.

A model is the JSON tree of REXS 1.7; `as_xml` writes the same in the XML form.
"""

import copy
import io
import json
import zipfile
from xml.etree import ElementTree

KINDS = {bool: "boolean", int: "integer", float: "floating_point", str: "string", list: "floating_point_array"}

STAGE, PINION, WHEEL, MATERIAL, LOAD, SHAFT, OUTPUT_SHAFT = 4, 5, 6, 11, 14, 2, 3
PINION_FLANKS, WHEEL_FLANKS, PINION_DATA, WHEEL_DATA, PINION_TOOL, WHEEL_TOOL, SETTINGS = (
    (7, 8),
    (9, 10),
    12,
    13,
    15,
    16,
    17,
)


def attribute(name, value, unit="none"):
    """An attribute of the kind that its value has."""
    return {"id": name, "unit": unit, KINDS[type(value)]: value}


def _component(number, kind, *attributes, name=""):
    named = {"name": name} if name else {}
    return {"id": number, "type": kind, **named, "attributes": [attribute(*each) for each in attributes]}


def _relation(number, kind, order=None, **roles):
    ordered = {"order": order} if order else {}
    return {
        "id": number,
        "type": kind,
        **ordered,
        "refs": [{"id": value, "role": role} for role, value in roles.items()],
    }


def _gear(number, name, teeth, tip, root, bore):
    return _component(
        number, "cylindrical_gear", ("normal_module", 4.5, "mm"), ("number_of_teeth", teeth),
        ("helix_angle_reference_diameter", 0.0, "deg"),
        ("face_width", 15.0, "mm"), ("tip_diameter", tip, "mm"), ("root_diameter", root, "mm"),
        ("inner_diameter", bore, "mm"), name=name,
    )  # fmt: skip


def _flank(number, shift):
    return _component(
        number,
        "cylindrical_gear_flank",
        ("normal_pressure_angle", 20.0, "deg"),
        ("addendum_modification_coefficient", shift),
    )


def _tool(number):
    return _component(
        number, "rack_shaped_tool", ("addendum_coefficient_reference_profile", 1.25), ("tip_radius_factor", 0.38)
    )


def paper_model():
    """The pair of demos/lundvall2004.toml between two shafts, with the torque on the output shaft and the speed of the
    input shaft."""
    components = [
        _component(1, "gear_unit", ("support_vector", [0.0, 0.0, 0.0], "mm")),
        _component(SHAFT, "shaft", ("rotational_speed", 750.0, "1 / min"), name="input shaft"),
        _component(OUTPUT_SHAFT, "shaft", name="output shaft"),
        _component(STAGE, "cylindrical_stage", ("center_distance", 91.5, "mm"), name="test stage"),
        _gear(PINION, "pinion", 16, 82.64, 62.50, 30.0),
        _gear(WHEEL, "wheel", 24, 118.64, 98.37, 40.0),
        *(_flank(number, 0.196) for number in PINION_FLANKS),
        *(_flank(number, 0.125) for number in WHEEL_FLANKS),
        _component(
            MATERIAL,
            "material",
            ("elastic_modulus", 206000.0, "N / mm^2"),
            ("poisson_ratio", 0.3),
            ("density", 7.85, "kg / dm^3"),
            name="steel",
        ),
        _component(PINION_DATA, "cylindrical_stage_gear_data"),
        _component(WHEEL_DATA, "cylindrical_stage_gear_data"),
        _component(
            LOAD, "external_load", ("torque_around_u_axis", -437.0, "N m"), ("transmits_torque", True), name="brake"
        ),
        _tool(PINION_TOOL),
        _tool(WHEEL_TOOL),
        _component(SETTINGS, "cylindrical_gear_manufacturing_settings"),
    ]
    relations = [
        _relation(1, "assembly", assembly=1, part=SHAFT),
        _relation(2, "assembly", assembly=1, part=OUTPUT_SHAFT),
        _relation(3, "assembly", assembly=1, part=STAGE),
        _relation(4, "assembly", assembly=SHAFT, part=PINION),
        _relation(5, "assembly", assembly=OUTPUT_SHAFT, part=WHEEL),
        _relation(6, "assembly", assembly=OUTPUT_SHAFT, part=LOAD),
        _relation(7, "stage", stage=STAGE, gear_1=PINION, gear_2=WHEEL),
        _relation(8, "stage_gear_data", stage=STAGE, gear=PINION, stage_gear_data=PINION_DATA),
        _relation(9, "stage_gear_data", stage=STAGE, gear=WHEEL, stage_gear_data=WHEEL_DATA),
        _relation(10, "flank", gear=PINION, left=PINION_FLANKS[0], right=PINION_FLANKS[1]),
        _relation(11, "flank", gear=WHEEL, left=WHEEL_FLANKS[0], right=WHEEL_FLANKS[1]),
        _relation(12, "reference", origin=PINION, referenced=MATERIAL),
        _relation(13, "reference", origin=WHEEL, referenced=MATERIAL),
    ]
    for tool, flanks in ((PINION_TOOL, PINION_FLANKS), (WHEEL_TOOL, WHEEL_FLANKS)):
        relations += [
            _relation(
                20 + flank, "manufacturing_step", order=1, workpiece=flank, tool=tool, manufacturing_settings=SETTINGS
            )
            for flank in flanks
        ]
    return {
        "model": {
            "version": "1.7", "applicationId": "fenics_gears tests", "applicationVersion": "1",
            "date": "2026-01-01T00:00:00+00:00",
            "relations": relations, "components": components,
        }
    }  # fmt: skip


def component(model, number):
    """The component of a number."""
    return next(each for each in model["model"]["components"] if each["id"] == number)


def with_value(model, number, name, value, unit="none"):
    """The model with an attribute of a component set; None takes it out."""
    changed = copy.deepcopy(model)
    holder = component(changed, number)
    others = [each for each in holder["attributes"] if each["id"] != name]
    holder["attributes"] = others + ([] if value is None else [attribute(name, value, unit)])
    return changed


def with_values(model, *changes):
    """The model with several attributes set, each as `with_value` takes it."""
    for change in changes:
        model = with_value(model, *change)
    return model


def with_component(model, number, kind, *attributes, **relations):
    """The model with one more component, in relations given by their type as dictionaries of roles."""
    changed = copy.deepcopy(model)
    changed["model"]["components"].append(_component(number, kind, *attributes))
    for place, (relation, roles) in enumerate(relations.items()):
        changed["model"]["relations"].append(_relation(1000 * number + place, relation.rstrip("_"), **roles))
    return changed


def as_json(model):
    """The content of a .rexsj file."""
    return json.dumps(model, ensure_ascii=False, indent=1).encode()


def as_xml(model, namespace=""):
    """The content of a .rexs file, whose numbers have the digits of the JSON form."""
    tree = model["model"]
    root = ElementTree.Element(
        "model", {name: tree[name] for name in ("version", "applicationId", "applicationVersion", "date")}
    )
    if namespace:
        root.set("xmlns", namespace)
    relations = ElementTree.SubElement(root, "relations")
    for each in tree["relations"]:
        relation = ElementTree.SubElement(
            relations, "relation", {key: str(each[key]) for key in ("id", "type", "order") if key in each}
        )
        for reference in each["refs"]:
            ElementTree.SubElement(relation, "ref", {key: str(value) for key, value in reference.items()})
    components = ElementTree.SubElement(root, "components")
    for each in tree["components"]:
        _xml_component(components, each)
    for case in tree.get("load_spectrum", {}).get("load_cases", []):
        spectrum = root.find("load_spectrum")
        spectrum = ElementTree.SubElement(root, "load_spectrum", {"id": "1"}) if spectrum is None else spectrum
        loaded = ElementTree.SubElement(spectrum, "load_case", {"id": str(case["id"])})
        for each in case["components"]:
            _xml_component(loaded, each)
    ElementTree.indent(root)
    return ElementTree.tostring(root, encoding="utf-8", xml_declaration=True)


def _xml_component(parent, tree):
    holder = ElementTree.SubElement(
        parent, "component", {key: str(tree[key]) for key in ("id", "type", "name") if key in tree}
    )
    for each in tree["attributes"]:
        name, unit, value = (
            each["id"],
            each["unit"],
            next(value for key, value in each.items() if key not in ("id", "unit")),
        )
        element = ElementTree.SubElement(holder, "attribute", {"id": name, "unit": unit})
        if isinstance(value, dict):
            ElementTree.SubElement(element, "array", {"code": value["code"]}).text = value["value"]
        elif isinstance(value, list):
            array = ElementTree.SubElement(element, "array")
            for number in value:
                ElementTree.SubElement(array, "c").text = str(number)
        else:
            element.text = str(value).lower() if isinstance(value, bool) else str(value)


def as_zip(*files):
    """The content of a .rexsz file that holds files, each a name and its content."""
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in files:
            archive.writestr(name, data)
    return content.getvalue()
