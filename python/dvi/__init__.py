"""Discrete variational mechanics: integrators that are stationary points of a discrete action.

    import dvi
    run = dvi.Scene("cart.yaml", l=0.2).run("galerkin:degree=4", h=0.05, t_end=20)
    run["theta"], run["energy"]
    run.plot("theta")

A system comes from a scene (`Scene`), from a Lagrangian of sympy (`System.of_lagrangian`) or from
callbacks (`System`). `run` records a whole run in arrays, `Integrator` takes single steps, and
`Ensemble` advances many members.
"""
from dvi._library import version
from dvi.ensemble import Ensemble
from dvi.errors import (BadArgument, CallbackFailed, Error, NotConverged, NotFinite, StepTooLarge,
                        Unsupported)
from dvi.field import Field, March, Mesh
from dvi.file import Rows, read
from dvi.integrator import Integrator
from dvi.paths import Path, path
from dvi.recording import Event, Run
from dvi.scene import Scene
from dvi.study import order, work
from dvi.sweeps import sweep, values
from dvi.system import System

__version__ = version()
__all__ = ["BadArgument", "CallbackFailed", "Ensemble", "Error", "Event", "Field", "Integrator",
           "March", "Mesh", "NotConverged", "NotFinite", "Path", "Rows", "Run", "Scene",
           "StepTooLarge", "System", "Unsupported", "order", "path", "read", "sweep", "values",
           "work"]
