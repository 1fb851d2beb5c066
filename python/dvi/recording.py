"""Runs, recorded in arrays by one call of the library."""
from __future__ import annotations

import html
import signal
import threading
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from dvi._callbacks import Callbacks
from dvi._dvi import ffi, lib
from dvi._library import Array, Owned, array, encoded, numbers
from dvi.errors import check, error

if TYPE_CHECKING:
    from dvi.integrator import Integrator
    from dvi.system import System

PARTS = {"q": lib.DVI_RECORD_Q, "p": lib.DVI_RECORD_P, "v": lib.DVI_RECORD_V,
         "invariants": lib.DVI_RECORD_INVARIANTS, "step": lib.DVI_RECORD_STEP,
         "constraint": lib.DVI_RECORD_CONSTRAINT, "reactions": lib.DVI_RECORD_REACTIONS}
NAMED = ("q", "v", "p", "invariants")  # in the order of the columns
ENDS = ("complete", "stopped", "event", "cancelled", "failed")


class Event(NamedTuple):
    """An event of a run: its name, its time, and the point q [nq], v [nv] of the path there."""

    name: str
    t: float
    q: Array
    v: Array


class Run:
    """A recorded run.

    t, q, p, v, invariants  arrays with a row for each time. v and invariants are evaluated when
                            they are first used, if they were not recorded
                            Parts that were not recorded raise AttributeError
    events                  list of `Event`
    steps                   number of accepted steps
    end                     why the run ended: complete, stopped, event, cancelled or failed
    run["x"]                a column by its name (`columns` has all of them). dict(run) has all
                            columns, and len(run) is the number of rows

    A run can be pickled, with v and invariants.
    """

    def __init__(self, system: System, method: str, recording: Owned, names: Sequence[str]) -> None:
        self.system: System | None = system
        self.method = method
        self._owned: Owned | None = recording
        self._names = {"q": system.coordinates, "v": system.velocities, "p": system.momenta,
                       "invariants": system.invariants}
        report = lib.dvi_recording_report(recording.pointer)
        self.steps: int = report.steps
        self.end = ENDS[report.end]
        rows = lib.dvi_recording_rows(recording.pointer)
        self._recorded = {name: _rows(recording, part, rows) for name, part in PARTS.items()}
        t = _rows(recording, lib.DVI_RECORD_T, rows)
        assert t is not None
        self.t: Array = t[:, 0]
        self.events = [_event(recording, i, names, system) for i in range(report.events)]
        self._place: dict[str, tuple[str, int | None]] = {"t": ("t", None)}
        for part, listed in self._names.items():
            self._list(part, listed)
        for part in ("step", "constraint"):
            self._list(part, [part])

    def _list(self, part: str, names: list[str]) -> None:
        if self._can_have(part) or self._recorded[part] is not None:
            for i, name in enumerate(names):
                self._place.setdefault(name, (part, i))

    def _can_have(self, part: str) -> bool:
        return part in ("v", "invariants") and all(
            self._recorded[of] is not None for of in ("q", "p"))

    def _part(self, part: str) -> Array:
        """Return recorded rows of a part. Those of v and invariants are evaluated once."""
        owned, system = self._owned, self.system
        if self._recorded[part] is None and self._can_have(part) and owned is not None:
            assert system is not None
            with owned:
                status = lib.dvi_recording_derive(owned.pointer, PARTS[part])
                system.raise_failure()
                check(status)
                self._recorded[part] = _rows(owned, PARTS[part],
                                             lib.dvi_recording_rows(owned.pointer))
        recorded = self._recorded[part]
        if recorded is None:
            raise AttributeError(f"the run has no {part}, which parts of run did not ask for, or "
                                 "which the system does not have")
        return recorded

    @property
    def q(self) -> Array:
        """Return the coordinates [rows, nq]."""
        return self._part("q")

    @property
    def p(self) -> Array:
        """Return the momenta [rows, nv]."""
        return self._part("p")

    @property
    def v(self) -> Array:
        """Return the velocities [rows, nv]."""
        return self._part("v")

    @property
    def invariants(self) -> Array:
        """Return the energy and what the system declares [rows, count]."""
        return self._part("invariants")

    @property
    def step(self) -> Array:
        """Return the lengths of the last steps [rows, 1], of the part "step"."""
        return self._part("step")

    @property
    def constraint(self) -> Array:
        """Return the distances from the constraint [rows, 1], of the part "constraint"."""
        return self._part("constraint")

    @property
    def reactions(self) -> Array:
        """Return the multipliers [rows, count], of the part "reactions"."""
        return self._part("reactions")

    @property
    def columns(self) -> list[str]:
        """Return the names of all columns."""
        return list(self._place)

    def keys(self) -> list[str]:
        """Return the names of all columns, so that dict(run) has them."""
        return self.columns

    def __getitem__(self, name: str) -> Array:
        """Return a column [rows] by its name. Raises KeyError with the names that there are."""
        if not isinstance(name, str) or name not in self._place:
            raise KeyError(f"there is no column {name!r}; there are {', '.join(self.columns)}")
        part, i = self._place[name]
        return self.t if i is None else getattr(self, part)[:, i]

    def __contains__(self, name: object) -> bool:
        return name in self._place

    def __iter__(self) -> Iterator[str]:
        return iter(self._place)

    def __len__(self) -> int:
        return len(self.t)

    def plot(self, *names: str, against: str = "t", axes: Any = None) -> Any:
        """Draw columns by matplotlib, by default the coordinates, and return the axes.

        against  the column along the axis of x
        axes     of matplotlib, by default the present ones
        """
        import matplotlib.pyplot as plt
        axes = plt.gca() if axes is None else axes
        drawn = list(names) or [name for name in self._names["q"][:8] if name in self]
        for name in drawn:
            axes.plot(self[against], self[name], label=name)
        axes.set_xlabel(against)
        axes.set_ylabel(", ".join(drawn[:4]) + (", .." if len(drawn) > 4 else ""))
        if len(drawn) > 1:
            axes.legend()
        return axes

    def __repr__(self) -> str:
        span = f"from t = {self.t[0]:g} to {self.t[-1]:g}, " if len(self) > 0 else ""
        return f"<Run of {self.method}: {len(self)} rows {span}{self.end}>"

    def _repr_html_(self) -> str:
        """Return a table of the first and last rows, for notebooks."""
        shown = [name for name in self if name not in self._names["v"]][:10]
        rows = [k for k in range(len(self)) if k < 3 or k >= len(self) - 3]
        cells = "".join("<tr>" + "".join(f"<td>{self[name][k]:.6g}</td>" for name in shown) +
                        "</tr>" for k in rows)
        head = "".join(f"<th>{html.escape(name)}</th>" for name in shown)
        return f"<p>{html.escape(repr(self))}</p><table><tr>{head}</tr>{cells}</table>"

    def __getstate__(self) -> dict[str, Any]:
        for name in self:
            self[name]  # evaluates what is not recorded
        state = dict(self.__dict__, system=None, _owned=None)
        return state


