"""``gears live SCENE``: change a gear pair in the browser and see what follows at once."""

import argparse

from fenics_gears.command_line import add_memory_argument, add_scene_argument, later


def add(commands, shared: argparse.ArgumentParser) -> None:
    command = commands.add_parser("live", parents=[shared])
    add_scene_argument(command)
    port = "port on this machine, such as 8050 to reach it by ssh -L 8050:localhost:8050 (default: any free one)"
    command.add_argument("--port", type=_port, metavar="N", default=0, help=port)
    command.add_argument("--no-browser", action="store_true", help="print the address, open no browser")
    add_memory_argument(command)
    command.set_defaults(command=later("fenics_gears.extensions.live.work:live"))


def _port(text: str) -> int:
    if not text.isdigit() or not 0 < int(text) < 65536:
        raise argparse.ArgumentTypeError(f"{text!r} is no port. Allowed: 1 to 65535; below 1024 needs rights")
    return int(text)
