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

"""Scheduler of threads: one works at a time, short jobs first, long jobs finish all the same."""

from threading import Event, Thread
from time import perf_counter, sleep, thread_time

import pytest
from rrr_traj_planner.nodes.planner_node import scheduler as scheduling
from rrr_traj_planner.nodes.planner_node.scheduler import FIRST_LEVEL, Scheduler

DEADLINE = 20.0  # s


def work(job, seconds):
    """Take the processor for a time, however long that takes on a busy machine."""
    begun = thread_time()
    while thread_time() < begun + seconds:
        job.checkpoint()


class Worker:
    """A thread whose job runs for so long; when it began and ended, and its run time."""

    def __init__(self, scheduler, seconds):
        self._scheduler, self._seconds = scheduler, seconds
        self.begun, self.ended = Event(), 0.0
        self._thread = Thread(target=self._run, daemon=True)
        self.submitted = perf_counter()
        self._thread.start()

    def _run(self):
        with self._scheduler.job() as job:
            self.begun.set()
            work(job, self._seconds)
            self.run_time, self.processor = job.run_time(), thread_time()
            self.ended = perf_counter()

    def join(self):
        self._thread.join(DEADLINE)
        assert self.ended
        return self


def started(scheduler, seconds):
    """Return a worker that is running or has run."""
    worker = Worker(scheduler, seconds)
    assert worker.begun.wait(DEADLINE)
    return worker


def test_short_work_runs_before_long_work_that_came_first():
    scheduler = Scheduler()
    long_ones = [started(scheduler, 0.6) for _ in range(3)]
    short = Worker(scheduler, 0.01).join()
    for worker in long_ones:
        worker.join()
    assert short.ended < min(w.ended for w in long_ones)


@pytest.mark.parametrize('period', [1.0, 0.02])  # of aging [s]; the delay is 0.3 s
def test_short_work_that_other_programs_delay_keeps_its_turn(monkeypatch, period):
    monkeypatch.setattr(scheduling, 'AGING_PERIOD', period)
    scheduler, order = Scheduler(), []

    def delayed():
        with scheduler.job() as job:
            running.set()
            assert asked.wait(DEADLINE)
            sleep(3.0 * FIRST_LEVEL)  # as if another program had the processor
            job.checkpoint()
            order.append('delayed')

    def short():
        with scheduler.run(queued):
            order.append('later')

    running, asked = Event(), Event()
    thread = Thread(target=delayed)
    thread.start()
    assert running.wait(DEADLINE)
    queued = scheduler.enqueue()
    later = Thread(target=short)
    later.start()
    asked.set()
    thread.join(DEADLINE)
    later.join(DEADLINE)
    assert order == ['delayed', 'later']


def test_run_time_leaves_out_the_time_of_others():
    scheduler = Scheduler()
    first, second = started(scheduler, 0.3), started(scheduler, 0.3)
    for worker in (first, second):
        worker.join()
        assert worker.run_time >= 0.3
    assert first.run_time + second.run_time <= max(first.ended, second.ended) - first.submitted


def test_one_works_at_a_time_and_equals_in_the_order_of_their_coming():
    scheduler, order = Scheduler(), []

    def append(k):
        with scheduler.job() as job:
            order.append(k)
            work(job, 0.005)
            order.append(k)

    with scheduler.job():
        threads = []
        for k in range(8):
            threads.append(Thread(target=append, args=(k,)))
            threads[-1].start()
            while len(scheduler._waiting) <= k:
                pass
    for thread in threads:
        thread.join(DEADLINE)
    assert order == [k for k in range(8) for _ in range(2)]


def test_long_work_gets_on_while_short_work_never_ends():
    scheduler, ended = Scheduler(), Event()

    def short_ones():
        while not ended.is_set():
            with scheduler.job() as job:
                work(job, 0.02)

    long_one = started(scheduler, 2.5 * FIRST_LEVEL)
    threads = [Thread(target=short_ones) for _ in range(2)]
    for thread in threads:
        thread.start()
    try:
        long_one.join()
    finally:
        ended.set()
        for thread in threads:
            thread.join(DEADLINE)


def test_job_that_is_expected_to_be_long_lets_short_ones_go_first_from_the_beginning():
    scheduler, order = Scheduler(), []

    def append(name, expected):
        with scheduler.job(expected):
            order.append(name)

    with scheduler.job():
        threads = [Thread(target=append, args=work) for work in (('long', 1.0), ('short', 0.01))]
        for k, thread in enumerate(threads):
            thread.start()
            while len(scheduler._waiting) <= k:
                pass
    for thread in threads:
        thread.join(DEADLINE)
    assert order == ['short', 'long']


def test_no_job_waits_after_the_scheduler_has_ended():
    scheduler = Scheduler()
    with scheduler.job():
        waiting = [Worker(scheduler, 0.0) for _ in range(3)]
        scheduler.end()
        for worker in waiting:
            worker.join()


def test_an_error_ends_its_job():
    scheduler = Scheduler()
    with pytest.raises(ValueError, match='^no$'), scheduler.job():
        raise ValueError('no')
    with scheduler.job():
        pass


def test_jobs_run_in_the_order_in_which_they_were_enqueued():
    scheduler, order = Scheduler(), []
    first, second = scheduler.enqueue(), scheduler.enqueue()

    def work(job, name):
        with scheduler.run(job):
            order.append(name)

    early = Thread(target=work, args=(second, 'second'))
    early.start()
    early.join(0.05)
    assert order == []
    work(first, 'first')
    early.join()
    assert order == ['first', 'second']
