"""Studies: the order of methods, and their time against their error."""
import math

import numpy as np

from dvi._dvi import ffi, lib
from dvi._library import numbers, vector
from dvi.errors import check

LEVEL = np.dtype([("h", float), ("steps", np.int64), ("error", float), ("order", float),
                  ("energy_error", float), ("seconds", float), ("evaluations", np.int64)])
COST = np.dtype([("h", float), ("steps", np.int64), ("error", float), ("seconds", float),
                 ("lower", float), ("upper", float), ("evaluations", np.int64),
                 ("status", "U24")])


class Table(np.ndarray):
    """A structured array that notebooks show as a table."""

    def _repr_html_(self):
        names = self.dtype.names
        if names is None or self.ndim != 1:
            return f"<pre>{self!r}</pre>"
        head = "".join(f"<th>{name}</th>" for name in names)
        rows = "".join("<tr>" + "".join(f"<td>{_cell(row[name])}</td>" for name in names) + "</tr>"
                       for row in self)
        return f"<table>{head}{rows}</table>"


def _cell(value):
    return f"{value:.6g}" if isinstance(value, float) else str(value)


class Order(Table):
    """The levels of an order study, a structured array, with what they show.

    claimed          the order of the method by its theory
    order            the fitted order, NaN if there is none, of the levels first to last
    settled, holds   whether it is the same all over these levels, and the claimed one
    floor, ceiling   errors outside are not fitted
    judge_error      error of the reference
    """

    def __array_finalize__(self, of):
        for name in ("claimed", "order", "first", "last", "settled", "holds", "floor", "ceiling",
                     "judge_error"):
            setattr(self, name, getattr(of, name, None))

    def _repr_html_(self):
        if self.claimed is None or self.ndim != 1:
            return super()._repr_html_()
        said = "holds" if self.holds else "settled" if self.settled else "not settled"
        return f"<p>order {self.order:.2f}, claimed {self.claimed}: {said}</p>" + \
            super()._repr_html_()


def _runs(system, t_end, reference, q=None, v=None, p=None, t=0.0):
    """Return the struct of the runs, and the arrays that it points to."""
    if q is None:
        q, p = system.start()
    if (v is None) == (p is None):
        raise TypeError("a start needs q with either v or p")
    runs = ffi.new("dvi_study_runs *", {"size": ffi.sizeof("dvi_study_runs"), "t": t,
                                        "t_end": t_end})
    held = {"q": vector(q, system.nq, "q")}
    held.update({"p": vector(p, system.nv, "p")} if v is None else
                {"v": vector(v, system.nv, "v")})
    if isinstance(reference, str):
        if reference != "ida":
            raise ValueError(f"the reference is q at t_end, 'ida' or None, not {reference!r}")
        runs.reference = 1
    elif reference is not None:
        held["end"] = vector(reference, system.nq, "reference")
    for name, array in held.items():
        setattr(runs, name, numbers(array))
    return runs, held


def check_on(system, status):
    """Raise what a callback of the system raised, or the exception of a status."""
    system.raise_failure()
    check(status)


def _evaluations(counters):
    return counters.values + counters.gradients + counters.hessians


def order(system, method, h, t_end, levels=5, reference=None, ratio=2.0, **start):
    """Measure the order of a method by steps h, h/ratio and so on.

    reference  q at t_end, or "ida" for an independent integrator. Default: runs of neighbouring
               steps are compared
    start      q with v or p, and t. A scene has a start of its own
    Returns an `Order`: a table of h, steps, error, order, energy_error, seconds and evaluations.
    """
    runs, held = _runs(system, t_end, reference, **start)
    options = ffi.new("dvi_study_order_options *",
                      {"size": ffi.sizeof("dvi_study_order_options"), "h": abs(h),
                       "ratio": ratio, "levels": levels})
    found = ffi.new("dvi_study_level[]", max(levels, lib.DVI_STUDY_LEVELS_MAX))
    result = ffi.new("dvi_study_order_result *")
    status = lib.dvi_study_order(system.pointer, method.encode(), runs, options, found, result)
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


def work(system, methods, steps, t_end, reference="ida", rounds=3, **start):
    """Measure seconds against errors of several methods, in rounds over all of them.

    reference  q at t_end, or "ida" for an independent integrator
    Returns a dict of tables by method, with h, steps, error, the median and the quartiles of
    seconds, evaluations, and the status, DVI_OK where the run reached t_end. Other rows have NaN.
    """
    runs, held = _runs(system, t_end, reference, **start)
    names = {method: ffi.new("char[]", method.encode()) for method in methods}
    listed = [(method, abs(h)) for method in names for h in steps]
    jobs = ffi.new("dvi_study_job[]", [{"method": names[method], "h": h} for method, h in listed])
    check_on(system, lib.dvi_study_work(system.pointer, runs, len(listed), jobs, rounds))
    del held
    made = {method: [] for method in names}
    for (method, _), job in zip(listed, jobs):
        made[method].append(_cost(job))
    return {method: np.array(rows, COST).view(Table) for method, rows in made.items()}


def _cost(job):
    status = ffi.string(lib.dvi_status_name(job.status)).decode()
    spread = (job.seconds.median, job.seconds.lower, job.seconds.upper)
    if job.status != lib.DVI_OK:
        return (job.h, 0, math.nan, math.nan, math.nan, math.nan, 0, status)
    return (job.h, job.counters.steps, job.error, *spread, _evaluations(job.counters), status)
