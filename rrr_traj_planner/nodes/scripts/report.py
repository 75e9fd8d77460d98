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

"""The script `report`: a page with the thesis's figures, or with any plan; needs no ROS."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
import sys

from rrr_traj_planner.nodes.process.entry import (
    add_limits_option,
    parse,
    run_script,
    StartError,
)

DESCRIPTION = """\
Write a self-contained page, OUT_DIR/index.html, with its figures as PNG and CSV beside it.

--thesis redraws the thesis's tables and figures from this package's own planners. --plan draws a
plan of a via-point file: profiles against limits, torque use, path, animation, peaks, residual
vibration; by several planners side by side. Starts no node; of the arguments for ROS the
parameters count, those of the planner. If a planner refuses, the page shows why, and the exit code
is 1."""

NO_MATPLOTLIB = (
    'no figures, matplotlib is missing ({error}): sudo apt install python3-matplotlib, or '
    "pip install matplotlib (the package's extra 'figures')")

MAX_NAME = 200  # bytes of a task's name in the folder's name; file systems allow 255 in all


def main(arguments: Sequence[str] | None = None) -> int:
    """
    Write a report.

    Parameters
    ----------
    arguments : sequence of str, optional
        The command line without the script's name; None: `sys.argv`'s.

    Returns
    -------
    int
        Exit code: 0 if the page is written and shows no refusal; 1 if not; 0 after SIGINT or
        SIGTERM.

    """
    def work() -> int:
        options, ros_arguments = parse('report', DESCRIPTION, arguments, _add_options)
        if options.thesis and (options.planner or options.output or options.joint_limits):
            print('report: --planner, --output and --joint-limits go with --plan', file=sys.stderr)
            return 2
        try:
            import matplotlib  # noqa: F401
        except ImportError as error:
            raise StartError(NO_MATPLOTLIB.format(error=error)) from None
        try:
            return _thesis(options.thesis) if options.thesis else _plan(
                options, ros_arguments)
        except OSError as error:
            raise StartError(f'cannot write the page: {error}') from None

    return run_script('report', work)


def _add_options(parser: argparse.ArgumentParser) -> None:
    what = parser.add_mutually_exclusive_group(required=True)
    what.add_argument('--thesis', type=Path, metavar='OUT_DIR',
                      help="redraw the thesis's tables and figures")
    what.add_argument('--plan', metavar='FILE',
                      help="draw a plan: via points, a file or one of the package's config/")
    parser.add_argument('--planner', action='append', default=[], metavar='ID',
                        help="planner id, may be repeated (default: the file's); 'all' for all "
                             'planners')
    parser.add_argument('--output', type=Path, metavar='OUT_DIR',
                        help='folder of the page of --plan (default: report_FILE); an earlier '
                             'report there is replaced, other files are left alone')
    add_limits_option(parser)


def _thesis(folder: Path) -> int:
    from rrr_traj_planner.report.thesis_report import write_thesis_report
    print('planning and drawing ...', flush=True)
    print(f'page: {write_thesis_report(folder)}')
    return 0


def _plan(options: argparse.Namespace, ros_arguments: list[str]) -> int:
    from rrr_traj_planner.nodes.parameters.configuration_files import found_file
    from rrr_traj_planner.nodes.parameters.planner_config import planner_config
    from rrr_traj_planner.nodes.parameters.ros_arguments import describes_an_arm
    from rrr_traj_planner.nodes.point_files.reading import read_task
    from rrr_traj_planner.nodes.point_files.task import given
    from rrr_traj_planner.planners.registry import planner_ids
    from rrr_traj_planner.planners.request import PlanningRequest
    from rrr_traj_planner.report.attempts import attempts, planned, Task
    from rrr_traj_planner.report.excitation import vibration_text
    from rrr_traj_planner.report.plan_report import write_plan_report

    file = read_task(options.plan)
    limits = options.joint_limits and found_file(options.joint_limits, Path.cwd())
    arm = None if describes_an_arm(ros_arguments) else file.arm
    config = planner_config(arm, limits, ros_arguments)
    file.check_frame(config.base_frame)
    joints = file.joint_via_points(config.model.joint_names)
    request = PlanningRequest(
        file.via_points if joints is None else None, joint_via_points=joints,
        stop_at=given(file.stop_at), dwell=given(file.dwell),
        segment_durations=given(file.segment_durations),
        sample_period=config.sample_period, max_deviation=config.max_deviation,
        max_tip_speed=config.max_tip_speed or float('inf'), steady_zones=config.steady_zones,
        half_transition=config.half_transition, least_jerk_rise=config.least_jerk_rise)
    ids = options.planner or [file.planner_id or config.default_planner_id]
    print('planning and drawing ...', flush=True)
    ids = planner_ids() if 'all' in ids else ids
    found = attempts(Task(file.name, config.model, config.limits_for(*ids), request), ids)
    for of in planned(found):
        trajectory = of.plan.trajectory
        print(f'{of.planner_id}: {trajectory.duration:.3f} s, '
              f'{vibration_text(trajectory, of.moving_knots)}', flush=True)
    name = file.name.encode()[:MAX_NAME].decode(errors='ignore')
    page = write_plan_report(options.output or Path(f'report_{name}'), found)
    print(f'page: {page}')
    refused = [a for a in found if a.plan is None]
    for attempt in refused:
        print(f'report: planner {attempt.planner_id} refuses: {attempt.refusal}', file=sys.stderr)
    return 1 if refused else 0


if __name__ == '__main__':
    raise SystemExit(main())
