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

"""The tree of a URDF's links: the path from one to another, and the subtree of each."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from difflib import get_close_matches

from rrr_traj_planner.core.arm.urdf_document import Document, Joint
from rrr_traj_planner.core.errors import InvalidInputError, quoted

MAX_SHOWN = 12  # names in one message

# Names of the first and the last link of an arm, unless others are given.
BASE, TIP = 'base_link', 'tip'


class LinkTree:
    """
    Links joined to a tree.

    Parameters
    ----------
    document : Document
        Links and joints.

    Raises
    ------
    InvalidInputError
        If there is no link, a name repeats, a joint's link is not there, or the links are not one
        tree: two parents, two roots or a loop.

    """

    def __init__(self, document: Document) -> None:
        self.links = {link.name: link for link in document.links}
        self.joints = {joint.name: joint for joint in document.joints}
        self._check_names(document)
        self._parents = {joint.child: joint for joint in document.joints}
        self._children: dict[str, list[Joint]] = {name: [] for name in self.links}
        for joint in document.joints:
            self._children[joint.parent].append(joint)
        self._check_shape(document)
        self.root = next(name for name in self.links if name not in self._parents)

    def subtree(self, link: str) -> Iterator[Joint]:
        """
        Yield every joint below a link, parents before children.

        Parameters
        ----------
        link : str
            Its name.

        Yields
        ------
        Joint
            One after the other.

        """
        waiting = self._children[link][::-1]
        while waiting:
            joint = waiting.pop()
            yield joint
            waiting += self._children[joint.child][::-1]

    def path(self, base: str, tip: str) -> list[Joint]:
        """
        Return the joints from one link to another.

        Parameters
        ----------
        base : str
            Name of the first link; empty: base_link if there is such a link, else the root.
        tip : str
            Name of the last link, below the base; empty: tip if there is such a link below the
            base, else the only leaf below it.

        Returns
        -------
        list of Joint
            From the base to the tip.

        Raises
        ------
        InvalidInputError
            If there is no such link, the tip is not below the base, or is to be the only leaf
            where there are several.

        """
        base = base or (BASE if BASE in self.links else self.root)
        self._check_link('base', base)
        tip = tip or self._default_tip(base)
        self._check_link('tip', tip)
        joints, link = [], tip
        while link != base:
            if link not in self._parents:
                raise InvalidInputError(
                    f'the tip, link {quoted(tip)}, is not below the base, link {quoted(base)}')
            joints.append(self._parents[link])
            link = joints[-1].parent
        return joints[::-1]

    def _default_tip(self, base: str) -> str:
        below = [joint.child for joint in self.subtree(base)]
        leaves = [TIP] if TIP in below else [name for name in below if not self._children[name]]
        if len(leaves) != 1:
            found = f'several leaves: {_listed(leaves)}' if leaves else 'no links'
            raise InvalidInputError(
                f'the tip frame is not given, and the tree below link {quoted(base)} has {found}')
        return leaves[0]

    def _check_link(self, role: str, name: str) -> None:
        if name not in self.links:
            near, = get_close_matches(name, self.links, 1, 0.0)
            raise InvalidInputError(
                f'no link {quoted(name)} for the {role}, the nearest name is {quoted(near)}')

    def _check_names(self, document: Document) -> None:
        """Refuse names that repeat, and joints of links that are not there."""
        if not self.links:
            raise InvalidInputError('there is no link')
        for what, parts in (('links', document.links), ('joints', document.joints)):
            repeated = [name for name, n in Counter(part.name for part in parts).items() if n > 1]
            if repeated:
                raise InvalidInputError(f'several {what} have the name {_listed(repeated)}')
        for joint in document.joints:
            for role, link in (('parent', joint.parent), ('child', joint.child)):
                if link not in self.links:
                    raise InvalidInputError(f'{joint.label}: its {role}, link {quoted(link)}, is '
                                            'not there')

    def _check_shape(self, document: Document) -> None:
        """Refuse links that are no tree."""
        parents = Counter(joint.child for joint in document.joints)
        for child, count in parents.items():
            if count > 1:
                above = _listed(j.name for j in document.joints if j.child == child)
                raise InvalidInputError(
                    f'link {quoted(child)} has {count} parents, through joints {above}: must be '
                    'a tree')
        roots = [name for name in self.links if name not in parents]
        if len(roots) > 1:
            raise InvalidInputError(f'links {_listed(roots)} have no parent: must be one root')
        reached = {joint.child for root in roots for joint in self.subtree(root)}
        looped = self.links.keys() - reached - set(roots)
        if looped:
            loop = [name for name in self.links if name in looped]
            raise InvalidInputError(f'links {_listed(loop)} are in a loop, or below one: must '
                                    'be a tree')


def _listed(names: Iterable[str]) -> str:
    names = list(names)
    more = len(names) - MAX_SHOWN
    return ', '.join(map(quoted, names[:MAX_SHOWN])) + (f' and {more} more' if more > 0 else '')
