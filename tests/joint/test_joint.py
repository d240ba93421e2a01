"""Joints: values that fit together, and files that give them back, comments and all."""

import copy
import math
import os
import pickle
import re
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from jointid import _core
from jointid.base.errors import InputError
from jointid.joint.joint import Joint
from jointid.joint.joint_file import joint_document, joint_from_document
from jointid.joint.link import Limits, Link
from jointid.joint.model import Model
from jointid.joint.parameters import Parameter
from jointid.joint.thesis import thesis_joint

POSITIVE = st.floats(min_value=1e-9, max_value=1e9)
FINITE = st.floats(min_value=-1e9, max_value=1e9)
ANGLES = st.floats(min_value=-10.0, max_value=10.0)
FEW = settings(max_examples=20)  # a joint takes 10 ms, and each run draws others


def optional(strategy: st.SearchStrategy[float]) -> st.SearchStrategy[float | None]:
    return st.none() | strategy


LINKS = st.builds(
    Link,
    mass=POSITIVE | st.just(0.0),
    centre_of_mass=POSITIVE,
    angle=ANGLES,
    inertia=optional(POSITIVE),
    gravity=st.floats(min_value=0.0, max_value=30.0),
)
RANGES = st.tuples(FINITE, FINITE).filter(lambda pair: pair[0] != pair[1]).map(sorted).map(tuple)
LIMITS = st.builds(
    Limits,
    position=st.none() | RANGES,
    velocity=optional(POSITIVE),
    torque=optional(POSITIVE),
    current=optional(POSITIVE),
)


_ABOVE_ZERO = {name for term in _core.terms() if term.above_zero for name in term.shapes}


@st.composite
def parameters(draw: st.DrawFn) -> dict[str, Parameter]:
    table = {}
    for name in draw(st.sets(st.sampled_from(_core.parameter_names()))):
        numbers = POSITIVE if name in _ABOVE_ZERO else FINITE
        low, value, high = sorted(draw(st.tuples(numbers, numbers, numbers)))
        known = draw(st.booleans())
        table[name] = Parameter(
            name=name,
            value=value if known else None,
            min=draw(st.sampled_from((low, None))),
            max=draw(st.sampled_from((high, None))),
            vary=draw(st.booleans()) or not known,
        )
    return table


@st.composite
def joints(draw: st.DrawFn) -> Joint:
    gear_ratio = draw(st.floats(min_value=0.01, max_value=1e4)) * draw(st.sampled_from((-1, 1)))
    rotor_inertia = draw(optional(st.floats(min_value=1e-9, max_value=1e3)))
    inertia = draw(optional(POSITIVE))
    if rotor_inertia is not None and inertia is not None:
        inertia = rotor_inertia * gear_ratio**2 * 1.0005
    kind: Any = draw(st.sampled_from(("revolute", "prismatic")))
    link = draw(st.none() | LINKS)
    ways = ["none", "free", "known"][: 1 if kind == "prismatic" else 2 if link is None else 3]
    return Joint(
        name=draw(st.text(max_size=20)),
        kind=kind,
        inertia=inertia,
        rotor_inertia=rotor_inertia,
        gear_ratio=gear_ratio,
        torque_constant=draw(optional(POSITIVE)),
        torque_hold=draw(st.sampled_from((None, "zoh", "linear"))),
        sensor=draw(st.booleans()),
        torque_offset=draw(st.sampled_from((None, False, True))),
        link=link,
        parameters=draw(parameters()),
        limits=draw(LIMITS),
        model=Model(
            draw(st.sampled_from(_core.model_names())), gravity=draw(st.sampled_from(ways))
        ),
    )


# --- Values ---


