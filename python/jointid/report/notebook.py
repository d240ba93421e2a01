"""The friction map for a notebook: a picture with its own style, which no style of the notebook touches."""

from __future__ import annotations

import base64
import re

from jointid.estimate.estimate import Estimate
from jointid.report.drawing.palette import STYLE
from jointid.report.estimate_pictures import friction_picture


def friction_image(estimate: Estimate) -> str:
    """Return the friction map as an image of HTML."""
    picture = str(friction_picture(estimate))
    svg = re.search(r"<svg.*</svg>", picture, re.DOTALL)
    assert svg is not None
    text = svg[0].replace("<svg", '<svg xmlns="http://www.w3.org/2000/svg"', 1)
    text = text.replace(">", f"><style>{STYLE}</style>", 1)
    data = base64.b64encode(text.encode()).decode()
    return (
        '<img alt="friction map" style="max-width: 46rem; width: 100%" '
        f'src="data:image/svg+xml;base64,{data}">'
    )
