"""Ensembles: many members of one method, advanced by one call."""
from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from dvi._dvi import ffi, lib
from dvi._library import Array, Owned, encoded, numbers
from dvi.errors import check
from dvi.system import System


class Ensemble:
    """Members of one system that differ in their starts.

    q [nq, members] and p [nv, members] are arrays of all members. Several threads share the
    members. It serves one thread of Python at a time, and is not for the child of a fork.
    """

    def __init__(self, system: System, method: str, members: int, threads: int = 1) -> None:
        if not isinstance(system, System):
            raise TypeError(f"an ensemble needs a system or a scene, not {system!r}")
        options = ffi.new("dvi_ensemble_options *", {"members": members, "threads": threads})
        made = ffi.new("dvi_ensemble **")
        name = encoded(method, "the method")
        check(lib.dvi_ensemble_create(system.pointer, name, options, made))
        self._owned = Owned("ensemble", made[0], system.owned, threads)
        self.pointer, self.system, self.members, self.method = made[0], system, members, method

    def _check(self, status: int) -> None:
        self.system.raise_failure(of_any_thread=True)
        check(status)

    def _given(self, rows: ArrayLike, count: int, name: str) -> Array:
        made = np.ascontiguousarray(rows, dtype=float)
        if made.shape != (count, self.members):
            raise ValueError(f"{name} has the shape {made.shape}; ({count}, {self.members}) is "
                             "needed")
        return made

    def start(self, q: ArrayLike, v: ArrayLike | None = None, p: ArrayLike | None = None,
              t: float = 0.0) -> Ensemble:
        """Put all members at time t in q [nq, members] with v or p [nv, members].

        Raises ValueError for other shapes, and `NotFinite` for NaN and Inf.
        """
        if (v is None) == (p is None):
            raise TypeError("a start needs q with either v or p")
        q = self._given(q, self.system.nq, "q")
        by = lib.dvi_ensemble_start if v is None else lib.dvi_ensemble_start_velocity
        given = p if v is None else v
        assert given is not None
        other = self._given(given, self.system.nv, "p" if v is None else "v")
        with self._owned:
            self._check(by(self.pointer, t, numbers(q), numbers(other)))
        return self

    def advance(self, h: float, steps: int) -> Ensemble:
        """Take steps with every member. Raises for a member that fails, when all others are done.

        Ctrl-C is noticed at the end of the call.
        """
        with self._owned:
            self._check(lib.dvi_ensemble_advance(self.pointer, h, steps))
        return self

    def record(self, h: float, steps: int, every: int = 1) -> tuple[Array, Array, Array]:
        """Take steps, and return t [rows], q [rows, nq, members] and p [rows, nv, members].

        There is a row at the start, and one after each `every` steps, which divide `steps`. An
        exception has the rows before it, as such a tuple, as its `rows`.
        """
        if every < 1 or steps < 0 or steps % every != 0:
            raise ValueError(f"steps = {steps} are no multiple of every = {every}")
        count = steps // every + 1
        t = np.full((count, self.members), np.nan)
        q, p = (np.empty((count, n, self.members)) for n in (self.system.nq, self.system.nv))
        rows = ffi.new("dvi_ensemble_rows *", {"size": ffi.sizeof("dvi_ensemble_rows"),
                                               "t": numbers(t), "q": numbers(q),
                                               "p": numbers(p)})
        try:
            with self._owned:
                self._check(lib.dvi_ensemble_record(self.pointer, h, every, count, rows))
        except BaseException as failure:
            kept = int(np.isfinite(t).all(axis=1).sum())
            failure.rows = t[:kept, 0], q[:kept], p[:kept]  # type: ignore[attr-defined]
            raise
        return t[:, 0], q, p

    def _state(self, which: int) -> Array:
        shape = [(self.members,), (self.system.nq, self.members), (self.system.nv, self.members)]
        made = np.empty(shape[which])
        arrays = [ffi.NULL] * 3
        arrays[which] = numbers(made)
        with self._owned:
            self._check(lib.dvi_ensemble_state(self.pointer, *arrays))
        return made

    @property
    def t(self) -> Array:
        """Return the times of the members [members], a new array."""
        return self._state(0)

    @property
    def q(self) -> Array:
        """Return the coordinates [nq, members], a new array."""
        return self._state(1)

    @property
    def p(self) -> Array:
        """Return the momenta [nv, members], a new array."""
        return self._state(2)

    def __reduce__(self) -> str:
        raise TypeError("an ensemble is not pickled; keep its t, q and p, and start another one")

    def __repr__(self) -> str:
        return f"<Ensemble of {self.members} by {self.method}>"
