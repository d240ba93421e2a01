"""Every example runs and gives what its text promises."""

import importlib.util
from pathlib import Path
from types import ModuleType

import matplotlib
import pytest

matplotlib.use("Agg")

EXAMPLES = sorted((Path(__file__).resolve().parents[2] / "examples").glob("[0-9]*.py"))


def _module(path: Path) -> ModuleType:
    spec = importlib.util.spec_from_file_location(f"example_{path.stem}", path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_examples_are_numbered_without_a_hole() -> None:
    assert [int(path.name[:2]) for path in EXAMPLES] == list(range(1, len(EXAMPLES) + 1))


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_example_runs(path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    estimate = _module(path).main()
    assert estimate.status == "converged"
    assert "parameter" in capsys.readouterr().out


def test_arrays_example_recovers_what_it_made() -> None:
    module = _module(EXAMPLES[2])
    estimate = module.main()
    assert estimate.parameters["coulomb"].value == pytest.approx(module.TRUE_COULOMB, rel=0.01)
    assert estimate.parameters["viscous"].value == pytest.approx(module.TRUE_VISCOUS, rel=0.01)


def test_simulation_example_closes_the_ring(capsys: pytest.CaptureFixture[str]) -> None:
    module = _module(EXAMPLES[3])
    module.main()
    lines = capsys.readouterr().out.splitlines()
    error = {
        name: float(line.split()[-2])
        for line in lines
        for name in ("first guess", "identified", "true")
        if line.startswith(f"  {name} ")
    }
    assert error["identified"] < error["first guess"] / 10.0
    assert error["identified"] == pytest.approx(error["true"], rel=0.05)


def test_bench_example_closes_the_ring(capsys: pytest.CaptureFixture[str]) -> None:
    _module(EXAMPLES[4]).main()
    told = capsys.readouterr().out
    assert "nothing speaks against a start" in told
    factor = told.split("fell by a factor of ")[1].split(";")[0]
    assert float(factor) > 10.0
