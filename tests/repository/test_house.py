"""Who may use whom: the rules of `house.py` hold in this repository, and each of them can fail."""

from pathlib import Path

import pytest
from house_rules import GROUPS, HEAVY, ROOMS, check

REPOSITORY = Path(__file__).resolve().parents[2]


def test_the_house_is_in_order() -> None:
    assert sorted((REPOSITORY / "cpp").rglob("*.cpp"))
    assert sorted((REPOSITORY / "python").rglob("*.py"))
    assert check(REPOSITORY) == []


def tree(root: Path, files: dict[str, str]) -> Path:
    for name, text in files.items():
        path = root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    return root


CLEAN = {
    "cpp/base/pool.hpp": "#pragma once\n#include <thread>\n#include <Eigen/Core>\n",
    "cpp/base/pool.cpp": '#include "pool.hpp"\n#include "base/pool.hpp"\n// #include <iostream>\n',
    "cpp/model/joint.hpp": '#include "base/pool.hpp"\n',
    "cpp/search/genetic.hpp": '#include "base/pool.hpp"\n',
    "cpp/identify/recording/mask.hpp": '#include "base/pool.hpp"\n',
    "cpp/identify/balance/terms.hpp": '#include "identify/recording/mask.hpp"\n',
    "cpp/identify/penalty/penalty.hpp": (
        '#include "model/joint.hpp"\n#include "identify/balance/terms.hpp"\n'
    ),
    "cpp/identify/solve/refit.hpp": (
        '#include "identify/penalty/penalty.hpp"\n#include "search/genetic.hpp"\n'
    ),
    "cpp/bind/module.cpp": (
        '#include <pybind11/pybind11.h>\n#include "identify/penalty/penalty.hpp"\n'
    ),
    "cpp/tests/check.cpp": '#include <cstdio>\n#include "model/joint.hpp"\n',
    "python/jointid/__init__.py": (
        "from jointid.identification import identify\n"
        "from . import _core\n"
        "def __getattr__(name):\n    from jointid import hardware\n    return hardware\n"
    ),
    "python/jointid/base/errors.py": "class InputError(ValueError): pass\n",
    "python/jointid/recording.py": (
        "from typing import TYPE_CHECKING\nimport numpy as np\nfrom .base.errors import InputError\n"
        "if TYPE_CHECKING:\n    import pandas\n"
    ),
    "python/jointid/identification.py": (
        "from jointid import _core\nfrom jointid.recording import Recording\n"
        "def identify():\n    from scipy import stats\n    return stats\n"
    ),
    "python/jointid/plot/estimate.py": (
        "from ..identification import identify\ndef draw():\n    import matplotlib.pyplot\n"
    ),
    "python/jointid/cli/command_line.py": (
        "import jointid\n"
        "def main():\n    from ..plot.estimate import draw\n    from ..hardware import bus\n"
    ),
    "python/jointid/hardware/__init__.py": "from .bus import Bus\n",
    "python/jointid/hardware/bus.py": (
        "import can\nfrom ..recording import Recording\nfrom . import limits\nclass Bus: pass\n"
    ),
    "python/jointid/hardware/limits.py": "",
}


def test_the_folders_of_the_core_have_no_circle() -> None:
    above: set[str] = set()
    for room, used in ROOMS.items():
        assert room in {"bind", "tests"} or used <= above, room
        above.add(room)


def test_a_clean_house_passes(tmp_path: Path) -> None:
    assert check(tree(tmp_path, CLEAN)) == []


