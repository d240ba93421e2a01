"""The house's rules, and the checker that reads imports and includes and finds what breaks them.

A new room or module is entered in `ROOMS` or `FOLDERS` on purpose: what is unknown is refused.
"""

import ast
import re
import statistics
import sys
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path

LONGEST = 400  # lines of a file

# --- C++: the folders of cpp/ and the folders each may include (itself always). docs/contributors/house.md
# has them in an order in which each uses only folders above it. ---
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
    "design": {"base", "model", "simulate", "search", "identify/balance"},
    "signals": {"base"},
    "text": set(),
    "diagnose": {
        *("base", "signals"),
        *("identify/recording", "identify/balance", "identify/penalty"),
    },
}
ROOMS["bind"] = ROOMS["tests"] = set(ROOMS)
PRINTING = {"iostream", "cstdio", "stdio.h", "print"}
WRITES_TEXT = ("base/digits.cpp", "cstdio")  # numbers in messages, by snprintf

# --- Python: the folders of jointid, those each may use (itself always), and the packages. In the
# table of docs/contributors/house.md each uses only folders above it. ---


@dataclass(frozen=True, kw_only=True)
class Folder:
    """What the modules of a folder may import: other folders (`_core` always) and packages."""

    may_use: set[str]
    packages: set[str] = field(default_factory=set)


_DATA = {"base", "recording", "joint"}
_FOUND = {*_DATA, "problem", "estimate"}
_SOUGHT = {*_FOUND, "identification", "identification/search"}

