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

"""The tree of a URDF's links: paths through it, and what is no tree."""

from __future__ import annotations

from helpers.urdf_texts import arm, joint, link, robot
import pytest
from rrr_traj_planner.core.arm.urdf_document import read_document
from rrr_traj_planner.core.arm.urdf_tree import LinkTree
from rrr_traj_planner.core.errors import InvalidInputError


def tree_of(text):
    return LinkTree(read_document(text))


def path(text, base='', tip=''):
    return [found.name for found in tree_of(text).path(base, tip)]


def fixed(*pairs):
    """Return joints that fix second links to first ones, by letters."""
    return [joint(f'{a}-{b}', 'fixed', a, b) for a, b in pairs]


def links(names):
    return [link(name) for name in names]


def test_paths_are_from_the_base_to_the_tip():
    text = robot(*links('dcbae'), *fixed('bc', 'ab', 'cd', 'be'))
    assert path(text, '', 'd') == ['a-b', 'b-c', 'c-d']
    assert path(text, 'b', 'e') == ['b-e']
    assert path(text, 'c') == ['c-d']
    assert path(text, 'b', 'b') == []


def test_default_ends_are_base_link_and_tip_else_the_root_and_the_only_leaf():
    text = robot(*(link(name) for name in ('w', 'base_link', 'arm', 'tip', 'x')),
                 *(joint(f'{a}-{b}', 'fixed', a, b) for a, b in (
                     ('w', 'base_link'), ('base_link', 'arm'), ('base_link', 'tip'),
                     ('arm', 'x'))))
    assert path(text) == ['base_link-tip']
    assert path(text, 'w') == ['w-base_link', 'base_link-tip']
    assert path(text, 'arm') == ['arm-x']  # the link tip is not below it
    assert path(text.replace('base_link', 'foot'), '', 'arm') == ['w-foot', 'foot-arm']


def test_subtrees_see_parents_before_children():
    text = robot(*links('abcdef'), *fixed('ce', 'ab', 'ac', 'cd', 'df'))
    assert [found.name for found in tree_of(text).subtree('a')] == [
        'a-b', 'a-c', 'c-e', 'c-d', 'd-f']


def test_a_long_chain_is_no_problem():
    names = [f'l{i}' for i in range(3000)]
    assert len(path(robot(*links(names), *fixed(*zip(names, names[1:]))))) == 2999


@pytest.mark.parametrize(('base', 'tip', 'message'), [
    ('bse', 'tip', "no link 'bse' for the base, the nearest name is 'base'"),
    ('base', 'tool', "no link 'tool' for the tip, the nearest name is 'tip'"),
    ('b', 'a', "the tip, link 'a', is not below the base, link 'b'"),
    ('tip', '', "the tip frame is not given, and the tree below link 'tip' has no links")])
def test_paths_that_are_not_there_are_refused(base, tip, message):
    with pytest.raises(InvalidInputError) as error:
        path(arm(), base, tip)
    assert str(error.value) == message


@pytest.mark.parametrize(('parts', 'message'), [
    ([], 'there is no link'),
    (links('aa'), "several links have the name 'a'"),
    ([*links('abc'), *fixed('ab'), *fixed('ab')], "several joints have the name 'a-b'"),
    ([*links('ab'), *fixed('ax')], "joint 'a-x': its child, link 'x', is not there"),
    ([*links('ab'), *fixed('xa')], "joint 'x-a': its parent, link 'x', is not there"),
    ([*links('abc'), *fixed('ac', 'bc')],
     "link 'c' has 2 parents, through joints 'a-c', 'b-c': must be a tree"),
    (links('ab'), "links 'a', 'b' have no parent: must be one root"),
    (links('abcdefghijklmn'), "links 'a', 'b', 'c', 'd', 'e', 'f', 'g', 'h', 'i', 'j', 'k', 'l' "
     'and 2 more have no parent: must be one root'),
    ([*links('ab'), *fixed('ab', 'ba')],
     "links 'a', 'b' are in a loop, or below one: must be a tree"),
    ([*links('rabc'), *fixed('ab', 'ba', 'bc')],
     "links 'a', 'b', 'c' are in a loop, or below one: must be a tree")])
def test_what_is_no_tree_is_refused(parts, message):
    with pytest.raises(InvalidInputError) as error:
        tree_of(robot(*parts))
    assert str(error.value) == message
