"""What is imported when: `import jointid` brings no room, `jointid --help` neither, and neither hides a name."""

import ast
import json
import subprocess
import sys
from pathlib import Path

import pytest
from example_recordings import WELL_EXCITED

import jointid as jid

# What the face itself needs; every other module comes with the first name that needs it.
FACE = {"jointid", "jointid.base", "jointid.base.interruption", "jointid.base.joining"}
HELP = {
    *("jointid.__main__", "jointid.cli", "jointid.cli.command_line", "jointid.cli.command_table"),
    *("jointid.cli.exit_codes", "jointid.cli.parser"),
}
HEAVY = {"scipy", "matplotlib", "can", "canopen", "pandas", "tomlkit", "pyarrow", "pinocchio"}


def loaded(script: str) -> set[str]:
    """Names of the modules that a script loads into a fresh interpreter."""
    program = (
        "import json, sys\nbefore = set(sys.modules)\n"
        f"{script}\nprint(json.dumps(sorted(set(sys.modules) - before)))"
    )
    command = [sys.executable, "-W", "error", "-c", program]
    run = subprocess.run(command, capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stderr
    modules: list[str] = json.loads(run.stdout.splitlines()[-1])
    return set(modules)


def roots(modules: set[str]) -> set[str]:
    """Packages that are not of the standard library; numpy's compiled modules leave their runtime's own entries."""
    found = {name.partition(".")[0] for name in modules} - sys.stdlib_module_names
    return {root for root in found if "cython" not in root}


def test_import_brings_no_room() -> None:
    modules = loaded("import jointid")
    assert {name for name in modules if name.startswith("jointid")} == FACE
    assert roots(modules) == {"jointid"}


def test_help_brings_no_room() -> None:
    script = (
        "import runpy\nsys.argv = ['jointid', '--help']\n"
        "try: runpy.run_module('jointid', run_name='__main__')\n"
        "except SystemExit as end: assert not end.code"
    )
    modules = loaded(script)
    assert {name for name in modules if name.startswith("jointid")} <= FACE | HELP
    assert roots(modules) == {"jointid"}
    # They are slow to import, and of no use here.
    assert not modules & {"dataclasses", "inspect", "traceback", "tempfile", "difflib"}


def test_all_names_are_there_and_bring_only_numpy() -> None:
    names = ["plot", "__version__", *jid._HOME_OF]
    modules = loaded(f"import jointid\nfor name in {names}: getattr(jointid, name)")
    assert {"jointid._core", "jointid.plot"} <= modules
    assert roots(modules) == {"jointid", "numpy"}
    assert not [name for name in modules if name.startswith("jointid.hardware")]


def test_completion_shows_what_is_not_loaded_yet() -> None:
    assert set(jid.__all__) <= set(dir(jid))
    shown = loaded_names("import jointid; print(*dir(jointid))")
    assert {each for each in shown if not each.startswith("__")} == {*jid.__all__} - {"__version__"}


def test_a_star_brings_every_name() -> None:
    found = loaded_names("from jointid import *; print(*globals())")
    assert set(jid.__all__) <= found


def loaded_names(script: str) -> set[str]:
    """The words that a script prints."""
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=True
    )
    return set(done.stdout.split())


def test_a_name_that_is_not_there_is_refused() -> None:
    with pytest.raises(AttributeError, match="module 'jointid' has no attribute 'nonsense'"):
        getattr(jid, "nonsense")  # noqa: B009 (a type checker knows that it is not there)


def test_a_name_is_loaded_once() -> None:
    assert jid.identify is jid.identify
    assert "identify" in vars(jid)


def test_the_type_checker_sees_what_is_loaded() -> None:
    """The imports for the type checker and the table of homes say the same."""
    tree = ast.parse(Path(jid.__file__).read_text(encoding="utf-8"))
    (checked,) = (
        node
        for node in tree.body
        if isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING"
    )
    homes = {
        (alias.asname or alias.name): node.module
        for node in checked.body
        if isinstance(node, ast.ImportFrom)
        for alias in node.names
    }
    homes = {name: home for name, home in homes.items() if name not in jid._FOLDERS}
    assert homes == jid._HOME_OF
    assert set(jid.__all__) <= {*homes, *jid._FOLDERS, "__version__"}


def test_the_missing_core_is_said_at_once(tmp_path: Path) -> None:
    package = tmp_path / "jointid"
    source = Path(jid.__file__).parent
    for name in ("__init__.py", "base/__init__.py", "base/interruption.py", "base/joining.py"):
        target = package / name
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_bytes((source / name).read_bytes())
    script = f"import sys; sys.path.insert(0, {str(tmp_path)!r}); import jointid"
    done = subprocess.run(
        [sys.executable, "-S", "-c", script], capture_output=True, text=True, check=False
    )
    assert "jointid's compiled core is missing" in done.stderr


