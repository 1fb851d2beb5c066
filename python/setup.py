"""The C part of the package is built by cffi. The version is that of the library."""
import pathlib
import re

from setuptools import setup

header = pathlib.Path(__file__).resolve().parent.parent / "lib/include/dvi/version.h"
parts = re.findall(r"#define DVI_VERSION_(?:MAJOR|MINOR|PATCH) (\d+)", header.read_text())
# An object of the last build may have been built against another libdvi.
setup(version=".".join(parts), cffi_modules=["build_dvi.py:ffibuilder"],
      options={"build_ext": {"force": True}})