def _rows(recording: Owned, part: int, rows: int) -> Array | None:
    width = ffi.new("int *")
    pointer = lib.dvi_recording_part(recording.pointer, part, width)
    if pointer == ffi.NULL:
        return None
    found = array(ffi.cast("double *", pointer), (rows, width[0]), recording)
    found.flags.writeable = False  # velocities and invariants are evaluated from them later
    return found


def _event(recording: Owned, i: int, names: Sequence[str], system: System) -> Event:
    event = lib.dvi_recording_event(recording.pointer, i)
    return Event(names[event.event], event.t, np.array(ffi.unpack(event.q, system.nq)),
                 np.array(ffi.unpack(event.v, system.nv)))


def _parts(given: Iterable[str]) -> int:
    """Return the flags of parts of a row."""
    flags = 0
    for part in [given] if isinstance(given, str) else given:
        if part not in PARTS:
            raise ValueError(f"there is no part {part!r} of a row; there are {', '.join(PARTS)}")
        flags |= PARTS[part]
    if flags == 0:
        raise ValueError(f"a row needs a part; there are {', '.join(PARTS)}")
    return flags


def _events(given: Mapping[str, Any], of: Callbacks) -> list[tuple[str, dict[str, Any]]]:
    """Return names and structs of functions whose zeros are wanted."""
    made = []
    for name, value in given.items():
        made.append((name, {"name": of.new("char[]", encoded(name, "the name of an event")),
                            "value": of.of_state(value),
                            "direction": getattr(value, "direction", 0),
                            "terminal": bool(getattr(value, "terminal", False))}))
    return made


