"""Questions that an estimate answers later, with other rooms: is it true, why does it not fit, what to record next."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from numpy.typing import ArrayLike

from jointid.base.argument_checks import whole_number
from jointid.base.errors import InputError
from jointid.base.joining import joined
from jointid.estimate.record import EstimateRecord, FollowUp

if TYPE_CHECKING:
    from jointid.estimate.bootstrap import Bootstrap
    from jointid.estimate.causes import Causes
    from jointid.estimate.self_test import SelfTest


class Questions(EstimateRecord):
    """The questions of an `Estimate`."""

    __slots__ = ()

    def selftest(self, trials: int = 3, seed: int = 0) -> SelfTest:
        """Test whether known parameters come back from the recorded motion with the noise of the recordings.

        Each trial keeps the recorded motion, without its noise, and computes the torque and the sensor's
        reading that known parameters need there. Noise as in the recordings is added: the quantum and the
        white noise of position, velocity and sensor, and the residuals of the estimate as a disturbance
        torque, in blocks in another order and with other signs. Then the parameters are identified with the
        same settings. The first trial injects the estimate itself, the others parameters from its intervals.

        What comes back can be identified from such a motion *if the joint is as modelled*; what does not,
        cannot.

        Parameters
        ----------
        trials : int
            1 to 1000. Default 3.
        seed : int
            The same seed gives the same bits, on any number of threads. Default 0.

        Returns
        -------
        SelfTest

        Raises
        ------
        InputError
            The estimate was read from a file, which does not hold the recordings; or another number.
        KeyboardInterrupt
            Ctrl-C; it is raised within 0.1 s.

        Examples
        --------
        >>> estimate.selftest().lost
        ()
        """
        trials = whole_number("trials", trials, 1, 1000)
        seed = whole_number("seed", seed, 0, 2**64 - 1)
        return self._with_recordings("selftest").selftest(self, trials, seed)

    def bootstrap(self, n: int = 1000, seed: int = 0) -> Bootstrap:
        """Draw stretches of the recordings anew, and refit the parameters to each draw (block bootstrap).

        A check of the standard errors that does not rest on their formula. The blocks are as long as a segment
        of motion: an eighth of the motion, between 0.25 and 1 s, and longer on recordings over 10 min. A draw is
        refitted inside the bounds of the search, with the torque balance linearised at the estimate.

        Parameters
        ----------
        n : int
            Draws, 20 to 1,000,000. Default 1000.
        seed : int
            The same seed gives the same bits, on any number of threads. Default 0.

        Returns
        -------
        Bootstrap

        Raises
        ------
        InputError
            The estimate was read from a file, which does not hold the recordings; or another number.
        KeyboardInterrupt
            Ctrl-C; it is raised within 0.1 s.

        Examples
        --------
        >>> 0.5 < estimate.bootstrap().parameters["coulomb"].ratio < 2.0
        True
        """
        n = whole_number("n", n, 20, 1_000_000)
        seed = whole_number("seed", seed, 0, 2**64 - 1)
        return self._with_recordings("bootstrap").bootstrap(self, n, seed)

    def causes(self, signals: Mapping[str, ArrayLike] | None = None) -> Causes:
        """Say why the model does not fit: causes by name, what they explain, what they move, what to do.

        Each candidate is fitted together with the model to part of the recording and judged on the rest,
        at windows of 1, 4, 16 and 64 times the length used. `identify` does so by itself where the
        residuals are more than noise, and reports the causes as findings.

        Parameters
        ----------
        signals : mapping of str to array_like, optional
            Further signals of the recording that may act on the joint, by name, one value a sample:
            another joint's velocity, a temperature. Default: none.

        Returns
        -------
        Causes

        Raises
        ------
        InputError
            The estimate was read from a file, which does not hold the recordings; or a signal that does
            not fit the recording.

        Examples
        --------
        >>> [cause.name for cause in estimate.causes().found]
        []
        """
        if signals is not None and not isinstance(signals, Mapping):
            raise InputError(
                "signals by name are expected", argument="signals", value=type(signals).__name__
            )
        return self._with_recordings("causes").causes(self, signals or {})

    def next_motion(
        self,
        limits: Mapping[str, Any] | Any = None,
        duration: float = 12.0,
        **options: Any,
    ) -> Any:
        """Design what to record next: the motion that adds most to what this estimate tells.

        The information of its recordings counts, joints are drawn from its intervals, and the controller
        believes its values, unless another is given. Identify both recordings together then:
        ``identify([first, second], joint)``.

        Parameters
        ----------
        limits : MotionLimits or mapping, optional
            As in `design`. Default: the joint's.
        duration : float
            [s]. Default 12.
        **options
            `joint` gives facts that the joint of the identification lacked, e.g. a link; others as in
            `design`. By default `parameters` are the free ones, `sensors` have the noise
            that the residuals show.

        Returns
        -------
        Design
            Errors are those expected of both recordings together; `before` is that of this estimate.

        Raises
        ------
        InputError
            As `design`; or nothing is free, or another joint.

        Examples
        --------
        >>> limits = {"position": (-1.0, 1.0), "velocity": 3.4, "torque": 160.0}
        >>> search = jid.DesignSearch(evaluations=64, joints=2, rehearsals=10)
        >>> estimate.next_motion(limits, duration=4.0, search=search).duration
        4.0
        """
        # The room that designs identifies what it rehearses, and so stands above this one.
        return joined("next_motion")(self, limits, duration, **options)

    def _with_recordings(self, question: str) -> FollowUp:
        """Return what answers questions that need the recordings."""
        if self.follow_up is None:
            raise InputError(
                "this estimate was read from a file, which does not hold the recordings",
                argument=question,
                remedy="identify again, and ask the new estimate",
            )
        return self.follow_up
