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

"""The pool of worker threads: calls in order, their results and exceptions, and its end."""

from threading import Event
from time import perf_counter, sleep

import pytest
from rrr_traj_planner.nodes.planner_node import worker_pool
from rrr_traj_planner.nodes.planner_node.worker_pool import WorkerPool

DEADLINE = 10.0  # s


@pytest.fixture
def threads(ros):
    pool = WorkerPool(ros.node, 'test')
    yield pool
    pool.end()


def until_done(*futures):
    """Return results or errors of futures, in the order in which they came."""
    came, all_done = [], Event()

    def done(future):
        came.append(str(future.exception()) if future.exception() else future.result())
        if len(came) == len(futures):
            all_done.set()

    for future in futures:
        future.add_done_callback(done)
    assert all_done.wait(DEADLINE)
    return came


def added(a, b, job):
    return a + b


def failing(job):
    raise ValueError('no number')


def test_calls_are_made_in_order_and_return_or_raise(threads):
    calls = [threads.call(added, 1, 2), threads.call(failing), threads.call(added, 3, 4)]
    assert until_done(*calls) == [3, 'no number', 7]


def test_end_waits_for_the_running_call(threads):
    begun, ended = Event(), []

    def slow(job):
        begun.set()
        sleep(0.2)
        ended.append(True)

    future = threads.call(slow)
    assert begun.wait(DEADLINE)
    assert not threads.is_ending()
    threads.end()
    assert ended
    assert threads.is_ending()
    assert not future.done()  # the executor has ended


def test_end_waits_for_a_limited_time(threads, monkeypatch):
    monkeypatch.setattr(worker_pool, 'JOIN_TIMEOUT', 0.05)
    begun, release = Event(), Event()

    def endless(job):
        begun.set()
        release.wait()

    threads.call(endless)
    assert begun.wait(DEADLINE)
    started = perf_counter()
    threads.end()
    assert perf_counter() - started < DEADLINE
    release.set()