def test_the_room_that_designs_is_loaded_by_the_first_design() -> None:
    before = "from jointid.estimate.estimate import Estimate\n"
    after = "from jointid.base.joining import joined\nassert callable(joined('next_motion'))"
    assert "jointid.excitation.next_motion" not in loaded(before)
    assert "jointid.excitation.next_motion" in loaded(before + after)


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A plain file of numbers."""
    path = tmp_path_factory.mktemp("run") / "run.csv"
    jid.load(WELL_EXCITED).save(path)
    return path


def command(*arguments: str) -> str:
    """A script that is one call of the command line."""
    return (
        f"import runpy\nsys.argv = ['jointid', *{arguments!r}, '--quiet']\n"
        "try: runpy.run_module('jointid', run_name='__main__')\n"
        "except SystemExit as end: assert not end.code"
    )


def test_a_report_brings_only_numpy(recording: Path, tmp_path: Path) -> None:
    """Pictures too: they are drawn without a plotting library."""
    page = tmp_path / "report.html"
    modules = loaded(command("identify", str(recording), "--report", str(page)))
    assert roots(modules) == {"jointid", "numpy"}
    assert page.read_text(encoding="utf-8").count("<svg ") > 1
    rooms = ("jointid.plot", "jointid.study", "jointid.simulation", "jointid.robot")
    assert not [name for name in modules if name.startswith(rooms)]
    assert not modules & {"numpy.random", "numpy.fft", "numpy.testing", "numpy.polynomial"}


def test_a_session_with_its_report_brings_no_plotting(tmp_path: Path) -> None:
    bench = Path(__file__).resolve().parents[2] / "examples" / "hardware" / "joint.toml"
    runs = tmp_path / "runs"
    session = command("run", str(bench), "--emulate", "--cycles", "0", "--output", str(runs))
    modules = loaded(session)
    assert not roots(modules) & {"matplotlib", "scipy", "pandas"}
    assert (runs / "report.html").read_text(encoding="utf-8").count("<svg ") == 1


# The folders of the package that a command loads, and no other.
READING = {
    *("base", "cli", "joint", "recording", "recording.readers", "recording.wide"),
    *("identification", "identification.search"),
}
IDENTIFYING = READING | {
    *("balance", "estimate", "problem", "identification.causes", "identification.inference"),
    *("identification.refinements", "identification.selection", "identification.warnings"),
}
# What a command needs of the standard library beside what NumPy, argparse, pathlib and dataclasses have loaded before:
# the last of them brings inspect, which later NumPys load themselves, and 2.0 does not.
LIBRARY = {
    *(
        "__future__",
        "atexit",
        "csv",
        "gc",
        "hashlib",
        "importlib",
        "locale",
        "select",
        "shlex",
        "signal",
    ),
    *("string", "tomllib", "zlib"),
}
COMMANDS: dict[str, tuple[list[str], set[str], int]] = {
    "identify": (["identify", "RUN", "--quiet"], IDENTIFYING, 254),
    "identify --report": (
        ["identify", "RUN", "--quiet", "--report", "PAGE"],
        IDENTIFYING
        | {"panels", "report", "report.drawing"}
        | {"report.page", "report.renderers", "report.sections"},
        302,
    ),
    "compare": (["compare", "RUN", "--quiet"], IDENTIFYING | {"comparison"}, 274),
    "info": (["info", "RUN"], IDENTIFYING, 220),
}


@pytest.mark.parametrize("command", COMMANDS)
def test_a_command_brings_what_it_needs(command: str, recording: Path) -> None:
    """A set in this message is of newcomers: import them where they are used, or enter them above."""
    words, rooms, most = COMMANDS[command]
    files = {"RUN": str(recording), "PAGE": str(recording.with_suffix(".html"))}
    arguments = ["jointid", *(files.get(word, word) for word in words)]
    script = (
        "import argparse, contextlib, dataclasses, io, pathlib, runpy, sys\n"
        "import numpy\nknown = set(sys.modules)\n"
        f"sys.argv = {arguments}\n"
        "with contextlib.redirect_stdout(io.StringIO()):\n"
        "    try: runpy.run_module('jointid', run_name='__main__')\n"
        "    except SystemExit as end: assert not end.code\n"
        "before |= known"
    )
    modules = loaded(script)
    assert roots(modules) - {"jointid"} <= {"numpy"}
    # numpy.ma alone takes a third of the time that NumPy takes.
    parts = {name for name in modules if name.startswith("numpy.")}
    assert parts - {"numpy.typing", "numpy._typing._add_docstring"} == set()
    # Each takes a 500th of what NumPy takes.
    assert len({name for name in modules if name.startswith("jointid.")}) <= most
    folders = {name.rpartition(".")[0] for name in modules if name.startswith("jointid.")}
    assert folders - {"jointid"} - {f"jointid.{room}" for room in rooms} == set()
    library = {name.partition(".")[0] for name in modules} & sys.stdlib_module_names
    assert {name for name in library if not name.startswith("_")} - LIBRARY == set()


def test_the_first_identify_brings_only_numpy(recording: Path) -> None:
    modules = loaded(f"from jointid import identify, load\nidentify(load({str(recording)!r}))")
    assert roots(modules) == {"jointid", "numpy"}
