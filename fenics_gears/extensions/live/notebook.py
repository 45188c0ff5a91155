"""The page of ``gears live`` in a cell of a notebook."""

from __future__ import annotations

import asyncio
from collections.abc import Mapping
from pathlib import Path
from threading import Event, Thread
from typing import Any

from fenics_gears import Scene
from fenics_gears.scene_text import model_of_tree, name_of, parsed, text_of

from .server import LiveServer

HEIGHT = 900


class LiveView:
    """A page that a notebook shows; `address`: where any browser of this machine has it. It ends with the notebook, or
    by `close`."""

    def __init__(self, tree: Mapping[str, Any], name: str, folder: Path):
        self.address = ""
        self._server = LiveServer(tree, model_of_tree(name, tree, folder), name, folder)
        self._loop = asyncio.new_event_loop()
        self._task: asyncio.Task[None] | None = None
        begun = Event()
        self._thread = Thread(target=self._serve, args=(begun,), daemon=True)
        self._thread.start()
        begun.wait()

    @property
    def scene(self) -> Mapping[str, Any]:
        """The sections of the present scene, for `build_scene`."""
        return self._server.session.tree

    def close(self) -> None:
        """End the page and what computes for it."""
        if self._task is not None:
            self._loop.call_soon_threadsafe(self._task.cancel)

    def _serve(self, begun: Event) -> None:
        def started(address: str) -> None:
            self.address = address
            begun.set()

        async def run() -> None:
            self._task = asyncio.current_task()
            await self._server.run(0, started)

        try:
            self._loop.run_until_complete(run())
        except asyncio.CancelledError:
            pass
        finally:
            begun.set()

    def _repr_html_(self) -> str:
        return (
            f'<iframe src="{self.address}" width="100%" height="{HEIGHT}" style="border: 1px solid #dde2e7"></iframe>'
        )


def live(scene: Scene | str | Path) -> LiveView:
    """Show a scene, or a scene file, in a notebook, to be changed there.

    >>> from fenics_gears.extensions.live import live
    >>> view = live("demos/lundvall2004.toml")
    >>> view.address.startswith("http://127.0.0.1:")
    True
    >>> view.close()
    """
    if isinstance(scene, Scene):
        return LiveView(parsed(scene.text, "scene"), "scene", Path())
    path = Path(scene)
    return LiveView(parsed(text_of(path, "scene"), str(path)), name_of(path), path.parent)
