"""A misspelt command or option, answered with the nearest one."""

import argparse
import re
from collections.abc import Iterator

from fenics_gears.inputs.problem import did_you_mean

_NO_CHOICE = re.compile(r"argument COMMAND: invalid choice: '(.*)' \(choose from (.*)\)", re.DOTALL)
_UNKNOWN = "unrecognized arguments: "


def in_words(message: str, parser: argparse.ArgumentParser) -> str:
    """What a parser says of a wrong call, with what may be meant."""
    if match := _NO_CHOICE.fullmatch(message):
        known = [name.strip("'") for name in match[2].split(", ")]
        return f'there is no command "{match[1]}".{did_you_mean(match[1], known)} Commands: {", ".join(known)}'
    if message.startswith(_UNKNOWN):
        words = message.removeprefix(_UNKNOWN).split()
        options = [word.partition("=")[0] for word in words if word.startswith("-")]
        return f"{message}." + "".join(did_you_mean(each, _known(parser)) for each in options)
    return message


def _known(parser: argparse.ArgumentParser) -> Iterator[str]:
    """The options of a parser, and of the commands that are added to it."""
    for action in parser._actions:
        yield from action.option_strings
        if isinstance(action, argparse._SubParsersAction):
            for each in action.choices.values():
                yield from _known(each)
