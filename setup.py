# Copyright 2026 the dynsim_ros authors
# SPDX-License-Identifier: Apache-2.0
from pathlib import Path
import re

from setuptools import find_packages, setup

NAME = 'dynsim_ros'
SHARE = f'share/{NAME}'
MATPLOTLIB = 'matplotlib>=3.6,<4'


def version():
    """Read the version where it is kept, without importing the package."""
    text = Path(NAME, '__init__.py').read_text(encoding='utf-8')
    return re.search(r"^__version__ = '([^']+)'$", text, re.MULTILINE).group(1)


def files(folder):
    """List the files in a folder that are installed to share/dynsim_ros/<folder>."""
    return (f'{SHARE}/{folder}', sorted(
        path.as_posix() for path in Path(folder).glob('*') if path.is_file()))


setup(
    name=NAME,
    version=version(),
    description='Rigid bodies on springs, simulated live on ROS 2 or offline',
    author='the dynsim_ros authors',
    maintainer='the dynsim_ros authors',
    maintainer_email='dynsim_ros@users.noreply.github.com',
    license='Apache-2.0',
    packages=find_packages(exclude=['test', 'test.*']),
    package_data={NAME: ['messages/shipped/share/*/msg/*']},
    data_files=[
        ('share/ament_index/resource_index/packages', [f'resource/{NAME}']),
        (SHARE, ['package.xml']),
        files('config'),
        files('examples'),
        files('launch'),
        files('scenes'),
    ],
    zip_safe=False,
    python_requires='>=3.10',
    # ROS itself is no requirement: a sourced installation brings it, else the extra 'ros'.
    install_requires=[
        'PyYAML>=5.4,<7',
        # Quicker checksums of bags, where it is compiled.
        'isal>=1,<2; platform_machine == "x86_64" or platform_machine == "aarch64"',
        'lz4>=3,<5',
        'mcap>=1.5,<2',
        'numba>=0.59,<1',
        'numpy>=1.23,<3',
        'zstandard>=0.17,<1',
    ],
    extras_require={
        'ros': [
            'ros-jazzy-common-interfaces>=5.3,<5.4',
            'ros-jazzy-rclpy[fastrtps]>=7.1,<7.2',
        ],
        'plot': [MATPLOTLIB],
        'bench': [MATPLOTLIB, 'scipy>=1.9,<2'],
        'view': ['viser>=1.1,<2'],
        # What the benchmarks compare with: tools/set_up installs each of them if it can be had.
        'peers': [
            'drake>=1.20,<2',
            'heyoka>=5,<8',
            'mujoco>=3,<5',
            'numbalsoda>=0.3,<1',
            'pybullet>=3.2,<4',
        ],
        'test': [
            'axe-playwright-python>=0.1.4,<1',
            'catkin_pkg>=1,<2',
            'colcon-common-extensions>=0.3,<1',
            'flake8>=6,<8',
            'flake8-builtins>=2,<4',
            'flake8-comprehensions>=3,<4',
            'flake8-docstrings>=1.6,<2',
            'flake8-import-order>=0.18,<1',
            'flake8-quotes>=3.3,<4',
            MATPLOTLIB,
            'mcap-ros2-support>=0.5,<1',
            'mpmath>=1.2,<2',
            'pandas>=2,<4',
            'playwright>=1.40,<2',
            'pytest>=7.4,<9',
            'pytest-timeout>=2.1,<3',
            'pytest-xdist>=3,<4',
            'rosbags>=0.10,<1',
            'ruff>=0.11,<1',
            'scipy>=1.9,<2',
            'setuptools>=70.1,<80',
        ],
    },
    entry_points={
        'console_scripts': [
            f'export = {NAME}.cli.export:main',
            f'plot = {NAME}.cli.plot:main',
            f'recover = {NAME}.cli.recover:main',
            f'replay = {NAME}.cli.replay:main',
            f'rerun = {NAME}.cli.rerun:main',
            f'sim_node = {NAME}.cli.sim_node:main',
            f'simulate = {NAME}.cli.simulate:main',
            f'view = {NAME}.cli.view:main',
        ],
    },
)
