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

"""The server that brings the page to the browser."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager, redirect_stdout
from io import StringIO
from logging import CRITICAL, getLogger
from socket import AI_PASSIVE, getaddrinfo, SOCK_STREAM, socket

from rrr_traj_planner.nodes.process.entry import StartError
from rrr_traj_planner.nodes.studio.web.same_origin import same_origin_only
import viser


class Server(viser.ViserServer):
    """
    A server that does not offer the page to the internet: viser's own does at a click.

    Attributes
    ----------
    is_dark : bool
        Whether the page is dark.

    """

    is_dark = False

    def darken(self, is_dark: bool) -> None:
        """
        Show every page dark, or light.

        Parameters
        ----------
        is_dark : bool
            Whether dark.

        """
        self.is_dark = is_dark
        self.gui.configure_theme(show_share_button=False, show_logo=False, control_width='large',
                                 dark_mode=is_dark)

    def request_share_url(self, verbose: bool = True) -> None:
        """Refuse."""


@contextmanager
def serving(host: str, port: int) -> Iterator[Server]:
    """
    Serve pages until the end of the context.

    Parameters
    ----------
    host : str
        Address to listen at.
    port : int
        Port; the next free one where it is in use.

    Yields
    ------
    Server
        The server.

    Raises
    ------
    StartError
        If it cannot listen there.

    """
    _check_address(host, port)
    getLogger('websockets').setLevel(CRITICAL)  # a request that is no page's is no news
    try:
        with same_origin_only(host), redirect_stdout(StringIO()):  # the script prints the address
            server = Server(host, port, label='studio', verbose=False)
    except (OSError, RuntimeError, AssertionError) as error:
        raise StartError(f'cannot serve at {host}, port {port}: {error}') from None
    try:
        yield server
    finally:
        with redirect_stdout(StringIO()):
            server.stop()


def address(host: str, port: int) -> str:
    """
    Return the address of the page for a browser on this machine.

    Parameters
    ----------
    host : str
        Address at which is listened.
    port : int
        Port.

    Returns
    -------
    str
        With a note where it is listened at all addresses, which is none that a browser can open.

    """
    own = {'0.0.0.0': '127.0.0.1', '::': '::1'}.get(host, host)
    name = f'[{own}]' if ':' in own else own
    others = '' if own == host else ', and from the network by the names of this machine'
    return f'http://{name}:{port}{others}'


def _check_address(host: str, port: int) -> None:
    """Refuse an address that is not this machine's, at which viser would wait for ever."""
    try:
        family, kind, protocol, _, address = getaddrinfo(
            host, 0, type=SOCK_STREAM, flags=AI_PASSIVE)[0]
        with socket(family, kind, protocol) as probe:
            probe.bind(address)
    except OSError as error:
        raise StartError(f'cannot serve at {host}, port {port}: {error}') from None
