"""The scene as it is being changed: what it was at the start, changes that can be undone, and what was shown last.

All browsers see the same scene. A session tells them by `tell`, and asks for runs by `ask`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from fenics_gears import SceneError, as_toml
from fenics_gears.scene_text import fields, is_train, known_paths

from .computing import RUN, Work
from .controls import Control, Path, Tree, control_of, controls_of, reach
from .train_controls import controls_of_train, names_in_train

MOST_UNDONE = 500
# Steps of a mesh cycle of a first look at what is slow, which takes a tenth of the time.
FIRST_LOOK = 10


class Session:
    """What one call of ``gears live`` shows. `slow`: what is over the face, or a planetary set."""

    def __init__(self, tree: Tree, name: str, slow: bool, ask: Callable[[Work], None], tell: Callable[[Any], None]):
        self.name = name
        self.start = dict(tree)
        self.tree = dict(tree)
        self._train = is_train(tree)
        self.controls: list[Control] = controls_of_train(tree) if self._train else controls_of(tree, slow)
        self._slow = slow
        self._ask = ask
        self._tell = tell
        self._undone: list[Tree] = []
        self._redone: list[Tree] = []
        # Of the present scene; results of others are old.
        self.number = 0
        # Of the present scene, and of the one at the start.
        self.result: dict[str, Any] | None = None
        self.first: dict[str, Any] | None = None
        self._problems: list[dict[str, str]] = []

    def do(self, message: Mapping[str, Any]) -> None:
        """Carry out what a browser asks for; a mistake is told beside the field."""
        action = message.get("do")
        if action == "set":
            self._set(str(message["name"]), message["value"])
        elif action == "show":
            self._show(str(message["name"]))
        elif action == "undo":
            self._turn(self._undone, self._redone)
        elif action == "redo":
            self._turn(self._redone, self._undone)
        elif action == "start":
            self._put(self.start)
        elif action == "compare":
            self.start = self.tree
            self.first = self.result
            self._tell({"kind": "start", "result": self.first})
            self.describe()

    def run(self) -> None:
        """Ask for the run of the present scene: over the face and of planetary sets first with few steps."""
        self.number += 1
        self._problems = []
        steps = FIRST_LOOK if self._slow else None
        others = () if self.number > 1 else tuple(reach(self.tree, self.controls))
        self._ask(Work(RUN, self.number, self.tree, steps, others))

    def answered(self, answer: dict[str, Any]) -> None:
        """Take what the computing process says of a scene."""
        if answer["number"] != self.number:
            return
        if answer["kind"] == "mistakes":
            self._problems = [self._of_a_control(each) for each in answer["problems"]]
            self.describe()
            return
        if answer["kind"] == "result":
            self.result = answer
            if self.tree == self.start and (self.first is None or self.first["first_look"]):
                self.first = answer
                self._tell({"kind": "start", "result": answer})
            if answer["first_look"]:
                self._ask(Work(RUN, self.number, self.tree))
        self._tell(answer)

    def describe(self) -> None:
        """Tell the state of all fields."""
        self._tell(self.state)

    @property
    def state(self) -> dict[str, Any]:
        """All that the page shows of the scene."""
        return {
            "kind": "state",
            "number": self.number,
            "title": str(self.tree.get("title") or self.name),
            "controls": [self._described(each) for each in self.controls],
            "problems": self._problems,
            "undo": len(self._undone),
            "redo": len(self._redone),
            "changed": self.tree != self.start,
            "python": self.python,
        }

    def _described(self, control: Control) -> dict[str, Any]:
        return control.described(self.tree) | {"start": control.described(self.start)["text"]}

    @property
    def messages(self) -> list[Any]:
        """What a browser that comes later has to be told."""
        of_start = [] if self.first is None else [{"kind": "start", "result": self.first}]
        return [
            {"kind": "names", "names": self._names},
            self.state,
            *of_start,
            *([] if self.result is None else [self.result]),
        ]

    @property
    def _names(self) -> list[str]:
        """Fields that the page may be asked for."""
        if self._train:
            return names_in_train(self.tree)
        return [".".join(path) for path, section in known_paths().items() if not section]

    @property
    def python(self) -> str:
        """Lines of Python that give the present result."""
        read, run = ("train_from_text", "simulate_train") if self._train else ("scene_from_text", "simulate")
        lines = [f"from fenics_gears import {read}, {run}", "", f'scene = {read}("""']
        return "\n".join([*lines, as_toml(self.tree).strip(), '""")', f"result = {run}(scene)"])

    def _set(self, name: str, value: Any) -> None:
        control = next((each for each in self.controls if each.name == name), None)
        if control is None:
            return
        try:
            if isinstance(value, str):
                value = _value(value)
            self._put(control.changed(self.tree, value))
        except SceneError as error:
            self._problems = [{"path": name, "message": str(error)}]
            self.describe()

    def _show(self, name: str) -> None:
        """A field by its name joins those of the page."""
        path: Path = tuple(name.split("."))
        why = fields.why_unknown(path)
        if why is None and fields.is_section(path):
            inside = [".".join(each) for each in known_paths() if each[: len(path)] == path and len(each) > len(path)]
            why = f"is a section. Its fields: {', '.join(inside[:8])}."
        if why is not None:
            self._tell({"kind": "unknown", "name": name, "message": f"{name} {why}"})
            return
        if all(each.path != path for each in self.controls):
            self.controls.append(control_of(path, self.tree))
        self.describe()

    def _put(self, tree: Tree) -> None:
        """Another scene takes the place of the present one."""
        if tree == self.tree:
            return
        self._undone = [*self._undone[-MOST_UNDONE:], self.tree]
        self._redone = []
        self.tree = dict(tree)
        self.run()
        self.describe()

    def _turn(self, back: list[Tree], forth: list[Tree]) -> None:
        if not back:
            return
        forth.append(self.tree)
        self.tree = dict(back.pop())
        self.run()
        self.describe()

    def _of_a_control(self, problem: dict[str, str]) -> dict[str, str]:
        """A mistake beside the nearest field that the page shows."""
        path = problem["path"].split(".")
        names = {each.name for each in self.controls}
        own = next((each for n in range(len(path), 0, -1) if (each := ".".join(path[:n])) in names), "")
        if not own:
            own = next((each for each in sorted(names) if path[:2] == each.split(".")[:2] and len(path) > 1), "")
        words = problem["message"] if own == problem["path"] else f"{problem['path']} {problem['message']}".strip()
        return {"path": own, "message": words}


def _value(written: str) -> Any:
    """What a user types as a scene has it: a number where it is one, else a text."""
    text = written.strip()
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            continue
    return {"true": True, "false": False, "": fields.ABSENT}.get(text, text)
