"""The link on a joint, and the joint's limits."""

from jointid.base.errors import InputError
from jointid.base.values import dataclass
from jointid.joint.checks import (
    finite_number,
    not_negative,
    positive_number,
    set_numbers,
)

STANDARD_GRAVITY = 9.80665  # m/s²


@dataclass(frozen=True, slots=True, kw_only=True)
class GravityCoefficients:
    """Torque of gravity at the joint [N·m] as ``cos * cos(q) + sin * sin(q)``."""

    cos: float
    sin: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Link:
    """The link that the joint moves.

    Parameters
    ----------
    mass : float
        Mass [kg].
    centre_of_mass : float
        Distance of the centre of mass from the joint's axis [m].
    angle : float
        Angle of the centre of mass above the horizontal at position zero [rad]. Default 0.
    inertia : float, optional
        Inertia about the joint's axis [kg·m²]. Default: inertia of a point mass.
    gravity : float
        Component of gravity perpendicular to the axis [m/s²]. Default 9.80665.

    Raises
    ------
    InputError
        A value is not finite, or a value other than the angle is negative.

    Examples
    --------
    >>> joint = jid.Joint(link=jid.Link(mass=2.0, centre_of_mass=0.25))
    >>> round(joint.link_inertia, 3)
    0.125
    """

    mass: float
    centre_of_mass: float
    angle: float = 0.0
    inertia: float | None = None
    gravity: float = STANDARD_GRAVITY

    def __post_init__(self) -> None:
        set_numbers(self, "link", ("angle",), finite_number)
        set_numbers(self, "link", ("mass", "centre_of_mass", "inertia", "gravity"), not_negative)


@dataclass(frozen=True, slots=True, kw_only=True)
class Limits:
    """Limits that the joint must not exceed; None: the limit is not known.

    Parameters
    ----------
    position : tuple of float, optional
        Lowest and highest position [rad] or [m].
    velocity, torque, current : float, optional
        Largest magnitude of velocity [rad/s] or [m/s], torque at the output [N·m] or [N], and motor current [A].

    Raises
    ------
    InputError
        A limit is not finite or not positive, or the position range is empty.

    Examples
    --------
    >>> jid.Joint(limits=jid.Limits(position=(-1.0, 1.0), velocity=3.0)).limits.velocity
    3.0
    """

    position: tuple[float, float] | None = None
    velocity: float | None = None
    torque: float | None = None
    current: float | None = None

    def __post_init__(self) -> None:
        if self.position is not None:
            if not isinstance(self.position, list | tuple) or len(self.position) != 2:
                raise InputError(
                    "[lowest, highest] is expected",
                    argument="position",
                    value=self.position,
                    place="limits",
                )
            low, high = (finite_number("limits", "position", bound) for bound in self.position)
            if not low < high:
                raise InputError(
                    "the first limit must be below the second",
                    argument="position",
                    value=[low, high],
                    place="limits",
                )
            object.__setattr__(self, "position", (low, high))
        set_numbers(self, "limits", ("velocity", "torque", "current"), positive_number)
