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

"""Via-point files, and the search path of configuration files."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rrr_traj_planner.core.arrays import Array, finite_array
from rrr_traj_planner.core.errors import InvalidInputError, shown
from rrr_traj_planner.nodes.parameters.point_tables import (
    check_number,
    listed_points,
    tabulated_points,
)
from rrr_traj_planner.nodes.parameters.yaml_loader import input_error, Loader
import yaml

SOURCE_FOLDER = Path(__file__).resolve().parents[3] / 'config'  # of the source tree
SHIPPED = ('.yaml', '.urdf')  # kinds of the package's own files
FIELDS = ('planner_id', 'via_points', 'segment_durations', 'arm')
NEEDED = 'must have via_points: [[x, y, z], ...] in m'


@dataclass(frozen=True, eq=False)
class Task:
    """
    A via-point file.

    Attributes
    ----------
    name : str
        The file's name without its suffix.
    via_points : ndarray, shape (n, 3)
        Tip positions [m].
    arm : Path
        The parameter file of the arm.
    planner_id : str
        Empty: the planner node's default.
    segment_durations : ndarray
        Time for each segment [s]; empty: as fast as the limits allow.

    """

    name: str
    via_points: Array
    arm: Path
    planner_id: str
    segment_durations: Array


def read_task(file: str) -> Task:
    """
    Read a via-point file: YAML, or comma-separated values if its suffix is .csv.

    Parameters
    ----------
    file : str
        A path, or the name of a file in the package's config/ or config/arms/.

    Returns
    -------
    Task
        The content, checked.

    Raises
    ------
    InvalidInputError
        If the file is missing or malformed; names the file, the line if known, and what is wrong.

    """
    path = found_file(file, Path.cwd())
    try:
        text = path.read_text(encoding='utf-8-sig')
        content, lines = _table(text) if path.suffix.lower() == '.csv' else _document(text)
        return Task(
            name=path.stem, via_points=listed_points(content['via_points'], lines),
            arm=found_file(_text(content, 'arm') or 'thesis_arm.yaml', path.parent),
            planner_id=_text(content, 'planner_id'),
            segment_durations=_durations(content.get('segment_durations')))
    except (OSError, UnicodeDecodeError, InvalidInputError) as error:
        raise InvalidInputError(f'{path}: {" ".join(str(error).split())}') from None


def _table(text: str) -> tuple[dict[str, Any], list[int]]:
    """Return the content of a CSV file in the form of `_document`, without line numbers."""
    points = tabulated_points(text).tolist()
    if not points:
        raise InvalidInputError('no via_points, must have a line x, y, z [m] for each')
    return {'via_points': points}, []


def _document(text: str) -> tuple[dict[str, Any], list[int]]:
    """Return the content of a YAML file, and the line number of each via point."""
    try:
        loader = Loader(text)
        root = loader.get_single_node()
        content = None if root is None else loader.construct_document(root)
    except yaml.YAMLError as error:
        raise input_error(error) from None
    if not isinstance(content, dict):
        raise InvalidInputError(
            f'no via_points, it {"is empty" if content is None else "has no fields"}: {NEEDED}')
    if 'via_points' not in content:
        raise InvalidInputError(
            f'no via_points, its fields are {", ".join(map(shown, content))}: {NEEDED}')
    _check_keys(root)
    points = next(value for key, value in root.value if key.value == 'via_points')
    if content['via_points'] in (None, []):
        raise InvalidInputError(
            f'line {points.start_mark.line + 1}: no via_points, the list is empty: {NEEDED}')
    return content, [item.start_mark.line + 1 for item in points.value
                     if isinstance(item, yaml.Node)]


def _check_keys(root: yaml.MappingNode) -> None:
    """Refuse unknown and repeated keys: YAML would silently take the last one."""
    lines: dict[str, int] = {}
    for key, _ in root.value:
        name, line = str(key.value), key.start_mark.line + 1
        if name not in FIELDS:
            raise InvalidInputError(
                f'line {line}: unknown {name}; known are {", ".join(FIELDS)}')
        if name in lines:
            raise InvalidInputError(
                f'line {line}: {name} is repeated (first in line {lines[name]})')
        lines[name] = line


def found_file(name: str, folder: Path) -> Path:
    """
    Return the path of a file: given, or one of the package's.

    Parameters
    ----------
    name : str
        A path, absolute or relative to the folder, or the name of a file in the package's config/
        or config/arms/.
    folder : Path
        The folder that relative paths refer to.

    Returns
    -------
    Path
        An existing file.

    Raises
    ------
    InvalidInputError
        If there is no such file.

    """
    shipped = (shipped_folder(), shipped_folder() / 'arms')
    for path in (folder / name, *(place / name for place in shipped)):
        if path.is_file():
            return path.resolve()
        if path.is_dir():
            raise InvalidInputError(f"'{name}' is a folder, must be a file")
    ending = Path(name).suffix if Path(name).suffix in SHIPPED else SHIPPED[0]
    names = ', '.join(sorted(p.name for place in shipped for p in place.glob(f'*{ending}')))
    raise InvalidInputError(f"no file '{name}' in {folder}, nor among the package's: {names}")


def _text(content: dict[str, Any], field: str) -> str:
    value = content.get(field)
    if value is not None and not isinstance(value, str):
        raise InvalidInputError(f'{field} is {shown(value)}, must be a text')
    return value or ''


def _durations(value: Any) -> Array:
    if isinstance(value, list):
        for i, seconds in enumerate(value):
            check_number(f'segment_durations[{i}]', seconds)
    return finite_array('segment_durations', [] if value is None else value, (-1,))


def shipped_folder() -> Path:
    """
    Return the folder of the package's own configuration files.

    Returns
    -------
    Path
        share/rrr_traj_planner/config of the installed package; config/ of the source tree where
        the package is not installed or ROS is missing.

    """
    try:
        from ament_index_python.packages import get_package_share_path, PackageNotFoundError
    except ImportError:
        return SOURCE_FOLDER
    try:
        return Path(get_package_share_path('rrr_traj_planner')) / 'config'
    except PackageNotFoundError:
        return SOURCE_FOLDER
