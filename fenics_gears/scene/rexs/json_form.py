"""The JSON form of REXS, ``.rexsj``."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

from fenics_gears.scene.rexs.model import Attribute, Component, Model, ModelError, Relation, attributes_by_name, checked_model, readable


def model_of_json(content: bytes) -> Model:
    """The model that a JSON file holds. Raises ModelError where it is none."""
    try:
        # Numbers stay texts, so that a scene has the digits that the file has.
        tree = json.loads(content.decode("utf-8-sig"), parse_float=str, parse_int=str, parse_constant=str)
    except (ValueError, RecursionError) as error:
        raise ModelError(f"is not valid JSON: {error}") from None
    model = _needed(tree, "model", Mapping, "the file")
    spectrum = _given(model, "load_spectrum", Mapping, "the model") or {}
    return checked_model(
        _text(model, "version", "the model"),
        readable(f"{model.get('applicationId', '')} {model.get('applicationVersion', '')}"),
        readable(str(model.get("date", ""))),
        [_component(each) for each in _given(model, "components", list, "the model") or []],
        [_relation(each) for each in _given(model, "relations", list, "the model") or []],
        dict(_load_case(each) for each in _given(spectrum, "load_cases", list, "the load spectrum") or []),
    )


def _given(holder: Any, name: str, kind: type, owner: str) -> Any:
    """What is there by a name, None where nothing is. Raises ModelError where it is of another kind."""
    value = holder.get(name) if isinstance(holder, Mapping) else None
    if value is not None and not isinstance(value, kind):
        raise ModelError(f'has a "{name}" in {owner} that is not {_WORDS[kind]}')
    return value


_WORDS = {Mapping: "an object", list: "a list", str: "a text or a number"}


def _needed(holder: Any, name: str, kind: type, owner: str) -> Any:
    value = _given(holder, name, kind, owner)
    if value is None:
        raise ModelError(f'is JSON, but no REXS: {owner} has no "{name}"')
    return value


def _text(holder: Any, name: str, owner: str) -> str:
    return readable(_needed(holder, name, str, owner))


def _number(holder: Any, name: str, owner: str) -> int:
    text = _text(holder, name, owner)
    try:
        return int(text)
    except ValueError:
        raise ModelError(f'has {owner} whose {name} is "{text}", not a whole number') from None


def _component(tree: Any) -> Component:
    number = _number(tree, "id", "a component")
    owner = f"component {number}"
    return Component(number, _text(tree, "type", owner), readable(_given(tree, "name", str, owner)), _attributes(tree, owner))


def _attributes(tree: Any, owner: str) -> dict[str, Attribute]:
    attributes = (_attribute(each, owner) for each in _given(tree, "attributes", list, owner) or [])
    return attributes_by_name([each for each in attributes if each is not None], owner)


def _attribute(tree: Any, owner: str) -> Attribute | None:
    """The attribute; its value has the name of its type. None where it is null or empty."""
    name = _text(tree, "id", f"an attribute of {owner}")
    unit = readable(_given(tree, "unit", str, owner))
    value = next((value for key, value in tree.items() if key not in ("id", "unit")), None)
    if value is None or value == "":
        return None
    if isinstance(value, bool):
        value = "true" if value else "false"
    return Attribute(name, unit, readable(value) if isinstance(value, str) else None)


def _relation(tree: Any) -> Relation:
    roles = {_text(each, "role", "a relation"): _number(each, "id", "a relation") for each in _needed(tree, "refs", list, "a relation")}
    order = None if _given(tree, "order", str, "a relation") is None else _number(tree, "order", "a relation")
    return Relation(_text(tree, "type", "a relation"), roles, order)


def _load_case(tree: Any) -> tuple[str, dict[int, dict[str, Attribute]]]:
    name = _text(tree, "id", "a load case")
    components = _given(tree, "components", list, f"load case {name}") or []
    numbers = [_number(each, "id", f"load case {name}") for each in components]
    return name, {number: _attributes(each, f"load case {name}, component {number}") for number, each in zip(numbers, components)}
