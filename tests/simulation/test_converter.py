"""A converter's ends: two's complement has one level more below zero than above."""

import numpy as np
from closed_loop import TRUTH, thesis_joint, well_excited, wrong_controller

import jointid as jid


def test_a_converter_ends_a_level_before_its_range() -> None:
    run = jid.simulate(
        thesis_joint().with_parameters(TRUTH | {"sensor_offset": 0.0}),
        wrong_controller(),
        well_excited(3.0),
        sensors=jid.Sensors(converter_bits=8, converter_range=0.25),
    )
    assert run.sensor is not None
    exact = run.truth.signals["link_torque"] / TRUTH["sensor_gain"]
    above, below = exact > 0.3, exact < -0.3
    assert above.any()
    assert below.any()
    np.testing.assert_array_equal(run.sensor[above], 0.25 * 127.0 / 128.0)
    np.testing.assert_array_equal(run.sensor[below], -0.25)