FOLDERS: dict[str, Folder] = {
    "base": Folder(may_use=set(), packages={"pandas"}),
    "recording": Folder(may_use={"base"}, packages={"numpy", "pandas"}),
    "recording/messages": Folder(
        may_use={"base", "recording"}, packages={"numpy", "mcap", "rosbags", "lz4", "zstandard"}
    ),
    "recording/hierarchies": Folder(may_use={"base", "recording"}, packages={"numpy", "h5py"}),
    "recording/wide": Folder(may_use={"base", "recording"}, packages={"numpy"}),
    "recording/readers": Folder(
        may_use={
            *("base", "recording", "recording/messages", "recording/hierarchies", "recording/wide"),
        },
        packages={"numpy", "pyarrow", "wpiutil"},
    ),
    "joint": Folder(may_use={"base", "recording"}, packages={"numpy", "tomlkit"}),
    "balance": Folder(may_use={"base", "recording"}, packages={"numpy"}),
    "problem": Folder(may_use=_DATA, packages={"numpy"}),
    "estimate": Folder(may_use={*_DATA, "problem"}, packages={"numpy", "pandas"}),
    "identification": Folder(
        may_use={
            "balance",
            *_SOUGHT,
            *("identification/selection", "identification/inference", "identification/warnings"),
            *("identification/self_test", "identification/refinements"),
            "identification/causes",
        },
        packages={"numpy"},
    ),
    "identification/causes": Folder(may_use=_FOUND - {"joint"}, packages={"numpy"}),
    "identification/refinements": Folder(
        may_use={*(_FOUND - {"joint"}), "balance"}, packages={"numpy"}
    ),
    "identification/search": Folder(
        may_use={*(_FOUND - {"recording"}), "balance"}, packages={"numpy"}
    ),
    "identification/selection": Folder(
        may_use={"balance", *_FOUND, "identification/search"}, packages={"numpy"}
    ),
    # It identifies again, and is imported when an estimate is asked for it.
    "identification/self_test": Folder(
        may_use={*(_FOUND - {"joint"}), *("identification/search", "identification/inference")},
        packages={"numpy"},
    ),
    "identification/inference": Folder(
        may_use={"balance", *_FOUND, "identification/search"}, packages={"numpy"}
    ),
    "identification/warnings": Folder(
        may_use={"balance", *_FOUND, "identification/inference", "identification/causes"},
        packages={"numpy"},
    ),
    "comparison": Folder(may_use={"balance", *_SOUGHT, "servo"}, packages={"numpy", "pandas"}),
    "joints": Folder(
        may_use={*(_SOUGHT - {"problem"}), "recording/wide", "identification/causes"},
        packages={"numpy", "pandas"},
    ),
    "online": Folder(may_use={"balance", *_SOUGHT, "identification/inference"}, packages={"numpy"}),
    "simulation": Folder(may_use=_DATA, packages={"numpy"}),
    "study": Folder(may_use={*_SOUGHT, "simulation"}, packages={"numpy", "pandas", "pyarrow"}),
    "excitation": Folder(
        may_use={*(_SOUGHT - {"identification/search"}), "simulation", "plot"},
        packages={"numpy", "matplotlib", "pandas"},
    ),
    "robot/links": Folder(
        may_use={"base", "joint", "recording", "recording/wide"}, packages={"numpy", "pinocchio"}
    ),
    "robot/motion": Folder(
        may_use={"base", "problem", "recording", "recording/wide", "robot/links"},
        packages={"numpy"},
    ),
    "robot/balance": Folder(
        may_use={"balance", "identification/search", "robot/links", "robot/motion"},
        packages={"numpy"},
    ),
    "robot/result": Folder(
        may_use={
            "balance",
            "base",
            "estimate",
            "identification/inference",
            "joints",
            "problem",
            "recording/wide",
            "robot/balance",
            "robot/links",
            "robot/motion",
        },
        packages={"numpy", "pandas"},
    ),
    "robot/fit": Folder(
        may_use={
            "balance",
            "base",
            "estimate",
            "joint",
            "problem",
            "recording/wide",
            "robot/balance",
            "robot/links",
            "robot/motion",
            "robot/result",
        },
        packages={"numpy"},
    ),
    "robot/facts": Folder(
        may_use={
            "balance",
            "base",
            "estimate",
            "identification/causes",
            "joint",
            "recording/wide",
            "robot/balance",
            "robot/fit",
            "robot/links",
            "robot/motion",
            "robot/result",
        },
        packages={"numpy"},
    ),
    "robot/checks": Folder(
        may_use={
            "base",
            "estimate",
            "problem",
            "recording/wide",
            "robot/balance",
            "robot/fit",
            "robot/links",
            "robot/motion",
            "robot/result",
        },
        packages={"numpy"},
    ),
    "robot/rollout": Folder(
        may_use={
            *("base", "recording/wide", "joint", "estimate"),
            *("robot/links", "robot/motion", "robot/result"),
        },
        packages={"numpy", "pinocchio"},
    ),
    "robot": Folder(
        may_use={
            "balance",
            "base",
            "comparison",
            "estimate",
            "joint",
            "problem",
            "recording/wide",
            "robot/balance",
            "robot/checks",
            "robot/facts",
            "robot/fit",
            "robot/links",
            "robot/motion",
            "robot/result",
        },
        packages={"numpy"},
    ),
    "servo": Folder(
        may_use={"balance", *_DATA, "estimate", "identification/causes"},
        packages={"numpy", "pandas"},
    ),
    "panels": Folder(
        may_use={
            *("base", "recording", "joint", "problem", "estimate", "simulation"),
            *("robot/result", "servo", "comparison", "study", "commissioning"),
        },
        packages={"numpy"},
    ),
    "plot": Folder(
        may_use={*_DATA, "simulation", "estimate", "study", "panels"},
        packages={"numpy", "matplotlib"},
    ),
    "report": Folder(
        may_use={
            *("base", "problem", "recording", "estimate"),
            *("report/page", "report/sections", "report/renderers"),
        }
    ),
    "report/page": Folder(may_use={"base", "recording", "estimate", "panels"}),
    "report/sections": Folder(
        may_use={
            *("base", "recording", "problem", "estimate", "identification/warnings", "comparison"),
            *("joints", "robot/result", "servo", "excitation", "study", "commissioning"),
            *("panels", "report/page"),
        },
        packages={"numpy"},
    ),
    "report/renderers": Folder(may_use={"base", "report/drawing", "report/page"}),
    "report/drawing": Folder(may_use={"base", "panels"}, packages={"numpy"}),
    "exports": Folder(
        may_use={
            *("base", "joint", "estimate", "simulation", "identification", "problem"),
            *("robot/links", "robot/result", "servo"),
        },
        packages={"numpy", "scipy"},
    ),
    "hardware/session": Folder(may_use={*_DATA, "simulation"}, packages={"numpy"}),
    "hardware/can": Folder(may_use={"base", "joint"}, packages={"can"}),
    "hardware/live": Folder(may_use={"base", "hardware/session"}, packages={"numpy", "matplotlib"}),
    "hardware/emulated": Folder(may_use={"base", "hardware/can"}, packages={"numpy", "can"}),
    "hardware/bench": Folder(
        may_use={
            *(*_DATA, "recording/readers", "simulation"),
            *("hardware/session", "hardware/can", "hardware/emulated"),
        },
        packages={"numpy", "can"},
    ),
    "hardware/proof": Folder(
        may_use={"base", "joint", "hardware/session", "hardware/bench"}, packages={"numpy"}
    ),
    "hardware/elmo": Folder(
        may_use={
            *("base", "joint", "simulation"),
            *("hardware/session", "hardware/can", "hardware/bench", "hardware/emulated"),
        },
        packages={"numpy", "can"},
    ),
    # What a drive's type brings is found by its name: nothing here depends on one of them.
    "hardware": Folder(
        may_use={
            *("hardware/session", "hardware/can", "hardware/live", "hardware/bench"),
            *("hardware/emulated", "hardware/proof"),
        },
    ),
    "commissioning": Folder(
        may_use={*_SOUGHT, "simulation", "hardware/session", "hardware/bench"} - {"problem"},
        packages={"numpy"},
    ),
    # One verb an act: each finds the function of its subject in the rooms below.
    "verbs": Folder(
        may_use={
            *(*_DATA, "estimate", "identification"),
            *("recording/readers", "recording/wide", "comparison", "joints", "servo"),
            *("robot", "robot/links", "robot/result", "robot/rollout"),
            *("simulation", "excitation", "study"),
        },
        packages={"numpy"},
    ),
    # The page in a browser; what it computes is asked for in a process of its own.
    "app": Folder(
        may_use={
            *(_SOUGHT - {"problem"}),
            *("recording/readers", "comparison", "panels"),
            *("report", "report/page", "report/renderers"),
        },
        packages={"numpy", "nicegui"},
    ),
    "cli": Folder(
        may_use={
            *_SOUGHT,
            *(
                *("recording/readers", "recording/wide"),
                "comparison",
                "joints",
                *("robot", "robot/links", "robot/result", "robot/rollout"),
                "servo",
                "simulation",
                "study",
                "excitation",
                "plot",
                *("report", "report/renderers"),
                "exports",
                "verbs",
                "identification/warnings",
            ),
            *("hardware/session", "hardware/can", "hardware/live", "hardware/bench"),
            *("hardware/emulated", "hardware/proof", "commissioning", "app", ""),
        },
        packages={"numpy", "matplotlib"},
    ),
    # The face of the package: its own folder is the top one.
    "": Folder(
        may_use={
            *(_SOUGHT - {"problem", "identification"}),
            *(
                "recording/readers",
                "recording/wide",
                "comparison",
                "joints",
                "online",
                *("robot", "robot/links", "robot/result"),
                "servo",
            ),
            *("simulation", "study", "excitation"),
            *("plot", "report", "exports", "verbs", "hardware", "commissioning", "cli"),
        },
    ),
}
TOP = {"__init__", "__main__"}
# These bring python-can, a window, or a motor: imported by name, when asked for.
ASKED_FOR = {"hardware", "commissioning"}
# The registry of drive types names what is loaded only when a bench asks for it.
NAMED_ON_PURPOSE = {"hardware.bench.drive_types"}
MEDIAN = 130  # lines of a Python file, at most
# Slow to load, or of use to few: imported inside the function that needs it (hardware aside).
HEAVY = {"scipy", "pandas", "pyarrow", "matplotlib", "can", "canopen", "tomlkit", "pinocchio"}

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
    return found + _circles(repository / "python" / "jointid") + _median(python)


