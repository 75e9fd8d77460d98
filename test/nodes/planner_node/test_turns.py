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

"""Turns of threads: one works at a time, short work goes first, long work gets on all the same."""

from threading import Event, Thread
from time import perf_counter, thread_time

import pytest
from rrr_traj_planner.nodes.planner_node.turns import FIRST_LEVEL, Turns

DEADLINE = 20.0  # s


def work(turn, seconds):
    """Take a time of one's own."""
    while turn.seconds() < seconds:
        pass


class Worker:
    """A thread that works for so long; when it began and ended, and how long that was work."""

    def __init__(self, turns, seconds):
        self._turns, self._seconds = turns, seconds
        self.begun, self.ended = Event(), 0.0
        self._thread = Thread(target=self._run, daemon=True)
        self.asked = perf_counter()
        self._thread.start()

    def _run(self):
        with self._turns.turn() as turn:
            self.begun.set()
            work(turn, self._seconds)
            self.used, self.processor = turn.used(), thread_time()
            self.ended = perf_counter()

    def join(self):
        self._thread.join(DEADLINE)
        assert self.ended
        return self


def started(turns, seconds):
    """Return a worker that has had its first turn."""
    worker = Worker(turns, seconds)
    assert worker.begun.wait(DEADLINE)
    return worker


def test_short_work_goes_before_long_work_that_came_first():
    turns = Turns()
    long_ones = [started(turns, 0.6) for _ in range(3)]
    short = Worker(turns, 0.01).join()
    for worker in long_ones:
        worker.join()
    assert short.ended < min(w.ended for w in long_ones)


def test_work_is_timed_without_the_turns_of_others():
    turns = Turns()
    first, second = started(turns, 0.3), started(turns, 0.3)
    for worker in (first, second):
        worker.join()
        assert 0.3 <= worker.used < 0.45
    assert max(first.ended, second.ended) - first.asked > 0.6


def test_one_works_at_a_time_and_equals_in_the_order_of_their_coming():
    turns, order = Turns(), []

    def append(k):
        with turns.turn() as turn:
            order.append(k)
            work(turn, 0.005)
            order.append(k)

    with turns.turn():
        threads = []
        for k in range(8):
            threads.append(Thread(target=append, args=(k,)))
            threads[-1].start()
            while len(turns._waiting) <= k:
                pass
    for thread in threads:
        thread.join(DEADLINE)
    assert order == [k for k in range(8) for _ in range(2)]


def test_long_work_gets_on_while_short_work_never_ends():
    turns, ended = Turns(), Event()

    def short_ones():
        while not ended.is_set():
            with turns.turn() as turn:
                work(turn, 0.02)

    long_one = started(turns, 2.5 * FIRST_LEVEL)
    threads = [Thread(target=short_ones) for _ in range(2)]
    for thread in threads:
        thread.start()
    try:
        long_one.join()
    finally:
        ended.set()
        for thread in threads:
            thread.join(DEADLINE)


def test_what_is_expected_to_take_long_lets_others_go_first_from_the_beginning():
    turns, order = Turns(), []

    def append(name, expected):
        with turns.turn(expected):
            order.append(name)

    with turns.turn():
        threads = [Thread(target=append, args=work) for work in (('long', 1.0), ('short', 0.01))]
        for k, thread in enumerate(threads):
            thread.start()
            while len(turns._waiting) <= k:
                pass
    for thread in threads:
        thread.join(DEADLINE)
    assert order == ['short', 'long']


def test_nobody_waits_once_turns_have_ended():
    turns = Turns()
    with turns.turn():
        waiting = [Worker(turns, 0.0) for _ in range(3)]
        turns.end()
        for worker in waiting:
            worker.join()


def test_an_error_ends_its_turn():
    turns = Turns()
    with pytest.raises(ValueError, match='^no$'), turns.turn():
        raise ValueError('no')
    with turns.turn():
        pass


def test_turns_are_taken_in_the_order_in_which_they_were_queued():
    turns, order = Turns(), []
    first, second = turns.queued(), turns.queued()

    def work(turn, name):
        with turns.taken(turn):
            order.append(name)

    early = Thread(target=work, args=(second, 'second'))
    early.start()
    early.join(0.05)
    assert order == []
    work(first, 'first')
    early.join()
    assert order == ['first', 'second']
