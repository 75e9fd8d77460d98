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

"""Checked arrays: what is accepted, what is refused, and that nobody can write to them."""

import re

import numpy as np
import pytest
from rrr_traj_planner.core.arrays import bound_array, finite_array, joint_values
from rrr_traj_planner.core.errors import InvalidInputError, RrrPlannerError


@pytest.mark.parametrize('checked', [finite_array, bound_array])
def test_array_is_a_read_only_float_copy(checked):
    source = np.array([1, 2, 3])
    array = checked('x', source, (3,))
    source[0] = 7
    assert array.dtype == float
    assert array.tolist() == [1.0, 2.0, 3.0]
    with pytest.raises(ValueError, match='read-only'):
        array[0] = 5.0


@pytest.mark.parametrize('checked', [finite_array, bound_array])
@pytest.mark.parametrize(('value', 'shape', 'text'), [
    ([1.0, 2.0], (3,), r'^x has shape \(2,\), must have \(3\)$'),
    ([1.0], (2, 2), r'^x has shape \(1,\), must have \(2, 2\)$'),
    ([[1.0, 2.0]], (-1, 3), r'^x has shape \(1, 2\), must have \(n, 3\)$'),
    ([[1.0]], (-1,), r'^x has shape \(1, 1\), must have \(n\)$'),
    (1.0, (1,), r'^x has shape \(\), must have \(1\)$'),
])
def test_wrong_shape_is_refused_with_both_shapes(checked, value, shape, text):
    with pytest.raises(InvalidInputError, match=text):
        checked('x', value, shape)


@pytest.mark.parametrize('checked', [finite_array, bound_array])
@pytest.mark.parametrize('value', ['left', [1.0, 'left'], [[1.0], [1.0, 2.0]], None, {}, [1j]])
def test_what_is_no_array_of_numbers_is_refused(checked, value):
    with pytest.raises(InvalidInputError, match=r'^x(\[\d\])? (is .+, must be|has rows of)'):
        checked('x', value)


def test_length_of_any_size_fits_minus_one():
    assert finite_array('x', np.zeros((5, 3)), (-1, 3)).shape == (5, 3)
    assert finite_array('x', np.zeros((0, 3)), (-1, 3)).shape == (0, 3)


def test_any_shape_is_accepted_where_none_is_required():
    assert finite_array('x', 2).shape == ()
    assert finite_array('x', [[1], [2]]).shape == (2, 1)


@pytest.mark.parametrize(('value', 'text'), [
    (np.nan, r'^x is nan, must be finite$'),
    ([1.0, np.inf], r'^x\[1\] is inf, must be finite$'),
    ([[1.0, 2.0], [-np.inf, np.nan]], r'^x\[1\]\[0\] is -inf, must be finite$'),
])
def test_first_value_that_is_not_finite_is_named(value, text):
    with pytest.raises(InvalidInputError, match=text):
        finite_array('x', value)


def test_bounds_may_be_infinite_but_not_nan():
    assert bound_array('x', [np.inf, -np.inf]).tolist() == [np.inf, -np.inf]
    with pytest.raises(InvalidInputError, match=r'^x\[1\] is nan, must be a number$'):
        bound_array('x', [np.inf, np.nan])


@pytest.mark.parametrize('shape', [(3,), (5, 3), (2, 5, 3), (0, 3)])
def test_joint_values_have_any_leading_axes(shape):
    assert joint_values('q', np.ones(shape)).shape == shape


@pytest.mark.parametrize('value', [1.0, [1.0, 2.0], np.zeros((3, 2))])
def test_joint_values_need_three_joints_on_the_last_axis(value):
    text = re.escape(f'q has shape {np.shape(value)}, must have (..., 3)')
    with pytest.raises(InvalidInputError, match=f'^{text}$'):
        joint_values('q', value)


def test_a_caller_may_catch_invalid_input_as_value_error_or_as_the_package_s_error():
    assert issubclass(InvalidInputError, ValueError)
    assert issubclass(InvalidInputError, RrrPlannerError)
    assert InvalidInputError('text').via_point == -1
    assert InvalidInputError('text', via_point=4).via_point == 4
