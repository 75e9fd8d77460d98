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

"""Installs the package; its version stands in package.xml alone."""

from glob import glob
from xml.etree import ElementTree

from setuptools import Extension, find_packages, setup

NAME = 'rrr_traj_planner'
NATIVE = f'{NAME}/planners/native'

# Without a compiler the package works too: planners/compiled.py says how.
CHAIN = Extension(
    f'{NATIVE}/chain'.replace('/', '.'), sorted(glob(f'{NATIVE}/*.c')),
    depends=sorted(glob(f'{NATIVE}/*.h') + glob(f'{NATIVE}/*.inc')),
    extra_compile_args=['-std=c99', '-O3', '-fno-math-errno', '-fno-trapping-math',
                        '-fvisibility=hidden'], optional=True)

setup(
    name=NAME,
    version=ElementTree.parse('package.xml').findtext('version'),
    description='Trajectory planning for a three-joint (RRR) robot arm, on ROS 2',
    maintainer='rrr_traj_planner developers',
    maintainer_email='rrr-traj-planner@users.noreply.github.com',
    license='Apache-2.0',
    packages=find_packages(include=[NAME, f'{NAME}.*']),
    package_data={f'{NAME}.report': ['*.css', '*.js']},
    ext_modules=[CHAIN],
    data_files=[
        ('share/ament_index/resource_index/packages', [f'resource/{NAME}']),
        (f'share/{NAME}', ['package.xml']),
        (f'share/{NAME}/config', sorted(glob('config/*.yaml'))),
    ],
    python_requires='>=3.10',
    install_requires=['numpy', 'PyYAML', 'scipy', 'setuptools'],
    extras_require={'figures': ['matplotlib'], 'record': ['mcap'], 'test': ['pytest']},
    zip_safe=True,
    entry_points={
        'console_scripts': [
            f'{script} = {NAME}.nodes.{script}:main'
            for script in ('bringup', 'demo', 'planner', 'report', 'simulated_arm')
        ],
    },
)
