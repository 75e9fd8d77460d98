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

"""The thesis's figures of single functions and segments: 3.1 to 3.3, 4.1 and 4.5."""

from __future__ import annotations

from math import pi
from typing import Any, NamedTuple

import numpy as np
from rrr_traj_planner.core.arrays import Array
from rrr_traj_planner.core.motion_laws.cycloid import cruise, CycloidPiece, transition
from rrr_traj_planner.core.motion_laws.cycloid_transitions import CYCLOID
from rrr_traj_planner.core.motion_laws.gauss import GAUSS, maclaurin, maclaurin_error
from rrr_traj_planner.core.motion_laws.quartic import QUARTIC
from rrr_traj_planner.core.motion_laws.septic import SEPTIC
from rrr_traj_planner.core.trajectory.joint_profile import JointProfile
from rrr_traj_planner.core.trajectory.pieces import TransitionFunction
from rrr_traj_planner.report import drawing
from rrr_traj_planner.report.coefficients import is_transition
from rrr_traj_planner.report.picture import Picture
from rrr_traj_planner.report.theme import DASHES, LIGHT, SERIES

POINTS = 401  # of each curve
PARAMETERS_3_1 = ((0.5, 0.12), (0.5, 0.2), (0.35, 0.12))  # mu, sigma
ORDERS_3_1 = (3, 6, 9)  # of the Maclaurin series
PARAMETERS_3_2 = ((1.0, 1.0, 1.0), (0.75, 1.0, 1.0), (1.0, 0.6, 1.0), (1.0, 1.0, 1.3))  # a, b, c
FUNCTIONS: tuple[TransitionFunction, ...] = (CYCLOID, GAUSS, SEPTIC, QUARTIC)
LIMIT = 1.0    # rad/s^2 and rad/s, table 6.2
DISPLACEMENT = 1.8  # rad, of the hypothetical subtrajectory of figure 4.1


class Curve(NamedTuple):
    """A transition of a function over time."""

    name: str
    t: Array
    q: Array
    qd: Array
    qdd: Array
    qddd: Array


def gauss_function(t: Array, mu: float, sigma: float) -> tuple[Array, Array]:
    """
    Return Gauss's function and its derivative (3.1, 3.2).

    Parameters
    ----------
    t : ndarray
        Normalised times.
    mu, sigma : float
        Time and width of its peak.

    Returns
    -------
    tuple of ndarray
        Acceleration and jerk, of the same shape.

    """
    u = (t - mu) / sigma
    value = np.exp(-0.5 * u * u) / (np.sqrt(2.0 * pi) * sigma)
    return value, -u / sigma * value


def transitions_compared() -> list[Curve]:
    """Return each function's transition from rest to 1 rad/s, of peak acceleration 1 rad/s^2."""
    found = []
    for function in FUNCTIONS:
        duration = function.peak_acceleration * LIMIT / LIMIT
        s = np.linspace(0.0, 1.0, POINTS)
        piece = function.transition(duration, 0.0, 0.0, LIMIT)
        found.append(Curve(function.name, duration * s, *piece.at(s)))
    return found


