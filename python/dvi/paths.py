"""Paths between two ends, or closed ones, on which a discrete action is stationary."""
from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from dvi._dvi import ffi, lib
from dvi._library import Owned, encoded, numbers, text, vector
from dvi.errors import check
from dvi.study import check_on
from dvi.system import System

REPORT = ("action", "energy", "span", "energy_spread", "gradient", "negative", "zero",
          "symmetries", "iterations")


class Path:
    """A stationary path.

    t, q, p          its nodes, arrays with a row for each
    action, energy   the discrete action, and the mean energy of the steps
    negative, zero   eigenvalues of the second variation: with negative == 0 the action is least
    and span, energy_spread, gradient, symmetries, iterations, as dvi/path.h has them
    """

    action: float
    energy: float
    span: float
    energy_spread: float
    gradient: float
    negative: int
    zero: int
    symmetries: int
    iterations: int

    def __init__(self, system: System, pointer: Any, report: Any) -> None:
        rows = range(lib.dvi_path_steps(pointer) + 1)
        self.system, self.method = system, text(lib.dvi_path_method(pointer))
        self.t = np.array([lib.dvi_path_time(pointer, k) for k in rows])
        self.q = np.array([ffi.unpack(lib.dvi_path_q(pointer, k), system.nq) for k in rows])
        self.p = np.array([ffi.unpack(lib.dvi_path_p(pointer, k), system.nv) for k in rows])
        for name in REPORT:
            setattr(self, name, getattr(report, name))

    def __repr__(self) -> str:
        return (f"<Path of {self.method}: {len(self.t) - 1} steps from t = {self.t[0]:g} to "
                f"{self.t[-1]:g}, action {self.action:.6g}>")


def _ends(given: Iterable[str]) -> int:
    """Return the boundary conditions that the given arrays belong to."""
    kinds = {("q0", "q1"): lib.DVI_ENDS_FIXED, ("p0", "q0"): lib.DVI_ENDS_INITIAL,
             (): lib.DVI_ENDS_PERIODIC}
    kind = kinds.get(tuple(sorted(name for name in given if name != "shift")))
    if kind is None or ("shift" in given and kind != lib.DVI_ENDS_PERIODIC):
        raise TypeError("a path has q0 and q1, or q0 and p0, or none of them and perhaps a shift")
    return kind


def path(system: System, method: str, steps: int, span: float,
         guess: tuple[ArrayLike, ArrayLike] | None = None, start: float = 0.0,
         **ends: ArrayLike) -> Path:
    """Find a path on which the discrete action of all its steps is stationary.

    method  galerkin, midpoint, trapezoidal, hp or hamiltonian
    ends    q0 and q1 of both ends, or q0 and p0 of the start. A path without them is closed, up to
            `shift` (an angle that has turned by 2 pi)
    guess   times and coordinates of points on the way, the arrays t [points] and q [points, nq].
            Default: the straight line, or rest
    """
    held = {name: vector(given, system.nv if name == "p0" else system.nq, name)
            for name, given in ends.items() if given is not None}
    options = ffi.new("dvi_path_options *", {"ends": _ends(held), "steps": steps, "start": start,
                                             "span": span, "dimension": system.nq})
    for name, array in held.items():
        setattr(options, name, numbers(array))
    made, report = ffi.new("dvi_path **"), ffi.new("dvi_path_report *")
    specification = encoded(method, "the method")
    check_on(system, lib.dvi_path_create(system.pointer, specification, options, made))
    owned = Owned("path", made[0], system.owned)
    if guess is not None:
        t = vector(guess[0], np.size(guess[0]), "the times of the guess")
        q = np.ascontiguousarray(guess[1], dtype=float)
        if q.shape != (len(t), system.nq):
            raise ValueError(f"the guess has the shape {q.shape}, not {(len(t), system.nq)}")
        check(lib.dvi_path_guess(made[0], len(t), system.nq, numbers(t), numbers(q)))
    check_on(system, lib.dvi_path_solve(made[0], report))
    found = Path(system, made[0], report)
    del owned
    return found
