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

"""The page's server: for its own page, and for programs, but for no other website's page."""

from __future__ import annotations

from importlib import import_module
import socket

import pytest

pytest.importorskip('viser', reason='viser is not installed: make studio installs it')
client = import_module('websockets.sync.client')
exceptions = import_module('websockets.exceptions')
Headers = import_module('websockets').Headers
origins = import_module('rrr_traj_planner.nodes.studio.web.same_origin')
serving = import_module('rrr_traj_planner.nodes.studio.web.server').serving
PROTOCOL = f'viser-v{import_module("viser").__version__}'


@pytest.fixture(scope='module')
def port():
    """Serve a page; return the port."""
    with serving('127.0.0.1', 8080) as server:
        yield server.get_port()


@pytest.mark.parametrize('origin', [None, 'http://127.0.0.1:{port}'])
def test_own_page_and_programs_may_connect(port, origin):
    with client.connect(f'ws://127.0.0.1:{port}', subprotocols=[PROTOCOL],
                        origin=origin and origin.format(port=port)) as connection:
        assert connection.recv(timeout=20.0)  # what the page shows


@pytest.mark.parametrize('origin', [
    'https://example.com', 'http://127.0.0.1', 'http://127.0.0.1:1', 'http://localhost:{port}',
    'http://127.0.0.1.example.com:{port}', 'null', ''])
def test_page_of_another_origin_may_not(port, origin):
    with pytest.raises(exceptions.InvalidStatus, match='403'):
        client.connect(f'ws://127.0.0.1:{port}', subprotocols=[PROTOCOL],
                       origin=origin.format(port=port))


@pytest.mark.parametrize('name', [
    'example.com', 'example.com:{port}', '127.0.0.1.example.com', ''])
def test_name_that_points_here_may_not(port, name):
    """DNS rebinding: the page of a name that its owner has pointed to this machine."""
    name = name.format(port=port)
    with socket.create_connection(('127.0.0.1', port), 20.0) as raw:
        raw.sendall((f'GET / HTTP/1.1\r\nHost: {name}\r\nOrigin: http://{name}\r\n'
                     'Upgrade: websocket\r\nConnection: Upgrade\r\n'
                     'Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n'
                     f'Sec-WebSocket-Version: 13\r\nSec-WebSocket-Protocol: {PROTOCOL}\r\n\r\n'
                     ).encode())
        assert raw.recv(1000).startswith(b'HTTP/1.1 403')


@pytest.mark.parametrize(('name', 'may'), [
    ('localhost:1', True), ('127.0.0.1', True), ('[::1]:80', True), ('192.168.1.7:8080', True),
    ('robot.lan:8080', True), (f'{socket.gethostname()}:80', True),
    ('rebound.example:8080', False)])
def test_names_of_this_machine_are_known(name, may):
    assert origins.may_connect(Headers(Host=name, Origin=f'http://{name}'), 'robot.lan') == may
    assert not origins.may_connect(Headers(Host=name, Origin='http://example.com'), 'robot.lan')


def test_servers_of_others_are_as_they_were(port):
    server = import_module('websockets.asyncio.server')
    assert isinstance(server.serve, type)
