"""Single steps."""
from __future__ import annotations

import operator
import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from dvi._dvi import ffi, lib
from dvi._library import Array, Owned, encoded, numbers, text
from dvi.errors import check
from dvi.recording import Run, record
from dvi.system import System


class Integrator:
    """A method with a state, of a system or a scene, whose own method is the default.

        integrator = dvi.Integrator(system, "galerkin:degree=4").start([1, 0], v=[0, 1])
        for _ in integrator.steps(0.05, 100): print(integrator.t, integrator.q)

    It can be pickled where its system can, and goes on with the same bits. It serves one thread at
    a time: another one gets a RuntimeError.
    """

    def __init__(self, system: System, method: str | None = None) -> None:
        if not isinstance(system, System):
            raise TypeError(f"an integrator needs a system or a scene, not {system!r}")
        made = ffi.new("dvi_integrator **")
        name = encoded(system._method() if method is None else method, "the method")
        check(lib.dvi_integrator_create(system.pointer, name, made))
        self.pointer, self.system = made[0], system
        threads = re.search(r"\bthreads=(\d+)", self.method)
        self._owned = Owned("integrator", made[0], system.owned,
                            int(threads[1]) if threads else 1)
        self._acquire, self._release = self._owned.lock.acquire, self._owned.lock.release

    def _check(self, status: int) -> None:
        self.system.raise_failure()
        check(status)

    def start(self, q: ArrayLike | None = None, v: ArrayLike | None = None,
              p: ArrayLike | None = None, t: float = 0.0) -> Integrator:
        """Put the integrator at time t in q [nq] with v or p [nv]. A scene has its own start.

        Raises ValueError for other shapes, and `NotFinite` for NaN and Inf.
        """
        given, name, other = self.system._start_of(q, v, p)
        by = lib.dvi_integrator_start_velocity if name == "v" else lib.dvi_integrator_start
        with self._owned:
            self._check(by(self.pointer, t, numbers(given), numbers(other)))
        return self

    def step(self, h: float) -> None:
        """Take one step. After a failure the state is that before the step."""
        if not self._acquire(False):
            raise self._owned.busy()
        try:
            status = lib.dvi_integrator_step(self.pointer, h)
        finally:
            self._release()
        if status != lib.DVI_OK:
            self._check(status)

    def steps(self, h: float, count: int | None = None) -> Iterator[Integrator]:
        """Take steps without end, or `count`, and yield the integrator after each."""
        count = None if count is None else operator.index(count)
        if count is not None and count < 0:
            raise ValueError(f"{count} steps asked; 0 or more are possible")
        return self._steps(h, count)

    def _steps(self, h: float, count: int | None) -> Iterator[Integrator]:
        taken = 0
        while count is None or taken < count:
            self.step(h)
            taken += 1
            yield self

    def run(self, h: float, t_end: float, every: int | None = None, times: ArrayLike | None = None,
            parts: Iterable[str] = ("q", "p"),
            events: Mapping[str, Callable[..., float]] | None = None) -> Run:
        """Run from the present state to t_end, and return the `Run` (`dvi.recording.record`)."""
        return record(self, h, t_end, every, times, parts, events)

    def at(self, t: float) -> tuple[Array, Array]:
        """Return q [nq] and v [nv] of the last step's path at t, between its ends."""
        q, v = np.empty(self.system.nq), np.empty(self.system.nv)
        with self._owned:
            self._check(lib.dvi_integrator_interpolate(self.pointer, t, numbers(q), numbers(v)))
        return q, v

    @property
    def t(self) -> float:
        """Return the time."""
        return lib.dvi_integrator_time(self.pointer)

    @property
    def q(self) -> Array:
        """Return the coordinates [nq], a new array."""
        return self._copy(lib.dvi_integrator_q(self.pointer), self.system.nq)

    @property
    def p(self) -> Array:
        """Return the momenta [nv], a new array."""
        return self._copy(lib.dvi_integrator_p(self.pointer), self.system.nv)

    @staticmethod
    def _copy(pointer: Any, count: int) -> Array:
        return np.frombuffer(ffi.buffer(pointer, 8 * count), dtype=float).copy()

    @property
    def invariants(self) -> dict[str, float]:
        """Return a dict of the invariants' values. The first is the energy."""
        value = np.empty(len(self.system.invariants))
        with self._owned:
            self._check(lib.dvi_integrator_invariants(self.pointer, numbers(value)))
        return dict(zip(self.system.invariants, value.tolist()))

    @property
    def method(self) -> str:
        """Return the full specification of the method."""
        return text(lib.dvi_integrator_method(self.pointer))

    @property
    def order(self) -> int:
        """Return the order of the method."""
        return lib.dvi_integrator_order(self.pointer)

    def explain(self) -> str:
        """Return which kernel, solver and sparsity the integrator chose, and why."""
        with self._owned:
            size = lib.dvi_integrator_explain(self.pointer, ffi.NULL, 0) + 1
            room = ffi.new("char[]", size)
            lib.dvi_integrator_explain(self.pointer, room, size)
        return text(room)

    def save(self) -> bytes:
        """Return the state as bytes. A restored run goes on with the same bits."""
        size = ffi.new("size_t *")
        with self._owned:
            lib.dvi_integrator_save_memory(self.pointer, ffi.NULL, 0, size)
            room = ffi.new("char[]", size[0])
            self._check(lib.dvi_integrator_save_memory(self.pointer, room, size[0], size))
        return bytes(ffi.buffer(room, size[0]))

    def restore(self, state: bytes) -> Integrator:
        """Go on from a state that `save` returned. Raises `BadArgument` for other bytes."""
        state = bytes(memoryview(state))
        with self._owned:
            self._check(lib.dvi_integrator_restore_memory(self.pointer, state, len(state)))
        return self

    def __reduce__(self) -> Any:
        return _restored, (self.system, self.method, self.save())

    def __repr__(self) -> str:
        return f"<Integrator {self.method} at t = {self.t:g}>"


def _restored(system: System, method: str, state: bytes) -> Integrator:
    return Integrator(system, method).restore(state)
