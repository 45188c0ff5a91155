"""What ``gears live`` does."""

import argparse
import asyncio
import webbrowser
from contextlib import suppress
from pathlib import Path

from fenics_gears import SceneError, load_train
from fenics_gears.charts import gears_of_train
from fenics_gears.command_line import checked_model
from fenics_gears.scene_text import Tree, is_train, model_of_tree, name_of, parsed, text_of

MISSING = (
    "`gears live` needs the libraries {names}, which this Python lacks. Install them: apt install python3-aiohttp"
    ' python3-plotly, or pip install "fenics_gears[live]".'
)


def live(options: argparse.Namespace) -> int:
    """Serve the page until Ctrl-C."""
    _check_libraries()
    from .server import LiveServer

    path: Path = options.scene
    tree: Tree = parsed(text_of(path, "scene"), str(path))
    if is_train(tree):
        # They tell mistakes with their lines, and trains that are not shown in motion.
        gears_of_train(load_train(path))
        model = model_of_tree(name_of(path), tree, path.parent)
    else:
        model = checked_model(path)
    server = LiveServer(tree, model, name_of(path), path.parent)

    def started(address: str) -> None:
        if not options.quiet:
            print(
                f"{address}\nShows {path}; Ctrl-C ends it. Nothing is written unless the page is asked to.", flush=True
            )
        if not options.no_browser:
            webbrowser.open(address)

    with suppress(KeyboardInterrupt):
        asyncio.run(server.run(options.port, started))
    return 0


def _check_libraries() -> None:
    from importlib.util import find_spec

    missing = [name for name in ("aiohttp", "plotly") if find_spec(name) is None]
    if missing:
        raise SceneError(MISSING.format(names=" and ".join(missing)))
