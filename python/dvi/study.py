"""Studies of methods: convergence, and work against precision."""
import time

import numpy as np

from dvi.integrator import Integrator

KIND = np.dtype([("h", float), ("error", float), ("order", float), ("seconds", float)])


def _end(system, method, h, t_end, start):
    integrator = Integrator(system, method)
    integrator.start(**start)
    begun = time.process_time()
    integrator.run(h, t_end, every=2**62, parts=("q", "p"))
    return integrator.q, time.process_time() - begun


def order(system, method, h, t_end, levels=5, reference=None, **start):
    """Measure the order of a method by halved steps.

    reference  q at t_end. Default: that of twice as high a degree at the smallest step is not
               known to the library, so runs of neighbouring steps are compared
    Returns a table with h, error, order and seconds.
    """
    ends = [_end(system, method, h / 2**k, t_end, start) for k in range(levels + (reference is None))]
    errors = [np.max(np.abs(q - (reference if reference is not None else ends[k + 1][0])))
              for k, (q, _) in enumerate(ends[:levels])]
    table = np.zeros(levels, KIND)
    table["h"] = h / 2.0**np.arange(levels)
    table["error"], table["seconds"] = errors, [seconds for _, seconds in ends[:levels]]
    table["order"][0] = np.nan
    table["order"][1:] = np.log2(table["error"][:-1] / table["error"][1:])
    return table


def work(system, methods, steps, t_end, reference, **start):
    """Measure seconds against errors of several methods. Returns a dict of tables by method."""
    made = {}
    for method in methods:
        table = np.zeros(len(steps), KIND)
        table["h"] = steps
        for row in table:
            q, row["seconds"] = _end(system, method, row["h"], t_end, start)
            row["error"] = np.max(np.abs(q - reference))
        table["order"] = np.nan
        made[method] = table
    return made
