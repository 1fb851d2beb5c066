"""Runs, recorded in arrays by one call of the library."""
from typing import NamedTuple

import numpy as np

from dvi._dvi import ffi, lib
from dvi._library import Owned, array, numbers
from dvi.errors import check, error

PARTS = {"q": lib.DVI_RECORD_Q, "p": lib.DVI_RECORD_P, "v": lib.DVI_RECORD_V,
         "invariants": lib.DVI_RECORD_INVARIANTS, "step": lib.DVI_RECORD_STEP,
         "constraint": lib.DVI_RECORD_CONSTRAINT, "reactions": lib.DVI_RECORD_REACTIONS}
USUAL = ("q", "p")
ENDS = ("complete", "stopped", "event", "cancelled", "failed")


class Event(NamedTuple):
    """An event of a run: its name, its time, and the point of the path there."""

    name: str
    t: float
    q: np.ndarray
    v: np.ndarray


class Run:
    """A recorded run.

    t, q, p, v, invariants  arrays with a row for each time. v and invariants are evaluated when
                            they are first used, if they were not recorded
    events                  list of `Event`
    end                     why the run ended: complete, stopped, event or cancelled
    run["x"]                a column by its name (`columns` has all of them)
    """

    def __init__(self, system, method, recording, names):
        self.system, self.method = system, method
        self._owned, self._recording = recording, recording.pointer
        report = lib.dvi_recording_report(self._recording)
        self.steps, self.end = report.steps, ENDS[report.end]
        self.t = self._rows(lib.DVI_RECORD_T)[:, 0]
        self._recorded = {name: self._rows(part) for name, part in PARTS.items()}
        self.events = [self._event(i, names) for i in range(report.events)]
        self._place = {"t": ("t", None)}
        self._list("q", system.coordinates)
        self._list("v", system.velocities)
        self._list("p", system.momenta)
        self._list("invariants", system.invariants)
        for name in ("step", "constraint"):
            self._list(name, [name])

    def _rows(self, part):
        width = ffi.new("int *")
        pointer = lib.dvi_recording_part(self._recording, part, width)
        if pointer == ffi.NULL:
            return None
        pointer = ffi.cast("double *", pointer)
        return array(pointer, (lib.dvi_recording_rows(self._recording), width[0]),
                     self._owned)

    def _event(self, i, names):
        event = lib.dvi_recording_event(self._recording, i)
        nq, nv = self.system.nq, self.system.nv
        return Event(names[event.event], event.t, np.array(ffi.unpack(event.q, nq)),
                     np.array(ffi.unpack(event.v, nv)))

    def _list(self, part, names):
        derived = part in ("v", "invariants") and self._has_states()
        if derived or self._recorded[part] is not None:
            for i, name in enumerate(names):
                self._place.setdefault(name, (part, i))

    def _has_states(self):
        return self._recorded["q"] is not None and self._recorded["p"] is not None

    def _derived(self, part):
        """Return recorded rows of a part, or evaluate them once."""
        if self._recorded[part] is None and self._has_states():
            status = lib.dvi_recording_derive(self._recording, PARTS[part])
            self.system.raise_failure()
            check(status)
            self._recorded[part] = self._rows(PARTS[part])
        return self._recorded[part]

    @property
    def q(self):
        """Return the coordinates [rows, nq]."""
        return self._recorded["q"]

    @property
    def p(self):
        """Return the momenta [rows, nv]."""
        return self._recorded["p"]

    @property
    def v(self):
        """Return the velocities [rows, nv]."""
        return self._derived("v")

    @property
    def invariants(self):
        """Return the energy and what the system declares [rows, count]."""
        return self._derived("invariants")

    @property
    def step(self):
        """Return the lengths of the last steps [rows, 1], if they were recorded."""
        return self._recorded["step"]

    @property
    def constraint(self):
        """Return the distances from the constraint [rows, 1], if they were recorded."""
        return self._recorded["constraint"]

    @property
    def reactions(self):
        """Return the multipliers [rows, count], if they were recorded."""
        return self._recorded["reactions"]

    @property
    def columns(self):
        """Return the names of all columns."""
        return list(self._place)

    def __getitem__(self, name):
        if name not in self._place:
            raise KeyError(f"there is no column {name!r}; there are {', '.join(self.columns)}")
        part, i = self._place[name]
        return self.t if i is None else getattr(self, part)[:, i]

    def __len__(self):
        return len(self.t)

    def plot(self, *names, against="t", axes=None):
        """Draw columns by matplotlib, by default the coordinates, and return the axes."""
        import matplotlib.pyplot as plt
        axes = axes or plt.gca()
        for name in names or self.system.coordinates[:8]:
            axes.plot(self[against], self[name], label=name)
        axes.set_xlabel(against)
        axes.legend()
        return axes

    def __repr__(self):
        return (f"<Run of {self.method}: {len(self)} rows from t = {self.t[0]:g} to "
                f"{self.t[-1]:g}, {self.end}>")

    def _repr_html_(self):
        """Return a table of the first and last rows, for notebooks."""
        shown = [name for name in self.columns if name not in self.system.velocities][:10]
        rows = [k for k in range(len(self)) if k < 3 or k >= len(self) - 3]
        cells = "".join("<tr>" + "".join(f"<td>{self[name][k]:.6g}</td>" for name in shown) +
                        "</tr>" for k in rows)
        head = "".join(f"<th>{name}</th>" for name in shown)
        return f"<p>{self!r}".replace("<Run", "&lt;Run") + f"</p><table>{head}{cells}</table>"

    def __reduce__(self):
        raise TypeError("a run is not pickled; keep its arrays, as in dict of run[name]")


def record(integrator, h, t_end, every=1, times=None, parts=USUAL, events=()):
    """Run an integrator to t_end and return the `Run`.

    every   steps between two rows. times  the times of the rows in place of that
    parts   of a row, some of q, p, v, invariants, step, constraint, reactions
    events  names and structs of the scene's events
    """
    system = integrator.system
    options = ffi.new("dvi_record_options *", {"size": ffi.sizeof("dvi_record_options")})
    for part in parts:
        options.parts |= PARTS[part]
    if times is not None:
        times = np.ascontiguousarray(times, dtype=float)
        options.times, options.time_count = numbers(times), len(times)
    listed = ffi.new("dvi_event[]", [event for _, event in events])
    run = ffi.new("dvi_run_options *", {"h": h, "t_end": t_end, "every": every})
    if events:
        run.events, run.event_count = listed, len(events)
    made, interrupted = ffi.new("dvi_recording **"), ffi.new("int *")
    status = lib.interruptible_record(integrator.pointer, run, options, made, interrupted)
    failure = error(status) if status != lib.DVI_OK else None
    recording = Owned("recording", made[0]) if made[0] != ffi.NULL else None
    system.raise_failure()
    result = Run(system, integrator.method, recording, [name for name, _ in events]) \
        if recording is not None and lib.dvi_recording_rows(made[0]) > 0 else None
    if interrupted[0]:
        raise KeyboardInterrupt
    if failure is not None:
        failure.run = result  # what was recorded before the failure
        raise failure
    return result
