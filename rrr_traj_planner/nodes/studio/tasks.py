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

"""Tasks that are opened: for the arm that is shown, or for another one, for which nodes start."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from rrr_traj_planner.core.arm.payload import Payload
from rrr_traj_planner.core.errors import InvalidInputError
from rrr_traj_planner.nodes.parameters.configuration import PlannerConfig
from rrr_traj_planner.nodes.parameters.planner_config import planner_config
from rrr_traj_planner.nodes.parameters.ros_arguments import describes_an_arm, without_parameters
from rrr_traj_planner.nodes.point_files.shipped import shipped_task
from rrr_traj_planner.nodes.point_files.task import Task
from rrr_traj_planner.nodes.studio.editor import Editor
from rrr_traj_planner.nodes.studio.files import loaded
from rrr_traj_planner.nodes.studio.wanted import Wanted, wanted_of

STARTING = 'starting the nodes anew for the arm of {}'


@dataclass(frozen=True, eq=False)
class Start:
    """
    With what the nodes are started.

    Attributes
    ----------
    task : Task
        What is planned at first.
    arm : Path or None
        The arm's parameter file; None: `ros_arguments` describe the arm.
    ros_arguments : list of str
        For all nodes.
    wanted : Wanted or None
        What is planned at first in place of the task: what was wanted of this arm before.
    error : str
        What the page says at first, in red; empty: nothing.

    """

    task: Task
    arm: Path | None
    ros_arguments: list[str]
    wanted: Wanted | None = None
    error: str = ''

    def first_wanted(self, config: PlannerConfig, payload: Payload) -> Wanted:
        """
        Return what is planned at first.

        Parameters
        ----------
        config : PlannerConfig
            The planner's.
        payload : Payload
            What the arm carries.

        Returns
        -------
        Wanted
            With its options.

        Raises
        ------
        InvalidInputError
            If the task is for other joints, or in another frame.

        """
        if self.wanted is not None:
            return self.wanted
        wanted = wanted_of(
            self.task, config.model, config.base_frame, config.default_planner_id)
        return replace(wanted, payload=payload)


def first_start(task: Task, ros_arguments: Sequence[str]) -> Start:
    """
    Return the start that the command line asks for.

    Parameters
    ----------
    task : Task
        The via-point file.
    ros_arguments : sequence of str
        The user's; an arm that they describe is taken in place of the file's.

    Returns
    -------
    Start
        With the arm.

    """
    arm = None if describes_an_arm(ros_arguments) else task.arm
    return Start(task, arm, list(ros_arguments))


def another_start(task: Task, before: Start) -> Start:
    """
    Return the start of a task with its own arm.

    Parameters
    ----------
    task : Task
        The task.
    before : Start
        The one in progress; its parameters are left out, as they are of the arm before.

    Returns
    -------
    Start
        With names of topics and nodes as they are.

    """
    return Start(task, task.arm, without_parameters(before.ros_arguments))


def started_again(before: Start, failed: Start, error: str) -> Start:
    """
    Return the start of the arm before, after another one could not be started.

    Parameters
    ----------
    before, failed : Start
        The two.
    error : str
        Why not.

    Returns
    -------
    Start
        With a message for the page.

    """
    return replace(
        before, error=f'{failed.task.name} cannot be started: {error}; see the terminal')


def check_arm(task: Task) -> None:
    """
    Refuse a task whose arm cannot be started, before the nodes of the present one are ended.

    Parameters
    ----------
    task : Task
        The task.

    Raises
    ------
    InvalidInputError
        If its arm's parameters are wrong, or its via points are not of this arm.

    """
    config = planner_config(task.arm)
    wanted_of(task, config.model, config.base_frame, config.default_planner_id)


class Tasks:
    """
    What opens tasks.

    Parameters
    ----------
    editor : Editor
        Gets those for the arm that is shown.
    config : PlannerConfig
        The planner's.
    arm : Path or None
        The parameter file of the arm that is shown; None: it is described otherwise.
    said : callable
        Called when there is something else to be said.
    can_exchange : bool
        Whether another arm can be started in place of the one that is shown.

    Attributes
    ----------
    message : str
        What there is to say about the last task; empty: nothing.
    is_error : bool
        Whether it is that the task could not be opened.
    next : Task or None
        A task for another arm, with which the nodes are to be started anew.

    """

    def __init__(self, editor: Editor, config: PlannerConfig, arm: Path | None,
                 said: Callable[[], None], can_exchange: bool = True) -> None:
        self._editor, self._config, self._said, self.arm = editor, config, said, arm
        self._can_exchange = can_exchange
        self.message, self.is_error = '', False
        self.next: Task | None = None

    def say(self, message: str, is_error: bool = False) -> None:
        """
        Have the page say something about the last task.

        Parameters
        ----------
        message : str
            Empty: nothing any more.
        is_error : bool
            Whether it is an error.

        """
        self.message, self.is_error = message, is_error
        self._said()

    def refuse(self, error: str) -> None:
        """
        Have the page say in red what is wrong with what the user has done.

        Parameters
        ----------
        error : str
            Empty: nothing any more.

        """
        self.say(error, is_error=True)

    def load(self, name: str, content: bytes) -> None:
        """
        Open a via-point file: for the arm that it names, if it names one.

        The arm's file is looked for beside that of the arm that is shown, and where the studio was
        started. An arm that was described on the command line is kept.

        Parameters
        ----------
        name : str
            Its name.
        content : bytes
            Its content.

        """
        def read() -> tuple[Task, bool]:
            shown = () if self.arm is None else (self.arm.parent,)
            task, names_arm = loaded(name, content, *shown, Path.cwd())
            return task, names_arm and self.arm is not None

        self._open(read)

    def open_shipped(self, name: str) -> None:
        """
        Open one of the package's tasks, for its arm.

        Parameters
        ----------
        name : str
            As in `shipped_tasks`.

        """
        self._open(lambda: (shipped_task(name), True))

    def _open(self, read: Callable[[], tuple[Task, bool]]) -> None:
        """Take a task; refuse one that is wrong, or whose arm is, before anything changes."""
        try:
            task, with_arm = read()
            if with_arm and task.arm != self.arm:
                if not self._can_exchange:
                    raise InvalidInputError(
                        f'{task.name} is for {task.arm.stem}, not for the arm that is connected')
                check_arm(task)
                self.say(STARTING.format(task.name))
                self.next = task
                return
            before, config = self._editor.wanted, self._config
            found = wanted_of(task, config.model, config.base_frame, before.task.planner_id)
        except InvalidInputError as error:
            self.refuse(str(error))
            return
        self.say('')
        self._editor.chosen = 0
        self._editor.change(found.with_options(before))
