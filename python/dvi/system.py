"""Systems: what moves, by callbacks or by a Lagrangian of sympy."""
from __future__ import annotations

import html
import threading
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from numpy.typing import ArrayLike

from dvi import _sympy
from dvi._callbacks import Callbacks
from dvi._dvi import ffi, lib
from dvi._library import Array, Owned, text, vector
from dvi.errors import check
from dvi.recording import Run, record

if TYPE_CHECKING:
    from dvi.scene import Scene

Callback = Any  # a function of Python, or the address of one of C


class System:
    """A mechanical system L = v.M v/2 - V(t,q), or L(t,q,v), by callbacks.

    potential, gradient   V(t, q) -> float, V_q(t, q) -> array. A gradient that is left out is
                          differenced
    hessian, pattern      V_qq(t, q) -> array [n, n] or sparse matrix, or the entries of a sparse
                          pattern of scipy by columns. Left out, it is differenced
    forces                F(t, q, v) -> array, outside of the Lagrangian
    mass                  a number, a vector of diagonal entries, or a symmetric matrix (also of
                          scipy.sparse). Default: 1
    lagrangian            L(t, q, v) -> float in place of potential and mass
    names                 of the coordinates. Default: q1, q2, ..
    autonomous            True if no callback depends on t
    constraints, jacobian phi(t, q) -> array [constraint_count] that stays 0, and its derivatives
                          phi_q(t, q) -> array [constraint_count, n]
    invariants            a dict of functions I(t, q, p) -> float by names, for columns of runs

    A callback is a function of Python, or the address of a function of C (a `cfunc` of numba, an
    int, a pointer of cffi or ctypes) with the signature of dvi/system.h. Those of C cost nothing.
    Arrays that a function of Python gets are copies, which it may keep and not change.
    An exception of a callback is raised again by the call that needed it.

    nq, nv                the numbers of coordinates, and of velocities and momenta
    coordinates, velocities, momenta    their names
    """

    def __init__(self, n: int | None = None, potential: Callback = None, gradient: Callback = None,
                 mass: Any = None, lagrangian: Callback = None, names: Iterable[str] | None = None,
                 autonomous: bool = False, hessian: Callback = None, pattern: Any = None,
                 forces: Callback = None, constraints: Callback = None, jacobian: Callback = None,
                 constraint_count: int = 1,
                 invariants: Mapping[str, Callback] | None = None) -> None:
        names = None if names is None else [str(name) for name in names]
        self._given = {key: given for key, given in locals().items()
                       if key not in ("self", "__class__")}
        _refuse_pairs(self._given)
        n = _dimension(n, names)
        self._begin()
        of = Callbacks(n, self._failures)
        terms = of.new("dvi_system_terms *")
        terms.dimension, terms.autonomous = n, autonomous
        if potential is not None:
            terms.potentials, terms.potential_count = of.potential(potential, gradient), 1
            of.set_hessian(terms.potentials, hessian, pattern)
            of.set_mass(terms.mass, 1.0 if mass is None else mass)
        else:
            terms.lagrangian = of.lagrangian(lagrangian)
        if forces is not None:
            terms.forces, terms.force_count = of.forces(forces), 1
        if constraints is not None:
            terms.holonomics = of.holonomic(constraints, jacobian, constraint_count)
            terms.holonomic_count = 1
        if invariants:
            terms.invariants, terms.invariant_count = of.invariants(invariants), len(invariants)
        made = ffi.new("dvi_system **")
        check(lib.dvi_system_create(terms, made))
        self._keep, self.owned = of.keep, Owned("system", made[0])
        self._adopt(made[0], names or [f"q{i + 1}" for i in range(n)])

    @classmethod
    def of_lagrangian(cls, lagrangian: Any, coordinates: Sequence[Any], time: Any = None,
                      **parameters: float) -> Scene:
        """Make a system of a Lagrangian of sympy.

        coordinates  functions x(t) of sympy, in the order of the state. L has their derivatives
        time         the symbol of the time. Default: the argument of the coordinates
        parameters   numbers for the other symbols of L, by their names
        Returns a `Scene` without a start, a step and an end of its own. Raises TypeError for a
        symbol without a number, and for a number without a symbol.
        """
        from dvi.scene import Scene
        made = Scene.parse(_sympy.scene(lagrangian, coordinates, time, parameters))
        made._is_planned = False
        return made

    def _method(self) -> str:
        raise TypeError("a system has no method of its own; give one")

    def _begin(self) -> None:
        self._failures: dict[int, BaseException] = {}

    def _adopt(self, pointer: Any, names: list[str], velocities: list[str] | None = None,
               momenta: list[str] | None = None) -> None:
        self.pointer = pointer
        self.nq: int = lib.dvi_system_nq(pointer)
        self.nv: int = lib.dvi_system_nv(pointer)
        self.coordinates = list(names)
        self.velocities = velocities or [f"v_{name}" for name in names]
        self.momenta = momenta or [f"p_{name}" for name in names]
        count = lib.dvi_system_invariant_count(pointer)
        self.invariants: list[str] = [text(lib.dvi_system_invariant_name(pointer, i))
                                      for i in range(count)]

    def raise_failure(self, of_any_thread: bool = False) -> None:
        """Raise what a callback of Python has raised on this thread, or on any."""
        if not self._failures:
            return
        failure = self._failures.pop(threading.get_ident(), None)
        if failure is None and of_any_thread and self._failures:
            failure = self._failures.popitem()[1]
        if failure is not None:
            raise failure

    def _start_of(self, q: ArrayLike | None, v: ArrayLike | None,
                  p: ArrayLike | None) -> tuple[Array, str, Array]:
        """Return a start q, and with it "v" or "p" and the vector of that."""
        if q is None or (v is None) == (p is None):
            raise TypeError("a start needs q with either v or p")
        name, given = ("v", v) if p is None else ("p", p)
        assert given is not None
        return vector(q, self.nq, "q"), name, vector(given, self.nv, name)

    def run(self, method: str, h: float, t_end: float, q: ArrayLike | None = None,
            v: ArrayLike | None = None, p: ArrayLike | None = None, t: float = 0.0,
            every: int | None = None, times: ArrayLike | None = None,
            parts: Iterable[str] = ("q", "p"),
            events: Mapping[str, Callable[..., float]] | None = None) -> Run:
        """Run from q [nq] with v or p [nv] at the time t, and return the `Run`.

        h, t_end              the step, or the first one, and the end
        every, times, parts, events    as of `dvi.recording.record`, which tells the errors, too
        """
        from dvi.integrator import Integrator
        integrator = Integrator(self, method)
        integrator.start(q, v=v, p=p, t=t)
        return record(integrator, h, t_end, every, times, parts, events)

    def __reduce__(self) -> Any:
        return _made, (type(self), self._given)

    def __repr__(self) -> str:
        return f"{type(self).__name__}({', '.join(self.coordinates)})"

    def _repr_html_(self) -> str:
        """Return a table of the names, for notebooks."""
        return f"<p>{html.escape(repr(self))}</p>" + names_table(self)


