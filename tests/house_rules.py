"""The house's rules, and the checker that reads imports and includes and finds what breaks them.

A new room or module is entered in `ROOMS` or `GROUPS` on purpose: what is unknown is refused.
"""

import ast
import re
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

LONGEST = 400  # lines of a file

# --- C++: the folders of cpp/ and the folders each may include (itself always). Each lists only
# folders above it, so that no circle is possible; a test holds the table to that. ---
ROOMS: dict[str, set[str]] = {
    "base": set(),
    "model": {"base"},
    "simulate": {"base", "model"},
    "search": {"base"},
    "identify/recording": {"base"},
    "identify/balance": {"base", "model", "identify/recording"},
    "identify/penalty": {"base", "model", "identify/recording", "identify/balance"},
    "identify/compressed": {
        *("base", "model", "search"),
        *("identify/recording", "identify/balance", "identify/penalty"),
    },
    "identify/solve": {
        *("base", "model", "search"),
        *("identify/recording", "identify/balance", "identify/penalty"),
    },
    "diagnose": {"base", "identify/recording", "identify/balance", "identify/penalty"},
}
ROOMS["bind"] = ROOMS["tests"] = set(ROOMS)
PRINTING = {"iostream", "cstdio", "stdio.h", "print"}

# --- Python: the modules of each group, the groups and the packages it may use. ---


@dataclass(frozen=True, kw_only=True)
class Group:
    """Modules under one rule; a name that ends in `.` stands for a whole subpackage."""

    modules: set[str]
    may_use: set[str]
    packages: set[str]


GROUPS: dict[str, Group] = {
    "core": Group(modules={"_core"}, may_use=set(), packages=set()),
    "recording": Group(
        modules={"base.", "recording.", "joint."},
        may_use={"core"},
        packages={"numpy", "scipy", "pandas", "pyarrow", "tomlkit"},
    ),
    "simulation": Group(modules={"simulation."}, may_use={"core", "recording"}, packages={"numpy"}),
    "analysis": Group(
        modules={"problem.", "identification.", "estimate.", "comparison.", "online."},
        may_use={"core", "recording"},
        packages={"numpy", "scipy", "pandas"},
    ),
    "study": Group(
        modules={"study."},
        may_use={"core", "recording", "simulation", "analysis"},
        packages={"numpy", "pandas", "pyarrow"},
    ),
    "presentation": Group(
        modules={"plot.", "report."},
        may_use={"core", "recording", "simulation", "analysis", "study"},
        packages={"numpy", "matplotlib"},
    ),
    # A program of its own that a session starts, so that drawing takes none of the loop's time.
    "live window": Group(
        modules={"hardware.live.window"},
        may_use={"hardware"},
        packages={"matplotlib"},
    ),
    "hardware": Group(
        modules={"hardware."},
        may_use={"core", "recording", "simulation"},
        packages={"numpy", "can", "canopen"},
    ),
    "commissioning": Group(
        modules={"commissioning."},
        may_use={"core", "recording", "simulation", "analysis", "hardware"},
        packages={"numpy"},
    ),
    "face": Group(
        modules={"__init__"},
        may_use={
            *("core", "recording", "simulation", "analysis", "study", "presentation"),
            *("hardware", "commissioning"),
        },
        packages=set(),
    ),
    "command line": Group(
        modules={"__main__", "cli."},
        may_use={
            *("core", "recording", "simulation", "analysis", "study", "presentation"),
            *("hardware", "commissioning", "face", "command line"),
        },
        packages={"numpy", "matplotlib"},
    ),
}
# Slow to load, or of use to few: imported inside the function that needs it (hardware aside).
HEAVY = {"scipy", "pandas", "pyarrow", "matplotlib", "can", "canopen", "tomlkit"}

FORBIDDEN_WORDS = {
    *("data", "manager", "managers", "helper", "helpers", "util", "utils"),
    *("handler", "handlers", "process", "do"),
}


def check(repository: Path) -> list[str]:
    """Return one sentence for every break of the rules in `cpp/` and `python/jointid/`."""
    cpp = sorted(
        path for path in (repository / "cpp").rglob("*") if path.suffix in {".cpp", ".hpp"}
    )
    python = sorted((repository / "python" / "jointid").rglob("*.py"))
    found: list[str] = []
    for path in [*cpp, *python]:
        place = path.relative_to(repository).as_posix()
        found += [f"{place}: {what}" for what in _names_and_length(path)]
        rules = _includes if path.suffix in {".cpp", ".hpp"} else _imports
        found += [f"{place}: {what}" for what in rules(path, repository)]
    return found


def _names_and_length(path: Path) -> Iterator[str]:
    lines = len(path.read_text(encoding="utf-8").splitlines())
    if lines > LONGEST:
        yield f"has {lines} lines, the longest allowed is {LONGEST}: one idea a file"
    for word in sorted(FORBIDDEN_WORDS & set(path.stem.split("_"))):
        yield f"a name with '{word}' says nothing: name the idea"


