"""Figures 2-1 and 3-2: the friction models, and the adaptation of crossover and mutation."""

import numpy as np
from gallery import Gallery, titled
from scenario import TRUTH, first_recording, hanging_joint

import jointid as jid


def draw(gallery: Gallery) -> None:
    """Draw both."""
    stribeck = hanging_joint().with_parameters(TRUTH)
    plain = jid.Joint(inertia=1.0, model=jid.Model("coulomb_viscous")).with_parameters(
        {name: TRUTH[name] for name in ("coulomb", "viscous")}
    )
    general = jid.Joint(inertia=1.0, model=jid.Model("stribeck_general")).with_parameters(
        {
            **{name: TRUTH[name] for name in ("coulomb", "static", "viscous")},
            "stribeck_velocity": 0.1,
            "stribeck_exponent": 1.0,
        }
    )
    with gallery.picture("2-1_friction_models") as axes:
        jid.plot.friction_curves(
            {
                "Coulomb and viscous (2-1)": plain,
                "static and Stribeck (4-1)": stribeck,
                "the same, exponent 1 (2-3)": general,
            },
            axes,
            peak=0.6,
        )
    fast = TRUTH["static"] * float(np.exp(-TRUTH["stribeck"] * 0.6**2))
    gallery.note("2-1", "models differ at 0.6 rad/s by", fast, "N·m", "the same at higher speed")

    seen: list[jid.Generation] = []
    options = jid.GaOptions.thesis().replace(generations=30 if gallery.quick else 300)
    jid.identify(
        first_recording(),
        hanging_joint(),
        residual="sensor",  # the residual of the thesis
        search=jid.Search("ga", ga=options, callback=seen.append),
    )
    with gallery.picture("3-2_dynamic_adaptation") as axes:
        jid.plot.adaptation(options, seen, axes)
        titled(axes, "GaOptions.thesis(): diversity is mean / max of the fitness")
    measure = np.array([generation.diversity for generation in seen])
    corners = (options.diversity_low, options.diversity_high)
    wanted = np.interp(
        measure, corners, (options.crossover_probability, options.crossover_probability_alike)
    )
    applied = np.array([generation.crossover_probability for generation in seen])
    gallery.note("3-2", "largest distance from the law", np.abs(applied - wanted).max())
    gallery.note(
        "3-2", "generations in which it acts", 100.0 * float(np.mean(measure > corners[0])), "%"
    )