def _median(python: list[Path]) -> list[str]:
    lengths = [len(path.read_text(encoding="utf-8").splitlines()) for path in python]
    median = statistics.median(lengths) if lengths else 0
    return [f"python/jointid: half of its files have more than {MEDIAN} lines"] * (median > MEDIAN)


def unused_arrows(package: Path) -> list[tuple[str, str]]:
    """Pairs of folders that the table allows and no import needs, for the type checker neither."""
    used: set[tuple[str, str]] = set()
    for path in package.rglob("*.py"):
        name = path.parent.relative_to(package).as_posix().removeprefix(".")
        text = path.read_text(encoding="utf-8")
        for _, target, _ in _imported(text, _module(path, package), package):
            other = target.partition(".")[2]
            inner = package.joinpath(*other.split("."))
            used.add((name, _folder(other if inner.is_dir() else other.rpartition(".")[0])))
    allowed = {
        (name, other) for name, folder in FOLDERS.items() for other in folder.may_use - {name}
    }
    return sorted(allowed - used)


def module_graph(package: Path) -> dict[str, set[str]]:
    """Return what each module of a package imports of it, also in functions or for the type checker."""
    names = {_module(path, package): path for path in sorted(package.rglob("*.py"))}
    known = {name.removesuffix(".__init__") for name in names}
    graph: dict[str, set[str]] = {}
    for module, path in names.items():
        text = path.read_text(encoding="utf-8")
        own = module.removesuffix(".__init__")
        graph[own] = set()
        for _, target, _ in _imported(text, module, package, texts=False):
            inner = target.partition(".")[2]
            if f"{inner}.__init__" in names:
                inner = f"{inner}.__init__"
            inner = inner.removesuffix(".__init__")
            if target.startswith("jointid.") and inner in known:
                graph[own].add(inner)
        graph[own].discard(own)
    return graph