def _made(kind: type[System], given: dict[str, Any]) -> System:
    return kind(**given)


def names_table(system: System) -> str:
    """Return the names of a system's columns as a table of HTML."""
    parts = ("coordinates", "velocities", "momenta", "invariants")
    rows = "".join(f"<tr><th>{part}</th><td>{html.escape(_shortened(getattr(system, part)))}"
                   "</td></tr>" for part in parts)
    return f"<table>{rows}</table>"


def _shortened(names: list[str]) -> str:
    return ", ".join(names if len(names) <= 12 else names[:6] + ["…"] + names[-1:])


def _refuse_pairs(given: Mapping[str, Any]) -> None:
    """Raise TypeError if one of the arguments would be ignored."""
    if (given["potential"] is None) == (given["lagrangian"] is None):
        raise TypeError("a system needs either a potential or a lagrangian")
    for name in ("gradient", "hessian", "pattern", "mass"):
        if given["lagrangian"] is not None and given[name] is not None:
            raise TypeError(f"{name} belongs to a potential; a lagrangian has none")
    if (given["constraints"] is None) != (given["jacobian"] is None):
        raise TypeError("constraints and jacobian belong together")


def _dimension(n: int | None, names: list[str] | None) -> int:
    """Return the number of coordinates, or complain about it or their names."""
    if n is None and names is None:
        raise TypeError("a system needs n, the number of its coordinates, or their names")
    if n is not None and names is not None and n != len(names):
        raise ValueError(f"{n} coordinates have {len(names)} names")
    if names is not None and len(set(names)) < len(names):
        raise ValueError(f"two coordinates have one name: {', '.join(names)}")
    return n if n is not None else len(names or [])
