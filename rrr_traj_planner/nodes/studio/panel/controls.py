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
from typing import Any

# Calls a function in the thread in which the studio is to be called.
Post = Callable[[Callable[[], None]], Any]

PAUSE = 0.7  # s without another key, after which a number is what the user has typed


def given(handle: Any, post: Post, act: Callable[[Any], None]) -> None:
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

    """
    async def changed(event: Any) -> None:  # not in a pool of threads, where the order is lost
        value = handle.value
        if event.client_id is not None:
            post(lambda: act(value))

    (handle.on_update if hasattr(handle, 'on_update') else handle.on_click)(changed)


def typed(handle: Any, post: Post, act: Callable[[Any], None]) -> None:
    """
    Have a number do something once the user has typed it: viser tells of every key.

    Parameters
    ----------
    handle : viser's handle of a control
        What has a value.
    post : callable
        Calls a function in the studio's thread.
    act : callable
        Gets the value that the user has given; not what the page itself has set.

    """
    waiting: list[TimerHandle] = []

    async def changed(event: Any) -> None:
        value = handle.value
        if event.client_id is not None:
            while waiting:
                waiting.pop().cancel()
            waiting.append(get_running_loop().call_later(
                PAUSE, lambda: post(lambda: act(value))))

    handle.on_update(changed)


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
