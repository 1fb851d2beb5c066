# A recipe for Spack. From the top of the tree, without a release to fetch:
#   spack repo create recipes && mkdir -p recipes/packages/libdvi
#   cp packaging/spack/package.py recipes/packages/libdvi/ && spack repo add recipes
#   spack dev-build libdvi@0.1.0
from spack.package import *


class Libdvi(CMakePackage):
    """Discrete variational integrators: mechanics by making a discrete action stationary."""

    license("BSD-3-Clause")

    version("0.1.0")

    depends_on("c", type="build")
    depends_on("cmake@3.22:", type="build")
    depends_on("pkgconfig", type="build")
    depends_on("sundials@6.4:7+klu+kinsol+ida+cvode+arkode~mpi")
    depends_on("suite-sparse")
    depends_on("arpack-ng+icb")
    depends_on("lapack")
    depends_on("libyaml")
    depends_on("check", type="test")

    def cmake_args(self):
        return [
            self.define("BUILD_TESTING", self.run_tests),
            self.define("DVI_PYTHON", False),
        ]
