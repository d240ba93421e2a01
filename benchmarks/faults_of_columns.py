"""Faults of columns, names, units and single runs in the logs of `faulty_logs.py`."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from foreign_joints import RATES, TURN, Draw, Drawn, Layout, Table, layout
from log_plans import SI, Log, Plan, log_of, one_run


def behind_friction(draw: Draw) -> Plan:
    """Put the torque sensor behind the friction; the header says so, or not."""

    def change(draw: Draw, table: Table, drawn: Drawn) -> Log:
        header = draw.variant(("tau_J", "joint_torque_Nm", "torque_sensor_Nm", "torque_Nm"))
        table["torque"] = table["link"]
        form = layout("time_s", "position_rad", "velocity_rad_s", header)
        causes = r"behind|link side|at the link|contains no friction|torque sensor|joint's side|--column sensor"
        return log_of(draw, [table], drawn, form=form, causes=causes, what=header)

    return one_run(draw, change)


def reversed_torque(draw: Draw) -> Plan:
    """Reverse the sign of the torque."""

    def change(draw: Draw, table: Table, drawn: Drawn) -> Log:
        table["torque"] *= -1.0
        return log_of(draw, [table], drawn, causes=r"\bsigns?\b|against|opposite|revers")

    return one_run(draw, change)


def geared_torque(draw: Draw) -> Plan:
    """Record the motor's torque with a known gear ratio: the header says so, or the known inertia contradicts it."""

    def change(draw: Draw, table: Table, drawn: Drawn) -> Log:
        ratio, said = draw.scale(5.0, 150.0), draw.variant((True, False))
        table["torque"] /= ratio
        header = draw.one(("motor_torque_Nm", "motor torque [Nm]")) if said else "torque_Nm"
        options = ["--gear-ratio", f"{ratio:.6g}"]
        if not said:
            options += ["--inertia", f"{drawn.truth['inertia']:.6g}"]
        form = layout("time_s", "position_rad", "velocity_rad_s", header)
        return log_of(
            *(draw, [table], drawn),
            form=form,
            options=tuple(options),
            causes=r"scale|gear|motor|implausible|known inertia",
            what=f"gear {ratio:.0f}, {header}",
        )

    return one_run(draw, change)


def current(draw: Draw) -> Plan:
    """Record a current in amperes, as its header says, with and without the torque constant."""

    def change(draw: Draw, table: Table, drawn: Drawn) -> Log:
        constant, known = draw.scale(0.02, 0.5), draw.variant((True, False))
        ratio = draw.scale(5.0, 120.0) if draw.chance(0.6) else 1.0
        table["torque"] /= constant * ratio
        header = draw.one(("current_A", "motor_current [A]", "i_q [A]", "actual_current_A"))
        options: tuple[str, ...] = ("--gear-ratio", f"{ratio:.6g}") if ratio > 1.0 else ()
        if known:
            options += ("--torque-constant", f"{constant:.6g}")
        form = layout("time_s", "position_rad", "velocity_rad_s", header)
        return log_of(
            *(draw, [table], drawn),
            form=form,
            options=options,
            causes=r"torque.constant|current|ampere",
            what=f"{header}, gear {ratio:.0f}, constant {'given' if known else 'not given'}",
        )

    return one_run(draw, change)


def saturated(draw: Draw) -> Plan:
    """Clip the torque at a limit: the drive's, or only the recorder's."""
    applied = draw.variant((True, False))
    every = draw.one(RATES)
    share = draw.between(0.3, 0.7) if applied else draw.between(0.6, 0.85)
    motion = draw.motion(draw.scale(0.5, 1.5))
    drawn = draw.joint([motion], every, limit=share if applied else 1e6)

    def write(runs: list[Table]) -> Log:
        table = draw.sampled(runs[0], replace(drawn, noise=0.0))
        torque = table["torque"] + draw.rng.normal(0.0, drawn.noise, table["torque"].size)
        most = drawn.limit if applied else share * float(np.quantile(np.abs(torque), 0.995))
        table["torque"] = np.clip(torque, -most, most)
        at = float(np.mean(np.abs(table["torque"]) >= most))
        what = f"{'applied' if applied else 'recorded'} limit in {100 * at:.0f} % of the rows"
        return log_of(draw, [table], drawn, causes=r"saturat|limit of|clip", what=what)

    return Plan(drawn=drawn, write=write)