def figure_3_1() -> Picture:
    """Return the figure of Gauss's function."""
    t = np.linspace(0.0, 1.0, POINTS)
    curves = [(f'μ {mu:g}, σ {sigma:g}', *gauss_function(t, mu, sigma))
              for mu, sigma in PARAMETERS_3_1]

    def draw(figure: Any) -> None:
        axes = list(figure.subplots(3, 1))
        for i, (label, value, slope) in enumerate(curves):
            for one, y in zip(axes, (value, slope)):
                one.plot(t, y, color=SERIES[i], linestyle=DASHES[i], label=label)
        _series(axes[2])
        for one, y_label, x_label in zip(
                axes, ('f(t), (3.1)', 'df/dt, (3.2)', 'exp(−u²/2), (3.3)'),
                ('normalised time t', 'normalised time t', 'u = (t − μ) / σ')):
            one.set(ylabel=y_label, xlabel=x_label)
            one.margins(x=0.0)
            one.legend(loc='upper right')
        axes[2].legend(loc='upper center', ncols=2)
        figure.align_ylabels(axes)

    errors = ', '.join(f'{maclaurin_error(order):.1e} for N = {order}' for order in ORDERS_3_1)
    return Picture(
        'figure_3_1', 'Figure 3.1: Gauss function',
        'A larger σ flattens it, μ moves its peak. Bottom: the Maclaurin series (3.3); its error '
        f'within two σ of the peak is {errors}.', draw, 6.6,
        {'t': t, **{f'{n} {what}': y for n, v, d in curves for what, y in (
            ('f', v), ('df/dt', d))}})


def _series(axes: Any) -> None:
    """Draw exp(-u^2 / 2) and its series."""
    u = np.linspace(-4.0, 4.0, POINTS)
    axes.plot(u, np.exp(-0.5 * u * u), color=LIGHT['ink'], label='closed form')
    for i, order in enumerate(ORDERS_3_1):
        axes.plot(u, maclaurin(u, order), color=SERIES[i + 3], linestyle=DASHES[i],
                  label=f'series, N = {order}')
    axes.set_ylim(-0.3, 2.2)


def figure_3_2() -> Picture:
    """Return the figure of the cycloid function."""
    curves = []
    for a, b, c in PARAMETERS_3_2:
        t = np.linspace(0.0, 2.0 * pi * a, POINTS)
        piece = CycloidPiece(2.0 * pi * a, 0.0, 0.0, c, b, 2.0 * pi)
        _, _, value, slope = piece.at(np.linspace(0.0, 1.0, POINTS))
        curves.append((f'a {a:g}, b {b:g}, c {c:g}', t, value, slope))

    def draw(figure: Any) -> None:
        axes = drawing.stacked(figure, ['c − b cos(t/a), (3.4)', '(b/a) sin(t/a), (3.5)'],
                               'time t, one period')
        for i, (label, t, value, slope) in enumerate(curves):
            for one, y in zip(axes, (value, slope)):
                lines = one.plot(t, y, color=SERIES[i], linestyle=DASHES[i % 3], label=label)
            lines[0].set_label(label)
        drawing.legend(figure, axes[0].get_lines(), 2)

    return Picture(
        'figure_3_2', 'Figure 3.2: the cycloid function',
        'a scales time, b is the amplitude, c the mean: with b = c it begins and ends at zero.',
        draw, 4.4, {f'{n} {what}': y for n, *ys in curves for what, y in zip(
            ('t', 'f', 'df/dt'), ys)})


def figure_3_3() -> Picture:
    """Return the figure of the proposed function beside others."""
    curves = transitions_compared()
    labels = (drawing.POSITION, drawing.VELOCITY, drawing.ACCELERATION, drawing.JERK)

    def draw(figure: Any) -> None:
        axes = drawing.stacked(figure, labels)
        for i, curve in enumerate(curves):
            for one, y in zip(axes, curve[2:]):
                one.plot(curve.t, y, color=SERIES[i], linestyle=DASHES[i % 3], label=curve.name)
        drawing.legend(figure, axes[0].get_lines(), 4)

    times = ', '.join(f'{c.name} {c.t[-1]:.3f} s' for c in curves)
    return Picture(
        'figure_3_3', 'Figure 3.3: position, velocity and acceleration of the proposed function',
        'A transition from rest to 1 rad/s with a peak acceleration of 1 rad/s² by each function '
        f'({times}): the quartic is the shortest, and its jerk steps at both ends; so does '
        "Gauss's.", draw, drawing.height_of(4),
        {f'{c.name} {what}': y for c in curves for what, y in zip(('t [s]', *labels), c[1:])})


