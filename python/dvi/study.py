"""Studies: the order of methods, and their time against their error."""
from __future__ import annotations

import html
import math
from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from dvi._dvi import ffi, lib
from dvi._library import Array, encoded, numbers, vector
from dvi.errors import check
from dvi.system import System

LEVEL = np.dtype([("h", float), ("steps", np.int64), ("error", float), ("order", float),
                  ("energy_error", float), ("seconds", float), ("evaluations", np.int64)])
COST = np.dtype([("h", float), ("steps", np.int64), ("error", float), ("seconds", float),
                 ("lower", float), ("upper", float), ("evaluations", np.int64),
                 ("status", "U24")])


class Table(np.ndarray):
    """A structured array that notebooks show as a table."""

    def _repr_html_(self) -> str:
        names = self.dtype.names
        if names is None or self.ndim != 1:
            return f"<pre>{html.escape(repr(self))}</pre>"
        head = "".join(f"<th>{name}</th>" for name in names)
        rows = "".join("<tr>" + "".join(f"<td>{_cell(row[name])}</td>" for name in names) + "</tr>"
                       for row in self)
        return f"<table><tr>{head}</tr>{rows}</table>"


def _cell(value: Any) -> str:
    return f"{value:.6g}" if isinstance(value, float) else html.escape(str(value))


class Order(Table):
    """The levels of an order study, a structured array, with what they show.

    claimed          the order of the method by its theory
    order            the fitted order, NaN if there is none, of the levels first to last
    settled, holds   whether it is the same all over these levels, and the claimed one
    floor, ceiling   errors outside are not fitted
    judge_error      error of the reference
    """

    claimed: int
    order: float
    first: int
    last: int
    settled: bool
    holds: bool
    floor: float
    ceiling: float
    judge_error: float

    def __array_finalize__(self, of: Any) -> None:
        for name in ("claimed", "order", "first", "last", "settled", "holds", "floor", "ceiling",
                     "judge_error"):
            setattr(self, name, getattr(of, name, None))

    def _repr_html_(self) -> str:
        if self.claimed is None or self.ndim != 1:
            return super()._repr_html_()
        said = "holds" if self.holds else "settled" if self.settled else "not settled"
        return f"<p>order {self.order:.2f}, claimed {self.claimed}: {said}</p>" + \
            super()._repr_html_()


def _runs(system: System, t_end: float, reference: ArrayLike | None, q: ArrayLike | None = None,
          v: ArrayLike | None = None, p: ArrayLike | None = None,
          t: float = 0.0) -> tuple[Any, dict[str, Array]]:
    """Return the struct of the runs, and the arrays that it points to."""
    start, kind, other = system._start_of(q, v, p)
    runs = ffi.new("dvi_study_runs *", {"size": ffi.sizeof("dvi_study_runs"), "t": t,
                                        "t_end": t_end})
    held = {"q": start, kind: other}
    if isinstance(reference, str):
        if reference != "ida":
            raise ValueError(f"the reference is q at t_end, 'ida' or None, not {reference!r}")
        runs.reference = 1
    elif reference is not None:
        held["end"] = vector(reference, system.nq, "reference")
    for name, array in held.items():
        setattr(runs, name, numbers(array))
    return runs, held


def check_on(system: System, status: int) -> None:
    """Raise what a callback of the system raised, or the exception of a status."""
    system.raise_failure()
    check(status)


def _evaluations(counters: Any) -> int:
    return counters.values + counters.gradients + counters.hessians


def order(system: System, method: str, h: float | None, t_end: float, levels: int = 5,
          reference: ArrayLike | None = None, ratio: float | None = None, **start: Any) -> Order:
    """Measure the order of a method by steps h, h/ratio and so on.

    h          None for a search for steps that show the order, which needs a reference
    ratio      default: 2, or that of the search
    reference  q at t_end, or "ida" for an independent integrator. Default: runs of neighbouring
               steps are compared
    start      q with v or p, and t. A scene has a start of its own
    Returns an `Order`: a table of h, steps, error, order, energy_error, seconds and evaluations.
    """
    runs, held = _runs(system, t_end, reference, **start)
    options = ffi.new("dvi_study_order_options *",
                      {"size": ffi.sizeof("dvi_study_order_options"), "h": abs(h or 0.0),
                       "ratio": ratio or 0.0, "levels": levels})
    found = ffi.new("dvi_study_level[]", max(levels, lib.DVI_STUDY_LEVELS_MAX))
    result = ffi.new("dvi_study_order_result *")
    specification = encoded(method, "the method")
    status = lib.dvi_study_order(system.pointer, specification, runs, options, found, result)
    check_on(system, status)
    del held
    rows = [(row.h, row.steps, row.error, row.slope or math.nan, row.energy_error, row.seconds,
             _evaluations(row.counters)) for row in found[0:result.levels]]
    table = np.array(rows, LEVEL).view(Order)
    for name in ("claimed", "first", "last", "floor", "ceiling", "judge_error"):
        setattr(table, name, getattr(result, name))
    table.order = result.order if result.first >= 0 else math.nan
    table.settled, table.holds = bool(result.settled), bool(result.holds)
    return table


def work(system: System, methods: Iterable[str], steps: Iterable[float], t_end: float,
         reference: ArrayLike | None = "ida", rounds: int = 3, **start: Any) -> dict[str, Table]:
    """Measure seconds against errors of several methods, in rounds over all of them.

    reference  q at t_end, or "ida" for an independent integrator
    Returns a dict of tables by method, with h, steps, error, the median and the quartiles of
    seconds, evaluations, and the status, DVI_OK where the run reached t_end. Other rows have NaN.
    """
    runs, held = _runs(system, t_end, reference, **start)
    if isinstance(methods, str):
        raise TypeError(f"methods is a list of methods, not {methods!r}")
    names = {method: ffi.new("char[]", encoded(method, "a method")) for method in methods}
    steps = [abs(h) for h in steps]
    listed = [(method, h) for method in names for h in steps]
    jobs = ffi.new("dvi_study_job[]", [{"method": names[method], "h": h} for method, h in listed])
    check_on(system, lib.dvi_study_work(system.pointer, runs, len(listed), jobs, rounds))
    del held
    made: dict[str, list[tuple[Any, ...]]] = {method: [] for method in names}
    for (method, _), job in zip(listed, jobs):
        made[method].append(_cost(job))
    return {method: np.array(rows, COST).view(Table) for method, rows in made.items()}


def _cost(job: Any) -> tuple[Any, ...]:
    status = ffi.string(lib.dvi_status_name(job.status)).decode()
    spread = (job.seconds.median, job.seconds.lower, job.seconds.upper)
    if job.status != lib.DVI_OK:
        return (job.h, 0, math.nan, math.nan, math.nan, math.nan, 0, status)
    return (job.h, job.counters.steps, job.error, *spread, _evaluations(job.counters), status)
