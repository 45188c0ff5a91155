"""A REXS file in any of its three forms; which one it is, its content says."""

from __future__ import annotations

import io
import zipfile
import zlib
from pathlib import Path

from fenics_gears.errors import SceneError
from fenics_gears.scene.rexs.json_form import model_of_json
from fenics_gears.scene.rexs.model import Model, ModelError
from fenics_gears.scene.rexs.xml_form import model_of_xml

# The largest that is read, in bytes; models of whole gearboxes have some hundred kilobytes.
LARGEST = 200_000_000
ENDINGS = (".rexs", ".rexsj")
PACKED = ".rexsz"


def read_model(path: Path) -> Model:
    """The model of a file ``.rexs`` (XML), ``.rexsj`` (JSON) or ``.rexsz`` (either, in a ZIP archive).

    Raises SceneError where it cannot be read or is none.
    """
    try:
        with open(path, "rb") as file:
            content = file.read(LARGEST + 1)
        if zipfile.is_zipfile(io.BytesIO(content)):
            return _model(_packed(content))
        if path.suffix == PACKED and _start(content) not in b"{[<":
            raise ModelError(f"is no ZIP archive, as {PACKED} files are, nor XML or JSON")
        return _model(content)
    except FileNotFoundError:
        raise SceneError(f"{path}: there is no such file. REXS files end in .rexs, .rexsj or .rexsz.") from None
    except (OSError, ModelError) as error:
        raise SceneError(f"{path}: {_reason(error)}.\nNothing was written.") from None


def _reason(error: Exception) -> str:
    return f"cannot be read: {error.strerror or error}" if isinstance(error, OSError) else str(error)


def _model(content: bytes) -> Model:
    if len(content) > LARGEST:
        raise ModelError(f"has more than {LARGEST // 1_000_000} MB, which is not read")
    start = _start(content)
    if not start:
        raise ModelError("is empty")
    return model_of_json(content) if start in b"{[" else model_of_xml(content)


def _start(content: bytes) -> bytes:
    """The first character after a byte order mark and blanks; nothing where there is none."""
    return content.lstrip(b"\xef\xbb\xbf \t\r\n")[:1]


def _packed(content: bytes) -> bytes:
    """The one model in an archive; systems put files of their own beside it, whose names begin with a dot."""
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            models = [each for each in archive.infolist() if each.filename.endswith(ENDINGS) and not Path(each.filename).name.startswith(".")]
            if len(models) != 1:
                names = ", ".join(each.filename for each in models) or "none"
                raise ModelError(f"is a ZIP archive that must hold one .rexs or .rexsj file, but holds: {names}")
            with archive.open(models[0]) as file:
                return file.read(LARGEST + 1)
    except (zipfile.BadZipFile, zlib.error, RuntimeError, NotImplementedError, EOFError) as error:
        raise ModelError(f"is a ZIP archive that cannot be unpacked: {error}") from None
