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

"""
Connections from the page alone: no other website in the user's browser may move the arm.

A browser lets any website open a WebSocket to any server, and tells the server which one it is in
the header Origin (RFC 6455, section 10.2). viser does not look at it, and has no hook to do so;
the server that it makes is made by a function of websockets, which is wrapped here meanwhile.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from http import HTTPStatus
from typing import Any
from urllib.parse import urlsplit

import websockets.asyncio.server as websockets

REFUSAL = 'a page of another origin may not connect\n'


def is_of_another_origin(headers: Any) -> bool:
    """
    Return whether a request comes from another website's page.

    Parameters
    ----------
    headers : mapping
        Of the request.

    Returns
    -------
    bool
        False also for programs that are no browsers, which have no origin.

    """
    origin = headers.get('Origin')
    return origin is not None and urlsplit(origin).netloc != headers.get('Host')


@contextmanager
def same_origin_only() -> Iterator[None]:
    """Have servers that are started meanwhile refuse pages of other origins, for good."""
    serve = websockets.serve

    def checked(*args: Any, process_request: Callable[..., Any], **kwargs: Any) -> Any:
        def process(connection: Any, request: Any) -> Any:
            if is_of_another_origin(request.headers):
                return connection.respond(HTTPStatus.FORBIDDEN, REFUSAL)
            return process_request(connection, request)

        return serve(*args, process_request=process, **kwargs)

    websockets.serve = checked  # type: ignore[misc, assignment]
    try:
        yield
    finally:
        websockets.serve = serve  # type: ignore[misc]
