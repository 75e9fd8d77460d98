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

"""URDFs made by hand and at random, of a few words each."""

from __future__ import annotations

from helpers.random_chains import random_inertia
import numpy as np


def robot(*parts):
    """Return a URDF."""
    return '\n'.join(('<robot name="arm">', *parts, '</robot>'))


def numbers(values):
    return ' '.join(repr(float(x)) for x in values)


def inertial(mass, moments=(0.1, 0.0, 0.0, 0.1, 0.0, 0.1), xyz=(0.0, 0.0, 0.0),
             rpy=(0.0, 0.0, 0.0)):
    values = ' '.join(f'{name}="{float(x)!r}"' for name, x in zip(
        ('ixx', 'ixy', 'ixz', 'iyy', 'iyz', 'izz'), moments))
    return (f'<inertial><origin xyz="{numbers(xyz)}" rpy="{numbers(rpy)}"/>'
            f'<mass value="{mass}"/><inertia {values}/></inertial>')


def texts(found):
    """Return the texts of an arm's, or a document's, warnings."""
    return tuple(warning.text for warning in found.warnings)


def link(name, inside=''):
    return f'<link name="{name}">{inside}</link>'


def joint(name, kind, parent, child, inside='', xyz=(0.0, 0.0, 0.0), rpy=(0.0, 0.0, 0.0)):
    return (f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
            f'<origin xyz="{numbers(xyz)}" rpy="{numbers(rpy)}"/>{inside}</joint>')


def axis(*xyz):
    return f'<axis xyz="{numbers(xyz)}"/>'


def limit(lower=-2.0, upper=2.0, velocity=3.0, effort=40.0):
    return f'<limit lower="{lower}" upper="{upper}" velocity="{velocity}" effort="{effort}"/>'


BODY = inertial(2.0, xyz=(0.1, 0.0, 0.2))
Z, Y = axis(0, 0, 1) + limit(), axis(0, 1, 0) + limit()

# An arm of few words, by the name of each part.
PARTS = {
    'base': link('base'), 'a': link('a', BODY), 'b': link('b', BODY), 'c': link('c', BODY),
    'tip': link('tip'), 'j1': joint('j1', 'revolute', 'base', 'a', Z, (0.0, 0.0, 0.3)),
    'j2': joint('j2', 'revolute', 'a', 'b', Y, (0.1, 0.0, 0.2)),
    'j3': joint('j3', 'revolute', 'b', 'c', Y, (0.5, 0.0, 0.0)),
    'end': joint('end', 'fixed', 'c', 'tip', '', (0.4, 0.0, 0.1))}


def arm(*more, **changed):
    """Return that arm with parts changed, and with more of them."""
    return robot(*{**PARTS, **changed}.values(), *more)


class RandomTree:
    """A random URDF: an arm of three joints with what may be before, beside and behind it."""

    def __init__(self, seed):
        """Grow the links before the base, the arm, and branches everywhere."""
        self.rng, self.parts, self.locked, self.count = np.random.default_rng(seed), [], {}, 0
        root = self.link()
        self.base = self.grown(root, self.rng.integers(0, 3))
        end, self.names = self.base, []
        for i in range(3):
            end = self.fixed(end)
            child = self.link()
            kind = self.rng.choice(('revolute', 'continuous'))
            self.names.append(self.joint(kind, end, child, f'arm {i}', ''))
            end = child
            self.grown(end, self.rng.integers(0, 3))
        self.tip = self.fixed(end, 1)
        self.grown(self.tip, self.rng.integers(0, 3))
        self.grown(root, 3)
        self.rng.shuffle(self.parts)
        self.text = robot(*self.parts)

    def link(self):
        """Add a link, most with a mass."""
        self.count += 1
        name = f'link {self.count}'
        mass = self.rng.uniform(0.1, 5.0)
        tensor = random_inertia(self.rng, mass)
        body = inertial(mass, tensor[np.triu_indices(3)], self.rng.normal(0.0, 0.2, 3),
                        self.rng.uniform(-3.0, 3.0, 3))
        self.parts.append(link(name, body if self.rng.random() < 0.8 else ''))
        return name

    def joint(self, kind, parent, child, name='', range_='lower="-1" upper="1"'):
        """Add a joint anywhere, with any axis that is not next to zero."""
        name = name or f'joint to {child}'
        inside = axis(*self.rng.normal(0.0, 1.0, 3))
        if kind in ('revolute', 'prismatic'):
            inside += f'<limit {range_} velocity="1" effort="1"/>'
        self.parts.append(joint(name, kind, parent, child, inside,
                                self.rng.uniform(-0.5, 0.5, 3), self.rng.uniform(-3.0, 3.0, 3)))
        return name

    def fixed(self, end, least=0):
        """Return the last of up to two links that are fixed to one."""
        for _ in range(self.rng.integers(least, 3)):
            child = self.link()
            self.joint('fixed', end, child)
            end = child
        return end

    def grown(self, end, length):
        """Return the last of links with joints of all kinds, locked at the nearest to zero."""
        for _ in range(length):
            child, kind = self.link(), self.rng.choice(('fixed', 'revolute', 'prismatic',
                                                        'continuous'))
            low = self.rng.uniform(-0.6, 0.2)
            high = low + 0.3
            name = self.joint(kind, end, child, '', f'lower="{low!r}" upper="{high!r}"')
            if kind != 'fixed':
                inside = kind != 'continuous'
                self.locked[name] = min(max(0.0, low), high) if inside else 0.0
            end = child
        return end
