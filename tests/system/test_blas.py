"""OpenBLAS, by what it says that it runs (`openblas_get_corename`), and products of whole numbers, without
round-off."""

import os
import subprocess
import sys

import pytest

from fenics_gears.commands.cli import main
from fenics_gears.system import blas

MODERN, OLD = "fpu sse3 avx avx2 fma", "fpu sse3 avx"
# A process whose OpenBLAS does not know the processor, and takes the kernels of 2004.
UNKNOWING = """
from fenics_gears.system import blas, environment
look = blas.in_another_process
blas.in_another_process = lambda kernels: look(kernels or "Prescott")
environment.prepare()
print(*{each["kernels"] for each in blas.libraries()})
"""


@pytest.fixture
def machine(monkeypatch, tmp_path):
    """A processor with these flags, whose OpenBLAS takes these kernels; returns what was looked for."""
    if not blas.libraries() or not blas.INSTRUCTIONS <= {*blas._processor().get("flags", "").split()}:
        pytest.skip("needs OpenBLAS, and a processor with AVX2 and FMA")
    looked, look = [], blas.in_another_process
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.setattr(blas, "PROCESSORS", tmp_path / "cpuinfo")

    def made(flags, kernels):
        (tmp_path / "cpuinfo").write_text(f"vendor_id\t: GenuineIntel\nflags\t\t: {flags}\n", encoding="ascii")
        monkeypatch.setattr(blas, "in_another_process", lambda tried: looked.append(tried) or look(tried or kernels))
        blas.choice.cache_clear()
        return looked

    yield made
    blas.choice.cache_clear()


def test_a_processor_that_openblas_does_not_know_gets_the_tried_kernels(machine):
    """Found out once, then read from the file."""
    looked = machine(MODERN, "Prescott")
    assert blas.choice().kernels == "Haswell"
    assert "takes Prescott's" in blas.choice().why
    blas.choice.cache_clear()
    assert blas.choice().kernels == "Haswell" and looked == [None, "Haswell"]


@pytest.mark.parametrize(("flags", "by_itself"), [(OLD, "Prescott"), (MODERN, "Haswell")])
def test_openblas_is_left_to_itself_where_its_kernels_suit(machine, flags, by_itself):
    """Others would end the program by an illegal instruction without AVX2."""
    machine(flags, by_itself)
    assert blas.choice().kernels == ""
    assert "chosen by OpenBLAS" in blas.choice().why


@pytest.mark.parametrize("wrong", [None, "Haswell"])
def test_kernels_with_wrong_products_are_not_taken(machine, monkeypatch, wrong):
    """Neither OpenBLAS's own nor the tried ones."""
    machine(MODERN, "Haswell" if wrong is None else "Prescott")
    look = blas.in_another_process

    def looked(kernels):
        return [each | {"exact": each["exact"] and kernels != wrong} for each in look(kernels)]

    monkeypatch.setattr(blas, "in_another_process", looked)
    assert blas.choice().kernels == ("Haswell" if wrong is None else "")
    assert "wrong" in blas.choice().why


def test_a_wrong_product_is_found(monkeypatch):
    """One entry of one product that is wrong by one."""
    files = [each["file"] for each in blas.libraries()]
    if not files:
        pytest.skip("needs OpenBLAS")
    assert all(blas.exact(file) for file in files)
    product, integer = blas._product(blas.ctypes.CDLL(files[0]))

    def wrong(*arguments):
        product(*arguments)
        first = blas.ctypes.cast(arguments[-2], blas.ctypes.POINTER(blas.ctypes.c_double))
        first[0] += arguments[2]._obj.value == blas.SIZES[-1][0]

    monkeypatch.setattr(blas, "_product", lambda library: (wrong, integer))
    assert not blas.exact(files[0])


@pytest.mark.parametrize(("given", "kernels"), [(None, "Haswell"), ("Prescott", "Prescott")])
def test_kernels_are_chosen_before_the_library_is_loaded(machine, tmp_path, given, kernels):
    """The library itself; a user's own choice is left alone."""
    environment = {**os.environ, "XDG_CACHE_HOME": str(tmp_path)}
    environment.pop(blas.VARIABLE, None)
    environment |= {blas.VARIABLE: given} if given else {}
    command = [sys.executable, "-P", "-c", UNKNOWING]
    assert subprocess.run(command, env=environment, capture_output=True, text=True).stdout == f"{kernels}\n"


def test_the_version_says_which_kernels_and_why(machine, monkeypatch, capsys):
    """Each library's file, and who chose its kernels."""
    machine(MODERN, "Haswell")
    monkeypatch.delenv(blas.VARIABLE, raising=False)
    assert main(["--version", "-v"]) == 0
    text = capsys.readouterr().out
    assert all(each["file"] in text and f"kernels for {each['kernels']}" in text for each in blas.libraries())
    assert text.endswith("kernels: chosen by OpenBLAS\n")
    monkeypatch.setenv(blas.VARIABLE, "Zen")
    assert blas.said() == "OPENBLAS_CORETYPE=Zen, set by the user"
