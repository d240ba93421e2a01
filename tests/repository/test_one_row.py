"""A new term is one row: nobody else spells a term's name, but for the places listed here with a reason."""

import ast
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

from jointid import _core

REPOSITORY = Path(__file__).resolve().parents[2]
TABLE = "cpp/identify/balance/terms.cpp"

# Places that may name a term: the term (a whole name, or a beginning that ends in `*`), where, and why.
ALLOWED: list[tuple[str, str, str]] = [
    # Known for another reason than the balance.
    ("inertia*", "cpp/", "a property of any joint, simulated or estimated"),
    ("inertia*", "python/jointid/", "a property of the joint file, which may fix it"),
    ("gravity_*", "python/jointid/", "gravity may be known from the link: it is then no unknown"),
    ("sensor_*", "cpp/", "the residual may be in the sensor's units"),
    ("sensor_*", "python/jointid/", "the residual may be in the sensor's units"),
    ("torque_offset", "cpp/model/", "simulated"),
    ("torque_offset", "cpp/bind/simulate", "simulated"),
    ("torque_offset", "cpp/identify/penalty/penalty.cpp", "its integral is a window's duration"),
    (
        "torque_offset",
        "cpp/identify/penalty/part_residuals.cpp",
        "its integral is a window's duration",
    ),
    (
        "torque_offset",
        "python/jointid/",
        "an option of the model, which the sensor's offset excludes",
    ),
    ("load_friction*", "python/jointid/joint/", "an option of the model, and of the joint file"),
    ("load_friction*", "python/jointid/online/settings.py", "an option of the model"),
    (
        "load_friction*",
        "python/jointid/identification/plain_least_squares.py",
        "an option of the model",
    ),
    ("load_friction*", "python/jointid/comparison/load_evidence.py", "an option of the model"),
    ("load_friction*", "python/jointid/cli/advice.py", "an option of the model"),
    ("load_friction*", "python/jointid/problem/terms.py", "an option of the model, and its terms"),
    (
        "load_friction*",
        "python/jointid/simulation/",
        "an option of the model, and a field of the simulated joint",
    ),
    ("load_friction", "cpp/identify/penalty/", "the balance is not linear in it"),
    ("link_share", "cpp/identify/penalty/", "the balance is not linear in it"),
    ("link_share", "python/jointid/", "known where the link and the drive are"),
    (
        "load_friction",
        "cpp/model/joint.cpp",
        "the simulated joint's, which needs the drive's torque",
    ),
    ("load_friction", "cpp/bind/simulate.cpp", "the simulated joint's, which needs the torque"),
    # Capabilities: what a row declares as simulated or compensated is written here, once each.
    ("*", "cpp/simulate/estimates.hpp", "what controllers compensate"),
    ("*", "cpp/bind/simulate_controllers.cpp", "what controllers compensate"),
    ("*", "python/jointid/simulation/plant.py", "values for both"),
    # Judgements about one friction model.
    ("*", "python/jointid/identification/warnings/", "whether the data support static friction"),
    ("*", "python/jointid/identification/causes/", "causes of a misfit, some named like a term"),
    ("static", "python/jointid/identification/refinements/", "decays of any shape, for a delay"),
    ("coulomb", "python/jointid/identification/refinements/", "the size of what creep contradicts"),
    ("coulomb*", "python/jointid/problem/constant_torque.py", "collinear with an offset"),
    (
        "coulomb",
        "python/jointid/identification/inference/offset_or_asymmetry.py",
        "an offset takes up its asymmetry",
    ),
    ("*", "python/jointid/joint/own_terms.py", "kinds of own terms, called like the terms"),
    ("*", "python/jointid/problem/own_integrals.py", "kinds of own terms, called like the terms"),
    ("*", "python/jointid/joint/thesis.py", "the thesis's joint, with its bounds"),
    ("coulomb", "python/jointid/simulation/scenario.py", "a controller with friction estimates"),
    ("coulomb", "python/jointid/cli/", "a controller with friction estimates; the demo's values"),
    ("viscous", "python/jointid/cli/", "the demo's values"),
    ("load_friction", "cpp/bind/simulate_servo.cpp", "a servo's friction, by its name"),
    ("load_friction", "cpp/simulate/servo_loop.cpp", "a servo's friction, by its name"),
    ("viscous", "cpp/bind/design.cpp", "what the torque limit has to leave for friction"),
    ("coulomb", "python/jointid/hardware/bench/", "a controller with friction estimates"),
    ("coulomb", "python/jointid/commissioning/", "a controller with friction estimates"),
    # Tables that show derived quantities: breakaway torque and Stribeck velocity.
    ("*", "python/jointid/estimate/", "derived quantities of the Stribeck curve"),
]
# A friction model and a shape parameter of the same name: where the text is the model's.
MODELS = {model.name for model in _core.models()}


