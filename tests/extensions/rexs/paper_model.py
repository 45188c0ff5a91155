"""The paper's pair as a REXS model, the JSON tree of REXS 1.7, and models as files of each form."""

import copy
import io
import json
import zipfile
from xml.etree import ElementTree

from tests.conftest import DEMOS

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
    return {"id": name, "unit": unit, KINDS[type(value)]: value}


def new_component(number, kind, *attributes, name=""):
    named = {"name": name} if name else {}
    return {"id": number, "type": kind, **named, "attributes": [attribute(*each) for each in attributes]}


def relation(number, kind, order=None, **roles):
    ordered = {"order": int(order)} if order else {}
    return {
        "id": number,
        "type": kind,
        **ordered,
        "refs": [{"id": value, "role": role} for role, value in roles.items()],
    }


def paper_model():
    """The pair of demos/lundvall2004.rexs, with the torque on the output shaft and the speed of the input shaft."""
    root = ElementTree.parse(DEMOS / "lundvall2004.rexs").getroot()
    relations = [
        relation(
            int(each.get("id")),
            each.get("type"),
            each.get("order"),
            **{ref.get("role"): int(ref.get("id")) for ref in each},
        )
        for each in root.find("relations")
    ]
    components = [
        new_component(int(each.get("id")), each.get("type"), *map(_read_attribute, each), name=each.get("name"))
        for each in root.find("components")
    ]
    head = {
        "version": "1.7",
        "applicationId": "fenics_gears tests",
        "applicationVersion": "1",
        "date": root.get("date"),
    }
    return {"model": {**head, "relations": relations, "components": components}}


def _read_attribute(element):
    array = element.find("array")
    value = json.loads(element.text) if array is None else [json.loads(number.text) for number in array]
    return element.get("id"), value, element.get("unit")


def component(model, number):
    return next(each for each in model["model"]["components"] if each["id"] == number)


def with_value(model, number, name, value, unit="none"):
    """The model with an attribute of a component set; None takes it out."""
    changed = copy.deepcopy(model)
    holder = component(changed, number)
    others = [each for each in holder["attributes"] if each["id"] != name]
    holder["attributes"] = others + ([] if value is None else [attribute(name, value, unit)])
    return changed


def with_values(model, *changes):
    for change in changes:
        model = with_value(model, *change)
    return model


def with_component(model, number, kind, *attributes, **relations):
    """The model with one more component, in relations given by their type as dictionaries of roles."""
    changed = copy.deepcopy(model)
    changed["model"]["components"].append(new_component(number, kind, *attributes))
    for place, (kind, roles) in enumerate(relations.items()):
        changed["model"]["relations"].append(relation(1000 * number + place, kind, **roles))
    return changed


def on_flanks(model, number, flanks):
    """The model whose `flanks` have a component as their modification."""
    changed = copy.deepcopy(model)
    for flank in flanks:
        given = relation(10 * number + flank, "reference", origin=flank, referenced=number)
        changed["model"]["relations"].append(given)
    return changed


def as_json(model):
    return json.dumps(model, ensure_ascii=False, indent=1).encode()


def as_xml(model, namespace=""):
    tree = model["model"]
    root = ElementTree.Element(
        "model", {name: tree[name] for name in ("version", "applicationId", "applicationVersion", "date")}
    )
    if namespace:
        root.set("xmlns", namespace)
    relations = ElementTree.SubElement(root, "relations")
    for each in tree["relations"]:
        holder = ElementTree.SubElement(
            relations, "relation", {key: str(each[key]) for key in ("id", "type", "order") if key in each}
        )
        for reference in each["refs"]:
            ElementTree.SubElement(holder, "ref", {key: str(value) for key, value in reference.items()})
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
    """A .rexsz file of files, each a name and its content."""
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in files:
            archive.writestr(name, data)
    return content.getvalue()
