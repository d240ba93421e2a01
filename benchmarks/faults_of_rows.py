"""Faults of rows, stamps, angles and motions in the logs of `faulty_logs.py`."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from foreign_joints import RATES, TURN, Array, Draw, Drawn, Table
from log_plans import Log, Plan, log_of, one_run
from plants import Motion, sines, trapezoids


def held_rows(draw: Draw) -> Plan:
    """Write rows faster than the bus: 2 to 10 rows per sample of 5 to 20 ms."""
    row = draw.one((1, 2, 4, 5))
    rows = draw.whole(max(2, -(-5 // row)), min(10, 20 // row))
    fresh, velocity, several = (bool(draw.turn & bit) for bit in (1, 2, 4))
    amplitude = draw.scale(0.5, 5.0)
    motions = [draw.motion(amplitude)]
    if several:
        motions += [
            trapezoids([amplitude * f], amplitude * f * draw.between(0.25, 0.5), 4.0 * amplitude)
            for f in (1.0, draw.between(1.0, 2.0))
        ]
    drawn = draw.joint(motions, row * rows)

    def write(runs: list[Table]) -> Log:
        tables = []
        for run in runs:
            table = draw.sampled(run, drawn, row, velocity=velocity)
            index = np.arange(table["time"].size) // rows * rows
            held = {"position", "velocity"} if fresh else {"position", "velocity", "torque"}
            tables.append({n: v[index] if n in held else v for n, v in table.items()})
        what = f"{rows} rows of {row} ms, {'fresh' if fresh else 'held'} torque"
        what += f", {len(runs)} runs{'' if velocity else ', no velocity'}"
        causes = r"held|hold|cop(y|ies)|repeat|rows a sample|faster than the bus"
        return log_of(draw, tables, drawn, causes=causes, what=what)

    return Plan(drawn=drawn, write=write)


def repeated_stamps(draw: Draw) -> Plan:
    """Write rows twice, equal in all columns."""

    def change(draw: Draw, table: Table, drawn: Drawn) -> Log:
        size = table["time"].size
        count = draw.whole(1, 40)
        times = np.ones(size, dtype=int)
        times[draw.rng.integers(size, size=count)] += draw.whole(1, 3)
        again = {name: np.repeat(values, times) for name, values in table.items()}
        what = f"{times.sum() - size} rows repeated"
        return log_of(draw, [again], drawn, causes=r"repeat|twice|same stamp|cop(y|ies)", what=what)

    return one_run(draw, change)


def rounded_stamps(draw: Draw) -> Plan:
    """Round stamps to 2 to 5 rows, or to another step that does not divide the period."""

    def change(draw: Draw, table: Table, drawn: Drawn) -> Log:
        period = 1e-3 * drawn.every
        step = period * draw.variant((2.0, 2.5, 4.0, 5.0))
        rounded = np.floor if draw.chance(0.5) else np.round
        stamps = rounded(table["time"] / step + 1e-9) * step
        what = f"rows of {drawn.every} ms, stamps in steps of {1e3 * step:g} ms"
        causes = r"rounded|jitter|--rate|repeat|same stamp"
        return log_of(draw, [table | {"time": stamps}], drawn, causes=causes, what=what)

    return one_run(draw, change, rates=(1, 2, 4, 5))


def torn_tail(draw: Draw) -> Plan:
    """Write the end of a buffer: the last row again and again, or zeros in all columns."""

    def change(draw: Draw, table: Table, drawn: Drawn) -> Log:
        count, zeros = draw.whole(20, 400), draw.variant((True, False))
        ends = {n: np.full(count, 0.0 if zeros else v[-1]) for n, v in table.items()}
        torn = {name: np.concatenate([values, ends[name]]) for name, values in table.items()}
        what = f"{count} {'zeros' if zeros else 'repeats'} at the end"
        causes = r"last rows|tail|at the end|repeat|zeros?\b"
        return log_of(draw, [torn], drawn, causes=causes, what=what)

    return one_run(draw, change)


def cut_line(draw: Draw) -> Plan:
    """Cut the last line anywhere."""

    def change(draw: Draw, table: Table, drawn: Drawn) -> Log:
        log = log_of(draw, [table], drawn, causes=r"last line|truncated|incomplete")
        ((name, text),) = log.files.items()
        lines = text.splitlines()
        lines[-1] = lines[-1][: draw.whole(1, len(lines[-1]) - 1)]
        return replace(log, files={name: "\n".join(lines)}, what=f"ends in {lines[-1]!r}")

    return one_run(draw, change)


def no_time(draw: Draw) -> Plan:
    """Leave out the column of time; half of the users give the rate."""

    def change(draw: Draw, table: Table, drawn: Drawn) -> Log:
        given = draw.variant((True, False))
        options = ("--rate", f"{1000 / drawn.every:g}") if given else ()
        del table["time"]
        what = f"{1000 / drawn.every:g} Hz, {'given' if given else 'not given'}"
        return log_of(
            draw, [table], drawn, options=options, causes=r"--rate|sample.period", what=what
        )

    return one_run(draw, change)


def wrapped(draw: Draw) -> Plan:
    """Wrap an angle modulo a revolution, in all runs or in some."""
    every, count = draw.one(RATES), draw.variant((1, 1, 3, 5))
    velocity, half = draw.chance(0.5), draw.chance(0.5)
    edge = np.pi if half else 0.0
    motions = []
    for k in range(count):
        far = k == 0 or draw.chance(0.3)
        amplitude = draw.scale(2.0, 8.0) if far else draw.between(1.0, 2.5)
        motion = draw.motion(amplitude)
        motions.append(motion.around(edge + (draw.between(-1.0, 1.0) if far else np.pi)))
    drawn = draw.joint(motions, every)

    def write(runs: list[Table]) -> Log:
        tables = [draw.sampled(run, drawn, velocity=velocity) for run in runs]
        low = -np.pi if half else 0.0
        wraps = 0
        for table in tables:
            position = table["position"]
            table["position"] = (position - low) % TURN + low
            wraps += int(np.sum(np.abs(np.diff(table["position"])) > np.pi))
        what = f"{wraps} wraps at {'±180°' if half else '0…360°'} in {count} runs"
        what += f", {1000 / every:g} Hz{'' if velocity else ', no velocity'}"
        return log_of(draw, tables, drawn, causes=r"wrap|jump", what=what)

    return Plan(drawn=drawn, write=write)


def many_turns(draw: Draw) -> Plan:
    """Move more than four revolutions in both directions, in stated units."""
    every = draw.one(RATES)
    drawn = draw.joint([draw.motion(draw.scale(26.0, 150.0))], every, gravity=False)

    def write(runs: list[Table]) -> Log:
        table = draw.sampled(runs[0], drawn, velocity=draw.chance(0.7))
        what = f"{np.ptp(runs[0]['position']) / TURN:.1f} turns"
        return log_of(draw, [table], drawn, causes=r"(?!)", what=what)

    return Plan(drawn=drawn, write=write)


def late_signal(draw: Draw) -> Plan:
    """Delay torque, velocity or position by 2 to 10 ms."""
    every = draw.one((1, 2, 4, 5))
    drawn = draw.joint([draw.motion(draw.scale(0.5, 1.5))], every)

    def write(runs: list[Table]) -> Log:
        name, late = draw.variant(("torque", "velocity", "position")), draw.between(2e-3, 10e-3)
        run = runs[0]
        if name == "torque":  # a held command is late by whole milliseconds
            late = round(late, 3)
            index = np.maximum(np.arange(run["time"].size) - round(1e3 * late), 0)
            moved = run[name][index]
        else:
            moved = np.interp(run["time"] - late, run["time"], run[name])
        table = draw.sampled(run | {name: moved}, drawn)
        what = f"{name} late by {1e3 * late:.1f} ms"
        return log_of(draw, [table], drawn, causes=r"\blate\b|delay|lag\b|\bearly\b", what=what)

    return Plan(drawn=drawn, write=write)


def short_run(draw: Draw) -> Plan:
    """Write 80 to 160 rows: the largest torque occurs once, which is no limit."""
    every, amplitude = draw.one((10, 20)), draw.scale(0.5, 1.0)
    rates = TURN / (0.09 * every) * np.array([[1.0, 2.3]]) * draw.rng.uniform(0.8, 1.1, (1, 2))
    motion = sines([[amplitude, 0.3 * amplitude]], rates, draw.rng.uniform(0.0, TURN, (1, 2)))
    drawn = draw.joint([motion], every, stribeck=False, gravity=False, held=True)

    def write(runs: list[Table]) -> Log:
        rows = draw.whole(80, 160)
        begin = draw.whole(0, 1000 // every)
        cut = slice(begin, begin + rows)
        table = {name: values[cut] for name, values in draw.sampled(runs[0], drawn).items()}
        table["time"] = table["time"] - table["time"][0]
        return log_of(draw, [table], drawn, causes=r"(?!)", never="saturat", what=f"{rows} rows")

    return Plan(drawn=drawn, write=write)


def _onward(draw: Draw) -> Motion:
    """Move in one direction only, at a varying speed."""
    speed, rates = draw.scale(0.5, 3.0), np.array([draw.between(1.0, 2.0), draw.between(3.0, 5.0)])
    sizes = speed * np.array([draw.between(0.2, 0.5), draw.between(0.1, 0.3)])
    phases = draw.rng.uniform(0.0, TURN, 2)

    def function(times: Array) -> tuple[Array, Array, Array]:
        angle = rates * times + phases
        way = speed * times - np.sum(sizes / rates * np.cos(angle), axis=1, keepdims=True)
        fast = speed + np.sum(sizes * np.sin(angle), axis=1, keepdims=True)
        return way, fast, np.sum(sizes * rates * np.cos(angle), axis=1, keepdims=True)

    return Motion(1, function)


def no_split(draw: Draw) -> Plan:
    """Move in one direction, or at one speed in both: then Coulomb friction and another value are inseparable."""
    every, onward = draw.one(RATES), draw.variant((True, False))
    size = draw.scale(0.5, 3.0)
    motion = _onward(draw) if onward else trapezoids([size], [size * 0.8], [size * 6.0], 0.0)
    if onward:
        drawn = draw.joint([motion], every, gravity=False, stribeck=False)
    else:
        drawn = draw.joint([motion], every, stribeck=False, offset=False)

    def write(runs: list[Table]) -> Log:
        table = draw.sampled(runs[0], drawn, velocity=draw.chance(0.7))
        causes = r"undivided|undetermined|determin|direction|separat|split|one speed|apart"
        what = "one direction" if onward else "one speed"
        return log_of(draw, [table], drawn, causes=causes, what=what)

    return Plan(drawn=drawn, write=write)


_STANDS = r"stands still|standing|never moves?|does not move|hardly_moves"


def standing(draw: Draw) -> Plan:
    """Let the joint stand still: constant, or moving by one step of the encoder."""

    def change(draw: Draw, table: Table, drawn: Drawn) -> Log:
        time = table["time"]
        step = TURN / draw.one((4096, 65536, 1_000_000))
        dithers = draw.variant((True, False))
        toggles = draw.rng.integers(0, 2, time.size) * int(dithers)
        table["position"] = np.asarray(step * (draw.whole(-1000, 1000) + toggles), dtype=float)
        table["velocity"] = np.zeros(time.size)
        pushes = 0.5 * drawn.plant["coulomb"] * np.sin(draw.between(0.5, 5.0) * time)
        table["torque"] = pushes + draw.rng.normal(0.0, drawn.noise, time.size)
        if draw.chance(0.5):
            del table["velocity"]
        what = "dithers" if dithers else "constant"
        return log_of(
            draw,
            [table],
            drawn,
            causes=r"stands still|standing|never moves?|does not move|hardly_moves",
            what=what,
        )

    return one_run(draw, change)