def _circles(package: Path) -> list[str]:
    """Circles of imports: between files, and between folders."""
    graph = module_graph(package)
    folder = {
        m: _folder(m if (package / m.replace(".", "/")).is_dir() else m.rpartition(".")[0])
        for m in graph
    }
    found = [
        f"python/jointid: files {', '.join(sorted(circle))} import each other"
        for circle in _components(graph)
    ]
    folders: dict[str, set[str]] = {}
    for module, targets in graph.items():
        if folder[module]:  # the face imports everything
            used = folders.setdefault(folder[module], set())
            used |= {folder[t] for t in targets if folder[t] and folder[t] != folder[module]}
    found += [
        f"python/jointid: folders {', '.join(sorted(circle))} import each other"
        for circle in _components(folders)
    ]
    return found


def _folder(module: str) -> str:
    return module.replace(".", "/")


def _components(graph: dict[str, set[str]]) -> list[set[str]]:
    """Sets of nodes that reach each other: what remains when everything without a circle is taken away."""
    reach = {node: set(targets) for node, targets in graph.items()}
    for middle in reach:
        for node in reach:
            if middle in reach[node]:
                reach[node] |= reach[middle]
    seen: set[str] = set()
    found = []
    for node in reach:
        if node in reach[node] and node not in seen:
            circle = {node} | {other for other in reach[node] if node in reach.get(other, set())}
            seen |= circle
            found.append(circle)
    return found


