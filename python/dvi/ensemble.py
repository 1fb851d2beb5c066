"""Ensembles: many members of one method, advanced by one call."""
import numpy as np

from dvi._dvi import ffi, lib
from dvi._library import Owned, numbers
from dvi.errors import check


class Ensemble:
    """Members of one system that differ in their starts.

    q [nq, members] and p [nv, members] are arrays of all members.
    """

    def __init__(self, system, method, members, threads=1):
        options = ffi.new("dvi_ensemble_options *", {"members": members, "threads": threads})
        made = ffi.new("dvi_ensemble **")
        check(lib.dvi_ensemble_create(system.pointer, method.encode(), options, made))
        self._owned = Owned("ensemble", made[0], system.owned)
        self.pointer, self.system, self.members = made[0], system, members

    def _check(self, status):
        self.system.raise_failure()
        check(status)

    def _given(self, rows, count, name):
        made = np.ascontiguousarray(rows, dtype=float)
        if made.shape != (count, self.members):
            raise ValueError(f"{name} has the shape {made.shape}; ({count}, {self.members}) is "
                             "needed")
        return made

    def start(self, q, v=None, p=None, t=0.0):
        """Put all members at time t in q [nq, members] with v or p [nv, members]."""
        if (v is None) == (p is None):
            raise TypeError("a start needs q with either v or p")
        q = self._given(q, self.system.nq, "q")
        by = lib.dvi_ensemble_start if p is not None else lib.dvi_ensemble_start_velocity
        other = self._given(p if p is not None else v, self.system.nv, "p" if v is None else "v")
        self._check(by(self.pointer, t, numbers(q), numbers(other)))
        return self

    def advance(self, h, steps):
        """Take steps with every member. Raises for a member that fails, when all others are done."""
        self._check(lib.dvi_ensemble_advance(self.pointer, h, steps))
        return self

    def record(self, h, steps, every=1):
        """Take steps, and return t [rows], q [rows, nq, members] and p [rows, nv, members]."""
        count = steps // every + 1
        t = np.empty((count, self.members))
        q, p = (np.empty((count, n, self.members)) for n in (self.system.nq, self.system.nv))
        rows = ffi.new("dvi_ensemble_rows *", {"size": ffi.sizeof("dvi_ensemble_rows"),
                                               "t": numbers(t), "q": numbers(q),
                                               "p": numbers(p)})
        self._check(lib.dvi_ensemble_record(self.pointer, h, every, count, rows))
        return t[:, 0], q, p

    def _state(self, which):
        shape = (self.members,) if which == 0 else (self.system.nq if which == 1 else
                                                    self.system.nv, self.members)
        made = np.empty(shape)
        arrays = [ffi.NULL] * 3
        arrays[which] = numbers(made)
        self._check(lib.dvi_ensemble_state(self.pointer, *arrays))
        return made

    t = property(lambda self: self._state(0), doc="The times of the members.")
    q = property(lambda self: self._state(1), doc="The coordinates [nq, members].")
    p = property(lambda self: self._state(2), doc="The momenta [nv, members].")
