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

"""The search path of configuration files."""

from __future__ import annotations

from difflib import get_close_matches
from pathlib import Path

from rrr_traj_planner.core.errors import did_you_mean, InvalidInputError

SOURCE_FOLDER = Path(__file__).resolve().parents[3] / 'config'  # of the source tree
SHIPPED = ('.yaml', '.urdf')  # kinds of the package's own files


def found_file(name: str, *folders: Path) -> Path:
    """
    Return the path of a file: given, or one of the package's.

    Parameters
    ----------
    name : str
        A path, absolute or relative to one of the folders, or the name of a file in the package's
        config/ or config/arms/.
    *folders : Path
        The folders that relative paths refer to, the first one first.

    Returns
    -------
    Path
        An existing file.

    Raises
    ------
    InvalidInputError
        If there is no such file; the message names similar ones.

    """
    shipped = (shipped_folder(), shipped_folder() / 'arms')
    for path in (place / name for place in (*folders, *shipped)):
        if path.is_file():
            return path.resolve()
        if path.is_dir():
            raise InvalidInputError(f"'{name}' is a folder, must be a file")
    ending = Path(name).suffix if Path(name).suffix in SHIPPED else SHIPPED[0]
    names = sorted(p.name for place in shipped for p in place.glob(f'*{ending}'))
    near = [f'{stem}{ending}' for stem in get_close_matches(
        Path(name).stem, [Path(n).stem for n in names])]
    places = ' and '.join(dict.fromkeys(map(str, folders)))
    raise InvalidInputError(f"no file '{name}' in {places}, nor among the package's"
                            + (f'; {did_you_mean(*near)}' if near else ''))


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
