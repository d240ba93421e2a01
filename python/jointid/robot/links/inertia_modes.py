"""Modes of identifying the links' inertias: not identified, one scale for each link, or base parameters."""

from typing import Literal

Inertia = Literal["urdf", "scaled", "free"]
URDF: Inertia = "urdf"
SCALED: Inertia = "scaled"
FREE: Inertia = "free"
MODES: tuple[Inertia, ...] = (URDF, SCALED, FREE)
