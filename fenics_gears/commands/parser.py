"""The parser of the command line, which answers a misspelt command or option with the nearest one."""

import argparse
import re
from collections.abc import Iterator
from typing import NoReturn

from fenics_gears.inputs.problem import did_you_mean

COMMAND = "COMMAND"
_NO_CHOICE = re.compile(rf"argument {COMMAND}: invalid choice: '(.*)' \(choose from (.*)\)", re.DOTALL)
_UNKNOWN = "unrecognized arguments: "


class Parser(argparse.ArgumentParser):
    """Also of each command: argparse makes them of the same class."""

    def error(self, message: str) -> NoReturn:
        if found := _NO_CHOICE.fullmatch(message):
            known = [name.strip("'") for name in found[2].split(", ")]
            message = f'there is no command "{found[1]}".{did_you_mean(found[1], known)} Commands: {", ".join(known)}'
        elif message.startswith(_UNKNOWN):
            options = [word.partition("=")[0] for word in message.removeprefix(_UNKNOWN).split() if word[0] == "-"]
            message += "." + "".join(did_you_mean(each, self._known()) for each in options)
        super().error(message)

    def _known(self) -> Iterator[str]:
        """The options of the parser, and of the commands that are added to it."""
        for action in self._actions:
            yield from action.option_strings
            if isinstance(action, argparse._SubParsersAction):
                for each in action.choices.values():
                    yield from each._known()
