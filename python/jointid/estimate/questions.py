"""Methods of an estimate that need other folders: self-test, bootstrap, causes, next motion."""

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
    """Methods of an `Estimate` that need its recordings."""

    __slots__ = ()

    def selftest(self, trials: int = 3, seed: int = 0) -> SelfTest:
        """Test whether known parameters are recovered from the recorded motion with the recordings' noise.

        Each trial uses the recorded motion without noise, and computes the torque and the sensor's reading for
        known parameters. Then it adds noise as in the recordings: quantization and white noise of position,
        velocity and sensor, and a disturbance torque from the residuals, in blocks with random order and signs.
        Then it identifies the parameters with the same settings. The first trial uses the estimated parameters;
        the others draw parameters from the intervals. If a parameter is recovered, such a motion can identify it,
        *provided that the joint is as modelled*; otherwise it cannot.

        Parameters
        ----------
        trials : int
            Number of trials, 1 to 1000. Default 3.
        seed : int
            The same seed gives the same bits, on any number of threads. Default 0.

        Returns
        -------
        SelfTest

        Raises
        ------
        InputError
            The estimate was read from a file, which does not hold the recordings; or `trials` is out of range.
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
        """Draw stretches of the recordings with replacement, and refit the parameters to each draw (block bootstrap).

        This checks the standard errors without their formula. A block is as long as a segment of motion: an
        eighth of the motion, between 0.25 and 1 s, and longer for recordings over 10 min. The refit stays within
        the search bounds, with the torque balance linearised at the estimate.

        Parameters
        ----------
        n : int
            Number of draws, 20 to 1,000,000. Default 1000.
        seed : int
            The same seed gives the same bits, on any number of threads. Default 0.

        Returns
        -------
        Bootstrap

        Raises
        ------
        InputError
            The estimate was read from a file, which does not hold the recordings; or `n` is out of range.
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
        """Return the causes of a poor fit: name, explained share of the residual, effect on the values, remedies.

        Each candidate is fitted together with the model to a part of the recording, and judged on the rest, with
        windows of 1, 4, 16 and 64 times the usual length. `identify` does this automatically if the residuals
        exceed the noise, and reports the causes as findings.

        Parameters
        ----------
        signals : mapping of str to array_like, optional
            Further signals that may act on the joint, by name, one value per sample: another joint's velocity,
            a temperature. Default: none.

        Returns
        -------
        Causes

        Raises
        ------
        InputError
            The estimate was read from a file, which does not hold the recordings; or a signal does not fit
            the recording.

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
        """Design the next motion to record: the motion that adds the most information to this estimate.

        The design uses the information of the estimate's recordings, draws joints from its intervals, and gives
        its values to the controller (unless another controller is set). Then identify both recordings together:
        ``identify([first, second], joint)``.

        Parameters
        ----------
        limits : MotionLimits or mapping, optional
            Same as in `design`. Default: the joint's limits.
        duration : float
            Duration of the motion [s]. Default 12.
        **options
            `joint` adds facts that the identified joint lacked, e.g. a link; other options as in `design`. By
            default `parameters` are the free parameters, and `sensors` have the noise from the residuals.

        Returns
        -------
        Design
            The design, with the expected errors from both recordings together; `before` has this estimate's errors.

        Raises
        ------
        InputError
            Same errors as `design`; or no parameter is free, or it is another joint.

        Examples
        --------
        >>> limits = {"position": (-1.0, 1.0), "velocity": 3.4, "torque": 160.0}
        >>> search = jid.DesignSearch(evaluations=64, joints=2, rehearsals=10)
        >>> estimate.next_motion(limits, duration=4.0, search=search).duration
        4.0
        """
        # The folder `design` uses `identify`, so that this folder may not import it directly.
        return joined("next_motion")(self, limits, duration, **options)

    def _with_recordings(self, question: str) -> FollowUp:
        """Return the object that answers questions with the recordings."""
        if self.follow_up is None:
            raise InputError(
                "this estimate was read from a file, which does not hold the recordings",
                argument=question,
                remedy="identify again, and ask the new estimate",
            )
        return self.follow_up
