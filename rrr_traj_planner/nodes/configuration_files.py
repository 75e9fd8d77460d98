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

"""Files of the package's config/ and of users: arms' parameters and via points."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rrr_traj_planner.core.arrays import Array, finite_array
from rrr_traj_planner.core.errors import InvalidInputError
import yaml

CHECKOUT = Path(__file__).resolve().parents[2] / 'config'
FIELDS = ('planner_id', 'via_points', 'segment_durations', 'arm')


@dataclass(frozen=True, eq=False)
class Task:
    """
    A via-point file.

    Attributes
    ----------
    name : str
        The file's, without its ending.
    via_points : ndarray, shape (n, 3)
        Tip positions [m].
    arm : Path
        The parameter file of the arm.
    planner_id : str
        Empty: the planner node's default.
    segment_durations : ndarray
        [s], empty: as fast as the limits allow.

    """

    name: str
    via_points: Array
    arm: Path
    planner_id: str
    segment_durations: Array


def read_task(file: str) -> Task:
    """
    Return what a via-point file says.

    Parameters
    ----------
    file : str
        A path, or the name of a file of the package's config/.

    Returns
    -------
    Task
        Checked.

    Raises
    ------
    InvalidInputError
        If the file is missing, no YAML, or malformed.

    """
    path = _found(file, Path.cwd())
    try:
        content = yaml.safe_load(path.read_text())
    except (OSError, UnicodeDecodeError, yaml.YAMLError) as error:
        raise InvalidInputError(f'{path}: {" ".join(str(error).split())}') from None
    if not isinstance(content, dict) or not content.get('via_points'):
        raise InvalidInputError(f'{path}: no via_points')
    unknown = sorted(set(map(str, content)) - set(FIELDS))
    if unknown:
        raise InvalidInputError(
            f'{path}: unknown {", ".join(unknown)}; known are {", ".join(FIELDS)}')
    try:
        return Task(
            name=path.stem, via_points=finite_array('via_points', content['via_points'], (-1, 3)),
            arm=arm_file(_text(content, 'arm') or 'thesis_arm.yaml', path.parent),
            planner_id=_text(content, 'planner_id'),
            segment_durations=_durations(content.get('segment_durations')))
    except InvalidInputError as error:
        raise InvalidInputError(f'{path}: {error}') from None


def arm_file(name: str, folder: Path) -> Path:
    """
    Return an arm's parameter file.

    Parameters
    ----------
    name : str
        A path, absolute or seen from a folder, or the name of a file of the package's config/.
    folder : Path
        That folder.

    Returns
    -------
    Path
        An existing file.

    Raises
    ------
    InvalidInputError
        If there is none.

    """
    return _found(name, folder)


def _text(content: dict[str, Any], field: str) -> str:
    value = content.get(field)
    if value is not None and not isinstance(value, str):
        raise InvalidInputError(f'{field} is {value!r}, must be a text')
    return value or ''


def _durations(value: Any) -> Array:
    return finite_array('segment_durations', [] if value is None else value, (-1,))


def _found(name: str, folder: Path) -> Path:
    for path in (folder / name, shipped_folder() / name):
        if path.is_file():
            return path.resolve()
    shipped = ', '.join(sorted(p.name for p in shipped_folder().glob('*.yaml')))
    raise InvalidInputError(f"no file '{name}' in {folder}, nor among the package's: {shipped}")


def shipped_folder() -> Path:
    """
    Return the folder of the package's own configuration files.

    Returns
    -------
    Path
        share/rrr_traj_planner/config where the package is installed, config/ in a checkout or
        without ROS.

    """
    try:
        from ament_index_python.packages import get_package_share_path, PackageNotFoundError
    except ImportError:
        return CHECKOUT
    try:
        return Path(get_package_share_path('rrr_traj_planner')) / 'config'
    except PackageNotFoundError:
        return CHECKOUT
