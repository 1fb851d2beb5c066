# A recipe for Spack from version 1.0 on, where variants of packages have the case that is written
# here. From the top of the tree, without a release to fetch:
#   spack repo create recipes dvi
#   cp -r packaging/spack/* recipes/spack_repo/dvi/packages/
#   spack repo add recipes/spack_repo/dvi
#   spack dev-build libdvi@0.1.0
from spack_repo.builtin.build_systems.cmake import CMakePackage

from spack.package import *


class Libdvi(CMakePackage):
    """Discrete variational integrators: mechanics by making a discrete action stationary."""

    license("BSD-3-Clause")

    version("0.1.0")

    depends_on("c", type="build")
    depends_on("cmake@3.22:", type="build")
    depends_on("gmake", type="build")
    depends_on("pkgconfig", type="build")
    depends_on("sundials@6.4:7+klu+KINSOL+IDA+CVODE+ARKODE~mpi")
    depends_on("suite-sparse")
    depends_on("arpack-ng+icb")
    depends_on("lapack")
    depends_on("libyaml")
    depends_on("hdf5@1.10.2:~mpi")
    depends_on("gnuplot", type="run")
    depends_on("check", type="test")
    depends_on("cxx", type="test")

    def cmake_args(self):
        return [
            self.define("BUILD_TESTING", self.run_tests),
            self.define("DVI_PYTHON", False),
        ]
