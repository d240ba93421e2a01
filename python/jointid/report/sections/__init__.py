"""The sections of all pages, one file for each, in the order of a page.

A section's file has `content(result, extras)`, which returns its parts of the page. A new section needs its
file and a row here: its name, and the kinds of result that it applies to.
"""

from __future__ import annotations

from jointid.base.result import KINDS

_VALUED = ("estimate", "servo", "self-test", "bootstrap", "online", "causes")
_COMPARED = ("comparison", "robot comparison", "servo comparison")
_JUDGED = ("estimate", "joints", "robot", "servo")

SECTIONS: dict[str, tuple[str, ...]] = {
    "answer": KINDS,
    "outcome": ("commissioning",),
    "models": _COMPARED,
    "values": _VALUED,
    "friction_map": ("estimate",),
    "joints_table": ("joints", "robot"),
    "expected_errors": ("design",),
    "motion": ("design",),
    "limits": ("design",),
    "cells": ("study",),
    "tracking": ("commissioning",),
    "session": ("commissioning",),
    "rollouts": ("rollout", "servo", "robot"),
    "friction_of_joints": ("joints", "robot"),
    "findings": _JUDGED,
    "couplings": ("joints",),
    "windows": ("estimate",),
    "signals": ("estimate",),
    "inner": (*_COMPARED, "joints", "commissioning"),
    "windows_of_joints": ("robot",),
    "base_parameters": ("robot",),
    "uncertainty": ("estimate", "servo"),
    "facts": tuple(kind for kind in KINDS if kind not in (*_COMPARED, "joints", "commissioning")),
    "convergence": ("estimate",),
    "values_to_copy": ("estimate",),
}
"""Kinds of result for each section."""
LAST_IN_NOTEBOOK = "findings"
"""Last section in a notebook."""
