"""Write the stub of a built extension: `python tools/stub.py EXTENSION OUTPUT`. CMake runs it after the link.

Needs pybind11-stubgen, but neither an installed jointid nor NumPy.
"""

import ast
import importlib.util
import re
import sys
import tempfile
from pathlib import Path
from types import ModuleType

PACKAGE = Path(__file__).resolve().parent.parent / "python" / "jointid" / "__init__.py"
HEADER = "# Generated from the extension; not to be edited.\n"

# Output of the generator that is incomplete or breaks the typing rules: pattern and replacement.
REWRITES = [
    # An enumeration: members by assignment, no constructor.
    (r"^    (\w+): typing\.ClassVar\[\w+\].*$", r"    \1 = ..."),
    (r"^    @classmethod\n    def __new__\(cls, value\):\n.*\n", ""),
    # Bare containers.
    (r"(: |-> )dict(?=[,:)])", r"\1dict[str, typing.Any]"),
    (r"-> tuple:", "-> tuple[typing.Any, ...]:"),
    (r"collections\.abc\.Callable(?!\[)", "collections.abc.Callable[..., typing.Any]"),
]


def load(extension: Path) -> ModuleType:
    """Import the file as `jointid._core`, even if another module of that name is installed."""
    package = ModuleType("jointid")
    package.__path__ = []
    sys.modules["jointid"] = package
    spec = importlib.util.spec_from_file_location("jointid._core", extension)
    assert spec is not None
    assert spec.loader is not None
    core = importlib.util.module_from_spec(spec)
    sys.modules["jointid._core"] = core
    spec.loader.exec_module(core)
    return core


class AnyName(ModuleType):
    """A module that has every name."""

    def __getattr__(self, name: str) -> type:
        if name.startswith("__"):
            raise AttributeError(name)
        return object


def stand_in_for_numpy() -> None:
    """Let the generator find the names of NumPy's types, because a build environment has no NumPy."""
    if importlib.util.find_spec("numpy") is None:
        for name in ("numpy", "numpy.typing"):
            sys.modules[name] = AnyName(name)


def generate(core: ModuleType) -> str:
    """Return the stub of the module."""
    from pybind11_stubgen import main as write_stub

    stand_in_for_numpy()
    with tempfile.TemporaryDirectory() as folder:
        write_stub([core.__name__, "--exit-code", "--output-dir", folder])
        text = Path(folder, "jointid", "_core.pyi").read_text(encoding="utf-8")
    for pattern, replacement in REWRITES:
        text = re.sub(pattern, replacement, text, flags=re.MULTILINE)
    text = re.sub(
        r"^class (\w+):\n(?:(?:    .*)?\n)*",
        lambda found: keywords(found, core),
        text,
        flags=re.MULTILINE,
    )
    text = re.sub(
        r"^class \w+\(enum\.Enum\):\n(?:(?:    .*)?\n)*", members, text, flags=re.MULTILINE
    )
    if "builtins." not in text:
        text = text.replace("import builtins\n", "")
    return HEADER + documented(text, public_classes(PACKAGE.read_text(encoding="utf-8")))


def public_classes(package: str) -> set[str]:
    """Return the names that the package's source, a text, imports from the extension: its public names."""
    return {
        name.name
        for node in ast.walk(ast.parse(package))
        if isinstance(node, ast.ImportFrom) and node.module == "jointid._core"
        for name in node.names
    }


def documented(text: str, public: set[str]) -> str:
    """Keep only the docstrings of these classes, which an editor shows; the extension has all docstrings."""
    lines = text.splitlines()
    pending: list[ast.stmt] = list(ast.parse(text).body)
    while pending:
        node = pending.pop()
        if not isinstance(node, ast.ClassDef | ast.FunctionDef):
            continue
        if isinstance(node, ast.ClassDef) and node.name in public:
            continue
        pending += node.body
        if ast.get_docstring(node) is not None:
            first = node.body[0]
            assert first.end_lineno is not None
            kept = [" " * first.col_offset + "..."] if len(node.body) == 1 else [""]
            empty = [""] * (first.end_lineno - first.lineno)
            lines[first.lineno - 1 : first.end_lineno] = kept + empty
    return "\n".join([*lines, ""])


def members(found: re.Match[str]) -> str:
    """Write an enumeration with its head, text and members, without the members of Python's own class."""
    head, text = re.match(r'(.*\n)((?:    """\n(?:    .*\n)*?    """\n)?)', found[0]).groups()  # type: ignore[union-attr]
    names = re.findall(r"^    ([a-z]\w*) = \.\.\.$", found[0], flags=re.MULTILINE)
    return head + text + "".join(f"    {name} = ...\n" for name in names) + "\n"


def keywords(found: re.Match[str], core: ModuleType) -> str:
    """Write a class of options with its fields as keywords instead of `**kwargs`."""
    body = found[0]
    if "(self, **kwargs)" not in body:
        return body
    types = dict(re.findall(r"@property\n    def (\w+)\(self\) -> (.+):", body))
    values = getattr(core, found[1])().asdict()
    fields = {name: types[name] for name in values}
    plain = (int, float, str)  # an enumeration member has no such expression
    shown = {name: repr(v) if isinstance(v, plain) else "..." for name, v in values.items()}
    new = ", ".join(f"{name}: {kind} = {shown[name]}" for name, kind in fields.items())
    changed = ", ".join(f"{name}: {kind} = ..." for name, kind in fields.items())
    body = body.replace("__init__(self, **kwargs)", f"__init__(self, *, {new})")
    return body.replace("replace(self, **kwargs)", f"replace(self, *, {changed})")


def main(arguments: list[str]) -> int:
    """Run the tool."""
    if len(arguments) != 2:
        sys.stderr.write(__doc__ or "")
        return 2
    extension, output = map(Path, arguments)
    output.write_text(generate(load(extension.resolve())), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