def figure_4_1() -> Picture:
    """Return the figure of a hypothetical subtrajectory."""
    profile = subtrajectory(DISPLACEMENT, 0.6)
    t = np.linspace(0.0, profile.duration, POINTS)
    values = profile(t)
    labels = (drawing.POSITION, drawing.VELOCITY, drawing.ACCELERATION)

    def draw(figure: Any) -> None:
        axes = drawing.stacked(figure, labels)
        for one, y in zip(axes, values):
            shade(one, profile)
            one.plot(t, y, color=SERIES[0])
        for k, text in enumerate(('acceleration', 'constant velocity', 'deceleration')):
            axes[0].text(0.5 * (profile.knots[k] + profile.knots[k + 1]), 1.03, text,
                         transform=axes[0].get_xaxis_transform(), ha='center', fontsize=8.5)
        drawing.legend(figure, [drawing.shade_handle('transition')])

    return Picture(
        'figure_4_1', 'Figure 4.1: types of motion of a hypothetical subtrajectory',
        f'{DISPLACEMENT:g} rad from rest to rest at 0.6 rad/s: position, velocity and '
        'acceleration are continuous where the three segments meet.', draw, drawing.height_of(3),
        {'time [s]': t, **dict(zip(labels, values))})


def figure_4_5() -> Picture:
    """Return the figure of the three types of motion."""
    one = JointProfile(transition(np.array([2.0]), np.zeros(1), np.zeros(1), np.ones(1)))
    cases = (('a) transition', one), ('b) two transitions', subtrajectory(2.0, 1.0)),
             ('c) two transitions + constant velocity', subtrajectory(3.0, 1.0)))

    def draw(figure: Any) -> None:
        axes = drawing.stacked(figure, [drawing.VELOCITY] * 3)
        for one_axes, (title, profile) in zip(axes, cases):
            t = np.linspace(0.0, profile.duration, POINTS)
            shade(one_axes, profile)
            one_axes.plot(t, profile(t)[1], color=SERIES[0])
            one_axes.axhline(LIMIT, color=LIGHT['limit'], linestyle='--', linewidth=0.9)
            one_axes.set_title(title, loc='left')
            one_axes.set_ylim(0.0, 1.15)
        drawing.legend(figure, [drawing.shade_handle('transition'), drawing.limit_handle()])

    return Picture(
        'figure_4_5', 'Figure 4.5: different types of robot motion for constrained joint',
        'With limits of 1 rad/s and 1 rad/s²: 1 rad, ending at full speed; 2 rad and 3 rad, '
        'ending at rest.', draw, drawing.height_of(3) + 0.5)


def subtrajectory(displacement: float, velocity: float) -> JointProfile:
    """
    Return a motion from rest to rest at the greatest acceleration of table 6.2.

    Parameters
    ----------
    displacement : float
        Displacement [rad].
    velocity : float
        Velocity between the transitions [rad/s].

    Returns
    -------
    JointProfile
        Transition, cruise (which may have no duration), transition.

    """
    duration = CYCLOID.peak_acceleration * velocity / LIMIT  # of a transition
    cruising = max(displacement / velocity - duration, 0.0)
    start = 0.5 * velocity * duration
    pieces = (transition(duration, 0.0, 0.0, velocity), cruise(cruising, start, velocity),
              transition(duration, start + velocity * cruising, velocity, 0.0))
    return JointProfile(CycloidPiece(*(np.array(f, dtype=float) for f in zip(*pieces))))


def shade(axes: Any, profile: JointProfile) -> None:
    """
    Shade the intervals of a motion's transitions.

    Parameters
    ----------
    axes : Axes
        The axes.
    profile : JointProfile
        The motion.

    """
    moving = is_transition(profile.pieces)
    for begin, end in zip(profile.knots[:-1][moving], profile.knots[1:][moving]):
        axes.axvspan(begin, end, color=LIGHT['transition'], linewidth=0.0, zorder=0)