def motor_velocity(draw: Draw) -> Plan:
    """Record the motor's velocity next to the joint's position, with the gear ratio known."""

    def change(draw: Draw, table: Table, drawn: Drawn) -> Log:
        ratio = draw.scale(4.0, 160.0) * (-1.0 if draw.chance(0.15) else 1.0)
        table["velocity"] *= ratio
        options = ("--gear-ratio", f"{ratio:.6g}")
        causes = r"gear|motor|--side"
        return log_of(
            *(draw, [table], drawn), options=options, causes=causes, what=f"gear {ratio:.0f}"
        )

    return one_run(draw, change)


def product_names(draw: Draw) -> Plan:
    """Use names of a product with documented units that are not SI, without a unit in the header."""

    def change(draw: Draw, table: Table, drawn: Drawn) -> Log:
        product = draw.variant(("ODrive", "CiA 402", "Feetech", "ODrive", "Dynamixel"))
        constant = draw.scale(0.02, 0.5)
        counts = 4096 / TURN
        options: tuple[str, ...] = ("--torque-constant", f"{constant:.6g}")
        if product == "ODrive":
            names = ("time", "pos_estimate", "vel_estimate", "Iq_measured")
            factors = (1.0, 1.0 / TURN, 1.0 / TURN, 1.0 / constant)
            options += ("--gear-ratio", "1")
        elif product == "CiA 402":
            names = (
                "time",
                "position_actual_value",
                "velocity_actual_value",
                "torque_actual_value",
            )
            factors = (1.0, counts * 32, counts * 32, 1000.0 / (3.0 * drawn.plant["coulomb"]))
            options = ()
        elif product == "Feetech":
            names = ("time", "Present_Position", "Present_Speed", "Present_Load")
            factors = (1.0, counts, counts, 1000.0 / (3.0 * drawn.plant["coulomb"]))
            options = ()
        else:
            names = ("time", "Present Position", "Present Velocity", "Present Current")
            factors = (1.0, counts, 60.0 / TURN / 0.229, 1000.0 / 2.69 / constant)
        signals = ("time", "position", "velocity", "torque")
        form = Layout(
            headers=dict(zip(signals, names, strict=True)),
            factors=dict(zip(signals, factors, strict=True)),
        )
        if product != "ODrive":
            for name in signals[1:]:
                table[name] = np.round(table[name] * form.factors[name]) / form.factors[name]
        causes = r"units?\b|turn|count|increment|per mille|rated|ODrive|CiA|Feetech|Dynamixel|servo"
        more = {"options": options, "causes": causes, "what": product, "paste": True}
        return log_of(draw, [table], drawn, form=form, **more)

    return one_run(draw, change)


def no_units(draw: Draw) -> Plan:
    """Use degrees and rpm under headers without a unit."""

    def change(draw: Draw, table: Table, drawn: Drawn) -> Log:
        position, velocity = draw.variant(
            (("deg", "deg/s"), ("deg", "rpm"), ("rad", "rpm"), ("deg", ""))
        )
        factors = {"rad": 1.0, "deg": 360.0 / TURN, "deg/s": 360.0 / TURN, "rpm": 60.0 / TURN}
        names = {"time": "time", "position": "position", "velocity": "velocity", "torque": "torque"}
        if not velocity:
            del table["velocity"]
        table["position"] *= factors[position]
        if velocity:
            table["velocity"] *= factors[velocity]
        causes = r"units?\b|degree|rpm|57|radian"
        what = f"{position}, {velocity or 'no velocity'}"
        return log_of(draw, [table], drawn, form=Layout(headers=names), causes=causes, what=what)

    return one_run(draw, change)