def test_the_thesis_joint() -> None:
    joint = thesis_joint()
    assert joint.reflected_inertia == pytest.approx(2.472e-4 * 101**2, rel=1e-15)
    assert (joint.rotor_inertia, joint.gear_ratio, joint.torque_constant) == (2.472e-4, 101, 0.198)
    assert (joint.model.name, joint.model.gravity, joint.sensor) == ("stribeck", "none", True)
    assert (joint.torque_hold, joint.inertia, joint.torque_offset) == ("zoh", None, None)
    assert joint.limits == Limits(torque=160.0, current=8.0)
    assert joint.link == Link(mass=3.0, centre_of_mass=0.25, inertia=0.25, gravity=9.817)
    assert {name: (p.min, p.max) for name, p in joint.parameters.items()} == {
        "coulomb": (0, 50),
        "static": (0, 40),
        "stribeck": (0, 200),
        "viscous": (0, 40),
        "sensor_offset": (-30, 30),
        "sensor_gain": (0.1, 5),
    }
    assert all(p.value is None and p.vary for p in joint.parameters.values())


def test_inertia_is_as_given_or_reflected_or_unknown() -> None:
    assert Joint().reflected_inertia is None
    assert Joint(inertia=2.5, gear_ratio=10).reflected_inertia == 2.5
    assert Joint(rotor_inertia=0.5, gear_ratio=-10).reflected_inertia == 50.0
    assert Joint(rotor_inertia=0.5, gear_ratio=10, inertia=50.04).reflected_inertia == 50.04


def test_a_joint_is_read_only() -> None:
    joint = thesis_joint()
    with pytest.raises(AttributeError):
        joint.gear_ratio = 2.0  # type: ignore[misc]
    with pytest.raises(TypeError):
        joint.parameters["coulomb"] = Parameter(name="coulomb")  # type: ignore[index]
    given_table = {"coulomb": Parameter(name="coulomb", value=1.0)}
    held = Joint(parameters=given_table)
    given_table.clear()
    assert held.parameters["coulomb"].value == 1.0


@FEW
@given(joints())
def test_copies_are_equal(joint: Joint) -> None:
    for twin in (pickle.loads(pickle.dumps(joint)), copy.deepcopy(joint), joint.replace()):
        assert twin == joint
        assert hash(twin) == hash(joint)
    assert eval(repr(joint)) == joint


def test_replace() -> None:
    joint = thesis_joint().replace(gear_ratio=50, sensor=False)
    assert joint != thesis_joint()
    assert joint.reflected_inertia == pytest.approx(2.472e-4 * 2500)
    with pytest.raises(
        InputError, match=r"gear_ration: a joint has no such field; did you mean 'gear_ratio'"
    ):
        joint.replace(gear_ration=3)
    with pytest.raises(InputError, match="joint 'thesis joint': gear_ratio is 0"):
        joint.replace(gear_ratio=0)


def test_with_parameters_sets_values_and_nothing_else() -> None:
    held = Parameter(name="viscous", value=3.0, max=9.0, vary=False)
    joint = thesis_joint().replace(parameters={**thesis_joint().parameters, "viscous": held})
    changed = joint.with_parameters({"coulomb": 25, "viscous": 4.0, "inertia": 2.5})
    assert changed.parameters["coulomb"] == Parameter(name="coulomb", value=25.0, min=0, max=50)
    assert changed.parameters["viscous"] == Parameter(
        name="viscous", value=4.0, max=9.0, vary=False
    )
    assert changed.parameters["inertia"] == Parameter(name="inertia", value=2.5)
    assert changed.parameters["static"] == joint.parameters["static"]
    assert changed.replace(parameters=joint.parameters) == joint
    assert joint.parameters["viscous"] == held


@pytest.mark.parametrize(
    ("values", "said"),
    [
        ({"coulomb": 50.1}, "parameter 'coulomb': value is 50.1: it is above max 50.0"),
        ({"sensor_offset": -31}, "value is -31.0: it is below min -30.0"),
        ({"coulomb": math.nan}, "value is nan"),
        ({"coulomb": None}, "value is None: a number"),
        ({"coulomb": {"value": 1.0}}, "a number is expected"),
        ({"colomb": 1.0}, "colomb: there is no such parameter; did you mean 'coulomb'?"),
    ],
)
def test_with_parameters_refuses(values: Any, said: str) -> None:
    with pytest.raises(InputError, match=re.escape(said)):
        thesis_joint().with_parameters(values)