def _includes(path: Path, repository: Path) -> Iterator[str]:
    root = repository / "cpp"
    room = _room(path.relative_to(root))
    if room not in ROOMS:
        yield f"room '{room}' is unknown: enter it in ROOMS of tests/house_rules.py with what it may use"
        return
    text = re.sub(r"/\*.*?\*/|//[^\n]*", "", path.read_text(encoding="utf-8"), flags=re.DOTALL)
    for quote, name in re.findall(
        r'^[ \t]*#[ \t]*include[ \t]*(["<])([^">]+)[">]', text, re.MULTILINE
    ):
        python = name.startswith("pybind11/") or name.endswith("Python.h")
        near, far = path.parent / name, root / name
        target = near if quote == '"' and near.exists() else far
        if python:
            if room != "bind":
                yield f"includes {name}: only bind/ knows of Python"
        elif target.exists():
            other = _room(target.resolve().relative_to(root.resolve()))
            if other != room and other not in ROOMS[room]:
                allowed = ", ".join(sorted(ROOMS[room])) or "no other room"
                yield f"includes {name}: {room} may use {allowed}"
        elif quote == '"':
            yield f'includes "{name}", which is not in cpp/: std and Eigen are written <...>'
        elif name in PRINTING and room != "tests":
            yield f"includes <{name}>: the core prints nothing"
        elif not name.startswith("Eigen/") and not re.fullmatch(r"[a-z0-9_]+|stdio\.h", name):
            yield f"includes <{name}>: the core uses std and Eigen only"
    if room != "tests" and re.search(r"std::(cout|cerr|clog)\b|\b(?:f|v|vf)?printf\s*\(", text):
        yield "prints: the core returns or throws what it has to say"


def _room(path: Path) -> str:
    """The folder of a file below cpp/; identify's own folders are rooms by themselves."""
    folders = path.parts[:-1]
    return "/".join(folders[:2] if folders[0] == "identify" else folders[:1])


def _imports(path: Path, repository: Path) -> Iterator[str]:
    package = repository / "python" / "jointid"
    module = ".".join(path.relative_to(package).with_suffix("").parts)
    name = _group(module)
    if name is None:
        yield f"module '{module}' is unknown: enter it in GROUPS of tests/house_rules.py"
        return
    tree = ast.parse(path.read_text(encoding="utf-8"))
    for node in tree.body:
        named = isinstance(node, ast.FunctionDef | ast.ClassDef) and node.name
        if named == path.stem:
            yield f"bears the name of what it defines, '{named}': from the package only one is seen"
    for line, target, inside in _imported(tree, module, package):
        root = target.split(".")[0]
        light = name in ("hardware", "commissioning") or inside  # loaded when asked for
        if root != "jointid":
            if root not in sys.stdlib_module_names and root not in GROUPS[name].packages:
                allowed = ", ".join(sorted(GROUPS[name].packages)) or "none"
                yield f"line {line} imports {root}: packages allowed in {name}: {allowed}"
            elif root in HEAVY and not light:
                yield f"line {line} imports {root} with the module: do it in the function"
            continue
        other = target.partition(".")[2] or "__init__"
        group = _group(other)
        if group is None:
            yield f"line {line} imports jointid.{other}, which is unknown to tests/house_rules.py"
        elif group != name and group not in GROUPS[name].may_use:
            allowed = ", ".join(sorted(GROUPS[name].may_use)) or "none"
            yield f"line {line} imports jointid.{other} ({group}): {name} may use {allowed}"
        elif group == "hardware" and not light:
            yield f"line {line} imports jointid.{other} with the module: do it in the function"


def _group(module: str) -> str | None:
    for name, group in GROUPS.items():
        if module in group.modules or f"{module.split('.')[0]}." in group.modules:
            return name
    return None


def _imported(tree: ast.Module, module: str, package: Path) -> Iterator[tuple[int, str, bool]]:
    """Yield line, full module name, and whether loading the module leaves it alone."""
    late = set()  # inside functions, or only for the type checker
    for node in ast.walk(tree):
        function = isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda)
        typing = isinstance(node, ast.If) and ast.unparse(node.test) in {
            "TYPE_CHECKING",
            "typing.TYPE_CHECKING",
        }
        if function:
            late |= set(map(id, ast.walk(node)))
        elif typing and isinstance(node, ast.If):
            late |= {id(inner) for statement in node.body for inner in ast.walk(statement)}
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            for alias in node.names:
                yield node.lineno, alias.name, id(node) in late
        elif isinstance(node, ast.ImportFrom):
            base = node.module or ""
            if (
                node.level
            ):  # relative: drop the module's own name, then one part for each further dot
                parents = ["jointid", *module.split(".")][: -node.level]
                base = ".".join([*parents, *([node.module] if node.module else [])])
            for alias in node.names:
                full = f"{base}.{alias.name}"
                inner = package.joinpath(*full.split(".")[1:])
                is_module = full.startswith("jointid.") and (
                    inner.is_dir() or inner.with_suffix(".py").exists() or alias.name == "_core"
                )
                yield node.lineno, full if is_module else base, id(node) in late