def names() -> set[str]:
    """Keys, names and shapes of the table, as the built core has them."""
    rows = _core.terms()
    return (
        {row.key for row in rows}
        | {row.name for row in rows}
        | {s for r in rows for s in r.shapes}
        | {shape.name for shape in _core.shapes()}
    )


@cache
def strings(path: Path) -> list[tuple[int, str]]:
    """Every string of a source file but docstrings, with its line."""
    return [*_strings(path)]


def _strings(path: Path) -> Iterator[tuple[int, str]]:
    text = path.read_text(encoding="utf-8")
    if path.suffix != ".py":
        for number, line in enumerate(text.splitlines(), 1):
            code = re.sub(r"^\s*//.*|\s//.*", "", line)
            yield from ((number, found) for found in re.findall(r'"((?:[^"\\]|\\.)*)"', code))
        return
    tree = ast.parse(text)
    documents = {
        id(node.value)
        for node in ast.walk(tree)
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)
    }
    for node in ast.walk(tree):
        if (
            isinstance(node, ast.Constant)
            and isinstance(node.value, str)
            and id(node) not in documents
        ):
            yield node.lineno, node.value


def allowed(name: str, place: str) -> bool:
    return any(
        place.startswith(folder)
        and (name.startswith(term[:-1]) if term.endswith("*") else name == term)
        for term, folder, _ in ALLOWED
    )


def spelt(repository: Path, wanted: set[str]) -> list[str]:
    """Every place outside the table that spells a term's name without being allowed to."""
    found = []
    for path in sorted([*(repository / "cpp").rglob("*"), *(repository / "python").rglob("*.py")]):
        place = path.relative_to(repository).as_posix()
        if path.suffix not in {".cpp", ".hpp", ".py"} or place == TABLE or "/tests/" in place:
            continue
        for line, text in strings(path):
            base = text.split("[")[0]
            if base in wanted - MODELS and not allowed(base, place):
                found.append(f"{place}:{line}: '{text}'")
    return found


def test_a_term_is_spelt_in_its_row_alone() -> None:
    assert spelt(REPOSITORY, names()) == []


def test_a_name_anywhere_else_is_found(tmp_path: Path) -> None:
    for place, line in (
        ("cpp/bind/extra.cpp", 'auto x = f("swirl");'),
        ("python/x.py", "x = 'swirl[1]'"),
    ):
        path = tmp_path / place
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(line, encoding="utf-8")
    (tmp_path / "python" / "y.py").write_text('"""swirl"""\n', encoding="utf-8")
    assert spelt(tmp_path, {"swirl"}) == [
        "cpp/bind/extra.cpp:1: 'swirl'",
        "python/x.py:1: 'swirl[1]'",
    ]


@pytest.mark.parametrize(("term", "folder", "reason"), ALLOWED)
def test_every_exception_is_needed(term: str, folder: str, reason: str) -> None:
    assert reason
    here = [
        text.split("[")[0]
        for path in [*(REPOSITORY / "cpp").rglob("*.?pp"), *(REPOSITORY / "python").rglob("*.py")]
        if path.relative_to(REPOSITORY).as_posix().startswith(folder)
        for _, text in strings(path)
    ]
    hits = {t for t in here if (t.startswith(term[:-1]) if term.endswith("*") else t == term)}
    assert hits & names(), f"{term} is not in {folder}: drop the exception"


def _has_orders(key: str) -> bool:
    return any(row.key == key and row.family and not row.own for row in _core.terms())


def test_every_row_of_the_source_is_in_the_built_core() -> None:
    """The table is read from the extension; a stale build would let a new row pass unseen."""
    text = (REPOSITORY / TABLE).read_text(encoding="utf-8")
    rows = text[text.index("base_rows()") : text.index("make_terms()")]
    keys = re.findall(r'(?:key = |friction\(|torque\(|harmonic\(|own\()\s*"(\w+)"', rows)
    assert len(keys) >= 15  # the pattern finds the rows
    assert {row.key for row in _core.terms()} == {
        key + side
        for key in keys
        for side in ("", "_positive", "_negative")
        if not side
        or (
            not key.endswith("_of")
            and _core.term(key + ("_2" if _has_orders(key) else "")).option == "name"
        )
    }
