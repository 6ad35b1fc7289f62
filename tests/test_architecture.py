"""Arrows point one way: what each part of porolub may import, read from the sources."""

import ast
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
PACKAGE = ROOT / "porolub"
LONGEST = 400

BELOW = ("scene", "laws", "mesh", "fem", "terms", "solve")
ALLOWED = {
    "errors": (),
    "scene": ("errors",),
    "laws": ("errors",),
    "mesh": ("errors",),
    "fem": ("mesh", "laws", "errors"),
    "terms": ("laws", "fem", "mesh", "errors"),
    "solve": ("scene", "laws", "mesh", "fem", "terms", "errors"),
    "io": (*BELOW, "errors", "together", ""),
    "study": (*BELOW, "errors", "io", "interrupt", "together", "finish", "run", "run_transient",
              ""),
    "versions": ("",),
    "interrupt": ("errors",),
    "together": ("errors",),
    "finish": (*BELOW, "errors", "io", "together", "versions", ""),
    "run_transient": (*BELOW, "errors", "io", "interrupt", "together", "finish"),
    "run": (*BELOW, "errors", "io", "interrupt", "together", "finish", "run_transient"),
    "cli": (*BELOW, "errors", "io", "study", "run", "run_transient", "versions", ""),
    "__main__": ("cli",),
    "": (),  # porolub/__init__.py
}
FOR_TYPES_ONLY = {"mesh": ("scene",)}


def room(module: str) -> str:
    """The part a module belongs to: 'porolub.mesh.grid' -> 'mesh', 'porolub' -> ''."""
    return module.split(".")[1] if "." in module else ""


def is_type_checking(node: ast.AST) -> bool:
    return isinstance(node, ast.If) and "TYPE_CHECKING" in ast.unparse(node.test)


def imports(source: str, package: str) -> list[tuple[str, bool]]:
    """All modules of porolub a source imports, also inside functions: (name, for types only)."""
    found: list[tuple[str, bool]] = []

    def visit(node: ast.AST, types: bool) -> None:
        if isinstance(node, ast.Import):
            found.extend((alias.name, types) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = node.module or ""
            if node.level:
                parts = package.split(".")
                parts = parts[: len(parts) - node.level + 1]
                base = ".".join([*parts, *filter(None, [node.module])])
            if base == "porolub":  # from porolub import mesh, __version__
                names = [alias.name for alias in node.names if not alias.name.startswith("__")]
                found.extend((f"porolub.{name}", types) for name in names or [""])
            else:
                found.append((base, types))
        for child in ast.iter_child_nodes(node):
            guarded = is_type_checking(node) and child not in getattr(node, "orelse", ())
            visit(child, types or guarded)

    visit(ast.parse(source), False)
    return [(name, types) for name, types in found if name.split(".")[0] == "porolub"]


def wrong_arrows(module: str, source: str, is_package: bool = False) -> list[str]:
    """Imports a module must not have."""
    package = module if is_package else module.rpartition(".")[0]
    here = room(module)
    wrong = []
    for name, types in imports(source, package):
        there = room(name)
        allowed = (*ALLOWED[here], *(FOR_TYPES_ONLY.get(here, ()) if types else ()))
        if there != here and there not in allowed:
            wrong.append(f"{module} imports {name}")
    return wrong


def modules() -> dict[str, Path]:
    return {".".join(path.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__"): path
            for path in sorted(PACKAGE.rglob("*.py"))}


def test_every_part_has_its_place():
    known = {room(name) for name in modules()}
    assert known <= set(ALLOWED), f"say in this test what {known - set(ALLOWED)} may import"
    assert {"laws", "scene", "mesh", "fem", "terms", "solve", "io", "cli"} <= known


@pytest.mark.parametrize("name", modules())
def test_arrows_point_one_way(name):
    path = modules()[name]
    assert not wrong_arrows(name, path.read_text(encoding="utf-8"), path.name == "__init__.py")


def test_no_part_depends_on_itself_by_a_detour():
    reached: dict[str, set[str]] = {}
    for part, direct in ALLOWED.items():
        todo, seen = list(direct), set()
        while todo:
            following = todo.pop()
            if following not in seen:
                seen.add(following)
                todo.extend(ALLOWED[following])
        reached[part] = seen
    assert not [part for part, seen in reached.items() if part in seen]


@pytest.mark.parametrize(
    ("module", "source"),
    [
        ("porolub.laws.solid", "from porolub.fem.points import Points"),
        ("porolub.laws.solid", "def f():\n    import porolub.mesh"),
        ("porolub.scene.scene", "from porolub import laws"),
        ("porolub.mesh.build", "from porolub.scene import Scene"),
        ("porolub.fem.dofs", "from ..terms import film"),
        ("porolub.terms.film", "from porolub.solve.scales import Scales"),
        ("porolub.terms.film", "if TYPE_CHECKING:\n    from porolub.scene import Scene"),
        ("porolub.solve.steady", "if TYPE_CHECKING:\n    pass\nelse:\n    import porolub.io.log"),
        ("porolub.io.log", "from porolub.cli import main"),
        ("porolub.errors", "import porolub.scene"),
        ("porolub.laws.solid", "from porolub import __version__"),
    ],
)
def test_a_wrong_arrow_is_seen(module, source):
    assert len(wrong_arrows(module, source)) == 1


@pytest.mark.parametrize(
    ("module", "source"),
    [
        ("porolub.laws.solid", "import numpy\nfrom porolub.laws.kinematics import outer"),
        ("porolub.mesh.build", "if TYPE_CHECKING:\n    from porolub.scene import Scene"),
        ("porolub.fem.dofs", "from .domains import Domain"),
        ("porolub.terms.film", "from ..laws.lubricant import Newtonian"),
        ("porolub.cli", "import porolub\nfrom porolub.io import log"),
        ("porolub.io.summary", "from porolub import __version__"),
    ],
)
def test_a_right_arrow_is_allowed(module, source):
    assert wrong_arrows(module, source) == []


def sources() -> list[str]:
    tree = [p for top in (PACKAGE, ROOT / "tests") for p in top.rglob("*")]
    return sorted(str(p.relative_to(ROOT)) for p in tree if p.suffix in (".py", ".c"))


@pytest.mark.parametrize("name", sources())
def test_files_are_short_and_finished(name):
    text = (ROOT / name).read_text(encoding="utf-8")
    assert text.count("\n") <= LONGEST
    if name.startswith("porolub"):
        for word in ("NotImplementedError", "TO" + "DO", "FIX" + "ME"):
            assert word not in text
