"""Systems: what moves, by callbacks or by a Lagrangian of sympy."""
import numpy as np

from dvi import _sympy
from dvi._dvi import ffi, lib
from dvi._library import Owned, numbers, text, vector
from dvi.errors import check
from dvi.recording import record


class System:
    """A mechanical system L = v.M v/2 - V(t,q), or L(t,q,v), by callbacks.

    potential, gradient   V(t, q) -> float, V_q(t, q) -> array. A gradient that is left out is
                          differenced
    hessian, pattern      V_qq(t, q) -> array [n, n], or the entries of a sparse pattern of scipy
                          by columns. Left out, it is differenced
    forces                F(t, q, v) -> array, outside of the Lagrangian
    mass                  a number, a vector of diagonal entries, or a symmetric matrix (also of
                          scipy.sparse). Default: 1
    lagrangian            L(t, q, v) -> float in place of all of these
    names                 of the coordinates. Default: q1, q2, ..

    A callback is a function of Python, or the address of a function of C (a `cfunc` of numba, an
    int, a pointer of cffi or ctypes) with the signature of dvi/system.h. Those of C cost nothing.
    """

    def __init__(self, n=None, potential=None, gradient=None, mass=1.0, lagrangian=None,
                 names=None, autonomous=False, hessian=None, pattern=None, forces=None):
        if (potential is None) == (lagrangian is None):
            raise TypeError("a system needs either a potential or a lagrangian")
        n = len(names) if n is None and names is not None else n
        if n is None:
            raise TypeError("a system needs n, the number of its coordinates, or their names")
        self._keep = []
        self._failure = None
        terms = self._new("dvi_system_terms *")
        terms.dimension, terms.autonomous = n, autonomous
        if potential is not None:
            V = self._potential(n, potential, gradient)
            self._set_hessian(V, n, hessian, pattern)
            terms.potentials, terms.potential_count = V, 1
            self._set_mass(terms.mass, n, mass)
        else:
            terms.lagrangian = self._lagrangian(n, lagrangian)
        if forces is not None:
            terms.forces, terms.force_count = self._forces(n, forces), 1
        made = ffi.new("dvi_system **")
        check(lib.dvi_system_create(terms, made))
        self.owned = Owned("system", made[0])
        self._adopt(made[0], names or [f"q{i + 1}" for i in range(n)])

    @classmethod
    def of_lagrangian(cls, lagrangian, coordinates, time=None, **parameters):
        """Make a system of a Lagrangian of sympy.

        coordinates  functions x(t) of sympy, in the order of the state. L has their derivatives
        parameters   numbers for the other symbols of L, by their names
        """
        from dvi.scene import Scene
        return Scene.parse(_sympy.scene(lagrangian, coordinates, time, parameters))

    def _adopt(self, pointer, names, velocities=None, momenta=None):
        self.pointer = pointer
        self.nq, self.nv = lib.dvi_system_nq(pointer), lib.dvi_system_nv(pointer)
        self.coordinates = list(names)
        self.velocities = velocities or [f"v_{name}" for name in names]
        self.momenta = momenta or [f"p_{name}" for name in names]
        count = lib.dvi_system_invariant_count(pointer)
        self.invariants = [text(lib.dvi_system_invariant_name(pointer, i)) for i in range(count)]

    def _new(self, kind, *value):
        made = ffi.new(kind, *value)
        self._keep.append(made)
        return made

    def _callback(self, kind, function, wrap):
        """Return the pointer of a callback: an address as it is, a function of Python wrapped."""
        address = getattr(function, "address", function)
        if isinstance(address, int):
            return ffi.cast(kind, address)
        if isinstance(address, ffi.CData):
            return address
        if not callable(function):
            raise TypeError(f"a callback is a function or an address, not {function!r}")

        def guarded(*arguments):
            try:
                wrap(*arguments)
                return 0
            except BaseException as failure:  # it must not pass through C
                self._failure = failure
                return -1
        made = ffi.callback(kind, guarded, error=-1)
        self._keep.append(made)
        return made

    def _potential(self, n, value, gradient):
        def put_value(t, q, V, _):
            V[0] = value(t, _view(q, n))

        def put_gradient(t, q, V_q, _):
            _view(V_q, n)[:] = gradient(t, _view(q, n))
        kind = "int(*)(double, double *, double *, void *)"
        V = self._new("dvi_potential *")
        V.value = self._callback(kind, value, put_value)
        if gradient is not None:
            V.gradient = self._callback(kind, gradient, put_gradient)
        return V

    def _set_hessian(self, V, n, hessian, pattern):
        """Set the Hessian and its pattern, of all entries if none is given."""
        if pattern is not None or hessian is not None:
            self._set_pattern(V.qq, np.ones((n, n)) if pattern is None else pattern)
        if hessian is None:
            return
        entries = V.qq.start[n]

        def put_hessian(t, q, V_qq, _):
            made = np.asarray(hessian(t, _view(q, n)), dtype=float)
            _view(V_qq, entries)[:] = made.T.ravel() if made.ndim == 2 else made
        V.hessian = self._callback("int(*)(double, double *, double *, void *)", hessian,
                                   put_hessian)

    def _set_pattern(self, to, given):
        from scipy import sparse
        matrix = sparse.csc_matrix(given)
        matrix.sort_indices()
        to.start = self._new("int[]", matrix.indptr.tolist())
        to.row = self._new("int[]", matrix.indices.tolist())
        return matrix

    def _forces(self, n, value):
        def put_value(t, q, v, F, _):
            _view(F, n)[:] = value(t, _view(q, n), _view(v, n))
        force = self._new("dvi_force *")
        force.value = self._callback("int(*)(double, double *, double *, double *, void *)", value,
                                     put_value)
        return force

    def _lagrangian(self, n, value):
        def put_value(t, q, v, L, _):
            L[0] = value(t, _view(q, n), _view(v, n))
        L = self._new("dvi_lagrangian *")
        L.value = self._callback("int(*)(double, double *, double *, double *, void *)", value,
                                 put_value)
        return L

    def _set_mass(self, mass, n, given):
        if hasattr(given, "tocsc") or np.ndim(given) == 2:
            self._set_sparse_mass(mass, given)
        elif np.ndim(given) == 0:
            mass.scalar = given
        else:
            mass.diagonal = self._numbers(vector(given, n, "mass"))

    def _set_sparse_mass(self, mass, given):
        matrix = self._set_pattern(mass.pattern, given)
        mass.values = self._numbers(np.array(matrix.data, dtype=float))

    def _numbers(self, array):
        self._keep.append(array)
        return numbers(array)

    def raise_failure(self):
        """Raise what a callback of Python has raised."""
        failure, self._failure = getattr(self, "_failure", None), None
        if failure is not None:
            raise failure

    def run(self, method, h, t_end, q=None, v=None, p=None, t=0.0, **options):
        """Run from a start q with v or p, and return the arrays of the run.

        options  every=1, times=None, parts=None, as of `dvi.recording.record`
        """
        from dvi.integrator import Integrator
        integrator = Integrator(self, method)
        integrator.start(q, v=v, p=p, t=t)
        return record(integrator, h, t_end, **options)

    def __repr__(self):
        return f"{type(self).__name__}({', '.join(self.coordinates)})"


def _view(pointer, n):
    return np.frombuffer(ffi.buffer(pointer, 8 * n), dtype=float)