@given(LINKS, ANGLES)
def test_gravity_expanded_is_gravity(link: Link, position: float) -> None:
    gravity = Joint(link=link).gravity_coefficients
    weight = link.mass * link.gravity * link.centre_of_mass
    expanded = gravity.cos * math.cos(position) + gravity.sin * math.sin(position)
    turned = weight * math.cos(position + link.angle)
    # The second addend: a share of a subnormal weight is 0.
    assert expanded == pytest.approx(turned, abs=1e-13 * weight + 1e-300)


def test_gravity_needs_a_link() -> None:
    with pytest.raises(InputError, match="needs a link"):
        Joint().gravity_coefficients  # noqa: B018


def signals(**present: Any) -> Any:
    """Stand for a recording."""
    return SimpleNamespace(**{"torque": None, "motor_torque": None, "current": None, **present})


def test_output_torque_from_each_signal() -> None:
    torque, motor_torque, current = np.array([1.0, -2.0]), np.array([0.5, 3.0]), np.array([2.0, 8])
    joint = Joint(gear_ratio=-101.0, torque_constant=0.2)
    every = {"torque": torque, "motor_torque": motor_torque, "current": current}
    np.testing.assert_array_equal(joint.output_torque(signals(**every)), torque)
    del every["torque"]
    np.testing.assert_array_equal(joint.output_torque(signals(**every)), motor_torque * -101.0)
    del every["motor_torque"]
    np.testing.assert_allclose(joint.output_torque(signals(**every)), current * -20.2, rtol=1e-15)
    np.testing.assert_array_equal(Joint().output_torque(signals(motor_torque=torque)), torque)


def test_output_torque_says_what_is_missing() -> None:
    with pytest.raises(InputError, match="no signal torque, motor_torque or current"):
        Joint(torque_constant=1.0).output_torque(signals())
    with pytest.raises(InputError, match=r"joint 'elbow': torque_constant: .*N·m/A"):
        Joint(name="elbow", gear_ratio=3).output_torque(signals(current=np.ones(3)))


# --- Files ---


@FEW
@given(joint=joints())
def test_every_field_comes_back_from_a_file(
    joint: Joint, tmp_path_factory: pytest.TempPathFactory
) -> None:
    path = tmp_path_factory.mktemp("joint") / "joint.toml"
    joint.save(path)
    assert Joint.load(path) == joint
    before = path.read_bytes()
    joint.save(path)
    assert path.read_bytes() == before


@given(joints())
def test_every_field_comes_back_from_a_document(joint: Joint) -> None:
    assert joint_from_document(joint_document(joint), "estimate", Joint) == joint


@FEW
@given(old=joints(), new=joints())
def test_a_file_takes_another_joint(
    old: Joint, new: Joint, tmp_path_factory: pytest.TempPathFactory
) -> None:
    path = tmp_path_factory.mktemp("joint") / "joint.toml"
    old.save(path)
    new.save(path)
    assert Joint.load(path) == new


COMMENTED = """\
# Elbow of the left arm.
schema = 2   # of this file
name = "elbow"

# From the data sheet.
[drive]
rotor_inertia = 2.472e-4   # kg·m², motor side
gear_ratio = 101           # turns

# The link without payload.
[link]
mass = 3   # weighed
centre_of_mass = 0.25

# Before identification.
[parameters.coulomb]
value = 25.0   # a guess
min = 0
max = 50.0

# Nobody's business but mine.
[user]
serial = "A-17"   # on the housing
[user.history]
overhauled = [2019-03-01, 2022-08-15]

# Of the cell.
[limits]
position = [-1.2, 1.2]   # fence

[estimate]
seed = 7
# The end.
"""


def test_saving_changes_nothing_but_what_changed(tmp_path: Path) -> None:
    path = tmp_path / "joint.toml"
    path.write_text(COMMENTED)
    joint = Joint.load(path).with_parameters({"coulomb": 21.5})
    joint.save(path)
    assert path.read_text() == COMMENTED.replace("value = 25.0", "value = 21.5")
    assert Joint.load(path) == joint


