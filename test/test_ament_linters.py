"""ROS's own linters, where they are installed (`ament_lint_auto` and the like from apt)."""

from __future__ import annotations

from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]


def test_docstrings_are_as_ament_pep257_wants_them():
    main = pytest.importorskip('ament_pep257.main')
    # D401 takes properties for functions.
    assert main.main(argv=['--add-ignore', 'D401', '--', str(ROOT / 'rrr_traj_planner')]) == 0


def test_package_xml_is_as_ament_xmllint_wants_it():
    main = pytest.importorskip('ament_xmllint.main')
    assert main.main(argv=[str(ROOT / 'package.xml')]) == 0
