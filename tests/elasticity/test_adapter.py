"""What the adapter does about DOLFINx's own traps."""

import logging

import pytest

from fenics_gears.elasticity import dolfinx_adapter as adapter


def test_leftover_of_a_killed_compile_is_removed(tmp_path):
    """The form compiler (ffcx, jit.py) names the file that a compile killed halfway has left."""
    leftover = tmp_path / "form cache" / "libffcx_forms_0.c"
    leftover.parent.mkdir()
    leftover.write_text("")

    def build():
        if leftover.exists():
            raise TimeoutError(
                f"JIT compilation timed out. Try cleaning cache (e.g. remove {leftover}) or increase timeout option."
            )
        return "compiled"

    assert adapter.with_compiled(build) == "compiled"


def test_another_timeout_is_not_swallowed():
    """A timeout that names no file is not repeated for ever."""

    def build():
        raise TimeoutError("the disk does not answer")

    with pytest.raises(TimeoutError, match="disk"):
        adapter.with_compiled(build)


def test_compiler_is_quiet_only_while_it_compiles(caplog):
    """The program's own warnings pass."""
    with caplog.at_level(logging.INFO), caplog.at_level(logging.INFO, logger="fenics_gears"):
        with adapter.quiet_compiler():
            logging.getLogger("distutils").info("x86_64-linux-gnu-gcc")
            logging.getLogger("fenics_gears").warning("kept")
        logging.getLogger("fenics_gears").info("after")
    assert [record.message for record in caplog.records] == ["kept", "after"]