def test_what_is_new_joins_its_like(tmp_path: Path) -> None:
    path = tmp_path / "joint.toml"
    path.write_text(COMMENTED)
    joint = Joint.load(path)
    table = {**joint.parameters, "viscous": Parameter(name="viscous", value=12.0)}
    joint.replace(parameters=table, torque_constant=0.2, kind="prismatic", sensor=True).save(path)
    expected = (
        COMMENTED.replace('"elbow"\n', '"elbow"\nkind = "prismatic"\n')
        .replace("# turns\n", "# turns\ntorque_constant = 0.2\n")
        .replace("max = 50.0\n", "max = 50.0\n\n[parameters.viscous]\nvalue = 12.0\n")
    )
    assert path.read_text() == expected + "\n[sensor]\npresent = true\n"


IN_DEGREES = """schema = 2
kind = "revolute"
[link]
mass = 1.0
centre_of_mass = 0.5
angle = "-90deg"  # hangs down
[limits]
position = ["-80deg", 1.25]  # stops
velocity = "180deg"
"""


def test_angles_of_a_file_may_be_degrees(tmp_path: Path) -> None:
    path = tmp_path / "joint.toml"
    path.write_text(IN_DEGREES)
    joint = Joint.load(path)
    assert joint.link is not None
    assert joint.link.angle == pytest.approx(-math.pi / 2)
    assert joint.limits.position == pytest.approx((math.radians(-80.0), 1.25))
    assert joint.limits.velocity == pytest.approx(math.pi)


def test_angles_that_do_not_change_stay_as_they_are_written(tmp_path: Path) -> None:
    path = tmp_path / "joint.toml"
    path.write_text(IN_DEGREES)
    joint = Joint.load(path)
    joint.replace(gear_ratio=101.0).save(path)
    assert path.read_text() == IN_DEGREES + "\n[drive]\ngear_ratio = 101.0\n"
    limits = Limits(position=(-1.0, 1.0), velocity=joint.limits.velocity)
    joint.replace(limits=limits).save(path)
    assert '["-80deg", 1.25]' not in path.read_text()
    assert 'position = [-1.0, 1.0]  # stops\nvelocity = "180deg"' in path.read_text()


def test_the_limits_of_a_joint_that_slides_are_no_angles(tmp_path: Path) -> None:
    path = tmp_path / "joint.toml"
    path.write_text(IN_DEGREES)
    Joint.load(path).replace(kind="prismatic").save(path)
    assert "velocity = 3.14" in path.read_text()
    path.write_text(IN_DEGREES.replace("revolute", "prismatic"))
    assert refusal(path) == "[limits]: position is '-80deg': a number is expected"


def test_what_is_gone_leaves_the_comments_of_its_neighbours(tmp_path: Path) -> None:
    path = tmp_path / "joint.toml"
    path.write_text(COMMENTED)
    Joint.load(path).replace(link=None, parameters={}, limits=Limits(), rotor_inertia=None).save(
        path
    )
    text = path.read_text()
    for kept in re.findall(r"^#.*", COMMENTED, re.MULTILINE):
        assert kept in text
    for kept in ("turns", "on the housing", "[user.history]", "[estimate]\nseed = 7"):
        assert kept in text
    for gone in ("[link]", "mass", "coulomb]", "position", "rotor_inertia"):
        assert gone not in text


BLOCKS = (
    ('[drive]\ngear_ratio = 3\ntorque_hold = "zoh"\n', "drive.gear_ratio = 3\n"),
    ('[model]\nfriction = "stribeck"\n', 'model = { friction = "stribeck" }\n'),
    ("[sensor]\n", "[sensor]\npresent = false\n"),
    ("[link]\nmass = 1\ncentre_of_mass = 1\n", "link = { mass = 1, centre_of_mass = 1 }\n"),
    (
        "[parameters.coulomb]\nmin = 0\nvary = true\n",
        "[parameters.coulomb]\n",
        "[parameters]\ncoulomb = 3.0\n",
        "[parameters]\ncoulomb.value = 3\ncoulomb.vary = false\n",
        "parameters.coulomb = { min = 0 }\n",
        "parameters.coulomb.min = 0\n",
    ),
    ("[parameters.static]\nvalue = 1\n", "", "parameters.viscous = { min = 0 }\n"),
    ("[limits]\nvelocity = 3\n", "limits = { position = [0, 1] }\n"),
    ("[user]\na.b = 1\n[[user.list]]\nx = 1\n", "[user]\n"),
    ("[estimate]\nseed = 1\n", "estimate = { seed = 1 }\n"),
)


