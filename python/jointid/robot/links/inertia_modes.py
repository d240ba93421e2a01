"""What of the links' inertias may be identified: nothing, a scale a link, or base parameters."""

from typing import Literal

Inertia = Literal["urdf", "scaled", "free"]
URDF: Inertia = "urdf"
SCALED: Inertia = "scaled"
FREE: Inertia = "free"
MODES: tuple[Inertia, ...] = (URDF, SCALED, FREE)
