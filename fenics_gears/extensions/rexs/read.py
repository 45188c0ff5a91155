"""Reading a REXS file of any of its three forms, found by its content, as the tree of its JSON form."""

import io
import json
import struct
import zipfile
import zlib
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

from fenics_gears import SceneError, user_file

from .model import ModelError, RexsModel, checked_model

# Bytes: models of whole gearboxes have some hundred kilobytes, with results some megabytes.
LARGEST = 200 * user_file.MEGABYTE
ENDINGS = (".rexs", ".rexsj", ".rexs.xml", ".rexs.json")
PACKED = ".rexsz"


def read_model(path: Path) -> RexsModel:
    """The model of a file ``.rexs`` (XML), ``.rexsj`` (JSON) or ``.rexsz`` (either, in a ZIP archive).

    Raises SceneError where it cannot be read or is none.
    """
    try:
        content = user_file.content_of(path, LARGEST)
        if _is_archive(content):
            return _model(_packed(content))
        if path.suffix == PACKED and _start(content) not in b"{[<":
            raise ModelError(f"is no ZIP archive, as {PACKED} files are, nor XML or JSON")
        return _model(content)
    except user_file.Missing as problem:
        raise SceneError(f"{path}: {problem}. REXS files end in .rexs, .rexsj or .rexsz.") from None
    except (user_file.Unreadable, ModelError) as problem:
        raise SceneError(f"{path}: {problem}.\nNothing was written.") from None


def _model(content: bytes) -> RexsModel:
    if len(content) > LARGEST:
        raise ModelError(f"has more than {LARGEST // 1_000_000} MB, which is not read")
    start = _start(content)
    if not start:
        raise ModelError("is empty")
    return checked_model(_of_json(content) if start in b"{[" else _of_xml(content))


def _is_archive(content: bytes) -> bool:
    try:
        return zipfile.is_zipfile(io.BytesIO(content))
    except ValueError:
        # It has an archive's end, whose figures are damaged.
        return True


def _start(content: bytes) -> bytes:
    """The first character after a byte order mark and blanks; nothing where there is none."""
    return content.lstrip(b"\xef\xbb\xbf \t\r\n")[:1]


def _packed(content: bytes) -> bytes:
    """The one model in an archive. Operating systems add files of their own, whose names begin with a dot."""
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            every = (name for name in archive.namelist() if name.endswith(ENDINGS))
            models = [name for name in every if not Path(name).name.startswith(".")]
            if len(models) != 1:
                holds = ", ".join(models) or "none"
                raise ModelError(f"is a ZIP archive that must hold one .rexs or .rexsj file, but holds: {holds}")
            with archive.open(models[0]) as file:
                return file.read(LARGEST + 1)
    except ModelError:
        raise
    except RuntimeError as error:
        # It is encrypted, or packed in a way that the library does not know.
        remedy = "Unpack it by another program, and name the file in it"
        raise ModelError(f"is a ZIP archive that cannot be unpacked: {error}. {remedy}") from None
    # Damage reaches the library as errors of many types: places before the file's beginning, names that are no text.
    except (zipfile.BadZipFile, zlib.error, EOFError, ValueError, OSError, struct.error) as error:
        raise ModelError(f"is a ZIP archive that cannot be unpacked: it is damaged ({error}). Pack it again") from None


def _of_json(content: bytes) -> Any:
    """The tree; its numbers stay texts, so that a scene has the digits that the file has."""
    try:
        tree = json.loads(content.decode("utf-8-sig"), parse_float=str, parse_int=str, parse_constant=str)
    except (ValueError, RecursionError) as error:
        raise ModelError(f"is not valid JSON: {error}") from None
    if not isinstance(tree, dict) or "model" not in tree:
        raise ModelError('is JSON, but no REXS: the file has no "model"')
    return tree["model"]


def _of_xml(content: bytes) -> Any:
    try:
        root = ElementTree.fromstring(content, parser=ElementTree.XMLParser(target=_NoDocumentType()))
    except ModelError:
        raise
    except (ElementTree.ParseError, LookupError, ValueError) as error:
        raise ModelError(f"is not valid XML: {error}") from None
    if _name(root) != "model":
        raise ModelError(f"is XML, but no REXS: its root is <{_name(root)}>, not <model>")
    components = [_component(each) for each in _within(root, "components", "component")]
    related = _within(root, "relations", "relation")
    relations = [{**each.attrib, "refs": [ref.attrib for ref in _within(each, "ref")]} for each in related]
    spectra = list(_within(root, "load_spectrum"))
    cases = []
    for spectrum in spectra:
        # Where there are several spectra, a case has the name of its own before its own.
        before = f"{spectrum.get('id')}." if len(spectra) > 1 else ""
        for case in _within(spectrum, "load_case"):
            loaded = [_component(each) for each in _within(case, "component")]
            cases.append({"id": f"{before}{case.get('id')}", "components": loaded})
    return {**root.attrib, "components": components, "relations": relations, "load_spectrum": {"load_cases": cases}}


class _NoDocumentType(ElementTree.TreeBuilder):
    """REXS has no document type declaration; entities, which one could declare, can make a small file fill the
    memory."""

    def doctype(self, name: str, pubid: str | None, system: str | None) -> None:
        raise ModelError("has a document type declaration (<!DOCTYPE ...>), which REXS has not; remove it")


def _name(element: ElementTree.Element) -> str:
    return element.tag.rpartition("}")[2]


def _within(element: ElementTree.Element, *names: str) -> Iterator[ElementTree.Element]:
    for child in element:
        if _name(child) == names[0]:
            yield from _within(child, *names[1:]) if len(names) > 1 else (child,)


def _component(element: ElementTree.Element) -> dict[str, Any]:
    attributes = [{**each.attrib, "value": _value(each)} for each in _within(element, "attribute")]
    return {**element.attrib, "attributes": attributes}


def _value(element: ElementTree.Element) -> Any:
    """Text; an array's columns, or its code and its text; a matrix's rows."""
    if not len(element):
        return (element.text or "").strip()
    inner = element[0]
    if "code" in inner.attrib:
        return {"code": inner.get("code"), "value": (inner.text or "").strip()}
    return [_value(each) for each in (inner if _name(inner) in ("array", "matrix") else element)]
