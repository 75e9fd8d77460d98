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
Scheduler that lets one of several threads work at a time: short jobs first.

Python runs one thread at a time, so jobs in parallel would only delay each other. The order is
that of a multilevel feedback queue (Corbato et al., An Experimental Time-Sharing System, 1962): a
job's level rises by one each time its processor time doubles, and falls while it waits (aging);
the job with the lowest level runs first, so that long jobs finish however many short ones come.
Levels use processor time, so delays by other programs do not count.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager
from math import floor, log2
from threading import Condition
from time import perf_counter, thread_time

FIRST_LEVEL = 0.1   # s of processor time up to which level 0 applies; twice for each further level
AGING_PERIOD = 1.0  # s of waiting after which a job is more urgent by one level

# A job runs for at least this time before it is preempted:
MIN_SLICE = 0.02      # s after a short wait,
SLICE_PER_WAIT = 0.1  # as a fraction of a longer wait,
MAX_SLICE = 0.3       # s at most


class Job:
    """
    One thread's work, and its place in the queue.

    Parameters
    ----------
    scheduler : Scheduler
        The scheduler that the job belongs to.
    expected : float
        Lower bound on the job's processor time [s]; the job's level is at least that of a job that
        has run for so long.

    """

    def __init__(self, scheduler: Scheduler, expected: float) -> None:
        self._scheduler, self._expected = scheduler, expected
        self._before = 0.0            # run time before the present slice [s]
        self._since = perf_counter()  # start of the present slice, or of the present wait
        self._slice = MIN_SLICE
        self._processor = 0.0  # processor time [s]; in a slice, minus the thread's at its start

    def run_time(self) -> float:
        """Return the run time so far, without waiting [s]; call it while the job runs."""
        return self._before + perf_counter() - self._since

    def checkpoint(self) -> float:
        """Let shorter jobs run first, then return the run time [s]; to be called often."""
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
        Return the level by processor time: 0 for a new short job; lower levels are more urgent.

        Parameters
        ----------
        running : bool
            Whether the job runs, in the calling thread; otherwise it waits.

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
        Return the level of a waiting job: by its processor time, less its waiting time.

        Parameters
        ----------
        now : float
            Present time of `perf_counter` [s].

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
        Return a job that waits from now on; jobs of the same level run in this order.

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
            Yields the job when it may run.

        """
        return self.run(self.enqueue(expected))

    @contextmanager
    def run(self, job: Job) -> Iterator[Job]:
        """
        Wait until a job may run, and let the next one run afterwards.

        Parameters
        ----------
        job : Job
            A waiting job. After `end` it runs at once.

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
        Suspend a running job while jobs wait whose processor time is at a lower level.

        Waiting time does not count here, so short jobs do not preempt each other.

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
        """Stop scheduling: all jobs run at once."""
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
