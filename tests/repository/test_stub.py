"""The stub beside the extension describes it: same names, same option fields."""

import ast
import enum
import inspect
from pathlib import Path
from types import ModuleType

import pytest

import jointid as jid
from jointid import _core

STUB = Path(_core.__file__).with_name("_core.pyi")


def names_in(body: list[ast.stmt]) -> set[str]:
    """Return the public names that a stub's module or class body defines."""
    found: set[str] = set()
    for node in body:
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            found.add(node.name)
        elif isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
            found.add(node.target.id)
        elif isinstance(node, ast.Assign):
            found |= {target.id for target in node.targets if isinstance(target, ast.Name)}
    return {name for name in found if not name.startswith("_")}


def stub_classes() -> dict[str, ast.ClassDef]:
    tree = ast.parse(STUB.read_text(encoding="utf-8"))
    return {node.name: node for node in tree.body if isinstance(node, ast.ClassDef)}


def public(of: ModuleType | type) -> set[str]:
    return {name for name in dir(of) if not name.startswith("_")}


CLASSES = sorted(name for name in public(_core) if inspect.isclass(getattr(_core, name)))
# Values with fields: settings and whatever else knows `asdict`.
OPTIONS = [name for name in CLASSES if hasattr(getattr(_core, name), "asdict")]


def test_the_stub_has_the_names_of_the_extension() -> None:
    tree = ast.parse(STUB.read_text(encoding="utf-8"))
    assert names_in(tree.body) == public(_core)


def test_there_are_options_to_compare() -> None:
    assert OPTIONS


@pytest.mark.parametrize("name", CLASSES)
def test_a_class_has_the_members_of_its_stub(name: str) -> None:
    class_ = getattr(_core, name)
    # An Enum's own members are its values; `name` and `value` belong to its base class.
    members = set(class_.__members__) if issubclass(class_, enum.Enum) else public(class_)
    inherited = public(class_.__bases__[0])
    assert names_in(stub_classes()[name].body) - inherited == members - inherited


@pytest.mark.parametrize("name", OPTIONS)
def test_option_fields_of_the_stub_equal_asdict(name: str) -> None:
    methods = [node for node in stub_classes()[name].body if isinstance(node, ast.FunctionDef)]
    values = getattr(_core, name)().asdict()
    properties = {
        method.name
        for method in methods
        if any(ast.unparse(decorator) == "property" for decorator in method.decorator_list)
    }
    assert properties == set(values)
    (constructor,) = (method for method in methods if method.name == "__init__")
    keywords = [argument.arg for argument in constructor.args.kwonlyargs]
    defaults = [ast.unparse(default) for default in constructor.args.kw_defaults if default]
    assert keywords == list(values)
    # The stub has no expression for an enumeration's member, only for plain values.
    shown = [repr(v) if isinstance(v, int | float | str) else "..." for v in values.values()]
    assert defaults == shown


# Names that the package takes from the extension; others, such as Model, are classes of its own.
PUBLIC = [name for name in CLASSES if getattr(jid, name, None) is getattr(_core, name)]


@pytest.mark.parametrize("name", PUBLIC)
def test_the_stub_documents_what_is_public(name: str) -> None:
    class_, stub = getattr(_core, name), stub_classes()[name]
    assert ast.get_docstring(stub) == inspect.cleandoc(class_.__doc__)
    fields = {
        method.name: ast.get_docstring(method)
        for method in stub.body
        if isinstance(method, ast.FunctionDef) and method.name in public(class_)
    }
    for field, text in fields.items():
        member = inspect.getattr_static(class_, field)
        if isinstance(member, property) and member.__doc__:
            assert text == inspect.cleandoc(member.__doc__), field
