"""A name that is none: a type checker sees it before the program runs, and the program says it.

Each comment that silences the checker is an error of the checker's own where there is nothing to silence (`make lint`).
"""

from typing import get_args

import numpy as np
import pytest

import jointid as jid
from jointid import _core
from jointid.joint.model import AUTO, ModelName


def _run() -> jid.Recording:
    time = np.linspace(0.0, 4.0, 400)
    return jid.Recording(time=time, position=np.sin(time), torque=np.cos(time))


def test_models_are_those_of_the_core() -> None:
    assert get_args(ModelName) == (*_core.model_names(), AUTO)


def test_a_misspelt_name_is_refused_and_is_an_error_of_types() -> None:
    run = _run()
    with pytest.raises(jid.InputError, match="stribek"):
        jid.identify(run, model="stribek")  # type: ignore[call-overload]
    with pytest.raises(jid.InputError, match="stribek"):
        jid.Model("stribek")  # type: ignore[arg-type]
    with pytest.raises(jid.InputError, match="separabel"):
        jid.identify(run, search="separabel")  # type: ignore[call-overload]
    with pytest.raises(jid.InputError, match="separabel"):
        jid.Search("separabel")  # type: ignore[arg-type]
    with pytest.raises(jid.InputError, match="torqe"):
        jid.identify(run, residual="torqe")  # type: ignore[call-overload]
    with pytest.raises(jid.InputError, match="hold"):
        jid.identify(run, torque_hold="hold")  # type: ignore[call-overload]


def test_text_with_options_runs() -> None:
    text = jid.identify(_run(), model="coulomb_viscous:asymmetric", search="separable")  # type: ignore[call-overload]
    value = jid.identify(
        _run(), model=jid.Model("coulomb_viscous", asymmetric=True), search="separable"
    )
    assert text.free == value.free