def interrupts() -> bool:
    """Tell if Ctrl-C is to end a run: on the main thread, unless the program handles it itself."""
    return (threading.current_thread() is threading.main_thread() and
            signal.getsignal(signal.SIGINT) is signal.default_int_handler)


def record(integrator: Integrator, h: float, t_end: float, every: int | None = None,
           times: ArrayLike | None = None, parts: Iterable[str] = ("q", "p"),
           events: Mapping[str, Callable[..., float]] | None = None,
           declared: Sequence[tuple[str, dict[str, Any]]] = ()) -> Run:
    """Run an integrator to t_end and return the `Run`.

    h         the step, or the first one. Its sign leads to t_end
    every     steps between two rows, 1 by default
    times     [rows] the times of the rows in place of that, in the order of the run
    parts     of a row, some of q, p, v, invariants, step, constraint, reactions
    events    a dict of functions g(t, q, v) -> float by names. Their zeros are the events of the
              run. As for solve_ivp of scipy, g.direction (1 rising, -1 falling) chooses some, and
              g.terminal = True ends the run there
    declared  names and structs of the scene's events

    An exception, also KeyboardInterrupt of Ctrl-C, has the `Run` before it as its `run`, None if
    there are no rows. The integrator stands where the run ended.
    """
    if every is not None and times is not None:
        raise TypeError("rows are after every so many steps, or at times; both are given")
    system, of = integrator.system, Callbacks(integrator.system.nq, integrator.system._failures)
    options = ffi.new("dvi_record_options *", {"size": ffi.sizeof("dvi_record_options"),
                                               "parts": _parts(parts)})
    if times is not None:
        at = np.array(times, dtype=float, ndmin=1)
        if at.ndim != 1:
            raise ValueError(f"times has the shape {at.shape}; (rows,) is needed")
        options.times, options.time_count = of.numbers(at), len(at)
    found = list(declared) + _events(events or {}, of)
    listed = ffi.new("dvi_event[]", [event for _, event in found])
    run = ffi.new("dvi_run_options *", {"h": h, "t_end": t_end, "every": every or 0})
    if found:
        run.events, run.event_count = listed, len(found)
    made, interrupted = ffi.new("dvi_recording **"), ffi.new("int *", interrupts())
    with integrator._owned:
        status = lib.interruptible_record(integrator.pointer, run, options, made, interrupted)
    failure: BaseException | None = error(status) if status != lib.DVI_OK else None
    recording = Owned("recording", made[0]) if made[0] != ffi.NULL else None
    result = Run(system, integrator.method, recording, [name for name, _ in found]) \
        if recording is not None and (failure is None or
                                      lib.dvi_recording_rows(made[0]) > 0) else None
    try:
        system.raise_failure()
    except BaseException as raised:
        failure = raised
    if interrupted[0]:
        failure = KeyboardInterrupt()
    if failure is not None:
        failure.run = result  # type: ignore[attr-defined]
        raise failure
    assert result is not None
    return result
