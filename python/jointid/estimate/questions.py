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
        """Test whether `identify` recovers known parameters from the recorded motion with the recordings' noise.

        Each trial uses the recorded motion without noise, and computes the torque and the sensor's reading for
        known parameters. Each trial then adds noise as in the recordings: quantization and white noise of position,
        velocity and sensor, and a disturbance torque. This torque consists of blocks of the residuals, with random
        order and signs. Then the trial identifies the parameters with the same settings. The known parameters are
        the estimated values in the first trial, and draws from their intervals in the other trials. Such a motion
        can identify the recovered parameters, *provided that the joint is as modelled*. It cannot identify the
        other parameters.

        Parameters
        ----------
        trials : int
            Number of trials, 1 to 1000. Default 3.
        seed : int
            Random seed. The same seed gives bit-identical results for any number of threads. Default 0.

        Returns
        -------
        SelfTest

        Raises
        ------
        InputError
            The estimate was read from a file and has no recordings, or `trials` is out of range.
        KeyboardInterrupt
            After Ctrl-C, within 0.1 s.

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

        The draws check the standard errors without their formula. A block lasts an eighth of the motion, at least
        0.25 s and at most 1 s; recordings over 10 min have longer blocks. Refitted values stay within the search
        bounds. The torque balance is linearised at the estimate.

        Parameters
        ----------
        n : int
            Number of draws, 20 to 1,000,000. Default 1000.
        seed : int
            Random seed. The same seed gives bit-identical results for any number of threads. Default 0.

        Returns
        -------
        Bootstrap

        Raises
        ------
        InputError
            The estimate was read from a file and has no recordings, or `n` is out of range.
        KeyboardInterrupt
            After Ctrl-C, within 0.1 s.

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

        Each possible cause is fitted together with the model to a part of the recording, and tested on the rest.
        The windows have 1, 4, 16 and 64 times the usual length. If the residuals exceed the noise, `identify`
        itself searches for causes and reports them as findings.

        Parameters
        ----------
        signals : mapping of str to array_like, optional
            Further signals that may act on the joint, by name, with one value per sample: e.g. another joint's
            velocity, or a temperature. Default: none.

        Returns
        -------
        Causes

        Raises
        ------
        InputError
            The estimate was read from a file and has no recordings, or a signal does not fit the recording.

        Examples
        --------
        >>> [cause.name for cause in estimate.causes().found]
        []
        """
        if signals is not None and not isinstance(signals, Mapping):
            raise InputError(
                "a mapping from names to signals is expected",
                argument="signals",
                value=type(signals).__name__,
            )
        return self._with_recordings("causes").causes(self, signals or {})

    def next_motion(
        self,
        limits: Mapping[str, Any] | Any = None,
        duration: float = 12.0,
        **options: Any,
    ) -> Any:
        """Design the next motion to record: the motion that adds the most information to this estimate.

        The design uses the information of the estimate's recordings, and draws joints from the estimate's
        intervals. The default controller has the estimated values. After the recording, identify both recordings
        together: ``identify([first, second], joint)``.

        Parameters
        ----------
        limits : MotionLimits or mapping, optional
            Limits of the motion, as in `design`. Default: the joint's limits.
        duration : float
            Duration of the motion [s]. Default 12.
        **options
            Options of `design`. `joint` adds facts that the identified joint lacked, e.g. a link. By default,
            `parameters` are the free parameters, and `sensors` have the noise from the residuals.

        Returns
        -------
        Design
            Design with the expected errors from both recordings together. Their attribute `before` is this
            estimate's error.

        Raises
        ------
        InputError
            Same errors as in `design`. No parameter is free, or `joint` is another joint.

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
                "this estimate was read from a file, and the file does not contain the recordings",
                argument=question,
                remedy="identify again, and use the new estimate",
            )
        return self.follow_up
