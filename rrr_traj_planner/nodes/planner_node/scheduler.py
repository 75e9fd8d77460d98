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
Scheduler of threads of which one works at a time: short jobs first.

Python runs one thread at a time, so jobs that ran side by side would only delay each other. The
order is that of a multilevel feedback queue (Corbato et al., An Experimental Time-Sharing System,
1962): a job's priority falls as its processor time doubles, and rises while it waits (aging), so
that long jobs finish however many short ones come. A job that another program delays is no longer
one for it.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager
from math import floor, log2
from threading import Condition
from time import perf_counter, thread_time

FIRST_LEVEL = 0.1    # s of processor time at level 0, the most urgent; each further one has twice
AGING_PERIOD = 1.0   # s of waiting after which a job is more urgent by one level
MIN_SLICE = 0.02     # s that a job may run before it is preempted; more after a long wait:
SLICE_PER_WAIT = 0.1  # of the time that the job has waited,
MAX_SLICE = 0.3      # s at most


class Job:
    """
    One thread's work, and its place in the queue.

    Parameters
    ----------
    scheduler : Scheduler
        The scheduler that the job belongs to.
    expected : float
        Lower bound on the job's processor time [s]: the job is never more urgent than one that has
        run for so long.

    """

    def __init__(self, scheduler: Scheduler, expected: float) -> None:
        self._scheduler, self._expected = scheduler, expected
        self._before = 0.0            # run time before the present slice [s]
        self._since = perf_counter()  # start of the present slice, or of the present wait
        self._slice = MIN_SLICE
        self._processor = 0.0  # processor time, while the job runs less its thread's at the start

    def run_time(self) -> float:
        """Return the run time so far, without waiting [s]; call it while the job runs."""
        return self._before + perf_counter() - self._since

    def checkpoint(self) -> float:
        """Let more urgent jobs run first, then return the run time [s]; call it often."""
        if self._scheduler.has_waiting and perf_counter() - self._since > self._slice:
            self._scheduler.preempt(self)
        return self.run_time()

    def resume(self) -> None:
        """Start a time slice."""
        now = perf_counter()
        waited, self._since = now - self._since, now
        self._slice = max(MIN_SLICE, min(SLICE_PER_WAIT * waited, MAX_SLICE))
        self._processor -= thread_time()

    def suspend(self) -> None:
        """End the time slice and start waiting."""
        self._before, self._since = self.run_time(), perf_counter()
        self._processor += thread_time()

    def work(self, running: bool = False) -> float:
        """
        Return the priority level by the work done: 0 for a new short job, lower is more urgent.

        Parameters
        ----------
        running : bool
            Whether the job runs, in the calling thread; else it waits.

        Returns
        -------
        float
            The level.

        """
        processor = self._processor + (thread_time() if running else 0.0)
        done = max(self._expected, processor, 0.5 * FIRST_LEVEL)
        return floor(1.0 + log2(done / FIRST_LEVEL))

    def level(self, now: float) -> float:
        """
        Return the priority level of a waiting job: by its work and by how long it has waited.

        Parameters
        ----------
        now : float
            The time, as of `perf_counter` [s].

        Returns
        -------
        float
            The level.

        """
        return self.work() - (now - self._since) / AGING_PERIOD


class Scheduler:
    """
    Runs the jobs of several threads, one at a time.

    Attributes
    ----------
    has_waiting : bool
        Whether a job waits.

    """

    def __init__(self) -> None:
        self.has_waiting = False
        self._changed = Condition()
        self._waiting: list[Job] = []
        self._busy = self._ended = False

    def enqueue(self, expected: float = 0.0) -> Job:
        """
        Return a job that waits from now on; equally urgent jobs run in this order.

        Parameters
        ----------
        expected : float
            See `Job`.

        Returns
        -------
        Job
            For `run`, in any thread.

        """
        with self._changed:
            job = Job(self, expected)
            self._waiting.append(job)
            self.has_waiting = True
        return job

    def job(self, expected: float = 0.0) -> AbstractContextManager[Job]:
        """
        Enqueue a job and run it; see `run`.

        Parameters
        ----------
        expected : float
            See `Job`.

        Returns
        -------
        context manager
            Yields the job once it is its turn.

        """
        return self.run(self.enqueue(expected))

    @contextmanager
    def run(self, job: Job) -> Iterator[Job]:
        """
        Wait until it is a job's turn, and let the next one run afterwards.

        Parameters
        ----------
        job : Job
            A job that waits. After `end` it does not wait any more.

        Yields
        ------
        Job
            The same.

        """
        with self._changed:
            self._wait(job)
        try:
            yield job
        finally:
            with self._changed:
                self._busy = False
                self._changed.notify_all()

    def preempt(self, job: Job) -> None:
        """
        Suspend a running job while jobs wait that have done less work by a level.

        Jobs that have waited long run before others that wait, not before one that runs: a short
        job is over soon, and is not overtaken by its like.

        Parameters
        ----------
        job : Job
            The job of the calling thread.

        """
        with self._changed:
            if self._ended or not any(w.work() < job.work(running=True) for w in self._waiting):
                return
            job.suspend()
            self._waiting.append(job)
            self.has_waiting = True
            self._busy = False
            self._changed.notify_all()
            self._wait(job)

    def end(self) -> None:
        """Stop scheduling: no job waits any more."""
        with self._changed:
            self._ended = True
            self._changed.notify_all()

    def _wait(self, job: Job) -> None:
        self._changed.wait_for(
            lambda: self._ended or not self._busy and job is self._most_urgent())
        self._waiting.remove(job)
        self.has_waiting = bool(self._waiting)
        self._busy = True
        job.resume()

    def _most_urgent(self) -> Job:
        now = perf_counter()
        return min(self._waiting, key=lambda w: w.level(now))
