"""Every example runs and gives what its text promises."""

import importlib.util
from pathlib import Path
from types import ModuleType

import matplotlib
import pytest

import jointid as jid

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


def _run(path: Path) -> tuple[ModuleType, jid.Estimate]:
    module = _module(path)
    estimate = module.main()
    assert estimate.status == "converged"
    return module, estimate


@pytest.mark.parametrize("path", EXAMPLES[:2], ids=lambda path: path.stem)
def test_example_runs(path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    _run(path)
    assert "coulomb" in capsys.readouterr().out


def test_arrays_example_recovers_what_it_made() -> None:
    module, estimate = _run(EXAMPLES[2])
    assert estimate.parameters["coulomb"].value == pytest.approx(module.TRUE_COULOMB, rel=0.01)
    assert estimate.parameters["viscous"].value == pytest.approx(module.TRUE_VISCOUS, rel=0.01)


def test_simulation_example_closes_the_ring(capsys: pytest.CaptureFixture[str]) -> None:
    _run(EXAMPLES[3])
    lines = capsys.readouterr().out.splitlines()
    error = {
        name: float(line.split()[-2])
        for line in lines
        for name in ("first guess", "identified", "true")
        if line.startswith(f"  {name} ")
    }
    assert error["identified"] < error["first guess"] / 10.0
    assert error["identified"] == pytest.approx(error["true"], rel=0.05)


@pytest.mark.slow
def test_bench_example_closes_the_ring(capsys: pytest.CaptureFixture[str]) -> None:
    _run(EXAMPLES[4])
    printed = capsys.readouterr().out
    assert "all pre-flight checks passed" in printed
    factor = printed.split("fell by a factor of ")[1].split(";")[0]
    assert float(factor) > 10.0
