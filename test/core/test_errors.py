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

"""Errors: what their messages may hold."""

from __future__ import annotations

import numpy as np
import pytest
from rrr_traj_planner.core.errors import counted, did_you_mean, format_distinct, quoted


@pytest.mark.parametrize(('text', 'shown'), [
    ('cycloid', "'cycloid'"), ('', "''"), ('a\nb', r"'a\nb'"), ('\x1b[2J', r"'\x1b[2J'")])
def test_text_from_outside_is_quoted_on_one_line(text, shown):
    assert quoted(text) == shown


def test_long_text_loses_its_middle():
    shown = quoted('begin' + 'x' * 10 ** 6 + 'end')
    assert len(shown) <= 60
    assert shown.startswith("'begin") and '...' in shown and shown.endswith("end'")


@pytest.mark.parametrize('bound', [1.5707963267948966, 0.0, 1.6, -np.pi, 200.0, 1e-9, 12345.678])
def test_a_value_just_beyond_its_bound_reads_as_beyond_it(bound):
    rng = np.random.default_rng(3)
    for exponent in range(-14, -2):
        miss = rng.uniform(1.0, 9.9) * 10.0 ** exponent
        for value in (bound + miss, bound - miss):
            shown, limit, other = format_distinct(value, bound, 7.0)
            if value == bound:  # too small a miss for a float
                continue
            assert (float(shown) > float(limit)) == (value > bound)
            assert shown != limit
            assert float(shown) == pytest.approx(value, rel=1e-5)
            assert float(limit) == pytest.approx(bound, rel=1e-5)
            assert other == '7'


def test_digits_are_few_where_few_suffice_or_there_is_nothing_to_tell():
    assert format_distinct(1.7, 0.0, np.pi / 2) == ('1.7', '0', '1.5708')
    assert format_distinct(218.93, 200.0, digits=4) == ('218.9', '200')
    assert format_distinct(1.0, 1.0, 1.0000001) == ('1', '1', '1.0000001')
    assert format_distinct(1.0, 1.0) == ('1', '1')
    assert format_distinct(np.nan, 0.1, np.inf) == ('nan', '0.1', 'inf')


@pytest.mark.parametrize(('count', 'nouns', 'text'), [
    (0, ('point',), '0 points'), (1, ('point',), '1 point'), (2, ('point',), '2 points'),
    (1, ('velocity', 'velocities'), '1 velocity'),
    (3, ('velocity', 'velocities'), '3 velocities')])
def test_what_is_counted_is_in_the_singular_where_it_is_one(count, nouns, text):
    assert counted(count, *nouns) == text


def test_what_may_have_been_meant_is_asked():
    assert did_you_mean() == ''
    assert did_you_mean('dwell') == 'did you mean "dwell"?'
    assert did_you_mean('a.x', 'b.x', 'c.x') == 'did you mean "a.x" or "b.x" or "c.x"?'
    assert did_you_mean('elbow', by='elbo') == 'did you mean "elbow" by "elbo"?'
