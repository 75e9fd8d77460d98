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

"""How the panel's controls call the studio: in its thread, in order, and only for the user."""

from __future__ import annotations

from asyncio import get_running_loop, TimerHandle
from collections.abc import Callable
from typing import Any, Protocol

from rrr_traj_planner.nodes.studio.studio import Studio

# Calls a function in the thread in which the studio is to be called.
Post = Callable[[Callable[[], None]], Any]

TYPED = 0.7  # s without another key, after which a number is what the user has typed


class Folder(Protocol):
    """A part of the panel."""

    def connect(self, studio: Studio, post: Post) -> None:
        """
        Have the controls do something.

        Parameters
        ----------
        studio : Studio
            What they act on.
        post : callable
            Calls a function in the studio's thread.

        """


def given(handle: Any, post: Post, act: Callable[..., None], pause: float = 0.0,
          about: Callable[[], Any] | None = None) -> None:
    """
    Have a control's value do something.

    Parameters
    ----------
    handle : viser's handle of a control
        What has a value.
    post : callable
        Calls a function in the studio's thread.
    act : callable
        Gets the value that the user has given; not what the page itself has set.
    pause : float
        Time without another value, after which this one is taken [s]: viser tells of every key.
    about : callable, optional
        Returns what the value is of, when the user gives it; `act` gets that too.

    """
    waiting: list[tuple[TimerHandle, tuple[Any, ...]]] = []  # one at most

    def take(values: tuple[Any, ...]) -> None:
        waiting.clear()
        post(lambda: act(*values))

    async def changed(event: Any) -> None:  # not in a pool of threads, where the order is lost
        if event.client_id is None:
            return
        values = (handle.value,) if about is None else (handle.value, about())
        for timer, before in list(waiting):
            timer.cancel()
            if before[1:] != values[1:]:
                take(before)
        if pause:
            waiting[:] = [(get_running_loop().call_later(pause, take, values), values)]
        else:
            take(values)

    (handle.on_update if hasattr(handle, 'on_update') else handle.on_click)(changed)


def enable(handle: Any, is_enabled: bool) -> None:
    """
    Let the user use a control, or not.

    Parameters
    ----------
    handle : viser's handle of a control
        The control.
    is_enabled : bool
        Whether it can be used.

    """
    if handle.disabled == is_enabled:
        handle.disabled = not is_enabled


def when(handle: Any, post: Post, act: Callable[[], None]) -> None:
    """
    Have a button do something.

    Parameters
    ----------
    handle : viser's handle of a control
        A button or a command.
    post : callable
        Calls a function in the studio's thread.
    act : callable
        What to do there when the user has clicked.

    """
    async def clicked(_: Any) -> None:  # not in a pool of threads, where the order is lost
        post(act)

    (handle.on_click if hasattr(handle, 'on_click') else handle.on_trigger)(clicked)
