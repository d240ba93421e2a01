"""Figures 5-12 to 5-35, Tables 5-1 to 5-4: population x generations, ten trials each."""

from dataclasses import dataclass

import numpy as np
from gallery import Gallery, titled
from guess_and_error import wrong_by
from numpy.typing import NDArray
from scenario import (
    NOISE,
    TRUTH,
    controller,
    errors,
    first_recording,
    hanging_joint,
    wide_motion,
)

import jointid as jid

POPULATIONS = (20, 50, 100, 200)
GENERATIONS = (20, 50, 100, 500, 1000, 1500)


@dataclass(frozen=True)
class Cell:
    """The result of one pair of settings."""

    mean: dict[str, float]  # parameters averaged over the trials
    good: int  # trials with all six within 5 %
    wrong: dict[str, float]  # mean magnitude of each parameter's error [%]


Cells = dict[tuple[int, int], Cell]
Runs = jid.SimulatedBatch


@dataclass(frozen=True)
class Panel:
    """A grid, and how well its averaged estimates track."""

    name: str
    cells: Cells
    runs: Runs
    baseline: Runs

    @property
    def ratio(self) -> NDArray[np.float64]:
        """Tracking error against the baseline's median, a cell each."""
        return np.asarray(self.runs.error / np.median(self.baseline.error))


def run_grid(
    options: jid.GaOptions,
    populations: tuple[int, ...],
    generations: tuple[int, ...],
    trials: int,
) -> Cells:
    """Search with every pair of settings."""
    study = jid.sweep(
        first_recording(),
        hanging_joint(),
        grid={"ga.population": populations, "ga.generations": generations},
        trials=trials,
        residual="sensor",  # the residual of the thesis
        search=jid.Search("ga", ga=options),
    )
    cells: Cells = {}
    for number, (labels, summary) in enumerate(
        zip(study.cells, study.summary().cells, strict=True)
    ):
        missed = [errors(row.values) for row in study.rows if row.cell == number]
        cells[labels["ga.population"], labels["ga.generations"]] = Cell(
            mean={name: summary.mean[name] for name in TRUTH},
            good=round(summary.success * trials) if summary.success is not None else 0,
            wrong={name: float(np.mean([abs(e[name]) for e in missed])) for name in TRUTH},
        )
    return cells


def draw(gallery: Gallery) -> None:
    """Draw the tracking error of each averaged estimate, and the table of all."""
    populations = POPULATIONS[:2] if gallery.quick else POPULATIONS
    generations = GENERATIONS[:2] if gallery.quick else GENERATIONS
    trials = 2 if gallery.quick else 10
    text = run_grid(jid.GaOptions.thesis(), populations, generations, trials)
    code = run_grid(jid.GaOptions.thesis_code(), populations, generations, trials)
    panels = [
        Panel("thesis(), friction by measured velocity", text, *track(text, "measured")),
        Panel("thesis(), by reference velocity", text, *track(text, "reference")),
        Panel("thesis_code(), by reference velocity", code, *track(code, "reference")),
    ]
    _tracking(gallery, panels[0], (len(populations), len(generations)))
    _heat_maps(gallery, panels, (populations, generations), trials)
    for panel in panels:
        _note(gallery, panel, trials)


def track(cells: Cells, friction_velocity: str) -> tuple[Runs, Runs]:
    """Track with each averaged estimate, and with parameters within ±5 % at random."""
    joint = hanging_joint()
    true = joint.with_parameters(TRUTH)

    def runs(estimates: list[dict[str, float]]) -> Runs:
        laws = [controller(joint, values) for values in estimates]
        return jid.simulate_batch(
            true,
            [law.replace(friction_velocity=friction_velocity) for law in laws],
            wide_motion(),
            sensors=NOISE,
            recordings=True,
        )

    return runs([cell.mean for cell in cells.values()]), runs(
        [wrong_by(5.0, seed) for seed in range(40)]
    )


def _tracking(gallery: Gallery, panel: Panel, shape: tuple[int, int]) -> None:
    middle = panel.baseline.recordings[int(np.argsort(panel.baseline.error)[20])]
    size = (2.5 * shape[1], 2.1 * shape[0])
    with gallery.picture(
        "5-12_to_5-35_grid", *shape, size=size, sharex=True, sharey=True
    ) as panels:
        for number, (axes, pair, run) in enumerate(
            zip(panels, panel.cells, panel.runs.recordings, strict=True)
        ):
            jid.plot.tracking_error({"±5 %": middle, "averaged": run}, axes)
            titled(axes, f"5-{number + 12}: {pair[0]} × {pair[1]}")
            axes.legend(fontsize=6.5, loc="upper right", handlelength=2.5)
            axes.set_xlabel("time [s]" if number >= (shape[0] - 1) * shape[1] else "")
            axes.set_ylabel("" if number % shape[1] else "error [mrad]")


def _heat_maps(
    gallery: Gallery,
    panels: list[Panel],
    axis: tuple[tuple[int, ...], tuple[int, ...]],
    trials: int,
) -> None:
    from matplotlib.colors import LogNorm

    shape = len(axis[0]), len(axis[1])
    ticks = [0.1, 0.2, 0.5, 1.0, 2.0, 5.0]
    ratios = np.concatenate([panel.ratio for panel in panels])
    lowest, highest = 0.9 * float(ratios.min()), float(ratios.max())
    with gallery.picture("5-12_to_5-35_summary", 1, 3, size=(13.0, 3.2), sharey=True) as drawn:
        for axes, panel in zip(drawn, panels, strict=True):
            image = axes.imshow(
                panel.ratio.reshape(shape),
                norm=LogNorm(lowest, highest),
                cmap="cividis_r",
                aspect="auto",
            )
            for place, (cell, ratio) in enumerate(
                zip(panel.cells.values(), panel.ratio, strict=True)
            ):
                row, column = divmod(place, shape[1])
                dark = np.log(ratio / lowest) > 0.6 * np.log(highest / lowest)
                axes.text(
                    column,
                    row,
                    f"{ratio:.2f}\n{cell.good} of {trials}",
                    ha="center",
                    va="center",
                    color="white" if dark else "black",
                    fontsize=8,
                )
            axes.set_xticks(range(shape[1]), [str(count) for count in axis[1]])
            axes.set_yticks(range(shape[0]), [str(count) for count in axis[0]])
            axes.grid(visible=False)
            axes.set_xlabel("generations [–]")
            titled(axes, panel.name)
        drawn[0].set_ylabel("population [–]")
        drawn[0].figure.colorbar(
            image,
            ax=list(drawn),
            label="rms tracking error of the average\n/ ±5 % baseline [–]",
            ticks=ticks,
            format=lambda value, _: f"{value:g}",
        ).minorticks_off()


def _note(gallery: Gallery, panel: Panel, trials: int) -> None:
    figure, size = "5-12 to 5-35", 1e3 * float(np.median(panel.baseline.error))
    gallery.note(figure, f"{panel.name}: ±5 % baseline, median rms error", size, "mrad")
    for (pair, cell), ratio in zip(panel.cells.items(), panel.ratio, strict=True):
        where = f"{panel.name} {pair[0]} × {pair[1]}"
        worst = max(cell.wrong, key=cell.wrong.__getitem__)
        gallery.note(figure, f"{where}: all within 5 %", cell.good, f"of {trials}")
        gallery.note(figure, f"{where}: hardest is {worst}, off by", cell.wrong[worst], "%")
        gallery.note(figure, f"{where}: averaged estimate's error / baseline", ratio)
