# The Python package, beside libdvi. See libdvi/package.py for the commands, and then:
#   spack dev-build py-dvi@0.1.0
from spack_repo.builtin.build_systems.python import PythonPackage

from spack.package import *


class PyDvi(PythonPackage):
    """Discrete variational integrators from Python, with runs as numpy arrays."""

    license("BSD-3-Clause")

    version("0.1.0")

    depends_on("c", type="build")
    depends_on("pkgconfig", type="build")
    depends_on("libdvi@0.1.0", type=("build", "link", "run"))
    depends_on("python@3.9:", type=("build", "link", "run"))
    depends_on("py-setuptools@61:", type="build")
    depends_on("py-wheel", type="build")
    depends_on("py-cffi@1.15:", type=("build", "run"))
    depends_on("py-numpy@1.21:", type=("build", "run"))

    build_directory = "python"