@st.composite
def layouts(draw: st.DrawFn) -> str:
    """Joint files laid out in many ways, with a comment of its own in front of each table."""
    chosen = [draw(st.sampled_from(block)) for block in BLOCKS]
    heads = [block for block in chosen if not block.startswith("[")]
    tables = [block for block in draw(st.permutations(chosen)) if block.startswith("[")]
    if any("parameters" in block for block in heads):  # a dotted key closes its table
        tables = [block for block in tables if "parameters" not in block]
    blank = draw(st.sampled_from(("", "\n")))
    parts = [f"{blank}# lead {number}\n{block}" for number, block in enumerate(tables)]
    text = "# head\nschema = 1\n" + "".join(heads) + "".join(parts)
    return text.removesuffix("\n") if draw(st.booleans()) else text


@FEW
@given(text=layouts(), joint=joints(), windows=st.booleans())
def test_any_layout_takes_any_joint_and_keeps_its_comments(
    text: str, joint: Joint, windows: bool, tmp_path_factory: pytest.TempPathFactory
) -> None:
    path = tmp_path_factory.mktemp("joint") / "joint.toml"
    path.write_text(text, newline="\r\n" if windows else "\n")
    held = Joint.load(path)
    held.save(path)
    assert Joint.load(path) == held
    joint.save(path)
    assert Joint.load(path) == joint
    saved = path.read_bytes().decode()
    assert saved.count("\r\n") == (saved.count("\n") if windows else 0)
    for comment in re.findall("# .*", text):
        assert saved.count(comment) == 1


def test_a_byte_order_mark_is_no_obstacle(tmp_path: Path) -> None:
    path = tmp_path / "joint.toml"
    path.write_text(COMMENTED, encoding="utf-8-sig")
    joint = Joint.load(path)
    joint.save(path)
    assert joint.name == "elbow"
    assert Joint.load(path) == joint


def test_an_empty_file_is_filled(tmp_path: Path) -> None:
    path = tmp_path / "joint.toml"
    path.touch()
    thesis_joint().save(path)
    assert Joint.load(path) == thesis_joint()


def test_a_sensor_may_be_excluded(tmp_path: Path) -> None:
    path = tmp_path / "joint.toml"
    path.write_text("schema = 1\n[sensor]\n")
    assert Joint.load(path).sensor
    path.write_text("schema = 1\n[sensor]\npresent = false\n")
    assert not Joint.load(path).sensor


def test_a_crash_leaves_the_old_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "joint.toml"
    path.write_text(COMMENTED)

    def crash(file: int) -> None:
        raise OSError("the disk is full")

    monkeypatch.setattr(os, "fsync", crash)
    with pytest.raises(OSError, match="the disk is full"):
        thesis_joint().save(path)
    assert path.read_text() == COMMENTED
    assert [entry.name for entry in tmp_path.iterdir()] == ["joint.toml"]


@pytest.mark.parametrize("text", ["[tool.ruff]\nline-length = 100\n", "a = \n", "schema = 3\n"])
def test_what_is_no_joint_file_is_not_overwritten(tmp_path: Path, text: str) -> None:
    path = tmp_path / "pyproject.toml"
    path.write_text(text)
    with pytest.raises(InputError, match=re.escape(str(path))):
        thesis_joint().save(path)
    assert path.read_text() == text


def test_a_folder_that_is_missing_is_named(tmp_path: Path) -> None:
    path = tmp_path / "arm" / "joint.toml"
    with pytest.raises(InputError, match=f"the folder '{path.parent}' does not exist"):
        thesis_joint().save(path)
    with pytest.raises(InputError, match="this is a folder"):
        thesis_joint().save(tmp_path)


def test_another_ending_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "joint.txt"
    with pytest.raises(InputError, match=r"path is 'joint.txt': a joint is saved as \.toml"):
        thesis_joint().save(path)
    assert not path.exists()


