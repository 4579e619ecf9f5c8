"""Python modules of the package, for catkin_python_setup in CMakeLists.txt; not to be run by hand."""
from setuptools import setup

from catkin_pkg.python_setup import generate_distutils_setup

setup(**generate_distutils_setup(packages=["semantic_mht_slam", "semantic_mht_slam.object_relay"],
                                 package_dir={"": "src"}))
