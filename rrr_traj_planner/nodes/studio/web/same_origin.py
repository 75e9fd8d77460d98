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
the header Origin (RFC 6455, section 10.2). It must be the one that the browser has asked, in the
header Host; and this must not be a name of the internet's, which its owner may point to this
machine (DNS rebinding). viser looks at neither, and has no hook to do so; the server that it makes
is made by a function of websockets, which is wrapped here meanwhile.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from http import HTTPStatus
from ipaddress import ip_address
from socket import getfqdn, gethostname
from typing import Any
from urllib.parse import urlsplit

import websockets.asyncio.server as websockets

REFUSAL = 'a page of another origin may not connect\n'


def may_connect(headers: Any, host: str) -> bool:
    """
    Return whether a request comes from the page, or from no browser.

    Parameters
    ----------
    headers : websockets.Headers
        Of the request.
    host : str
        Address at which is listened.

    Returns
    -------
    bool
        True only for requests to an IP address, to this machine's names or to the host.

    """
    hosts, origin = headers.get_all('Host'), headers.get('Origin')
    if len(hosts) != 1:
        return False
    return _is_this_machine(urlsplit(f'//{hosts[0]}').hostname or '', host) and (
        origin is None or urlsplit(origin).netloc == hosts[0])


def _is_this_machine(name: str, host: str) -> bool:
    if name in {'localhost', host, gethostname().lower(), getfqdn().lower()}:
        return True
    try:
        ip_address(name)
    except ValueError:
        return False
    return True


@contextmanager
def same_origin_only(host: str) -> Iterator[None]:
    """
    Have servers that are started meanwhile refuse pages of other origins, for good.

    Parameters
    ----------
    host : str
        Address at which they listen.

    """
    serve = websockets.serve

    def checked(*args: Any, process_request: Callable[..., Any], **kwargs: Any) -> Any:
        def process(connection: Any, request: Any) -> Any:
            if not may_connect(request.headers, host):
                return connection.respond(HTTPStatus.FORBIDDEN, REFUSAL)
            return process_request(connection, request)

        return serve(*args, process_request=process, **kwargs)

    websockets.serve = checked  # type: ignore[misc, assignment]
    try:
        yield
    finally:
        websockets.serve = serve  # type: ignore[misc]
