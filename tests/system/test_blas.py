"""OpenBLAS, by what it says that it runs (`openblas_get_corename`)."""

import os
import subprocess
import sys

import pytest

from fenics_gears.commands.cli import main
from fenics_gears.system import blas

MODERN, OLD = "fpu sse3 avx avx2 fma", "fpu sse3 avx"
# A process whose OpenBLAS does not know the processor, and would take the kernels of 2004.
UNKNOWING = """
from fenics_gears.system import blas, environment
blas.in_another_process = lambda: [{"kernels": "Prescott"}]
environment.prepare()
print(*{each["kernels"] for each in blas.libraries()})
"""


@pytest.fixture
def machine(monkeypatch, tmp_path):
    """A processor with these flags, whose OpenBLAS takes these kernels; returns what was looked for."""
    if not blas.libraries() or not blas.INSTRUCTIONS <= blas._flags():
        pytest.skip("needs OpenBLAS, and a processor with AVX2 and FMA")
    looked = []
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.setattr(blas, "PROCESSORS", tmp_path / "cpuinfo")

    def made(flags, kernels):
        (tmp_path / "cpuinfo").write_text(f"vendor_id\t: GenuineIntel\nflags\t\t: {flags}\n", encoding="ascii")
        monkeypatch.setattr(blas, "in_another_process", lambda: looked.append(kernels) or [{"kernels": kernels}])
        blas.takes_slow_kernels.cache_clear()
        return looked

    yield made
    blas.takes_slow_kernels.cache_clear()


def test_a_processor_that_openblas_does_not_know_gets_the_tried_kernels(machine):
    """Found out once, then read from the file."""
    looked = machine(MODERN, "Prescott")
    assert blas.takes_slow_kernels()
    blas.takes_slow_kernels.cache_clear()
    assert blas.takes_slow_kernels() and looked == ["Prescott"]


@pytest.mark.parametrize(("flags", "by_itself"), [(OLD, "Prescott"), (MODERN, "Haswell")])
def test_openblas_is_left_to_itself_where_its_kernels_suit(machine, flags, by_itself):
    """Others would end the program by an illegal instruction without AVX2."""
    machine(flags, by_itself)
    assert not blas.takes_slow_kernels()


def test_kernels_use_no_instruction_that_the_processor_lacks():
    """AVX-512 in all the parts that OpenBLAS's kernels for Skylake-X use."""
    parts = "avx512f avx512cd avx512bw avx512dq avx512vl".split()
    assert blas.kernels_for({*MODERN.split(), *parts}) == "SkylakeX"
    assert {blas.kernels_for({*MODERN.split(), *parts} - {part}) for part in parts} == {"Haswell"}


@pytest.mark.parametrize(
    ("given", "kernels"), [(None, blas.kernels_for(blas.INSTRUCTIONS | blas._flags())), ("Prescott", "Prescott")]
)
def test_kernels_are_chosen_before_the_library_is_loaded(machine, tmp_path, given, kernels):
    """The library itself; a user's own choice is left alone."""
    environment = {**os.environ, "XDG_CACHE_HOME": str(tmp_path)}
    environment.pop(blas.VARIABLE, None)
    environment |= {blas.VARIABLE: given} if given else {}
    command = [sys.executable, "-P", "-c", UNKNOWING]
    assert subprocess.run(command, env=environment, capture_output=True, text=True).stdout == f"{kernels}\n"


def test_another_process_says_what_openblas_takes_by_itself(monkeypatch):
    """The library itself, whatever this process was told to take."""
    monkeypatch.delenv(blas.VARIABLE, raising=False)
    alone = blas.in_another_process()
    monkeypatch.setenv(blas.VARIABLE, "Prescott")
    assert alone and blas.in_another_process() == alone


def test_the_version_says_which_kernels(capsys):
    """Each library's file and its kernels."""
    assert main(["--version", "-v"]) == 0
    text = capsys.readouterr().out
    assert all(each["file"] in text and f"kernels for {each['kernels']}" in text for each in blas.libraries())
