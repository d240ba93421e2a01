"""The side of a gear is stated for a data frame as for a file."""

import numpy as np
import pandas as pd
import pytest

import jointid as jid


def test_a_frame_is_brought_to_the_joint() -> None:
    time = 0.01 * np.arange(50)
    frame = pd.DataFrame({"time_s": time, "position_rad": np.sin(time), "i_A": np.cos(time)})
    frame["velocity_rad_s"] = 20.0 * np.cos(time)
    run = jid.Recording.from_dataframe(frame, side={"velocity": "motor"}, gear_ratio=20.0)
    np.testing.assert_allclose(run.velocity, np.cos(time))
    assert run.metadata["gear_ratio"] == 20.0
    with pytest.raises(jid.InputError, match="the gear ratio is needed to combine these signals"):
        jid.Recording.from_dataframe(frame, side={"velocity": "motor"})