@pytest.mark.parametrize(
    ("file", "line", "complaint"),
    [
        ("cpp/base/pool.hpp", '#include "model/joint.hpp"', "base may use no other room"),
        ("cpp/base/pool.hpp", '#include "../model/joint.hpp"', "base may use no other room"),
        ("cpp/base/pool.hpp", "#include <model/joint.hpp>", "base may use no other room"),
        ("cpp/model/joint.hpp", '#  include "search/genetic.hpp"', "model may use base"),
        ("cpp/search/genetic.hpp", '#include "model/joint.hpp"', "search may use base"),
        ("cpp/model/joint.hpp", '#include "identify/penalty/penalty.hpp"', "model may use base"),
        (
            "cpp/identify/recording/mask.hpp",
            '#include "identify/balance/terms.hpp"',
            "identify/recording may use base",
        ),
        (
            "cpp/identify/penalty/penalty.hpp",
            '#include "../solve/refit.hpp"',
            "identify/penalty may use base, identify/balance, identify/recording, model",
        ),
        ("cpp/identify/extra/new.hpp", "", "room 'identify/extra' is unknown"),
        ("cpp/identify/loose.hpp", "", "room 'identify' is unknown"),
        ("cpp/tests/check.cpp", '#include "bind/module.cpp"', "tests may use base"),
        ("cpp/search/genetic.hpp", "#include <pybind11/numpy.h>", "only bind/ knows of Python"),
        ("cpp/tests/check.cpp", "#include <Python.h>", "only bind/ knows of Python"),
        ("cpp/base/pool.hpp", "#include <iostream>", "prints nothing"),
        ("cpp/bind/module.cpp", "#include <cstdio>", "prints nothing"),
        ("cpp/base/pool.cpp", "void f() { std::cerr << 1; }", "prints:"),
        ("cpp/base/pool.cpp", 'void f() { printf("1"); }', "prints:"),
        ("cpp/base/pool.cpp", "#include <boost/any.hpp>", "std and Eigen only"),
        ("cpp/base/pool.cpp", "#include <pthread.h>", "std and Eigen only"),
        ("cpp/base/pool.cpp", '#include "gone.hpp"', "not in cpp/"),
        ("cpp/attic/old.cpp", "", "room 'attic' is unknown"),
        ("cpp/base/math_utils.hpp", "", "'utils' says nothing"),
        ("cpp/base/pool.hpp", "//\n" * 397, "has 401 lines"),
    ],
)
def test_a_forbidden_include_is_found(tmp_path: Path, file: str, line: str, complaint: str) -> None:
    house = tree(tmp_path, {**CLEAN, file: CLEAN.get(file, "") + line + "\n"})
    (found,) = check(house)
    assert found.startswith(f"{file}: ")
    assert complaint in found


@pytest.mark.parametrize(
    ("file", "line", "complaint"),
    [
        ("recording.py", "from jointid.identification import identify", "recording may use core"),
        ("recording.py", "from jointid import identification", "recording may use core"),
        ("recording.py", "def f():\n    from . import cli", "recording may use core"),
        ("recording.py", "import jointid.plot.estimate", "recording may use core"),
        ("recording.py", "import jointid", "jointid.__init__ (face)"),
        ("recording.py", "from jointid import identify", "jointid.__init__ (face)"),
        (
            "identification.py",
            "from jointid.hardware import bus",
            "analysis may use core, recording",
        ),
        ("identification.py", "def f():\n    import jointid.hardware.can.bus", "analysis may use"),
        (
            "identification.py",
            "from .plot.estimate import draw",
            "analysis may use core, recording",
        ),
        ("hardware/bus.py", "from ..identification import identify", "hardware may use core"),
        ("hardware/bus.py", "def f():\n    from jointid import plot", "hardware may use core"),
        ("recording.py", "import can", "packages allowed in recording"),
        ("recording.py", "import requests", "packages allowed in recording"),
        ("plot/estimate.py", "def f():\n    import scipy", "packages allowed in presentation"),
        ("recording.py", "import pandas as pd", "imports pandas with the module"),
        (
            "recording.py",
            "try:\n    import tomlkit\nexcept ImportError: pass",
            "imports tomlkit with",
        ),
        (
            "identification.py",
            "class A:\n    from scipy import stats",
            "imports scipy with the module",
        ),
        ("plot/estimate.py", "from matplotlib import pyplot", "imports matplotlib with the module"),
        ("cli/command_line.py", "from jointid.hardware import bus", "with the module"),
        ("__init__.py", "from . import hardware", "with the module"),
        ("sweeping.py", "", "module 'sweeping' is unknown"),
        ("recording.py", "from .sweeping import sweep", "unknown to tests/house_rules.py"),
        ("recording.py", "class recording: pass", "bears the name"),
        ("recording.py", "#\n" * 400, "lines, the longest allowed is 400"),
    ],
)
def test_a_forbidden_import_is_found(tmp_path: Path, file: str, line: str, complaint: str) -> None:
    place = f"python/jointid/{file}"
    house = tree(tmp_path, {**CLEAN, place: CLEAN.get(place, "") + line + "\n"})
    (found,) = check(house)
    assert found.startswith(f"{place}: ")
    assert complaint in found


@pytest.mark.parametrize("word", ["data", "manager", "helper", "utils", "handler", "process", "do"])
def test_a_name_that_says_nothing_is_found(tmp_path: Path, word: str) -> None:
    house = tree(tmp_path, {**CLEAN, f"python/jointid/hardware/{word}_frames.py": ""})
    (found,) = check(house)
    assert f"'{word}' says nothing" in found


def test_the_tables_name_only_what_they_know() -> None:
    assert all(used <= ROOMS.keys() for used in ROOMS.values())
    assert all(group.may_use <= GROUPS.keys() for group in GROUPS.values())
    allowed = set().union(*(group.packages for group in GROUPS.values()))
    assert allowed >= HEAVY
