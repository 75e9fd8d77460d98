# Copyright 2026 rrr_traj_planner developers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""Errors of the package: each names what was wrong, with values and units."""

from __future__ import annotations

from re import sub
from reprlib import Repr

_shortened = Repr()
_shortened.maxstring = _shortened.maxother = _shortened.maxlong = 60

MOST_DIGITS = 17  # significant digits that distinguish any two floats


class RrrPlannerError(Exception):
    """
    Base of every error that a caller may want to handle.

    Parameters
    ----------
    message : str
        What was wrong, where, the value, the bound and the unit.
    via_point : int, optional
        Index of the via point at fault, -1 if there is none.

    """

    def __init__(self, message: str, via_point: int = -1) -> None:
        super().__init__(message)
        self.via_point = via_point

    def __reduce__(self) -> tuple[object, ...]:
        """Return how to copy and pickle: message and fields, for any constructor."""
        return _remade, (type(self), self.args), vars(self)


class InvalidInputError(RrrPlannerError, ValueError):
    """A malformed value: wrong shape, not finite, out of range."""


class StartStateError(RrrPlannerError):
    """A start state that the arm cannot be in, or cannot start from."""


class UnreachableError(RrrPlannerError):
    """
    A tip position outside the workspace.

    Parameters
    ----------
    message : str
        The point, and its distance from the workspace.
    distance : float
        Distance of the point from the nearest reachable one [m].
    via_point : int, optional
        Index of the via point, -1 if there is none.

    """

    def __init__(self, message: str, distance: float, via_point: int = -1) -> None:
        super().__init__(message, via_point)
        self.distance = distance


class LimitViolationError(RrrPlannerError):
    """
    A point or a path that violates a limit at any speed.

    Parameters
    ----------
    message : str
        Joint, value, limit and unit.
    joint : str
        Name of the joint.
    value, limit : float
        The offending value and the limit that it violates (same unit).
    via_point : int, optional
        Index of the via point at fault, -1 if there is none.

    """

    def __init__(self, message: str, joint: str, value: float, limit: float,
                 via_point: int = -1) -> None:
        super().__init__(message, via_point)
        self.joint = joint
        self.value = value
        self.limit = limit


class JointRangeError(LimitViolationError):
    """A joint position out of range."""


class TimingError(RrrPlannerError):
    """
    No timing within the limits for the requested durations.

    Parameters
    ----------
    message : str
        The durations, and the least feasible ones.
    least_durations : tuple of float
        Feasible durations [s], none shorter than requested; empty if there are none.
    via_point : int, optional
        Index of the via point at fault, -1 if there is none.

    """

    def __init__(self, message: str, least_durations: tuple[float, ...] = (),
                 via_point: int = -1) -> None:
        super().__init__(message, via_point)
        self.least_durations = least_durations


class TimeLimitError(TimingError):
    """
    Planning that was aborted at its time limit.

    Parameters
    ----------
    limit : float
        The time limit [s].
    elapsed : float
        Time since planning began [s].
    step : str, optional
        Name of the interrupted step.

    """

    def __init__(self, limit: float, elapsed: float, step: str = '') -> None:
        super().__init__(f'planning_time_limit {limit:g} s: given up after {elapsed:.2f} s'
                         + (f', during {step}' if step else ''))
        self.limit = limit
        self.elapsed = elapsed
        self.step = step


class ConvergenceError(RrrPlannerError):
    """An iteration that did not converge within its limit."""


def _remade(kind: type[RrrPlannerError], arguments: tuple[object, ...]) -> RrrPlannerError:
    """Return an error without fields; its constructor is not called."""
    return kind.__new__(kind, *arguments)


def quoted(text: str) -> str:
    """
    Return a text from outside for an error's message: in quotes, on one line, not too long.

    Parameters
    ----------
    text : str
        The text.

    Returns
    -------
    str
        With escapes for unprintable characters; the middle is left out if it is long.

    """
    return shown(str(text))


def shown(value: object) -> str:
    """
    Return a value from outside for an error's message: on one line, not too long.

    Parameters
    ----------
    value : object
        The value.

    Returns
    -------
    str
        Its representation; the middle is left out if it is long.

    """
    try:
        return sub(r'\s*\n\s*', ' ', _shortened.repr(value))
    except ValueError:  # Python does not convert integers of thousands of digits
        return f'of {type(value).__name__} and too long to show'


def format_distinct(value: float, *bounds: float, digits: int = 6) -> tuple[str, ...]:
    """
    Return a value and its bounds for an error's message, with enough digits to differ.

    Parameters
    ----------
    value : float
        The value.
    *bounds : float
        Values that it is compared with.
    digits : int
        Significant digits if they suffice.

    Returns
    -------
    tuple of str
        The value and each bound, all with the same number of significant digits.

    """
    numbers = (value, *bounds)
    for count in range(digits, MOST_DIGITS):
        texts = tuple(f'{float(x):.{count}g}' for x in numbers)
        if all(text != texts[0] for text, x in zip(texts[1:], bounds) if x != value):
            return texts
    return tuple(f'{float(x):.{MOST_DIGITS}g}' for x in numbers)


def did_you_mean(*names: str, by: str = '') -> str:
    """
    Return the question whether something else was meant, for messages.

    Parameters
    ----------
    *names : str
        What may have been meant.
    by : str
        What was written, where the message does not begin with it.

    Returns
    -------
    str
        The question; empty without names.

    """
    if not names:
        return ''
    return ('did you mean ' + ' or '.join(f'"{name}"' for name in names)
            + (f' by "{by}"' if by else '') + '?')


def counted(count: int, singular: str, plural: str = '') -> str:
    """
    Return a number with what it counts, for messages.

    Parameters
    ----------
    count : int
        How many.
    singular : str
        Name of one of them.
    plural : str
        Name of several; empty: the singular and an s.

    Returns
    -------
    str
        Such as '1 point' and '2 points'.

    """
    return f'{count} {singular if count == 1 else plural or singular + "s"}'