# Joint file (behind `schema = 1`), and what the sentence says behind the file's name.
BAD = [
    (
        "[drive]\ngear_ration = 3",
        "[drive]: gear_ration: there is no such key; did you mean 'gear_ratio'?",
    ),
    (
        "[drive]\nqqq = 3",
        "[drive]: qqq: there is no such key; choose one of inertia, rotor_inertia",
    ),
    ("gear_ratio = 3", "gear_ratio: this key belongs in [drive], not here"),
    (
        "[drive]\nfriction = 'stribeck'",
        "[drive]: friction: this key belongs in [model], not here",
    ),
    ("[drives]", "drives: there is no such key; did you mean 'drive'?"),
    ("drive = 3", "drive is 3: a table [drive] is expected"),
    ("[[link]]", "link is [{}]: a table [link] is expected"),
    ("name = 3", "name is 3: text is expected"),
    ("kind = 'prismtic'", "kind is 'prismtic': it is unknown; did you mean 'prismatic'?"),
    ("[drive]\ngear_ratio = '101'", "[drive]: gear_ratio is '101': a number is expected"),
    ("[drive]\ngear_ratio = true", "[drive]: gear_ratio is True: a number is expected"),
    (
        "[drive]\ngear_ratio = 0",
        "[drive]: gear_ratio is 0: a value other than 0 is expected; use 1 for a joint without",
    ),
    ("[drive]\ngear_ratio = nan", "[drive]: gear_ratio is nan: a finite number is expected"),
    ("[drive]\ninertia = -2.5", "[drive]: inertia is -2.5: more than 0 is expected"),
    ("[drive]\nrotor_inertia = 0", "[drive]: rotor_inertia is 0.0: more than 0 is expected"),
    ("[drive]\ntorque_constant = inf", "[drive]: torque_constant is inf: a finite number"),
    (
        "[drive]\ninertia = 2.6\nrotor_inertia = 2.472e-4\ngear_ratio = 101",
        "[drive]: inertia is 2.6: but gear_ratio² · rotor_inertia is 2.52169; give only one",
    ),
    (
        "[drive]\nrotor_inertia = 1e300\ngear_ratio = 1e9",
        "[drive]: rotor_inertia is 1e+300: gear_ratio² · rotor_inertia is inf kg·m², but a finite value",
    ),
    (
        "[drive]\ntorque_hold = 'zero'",
        "[drive]: torque_hold is 'zero': it is unknown; choose one of",
    ),
    ("[model]\nfriction = 'stribek'", "[model]: name is 'stribek': it is unknown; did you"),
    ("[model]\nfriction = 'xyz'", "[model]: name is 'xyz': it is unknown; choose one of coulomb"),
    ("[model]\ngravity = 'known'", "[model]: gravity is 'known': there is no link"),
    (
        "[model]\ngravity = true",
        "[model]: gravity is True: it is unknown; choose one of none, known",
    ),
    (
        "kind = 'prismatic'\n[model]\ngravity = 'free'",
        "[model]: gravity is 'free': gravity on a prismatic joint is the same",
    ),
    (
        "[model]\ntorque_offset = 'yes'",
        "[model]: torque_offset is 'yes': true or false is expected",
    ),
    ("[sensor]\npresent = 1", "[sensor]: present is 1: true or false is expected"),
    ("[sensor]\ngain = 1", "[sensor]: gain: there is no such key; choose one of present"),
    ("[link]\nmass = 3.0", "[link]: centre_of_mass: it is missing"),
    ("[link]\nmass = -3\ncentre_of_mass = 1", "[link]: mass is -3.0: 0 or more is expected"),
    (
        "[link]\nmass = 3\ncentre_of_mass = 1\nangle = 'up'",
        "[link]: angle is 'up': an angle is expected",
    ),
    (
        "[parameters.coulom]",
        "[parameters]: coulom: there is no such parameter; did you mean 'coulomb'?",
    ),
    ("[parameters]\ncoulomb = 'big'", "[parameters]: coulomb is 'big': a number (it fixes"),
    ("[parameters]\ncoulomb = nan", "[parameters]: coulomb is nan: a finite number"),
    (
        "[parameters.coulomb]\nmaxi = 3",
        "[parameters.coulomb]: maxi: a parameter has no such field; did you mean",
    ),
    (
        "[parameters.coulomb]\nmin = 5\nmax = 3",
        "[parameters.coulomb]: min is 5.0: it is above max 3.0",
    ),
    (
        "[parameters.coulomb]\nvalue = 5\nmax = 3",
        "[parameters.coulomb]: value is 5.0: it is above max",
    ),
    (
        "[parameters.coulomb]\nvary = false",
        "[parameters.coulomb]: vary is False: a fixed parameter needs",
    ),
    ("[parameters.coulomb]\nvary = 'no'", "[parameters.coulomb]: vary is 'no': true or false"),
    (
        "[limits]\nposition = [1.2, -1.2]",
        "[limits]: position is [1.2, -1.2]: the first limit must be below",
    ),
    ("[limits]\nposition = 1.2", "[limits]: position is 1.2: [lowest, highest] is expected"),
    (
        "[limits]\nposition = [0, 'a']",
        "[limits]: position is 'a': an angle is expected, in rad or as",
    ),
    (
        "[limits]\nposition = ['-80deg', '80 dge']",
        "[limits]: position is '80 dge': an angle is expected, in rad or as \"60deg\"",
    ),
    ("[limits]\nvelocity = 'fast'", "[limits]: velocity is 'fast': an angle is expected"),
    ("[limits]\ntorque = '5deg'", "[limits]: torque is '5deg': a number is expected"),
    ("[limits]\ntorque = -160", "[limits]: torque is -160.0: more than 0 is expected"),
    ("schema = 1", ", line 2: not TOML: Cannot overwrite a value"),
    ("\n[drive\ngear_ratio = 101", ", line 3: not TOML: Expected ']'"),
    ("[drive]\ngear_ratio = ", ", line 3: not TOML: Invalid value"),
    ("[sensor]\npresent = yes", "write lines like gear_ratio = 101 or present = true"),
    ("[drive]\nname = '''", ", line 3: not TOML: "),
    ("a = " + "[" * 100_000, "nested too deeply"),
    ("[drive]\ngear_ratio = " + "9" * 5000, ", line 3: not TOML: "),
]


