"""Errors: what their messages may hold."""

from __future__ import annotations

import pytest
from rrr_traj_planner.core.errors import quoted


@pytest.mark.parametrize(('text', 'shown'), [
    ('cycloid', "'cycloid'"), ('', "''"), ('a\nb', r"'a\nb'"), ('\x1b[2J', r"'\x1b[2J'")])
def test_text_from_outside_is_quoted_on_one_line(text, shown):
    assert quoted(text) == shown


def test_long_text_loses_its_middle():
    shown = quoted('begin' + 'x' * 10 ** 6 + 'end')
    assert len(shown) <= 60
    assert shown.startswith("'begin") and '...' in shown and shown.endswith("end'")