def _module(path: Path, package: Path) -> str:
    return ".".join(path.relative_to(package).with_suffix("").parts)


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
            if (path.relative_to(root).as_posix(), name) != WRITES_TEXT:
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
    module = _module(path, package)
    name = path.parent.relative_to(package).as_posix().removeprefix(".")
    if name not in FOLDERS:
        yield f"folder '{name}' is unknown: enter it in FOLDERS of tests/house_rules.py"
        return
    if not name and path.stem not in TOP:
        yield f"module '{module}' stands at the top: give it a folder"
    rules = FOLDERS[name]
    text = path.read_text(encoding="utf-8")
    if re.search(rf"^(?:def|class) {path.stem}\b", text, re.MULTILINE):
        yield f"bears the name of what it defines, '{path.stem}': from the package only one is seen"
    for line, target, inside in _imported(text, module, package):
        root = target.split(".")[0]
        light = inside or name.split("/")[0] in ASKED_FOR  # loaded when asked for
        if root != "jointid":
            if root not in sys.stdlib_module_names and root not in rules.packages:
                allowed = ", ".join(sorted(rules.packages)) or "none"
                yield f"line {line} imports {root}: packages allowed in {name or 'the face'}: {allowed}"
            elif root in HEAVY and not light:
                yield f"line {line} imports {root} with the module: do it in the function"
            continue
        other = target.partition(".")[2]
        if other == "_core":
            continue
        inner = package.joinpath(*other.split("."))
        used = _folder(other if inner.is_dir() else other.rpartition(".")[0])
        if used not in FOLDERS or not (inner.is_dir() or inner.with_suffix(".py").exists()):
            yield f"line {line} imports jointid.{other}, which is unknown to tests/house_rules.py"
        elif used != name and used not in rules.may_use:
            allowed = ", ".join(sorted(rules.may_use - {""})) or "no other folder"
            yield f"line {line} imports jointid.{other} ({used or 'face'}): {name} may use {allowed}"
        elif used.split("/")[0] in ASKED_FOR and not light:
            yield f"line {line} imports jointid.{other} with the module: do it in the function"


def _imported(
    text: str, module: str, package: Path, *, texts: bool = True
) -> Iterator[tuple[int, str, bool]]:
    """Yield line, full module name, and whether loading the module leaves it alone.

    With `texts`, also modules that a text names.
    """
    for node, late in _naming(text):
        if isinstance(node, ast.Import):
            for alias in node.names:
                yield node.lineno, alias.name, late
        elif isinstance(node, ast.ImportFrom):
            base = node.module or ""
            if (
                node.level
            ):  # relative: drop the module's own name, then one part for each further dot
                parents = ["jointid", *module.split(".")][: -node.level]
                base = ".".join([*parents, *([node.module] if node.module else [])])
            for alias in node.names:
                full = f"{base}.{alias.name}"
                place = package.joinpath(*full.split(".")[1:])
                is_module = full.startswith("jointid.") and (
                    place.is_dir() or place.with_suffix(".py").exists() or alias.name == "_core"
                )
                yield node.lineno, full if is_module else base, late
        elif texts and isinstance(node, ast.Constant) and isinstance(node.value, str):
            # A module named in a text is imported by its name, sooner or later.
            named = re.fullmatch(r"(jointid(?:\.\w+)+)(?::\w+)?", node.value)
            if named and module not in NAMED_ON_PURPOSE:
                place = package.joinpath(*named[1].split(".")[1:])
                if place.is_dir() or place.with_suffix(".py").exists():
                    yield node.lineno, named[1], True


_CHECKING = {"TYPE_CHECKING", "typing.TYPE_CHECKING"}


@cache
def _naming(text: str) -> list[tuple[ast.AST, bool]]:
    """A source's imports and texts, and whether loading leaves each alone."""
    found: list[tuple[ast.AST, bool]] = []

    def look(node: ast.AST, late: bool) -> None:
        if isinstance(node, ast.Import | ast.ImportFrom | ast.Constant):
            found.append((node, late))
            return
        late = late or isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda)
        only = isinstance(node, ast.If) and ast.unparse(node.test) in _CHECKING
        for name in node._fields:
            value = getattr(node, name)
            for each in value if isinstance(value, list) else (value,):
                if isinstance(each, ast.AST) and each._fields:
                    look(each, late or (only and name == "body"))

    look(ast.parse(text), False)
    return found
