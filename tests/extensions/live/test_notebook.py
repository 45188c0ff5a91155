"""The page in a notebook."""

import urllib.error
import urllib.request

import pytest

from fenics_gears import build_scene
from fenics_gears.extensions.live import live

pytest.importorskip("aiohttp")


def test_a_notebook_shows_a_scene_until_it_is_closed(tree):
    """A cell shows the page of this very scene; after `close` nobody answers."""
    view = live(build_scene(tree))
    assert f'src="{view.address}"' in view._repr_html_()
    with urllib.request.urlopen(f"{view.address}scene.toml", timeout=30) as answer:
        assert b"teeth = 31" in answer.read()
    assert view.scene["gears"]["wheel"]["teeth"] == 31
    view.close()
    view._thread.join(30)
    with pytest.raises(urllib.error.URLError):
        urllib.request.urlopen(view.address, timeout=5)
