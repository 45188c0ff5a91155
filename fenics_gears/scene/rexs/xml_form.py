"""The XML form of REXS, ``.rexs``."""

from __future__ import annotations

from collections.abc import Iterator
from xml.etree import ElementTree

from fenics_gears.scene.rexs.model import Attribute, Component, Model, ModelError, Relation, attributes_by_name, checked_model, readable


def model_of_xml(content: bytes) -> Model:
    """The model that an XML file holds. Raises ModelError where it is none."""
    try:
        root = ElementTree.fromstring(content, parser=ElementTree.XMLParser(target=_NoDocumentType()))
    except (ElementTree.ParseError, LookupError, ValueError) as error:
        if isinstance(error, ModelError):
            raise
        raise ModelError(f"is not valid XML: {error}") from None
    if _name(root) != "model":
        raise ModelError(f"is XML, but no REXS: its root is <{_name(root)}>, not <model>")
    return checked_model(
        _needed(root, "version"),
        readable(f"{root.get('applicationId', '')} {root.get('applicationVersion', '')}"),
        readable(root.get("date")),
        (_component(each) for each in _within(root, "components", "component")),
        [_relation(each) for each in _within(root, "relations", "relation")],
        _load_cases(root),
    )


class _NoDocumentType(ElementTree.TreeBuilder):
    """REXS has no document type declaration; entities, which one could declare, can make a small file fill the memory."""

    def doctype(self, name: str, pubid: str | None, system: str | None) -> None:
        raise ModelError("has a document type declaration (<!DOCTYPE ...>), which REXS has not; remove it")


def _name(element: ElementTree.Element) -> str:
    """An element's name without its namespace."""
    return element.tag.rpartition("}")[2]


def _within(element: ElementTree.Element, *names: str) -> Iterator[ElementTree.Element]:
    """All elements below, by the names on the way."""
    for child in element:
        if _name(child) == names[0]:
            yield from _within(child, *names[1:]) if len(names) > 1 else (child,)


def _needed(element: ElementTree.Element, name: str) -> str:
    value = element.get(name)
    if value is None:
        raise ModelError(f"has a <{_name(element)}> without {name}")
    return readable(value)


def _number(element: ElementTree.Element, name: str) -> int:
    text = _needed(element, name)
    try:
        return int(text)
    except ValueError:
        raise ModelError(f'has a <{_name(element)}> whose {name} is "{text}", not a whole number') from None


def _component(element: ElementTree.Element) -> Component:
    number = _number(element, "id")
    return Component(number, _needed(element, "type"), readable(element.get("name")), _attributes(element, f"component {number}"))


def _attributes(element: ElementTree.Element, owner: str) -> dict[str, Attribute]:
    return attributes_by_name((_attribute(each) for each in _within(element, "attribute") if len(each) or (each.text or "").strip()), owner)


def _attribute(element: ElementTree.Element) -> Attribute:
    return Attribute(_needed(element, "id"), readable(element.get("unit")), None if len(element) else readable(element.text))


def _relation(element: ElementTree.Element) -> Relation:
    roles = {_needed(each, "role"): _number(each, "id") for each in _within(element, "ref")}
    return Relation(_needed(element, "type"), roles, _number(element, "order") if "order" in element.attrib else None)


def _load_cases(root: ElementTree.Element) -> dict[str, dict[int, dict[str, Attribute]]]:
    spectra = list(_within(root, "load_spectrum"))
    cases = {}
    for spectrum in spectra:
        for case in _within(spectrum, "load_case"):
            name = _needed(case, "id") if len(spectra) == 1 else f"{_needed(spectrum, 'id')}.{_needed(case, 'id')}"
            cases[name] = {_number(each, "id"): _attributes(each, f"load case {name}, component {each.get('id')}") for each in _within(case, "component")}
    return cases
