"""Sweeps: runs at all points of a grid of parameters or starts, on several threads."""
from __future__ import annotations

import threading
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from dvi._dvi import ffi, lib
from dvi._library import Array, numbers, text, vector
from dvi.errors import Error, check
from dvi.integrator import Integrator
from dvi.recording import interrupts
from dvi.scene import Scene
from dvi.study import Table
from dvi.system import System

ENTRIES: list[tuple[str, Any]] = [("status", "U64"), ("steps", np.int64), ("t", float)]


def values(first: float, last: float, count: int) -> Array:
    """Return equally spaced values with both ends, the bits of dvi sweep --set NAME=A:B:COUNT."""
    made = np.empty(max(count, 0))
    check(lib.dvi_study_range(first, last, count, numbers(made)))
    return made


class Sweep(Table):
    """The rows of a sweep, a structured array. `sentences` says why runs failed, by their row."""

    sentences: dict[int, str]

    def __array_finalize__(self, of: Any) -> None:
        self.sentences = getattr(of, "sentences", {})


class _Points:
    """The callbacks of a sweep, and its rows."""

    def __init__(self, make: Callable[..., Integrator], names: list[str], h: float,
                 t_end: float) -> None:
        self.make, self.names, self.h, self.t_end = make, names, h, t_end
        self.opened: dict[int, dict[str, Any]] = {}
        self.rows: dict[int, dict[str, Any]] = {}
        self.failure: BaseException | None = None
        self.system: System | None = None
        self.lock = threading.Lock()

    def guarded(self, kind: str, function: Callable[..., Any]) -> Any:
        """Return a callback of C. An exception ends the sweep, and is raised after it."""
        def call(*arguments: Any) -> Any:
            try:
                return function(*arguments) or 0
            except BaseException as failure:  # it must not pass through C
                self.failure = self.failure or failure
                return lib.DVI_CALLBACK_FAILED
        return ffi.callback(kind, call, error=lib.DVI_CALLBACK_FAILED)

    def open(self, point: Any, run: Any, _: Any) -> int:
        """Make the run of a point. An error of the library is the point's own."""
        given = dict(zip(self.names, ffi.unpack(point.value, len(self.names))))
        held: dict[str, Any] = {}
        with self.lock:
            self.opened[point.number] = held
        run.user = ffi.cast("void *", point.number)
        try:
            integrator = self.make(**given)
        except Error as failure:
            held["sentence"] = str(failure)
            return getattr(lib, failure.status)
        system = integrator.system
        events = list(system._events()) if isinstance(system, Scene) else []
        held["integrator"] = integrator
        held["events"] = [name for name, _ in events]
        held["list"] = ffi.new("dvi_event[]", [event for _, event in events])
        run.integrator = integrator.pointer
        run.options.h, run.options.t_end = self.h, self.t_end
        if events:
            run.options.events, run.options.event_count = held["list"], len(events)
        return 0

    def found(self, point: Any, run: Any, row: Any, _: Any) -> int:
        """Keep the row of a point. A positive number ends the sweep."""
        held = self.opened[point.number]
        if self.failure is not None:
            return 1
        status = text(lib.dvi_status_name(row.status))
        if row.status != lib.DVI_OK:
            held.setdefault("sentence", text(row.sentence))
        made = {"value": ffi.unpack(point.value, len(self.names)), "steps": row.report.steps,
                "t": row.t, "error": row.energy_error, "sentence": held.get("sentence")}
        if row.report.end == lib.DVI_RUN_EVENT:
            status = f"event {held['events'][row.report.event]}"
        made["status"] = status
        if row.q != ffi.NULL:
            system = held["integrator"].system
            system.raise_failure(of_any_thread=True)
            self.adopt(system)
            sizes = {"q": system.nq, "p": system.nv, "invariant": len(system.invariants),
                     "least": system.nq, "most": system.nq}
            made.update({name: ffi.unpack(getattr(row, name), size)
                         for name, size in sizes.items() if getattr(row, name) != ffi.NULL})
        self.rows[point.number] = made
        return 0

    def adopt(self, system: System) -> None:
        """Take the columns of the first system, which all others must have."""
        self.system = self.system or system
        for names in ("coordinates", "momenta", "invariants"):
            if getattr(system, names) != getattr(self.system, names):
                raise ValueError("the points of a sweep need systems with the same coordinates, "
                                 "momenta and invariants")

    def close(self, run: Any, _: Any) -> None:
        """Free the run of a point."""
        with self.lock:
            self.opened.pop(int(ffi.cast("intptr_t", run.user)), None)

    def table(self, extremes: bool) -> Sweep:
        """Return the rows in the order of the points."""
        lists: dict[str, list[str]] = {}
        if self.system is not None:
            lists = {"q": self.system.coordinates, "p": self.system.momenta,
                     "invariant": self.system.invariants}
            if extremes:
                lists["least"] = [f"least_{name}" for name in self.system.coordinates]
                lists["most"] = [f"most_{name}" for name in self.system.coordinates]
        columns = [name for names in lists.values() for name in names] + ["energy_error"]
        kinds: list[tuple[str, Any]] = [(name, float) for name in self.names] + ENTRIES
        kinds += [(name, float) for name in columns]
        rows: list[tuple[Any, ...]] = []
        sentences: dict[int, str] = {}
        for k, row in enumerate(self.rows[number] for number in sorted(self.rows)):
            if row["sentence"] is not None:
                sentences[k] = row["sentence"]
            numbers_of = [number for part, names in lists.items()
                          for number in row.get(part, [np.nan] * len(names))]
            rows.append((*row["value"], row["status"], row["steps"], row["t"], *numbers_of,
                         row["error"]))
        made = np.array(rows, kinds).view(Sweep)
        made.sentences = sentences
        return made