def bare_numbers(draw: Draw) -> Plan:
    """Leave out the header: time, position, velocity and torque, or three joints of which the first moves."""

    def change(draw: Draw, table: Table, drawn: Drawn) -> Log:
        size = table["time"].size
        arm = draw.variant((True, False))
        columns = dict(table) if not arm else {"time": table["time"]}
        if arm:
            rests = draw.rng.uniform(-2.0, 2.0, 2)
            for name, noise in (("position", 1e-4), ("velocity", 2e-4), ("torque", drawn.noise)):
                columns[f"{name} 0"] = table[name]
                for k, rest in enumerate(rests):
                    level = rest * {"position": 1.0, "velocity": 0.0, "torque": drawn.noise}[name]
                    columns[f"{name} {k + 1}"] = level + draw.rng.normal(0.0, noise, size)
        else:
            del columns["link"]
        form = Layout(
            headers={name: name for name in columns}, separator=draw.one((",", " ", "\t"))
        )
        log = log_of(draw, [columns], drawn, form=form, causes=r"header|which column|no column")
        ((name, _),) = log.files.items()
        what = f"{len(columns)} columns"
        return replace(log, files={name: form.text(columns, header=False)}, what=what, paste=True)

    return one_run(draw, change)


def recorder_pairs(draw: Draw) -> Plan:
    """Write a recorder's export: an X,Y pair of columns for each channel, X in ms."""

    def change(draw: Draw, table: Table, drawn: Drawn) -> Log:
        pairs = ("position", "velocity", "torque")
        separator = draw.one((",", ";"))
        first = separator.join(f"{name.capitalize()} actual{separator}" for name in pairs)
        columns: Table = {}
        for name in pairs:
            columns[f"{name} X"], columns[name] = 1e3 * table["time"], table[name]
        form = Layout(
            headers={n: "X" if n.endswith("X") else "Y" for n in columns}, separator=separator
        )
        log = log_of(draw, [columns], drawn, form=form, causes=r"pairs?\b|X,? ?Y", paste=True)
        return replace(log, files={name: f"{first}\n{text}" for name, text in log.files.items()})

    return one_run(draw, change)


def one_of_several(draw: Draw) -> Plan:
    """Write several runs of one joint, one with a fault."""
    every, count = draw.one(RATES), draw.whole(3, 6)
    motions = [draw.motion(draw.between(0.4, 1.2)) for _ in range(count)]
    drawn = draw.joint(motions, every)

    def write(runs: list[Table]) -> Log:
        tables = [draw.sampled(run, drawn) for run in runs]
        bad = draw.whole(0, count - 1)
        fault = draw.variant(("spike", "reversed", "standing", "constant", "degrees"))
        table = tables[bad]
        size = table["time"].size
        if fault == "spike":
            most = float(np.abs(table["torque"]).max())
            table["torque"][draw.whole(size // 5, size - 2)] += (
                most * draw.one((-1, 1)) * draw.between(3, 20)
            )
            causes = "spike"
        elif fault == "reversed":
            table["torque"] *= -1.0
            causes = r"\bsigns?\b|against|opposite|revers"
        elif fault == "standing":
            table["position"][:], table["velocity"][:] = table["position"][0], 0.0
            causes = r"stands? still|never moves?|does not move"
        elif fault == "constant":
            table["torque"][:] = table["torque"][size // 2]
            causes = r"never change|constant|frozen|freez"
        else:
            for name in ("position", "velocity"):
                table[name] *= 360.0 / TURN
            causes = r"unit|degree|57|radian"
        log = log_of(draw, tables, drawn, form=SI)
        named = f"(?s)(?=.*(?:{causes}))(?=.*run_{bad}\\b)"
        return replace(log, causes=named, what=f"{fault} in run_{bad} of {count}")

    return Plan(drawn=drawn, write=write)
