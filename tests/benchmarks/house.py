"""How large and how tangled the package is, as one table: `python -m tests.benchmarks.house [CHECKOUT ...]`.

A column for each checkout, this one unless named; then the members of all circles.
All is counted in the source, but for the modules of a plane run:
that run is made, without a cache of gears, so that condensing counts too.
"""

import ast
import io
import os
import subprocess
import sys
import tempfile
import tokenize
import tomllib
from functools import cached_property
from pathlib import Path

HERE = Path(__file__).resolve().parents[2]
CODE = {tokenize.NAME, tokenize.OP, tokenize.NUMBER, tokenize.STRING}
IMPORTS = (ast.Import, ast.ImportFrom)
# A scene names both gears of a pair, and the geometry of a pair is made of both.
SPEAK_OF_BOTH = ("fenics_gears.scene", "fenics_gears.geometry.pair", "fenics_gears.geometry.gear_checks")
# Fields of pairs, of which [0] is the pinion's and [1] the wheel's.
OF_BOTH = ("gears", "bodies", "sides", "flanks", "senses", "teeth", "names", "bearings", "shafts", "lever_arms", "pair")
PLANE_RUN = """
import sys
from fenics_gears.commands.cli import main
main(["run", "demos/lundvall2004.toml", "-o", sys.argv[1], "--quiet"])
print(sum(name.startswith("fenics_gears.") for name in sys.modules))
"""


class Module:
    def __init__(self, root: Path, path: Path):
        parts = path.relative_to(root).with_suffix("").parts
        self.is_package = parts[-1] == "__init__"
        self.name = ".".join(parts[: -1 if self.is_package else None])
        self.text = path.read_text(encoding="utf-8")
        self.tree = ast.parse(self.text)
        for node in ast.walk(self.tree):
            for child in ast.iter_child_nodes(node):
                child.parent = node

    @cached_property
    def imports(self) -> list[ast.stmt]:
        """Those that run: not those for annotations alone."""
        named = [node for node in ast.walk(self.tree) if isinstance(node, IMPORTS)]
        return [node for node in named if not any(map(_is_for_types, _above(node)))]

    @property
    def lazy(self) -> int:
        """Imports of the package's own modules within functions: other libraries are mostly slow to load."""
        own = [node for node in self.imports if getattr(node, "level", 0) or "fenics_gears" in ast.unparse(node)]
        return sum(any(isinstance(above, ast.FunctionDef) for above in _above(node)) for node in own)

    def targets(self, known: set[str]) -> set[str]:
        """The modules of the package from which it imports, at load time or later."""
        found = set()
        for node in self.imports:
            if isinstance(node, ast.Import):
                continue
            within = self.name.split(".") + ["__init__"] * self.is_package
            home = ".".join([*within[: -node.level if node.level else 0], *(node.module or "").split(".")]).strip(".")
            found |= {inner if (inner := f"{home}.{each.name}") in known else home for each in node.names}
        return found & known - {self.name}

    @property
    def tokens(self) -> int:
        """Names, operators, numbers and strings, but for imports and docstrings."""
        dropped = [node for node in ast.walk(self.tree) if isinstance(node, IMPORTS) or _is_docstring(node)]
        lines = {line for node in dropped for line in range(node.lineno, node.end_lineno + 1)}
        tokens = tokenize.generate_tokens(io.StringIO(self.text).readline)
        return sum(token.type in CODE and token.start[0] not in lines for token in tokens)


def _above(node: ast.AST):
    while node := getattr(node, "parent", None):
        yield node


def _is_for_types(node: ast.AST) -> bool:
    return isinstance(node, ast.If) and "TYPE_CHECKING" in ast.unparse(node.test)


def _is_docstring(node: ast.AST) -> bool:
    return isinstance(node, ast.Expr) and isinstance(getattr(node.value, "value", None), str)


def _names_one_gear(node: ast.AST) -> bool:
    """Names and strings with pinion or wheel in them, names that end with 1 or 2, and fields of both indexed."""
    name = getattr(node, "id", None) or getattr(node, "attr", None) or getattr(node, "arg", None)
    name = node.value if isinstance(node, ast.Constant) else name
    if isinstance(name, str) and " " not in name:
        return "pinion" in name or "wheel" in name or name.endswith(("_1", "_2"))
    if isinstance(node, ast.Subscript) and isinstance(node.slice, ast.Constant) and node.slice.value in (0, 1):
        return ast.unparse(node.value).split(".")[-1] in OF_BOTH
    return False


def _is_parallel(node: ast.Assign) -> bool:
    """a, b = x, y, but for swaps: the names of a swap are its values."""
    sides = [side for side in (node.targets[0], node.value) if isinstance(side, ast.Tuple)]
    return len({frozenset(map(ast.unparse, side.elts)) for side in sides}) == 2


def circles(modules: list[Module]) -> list[list[str]]:
    """Groups of modules that reach each other by imports, lazy ones counted."""
    known = {module.name for module in modules}
    reach = {module.name: module.targets(known) for module in modules}
    for middle in known:  # Warshall's closure
        for targets in reach.values():
            if middle in targets:
                targets |= reach[middle]
    groups = {frozenset(b for b in reach[a] if a in reach[b]) for a in known if a in reach[a]}
    return sorted((sorted(group) for group in groups), key=len, reverse=True)


def modules_of(root: Path) -> list[Module]:
    return [Module(root, path) for path in sorted((root / "fenics_gears").rglob("*.py"))]


def measures(root: Path) -> dict[str, str]:
    modules = modules_of(root)
    core = [module for module in modules if not module.name.startswith("fenics_gears.extensions")]
    settings = tomllib.loads((root / "pyproject.toml").read_text(encoding="utf-8"))["tool"]
    excused = sum(len(each.get("ignore_imports", [])) for each in settings["importlinter"]["contracts"])
    nodes = {module: list(ast.walk(module.tree)) for module in modules}
    parallel = [_is_parallel(node) for each in nodes.values() for node in each if isinstance(node, ast.Assign)]
    silent = [node for module in modules if not module.name.startswith(SPEAK_OF_BOTH) for node in nodes[module]]
    return {
        "tokens of code, core": f"{sum(module.tokens for module in core):,}",
        "tokens of code, whole": f"{sum(module.tokens for module in modules):,}",
        "modules that a plane run loads": _loaded(root),
        "circles of imports": str([len(circle) for circle in circles(modules)]),
        "lazy imports": str(sum(module.lazy for module in modules)),
        "places that name pinion and wheel": f"{sum(map(_names_one_gear, silent)):,}",
        "parallel assignments": f"{100 * sum(parallel) / len(parallel):.1f} %",
        "kinds of mypy errors switched off": str(len(settings["mypy"]["disable_error_code"])),
        "import exceptions": str(excused),
    }


def _loaded(root: Path) -> str:
    with tempfile.TemporaryDirectory() as folder:
        environment = {**os.environ, "PYTHONPATH": str(root), "FENICS_GEARS_CACHE": folder}
        call = [sys.executable, "-P", "-c", PLANE_RUN, f"{folder}/run"]
        done = subprocess.run(call, check=True, cwd=root, env=environment, capture_output=True, text=True)
    return done.stdout.split()[-1]


if __name__ == "__main__":
    columns = [measures(Path(each).resolve()) for each in sys.argv[1:] or [HERE]]
    for name in columns[0]:
        print("|".join(["", name, *(column[name] for column in columns), ""]))
    for root in sys.argv[1:] or [HERE]:
        for circle in circles(modules_of(Path(root).resolve())):
            print(f"circle in {root}:", *circle, sep="\n  ")
