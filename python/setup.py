"""The C part of the package is built by cffi."""
import pathlib
import re

from setuptools import setup

cmake = (pathlib.Path(__file__).resolve().parent.parent / "CMakeLists.txt").read_text()
setup(version=re.search(r"project\(\w+\s+VERSION\s+([\d.]+)", cmake).group(1),
      cffi_modules=["build_dvi.py:ffibuilder"])
