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
from subprocess import DEVNULL, run
from xml.etree import ElementTree

from setuptools import Extension, find_packages, setup
from setuptools.command.build_ext import build_ext
from setuptools.command.develop import develop
from setuptools.command.install_scripts import install_scripts
from setuptools.errors import BaseError, CCompilerError

NAME = 'rrr_traj_planner'
NATIVE = [f'{NAME}/core/native', f'{NAME}/planners/native']

KERNELS = Extension(
    f'{NATIVE[0]}/kernels'.replace('/', '.'),
    [path for folder in NATIVE for path in sorted(glob(f'{folder}/*.c'))], include_dirs=NATIVE,
    depends=[path for folder in NATIVE for path in sorted(glob(f'{folder}/*.[hi]*'))],
    extra_compile_args=['-std=c99', '-O3', '-fno-math-errno', '-fno-trapping-math',
                        '-fvisibility=hidden',
                        '-Wno-psabi'])  # functions that return vectors are inlined


class BuildKernels(build_ext):
    """Builds the kernels, which the planners need, or says in one line what is missing."""

    def build_extension(self, extension):
        """Compile and link."""
        try:
            super().build_extension(extension)
        except (BaseError, CCompilerError) as error:
            raise SystemExit(f'{NAME} needs a C compiler that builds its kernels, '
                             f'{" and ".join(NATIVE)}: {error}') from None


# SIGINT and SIGTERM wait until a script can answer them (nodes/process/signals.py): Python's
# own start loses them, or shows a traceback.
BLOCKED = ['/usr/bin/env', '--block-signal=INT,TERM']
LONGEST = 255  # characters of a script's first line that the kernel reads


class SignalsBlocked:
    """Writes scripts that start Python with both signals blocked, where env can do that."""

    def write_script(self, name, contents, *rest):
        """Write a script, its first line replaced."""
        first, _, others = contents.partition('\n')
        command, options = BLOCKED
        line = f'#!{command} -S {options} {first[2:]}'
        if len(line) < LONGEST and can_block_signals():
            contents = f'{line}\n{others}'
        super().write_script(name, contents, *rest)


def can_block_signals():
    """Return whether this machine's env has the option, as that of coreutils since 8.31."""
    try:
        return not run([*BLOCKED, 'true'], stdout=DEVNULL, stderr=DEVNULL).returncode
    except OSError:
        return False


class Develop(SignalsBlocked, develop):
    """Installs links, with such scripts."""


class InstallScripts(SignalsBlocked, install_scripts):
    """Installs such scripts."""


setup(
    name=NAME,
    version=ElementTree.parse('package.xml').findtext('version'),
    description='Trajectory planning for a three-joint (RRR) robot arm, on ROS 2',
    maintainer='rrr_traj_planner developers',
    maintainer_email='rrr-traj-planner@users.noreply.github.com',
    license='Apache-2.0',
    packages=find_packages(include=[NAME, f'{NAME}.*']),
    package_data={f'{NAME}.report': ['*.css', '*.js'], f'{NAME}.nodes.studio.panel': ['*.js']},
    ext_modules=[KERNELS],
    cmdclass={'build_ext': BuildKernels, 'develop': Develop, 'install_scripts': InstallScripts},
    data_files=[
        ('share/ament_index/resource_index/packages', [f'resource/{NAME}']),
        (f'share/{NAME}', ['package.xml']),
        (f'share/{NAME}/config', sorted(glob('config/*.yaml'))),
        (f'share/{NAME}/config/arms', sorted(glob('config/arms/*'))),
    ],
    python_requires='>=3.10',
    # urdf_parser_py, which reads URDFs, is urdfdom_py to ROS (package.xml) and urdf-parser-py to
    # PyPI: here, it would be installed twice beside ROS's
    install_requires=['numpy', 'PyYAML', 'scipy', 'setuptools'],
    extras_require={'figures': ['matplotlib'], 'record': ['mcap'],
                    'studio': ['viser', 'pycollada'], 'test': ['pytest'],
                    'urdf': ['urdf-parser-py']},
    zip_safe=False,
    entry_points={
        'console_scripts': [
            f'{script} = {NAME}.nodes.scripts.{script}:main'
            for script in (
                'bringup', 'demo', 'motion_server', 'move', 'planner', 'report', 'simulated_arm',
                'studio')
        ],
    },
)