def refusal(path: Path) -> str:
    """Return what is said of a file, which is one sentence that begins with its name."""
    with pytest.raises(InputError) as refused:
        Joint.load(path)
    sentence = str(refused.value)
    assert sentence.startswith(str(path))
    assert "\n" not in sentence
    assert len(sentence) < 400
    return sentence.removeprefix(str(path)).removeprefix(": ")


@pytest.mark.parametrize(("text", "said"), BAD, ids=[said[:40] for _, said in BAD])
def test_a_file_that_cannot_be_used(tmp_path: Path, text: str, said: str) -> None:
    path = tmp_path / "bad.toml"
    path.write_text("schema = 1\n" + text)
    assert said in refusal(path)


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (b"", "schema: it is missing; write schema = 2"),
        (
            b"schema = 3",
            "schema is 3: this version of jointid reads schemas up to 2; update jointid",
        ),
        (b"schema = 0", "schema is 0: 2 is expected"),
        (b"schema = true", "schema is True: 2 is expected"),
        (b"schema = '1'", "schema is '1': 2 is expected"),
        (b"schema = 1\n# caf\xe9", ", line 2: this is not text in UTF-8"),
        (b"PK\x03\x04\x00", ", line 1: not TOML"),
    ],
)
def test_a_file_of_another_form(tmp_path: Path, content: bytes, said: str) -> None:
    path = tmp_path / "bad.toml"
    path.write_bytes(content)
    assert said in refusal(path)


def test_a_file_that_is_not_there(tmp_path: Path) -> None:
    assert "there is no such file" in refusal(tmp_path / "none.toml")
    assert "this is a folder" in refusal(tmp_path)


@settings(deadline=None)
@given(text=st.text() | st.text(alphabet='[]=.{}"\n #abdeilmnrstuv019', max_size=60))
def test_any_text_is_a_joint_or_one_sentence(
    text: str, tmp_path_factory: pytest.TempPathFactory
) -> None:
    path = tmp_path_factory.mktemp("joint") / "any.toml"
    path.write_text("schema = 1\n" + text, newline="", encoding="utf-8")
    said = f"{path}: a joint"
    try:
        Joint.load(path)
    except InputError as error:
        said = str(error)
    assert said.startswith(str(path))
    assert "\n" not in said
