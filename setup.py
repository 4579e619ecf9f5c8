"""Python modules of the package, for catkin_python_setup in CMakeLists.txt; not to be run by hand."""
from setuptools import setup

from catkin_pkg.python_setup import generate_distutils_setup

PACKAGES = ["semantic_mht_slam", "semantic_mht_slam.benchmark", "semantic_mht_slam.fleet", "semantic_mht_slam.object_relay"]

setup(**generate_distutils_setup(packages=PACKAGES, package_dir={"": "src"},
                                 package_data={"semantic_mht_slam.benchmark": ["*.jinja"]}))
