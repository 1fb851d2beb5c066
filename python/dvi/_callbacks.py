"""Functions of Python as callbacks of C, and the terms of a system made of them."""
from __future__ import annotations

import threading
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from dvi._dvi import ffi
from dvi._library import Array, encoded, numbers, vector

AT_POINT = "int(*)(double, double *, double *, void *)"
AT_STATE = "int(*)(double, double *, double *, double *, void *)"
PAGE = 4096  # no function lies on the first page


class Callbacks:
    """What C holds of Python: structs, arrays and callbacks, which live as long as `keep`.

    failures  by threads, where exceptions wait until the call of C has returned
    """

    def __init__(self, n: int, failures: dict[int, BaseException]) -> None:
        self.n, self.failures = n, failures
        self.keep: list[Any] = []

    def new(self, kind: str, *value: Any) -> Any:
        """Return a new object of C that is kept."""
        made = ffi.new(kind, *value)
        self.keep.append(made)
        return made

    def function(self, kind: str, given: Any, wrap: Callable[..., None]) -> Any:
        """Return the pointer of a callback: an address as it is, a function of Python wrapped."""
        address = getattr(given, "address", given)
        if isinstance(address, int) and not isinstance(address, bool):
            if not PAGE <= address < 2**64:
                raise ValueError(f"{address} is no address of a function")
            return ffi.cast(kind, address)
        if isinstance(address, ffi.CData):
            if address == ffi.NULL:
                raise ValueError("NULL is no address of a function")
            return ffi.cast(kind, address)
        if not callable(given):
            raise TypeError(f"a callback is a function or an address, not {given!r}")
        failures = self.failures

        def guarded(*arguments: Any) -> int:
            try:
                wrap(*arguments)
                return 0
            except BaseException as failure:  # it must not pass through C
                failures[threading.get_ident()] = failure
                return -1
        made = ffi.callback(kind, guarded, error=-1)
        self.keep.append((made, given))
        return made

    def potential(self, value: Any, gradient: Any) -> Any:
        """Return a potential by its value, and its gradient if there is one."""
        n, V = self.n, self.new("dvi_potential *")

        def put_value(t: float, q: Any, V: Any, _: Any) -> None:
            V[0] = value(t, copy(q, n))

        def put_gradient(t: float, q: Any, V_q: Any, _: Any) -> None:
            fill(V_q, gradient(t, copy(q, n)), n, "gradient")
        V.value = self.function(AT_POINT, value, put_value)
        if gradient is not None:
            V.gradient = self.function(AT_POINT, gradient, put_gradient)
        return V

    def set_hessian(self, V: Any, hessian: Any, pattern: Any) -> None:
        """Set the Hessian and its pattern, of all entries if none is given."""
        n = self.n
        if pattern is None and hessian is None:
            return
        matrix = self.set_pattern(V.qq, np.ones((n, n)) if pattern is None else pattern, "pattern")
        if hessian is None:
            return
        row, column = matrix.indices, np.repeat(np.arange(n), np.diff(matrix.indptr))

        def put_hessian(t: float, q: Any, V_qq: Any, _: Any) -> None:
            made = hessian(t, copy(q, n))
            if np.shape(made) == (n, n):
                dense = made.toarray() if hasattr(made, "toarray") else np.asarray(made)
                made = dense[row, column]
            fill(V_qq, made, len(row), "hessian")
        V.hessian = self.function(AT_POINT, hessian, put_hessian)

    def set_pattern(self, to: Any, given: Any, name: str) -> Any:
        """Set a pattern [n, n], and return its sparse matrix."""
        from scipy import sparse
        matrix = sparse.csc_matrix(given)
        if matrix.shape != (self.n, self.n):
            raise ValueError(f"{name} has the shape {matrix.shape}; ({self.n}, {self.n}) is needed")
        matrix.sum_duplicates()
        matrix.sort_indices()
        to.start = self.new("int[]", matrix.indptr.tolist())
        to.row = self.new("int[]", matrix.indices.tolist())
        return matrix

    def forces(self, value: Any) -> Any:
        """Return forces outside of the Lagrangian."""
        n = self.n

        def put_value(t: float, q: Any, v: Any, F: Any, _: Any) -> None:
            fill(F, value(t, copy(q, n), copy(v, n)), n, "forces")
        force = self.new("dvi_force *")
        force.value = self.function(AT_STATE, value, put_value)
        return force

    def lagrangian(self, value: Any) -> Any:
        """Return a general Lagrangian."""
        L = self.new("dvi_lagrangian *")
        L.value = self.of_state(value)
        return L

    def of_state(self, value: Any) -> Any:
        """Return the pointer of a function of t, q [n] and v or p [n] with one number."""
        n = self.n

        def put_value(t: float, q: Any, v: Any, to: Any, _: Any) -> None:
            to[0] = value(t, copy(q, n), copy(v, n))
        return self.function(AT_STATE, value, put_value)

    def holonomic(self, value: Any, jacobian: Any, count: int) -> Any:
        """Return holonomic constraints, with gradients of all entries."""
        n = self.n
        if not 1 <= count <= n:
            raise ValueError(f"constraint_count = {count}; 1 to {n} are possible")

        def put_value(t: float, q: Any, phi: Any, _: Any) -> None:
            fill(phi, value(t, copy(q, n)), count, "constraints")

        def put_gradient(t: float, q: Any, phi_q: Any, _: Any) -> None:
            made = np.asarray(jacobian(t, copy(q, n)), dtype=float)
            if made.shape != (count, n) and not (count == 1 and made.shape == (n,)):
                raise ValueError(f"jacobian gave the shape {made.shape}; ({count}, {n}) is needed")
            fill(phi_q, made.ravel(), count * n, "jacobian")
        made = self.new("dvi_holonomic *")
        made.name, made.count = self.new("char[]", b"constraints"), count
        made.value = self.function(AT_POINT, value, put_value)
        made.gradient = self.function(AT_POINT, jacobian, put_gradient)
        made.gradients.start = self.new("int[]", [n * a for a in range(count + 1)])
        made.gradients.row = self.new("int[]", list(range(n)) * count)
        return made

    def invariants(self, given: Mapping[str, Any]) -> Any:
        """Return functions of the state that are watched."""
        made = self.new("dvi_invariant[]", len(given))
        for invariant, (name, value) in zip(made, given.items()):
            invariant.name = self.new("char[]", encoded(name, "the name of an invariant"))
            invariant.value = self.of_state(value)
        return made

    def set_mass(self, mass: Any, given: Any) -> None:
        """Set a mass: a number, a vector, or a matrix."""
        if hasattr(given, "tocsc") or np.ndim(given) == 2:
            matrix = self.set_pattern(mass.pattern, given, "mass")
            mass.values = self.numbers(np.array(matrix.data, dtype=float))
        elif np.ndim(given) == 0:
            mass.scalar = given
        else:
            mass.diagonal = self.numbers(vector(given, self.n, "mass"))

    def numbers(self, array: Array) -> Any:
        """Return the pointer to an array that is kept."""
        self.keep.append(array)
        return numbers(array)


def copy(pointer: Any, n: int) -> Array:
    """Return a copy of n numbers of C, which is not for writing."""
    return np.frombuffer(ffi.buffer(pointer, 8 * n)[:], dtype=float)


def fill(pointer: Any, given: Any, n: int, name: str) -> None:
    """Fill n numbers of C from a callback's array."""
    made = np.array(given, dtype=float, ndmin=1)
    if made.shape != (n,):
        raise ValueError(f"{name} gave the shape {made.shape}; {n} numbers are needed")
    np.frombuffer(ffi.buffer(pointer, 8 * n), dtype=float)[:] = made