def _of_scene(scene: Scene, method: str | None) -> Callable[..., Integrator]:
    """Return a function that makes a started integrator of the scene with other parameters."""
    name, source, parameters = scene._made_of
    method = method or text(scene._plan.method)
    if method is None:
        raise TypeError("the scene has no method: give one")

    def make(**given: float) -> Integrator:
        return Integrator(Scene.parse(source, name, **{**parameters, **given}), method).start()
    return make


def sweep(make: Scene | Callable[..., Integrator], grid: Mapping[str, ArrayLike],
          h: float | None = None, t_end: float | None = None, method: str | None = None,
          threads: int = 0, part: tuple[int, int] = (0, 1), extremes: bool = False) -> Sweep:
    """Run all points of a grid, as dvi sweep does.

    make      a scene, whose parameters are varied; or a function that takes the values of a point
              by their names and returns a started `Integrator`
    grid      a dict of names and their values. The last one changes from row to row
    h, t_end  of all runs. Default: those of the scene
    threads   runs at a time. Default: the number of cores. The rows have the same bits for all
    part      (k, n) takes points k, k + n, .. of the grid alone, to share it among machines
    extremes  adds the least and the most of each coordinate, least_x and most_x
    Returns a `Sweep`, a table: the values, status (DVI_OK, "event NAME", or why the run failed),
    steps, t, coordinates, momenta and invariants at the end, and the largest energy_error. Failed
    runs have NaN where there is no number.
    """
    if isinstance(make, Scene):
        h = make._plan.h if h is None else h
        t_end = make._plan.t_end if t_end is None else t_end
        make = _of_scene(make, method)
    elif method is not None:
        raise TypeError("a method is for scenes; a function makes integrators of its own")
    if h is None or t_end is None:
        raise TypeError("a sweep needs h and t_end")
    lists = {name: vector(given, np.size(given), name) for name, given in grid.items()}
    axis = ffi.new("dvi_study_axis[]", [{"count": len(given), "value": numbers(given)}
                                        for given in lists.values()])
    state = _Points(make, list(lists), h, t_end)
    callbacks = [
        state.guarded("dvi_status(*)(dvi_study_point *, dvi_study_run *, void *)", state.open),
        state.guarded("int(*)(dvi_study_point *, dvi_study_run *, dvi_study_row *, void *)",
                      state.found),
        ffi.callback("void(*)(dvi_study_run *, void *)", state.close)]
    options = ffi.new("dvi_study_sweep_options *", {
        "size": ffi.sizeof("dvi_study_sweep_options"), "axes": len(lists), "axis": axis,
        "part": part[0], "parts": part[1], "extremes": extremes,
        "threads": threads or lib.dvi_study_cores()})
    options.open, options.found, options.close = callbacks
    interrupted = ffi.new("int *", interrupts())
    status = lib.interruptible_sweep(options, interrupted)
    if state.failure is not None:
        raise state.failure
    if interrupted[0]:
        raise KeyboardInterrupt
    check(status)
    return state.table(extremes)
