"""One direction of data: a module imports only from its own floor or the floors below.
Also: `import klingel` stays quick because it loads nothing heavy."""

import ast
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import klingel

PACKAGE = Path(klingel.__file__).parent

FLOORS = [
    {"errors"},
    {"core"},
    {"units"},
    {"records"},
    {"vehicle", "track", "contact"},
    {"library"},
    {"doctor"},
    {"drives"},
    {"control"},
    {"scenario"},
    {"lower"},
    {"result"},
    {"linear"},
    {"design"},
    {"assess"},
    {"plot"},
    {"report"},
    {"study"},
    {"cli"},
]
FLOOR = {name: level for level, names in enumerate(FLOORS) for name in names}


def type_checking(node: ast.AST) -> bool:
    return isinstance(node, ast.If) and isinstance(node.test, ast.Name) and node.test.id == "TYPE_CHECKING"


def walk(node: ast.AST) -> Iterator[ast.AST]:
    """Every node that runs; imports for the type checker do not."""
    yield node
    for child in ast.iter_child_nodes(node):
        if not type_checking(child):
            yield from walk(child)


def imported(file: Path) -> Iterator[str]:
    """Parts of klingel that a file imports."""
    for node in walk(ast.parse(file.read_text())):
        if isinstance(node, ast.ImportFrom) and node.module == "klingel":
            yield from (alias.name for alias in node.names if alias.name != "__version__")
        elif isinstance(node, ast.ImportFrom) and node.module and node.module.startswith("klingel."):
            yield node.module.split(".")[1]
        elif isinstance(node, ast.Import):
            yield from (a.name.split(".")[1] for a in node.names if a.name.startswith("klingel."))


def test_every_module_imports_from_below() -> None:
    wrong = []
    for file in PACKAGE.rglob("*.py"):
        part = file.relative_to(PACKAGE).parts[0].removesuffix(".py")
        if part == "__init__":
            continue
        for other in imported(file):
            if other != part and not FLOOR[other] < FLOOR[part]:
                wrong.append(f"{file.relative_to(PACKAGE)} imports {other}")
    assert wrong == []


def test_every_part_has_a_floor() -> None:
    parts = {f.name.removesuffix(".py") for f in PACKAGE.iterdir() if f.suffix == ".py" or (f / "__init__.py").exists()}
    assert parts - {"__init__"} == set(FLOOR)


def test_import_loads_nothing_heavy() -> None:
    heavy = {"numpy", "pint", "pydantic", "xarray", "pandas", "scipy", "matplotlib", "netCDF4", "control", "rich"}
    code = "import sys, klingel; print(*{name.split('.')[0] for name in sys.modules})"
    loaded = subprocess.run([sys.executable, "-W", "ignore", "-c", code], capture_output=True, text=True, check=True)
    assert heavy & set(loaded.stdout.split()) == set()
