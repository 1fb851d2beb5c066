"""Scenes: systems that a file describes by expressions (docs/scenes.md)."""
from __future__ import annotations

import html
import os
import pathlib
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from dvi._dvi import ffi, lib
from dvi._library import Array, Owned, encoded, text
from dvi.errors import Unsupported, error
from dvi.field import Field, March, Mesh, field_of, mesh_of
from dvi.integrator import Integrator
from dvi.recording import Run, record
from dvi.system import System, names_table

# What a scene has once its system is made.
ADOPTED = ("pointer", "nq", "nv", "coordinates", "velocities", "momenta", "invariants")


class Scene(System):
    """A scene, with a system, a start and the plan of a run.

    path        of its file. OSError if it cannot be read, `BadArgument` if it makes no sense
    parameters  numbers in place of those of the file, as in Scene("cart.yaml", l=0.2)
    """

    def __init__(self, path: str | os.PathLike[str], **parameters: float) -> None:
        path = os.fspath(path)
        with open(path, encoding="utf-8") as file:
            self._read(path, file.read(), parameters)

    @classmethod
    def parse(cls, source: str, name: str = "scene.yaml", **parameters: float) -> Scene:
        """Make a scene of a text. `name` stands for its path, also in messages."""
        made = cls.__new__(cls)
        made._read(name, source, parameters)
        return made

    def _read(self, name: str, source: str, parameters: dict[str, float]) -> None:
        self._begin()
        self._made_of = (name, source, parameters)
        settings = [ffi.new("char[]", encoded(f"{key}={_setting(value)}", "a parameter"))
                    for key, value in parameters.items()]
        listed = ffi.new("char *[]", settings)
        code = source.encode()
        scene, message = ffi.new("dvi_scene **"), ffi.new("char[]", 4096)
        status = lib.dvi_scene_parse(encoded(name, "the path"), code, len(code), len(settings),
                                     listed, scene, message, 4096)
        if status != lib.DVI_OK:
            raise error(status, text(message))
        self.scene, self.owned = scene[0], Owned("scene", scene[0])
        self._plan = lib.dvi_scene_plan_of(self.scene)
        self._is_planned, self._adopted = True, False

    def __getattr__(self, name: str) -> Any:
        """Make the system when it is first asked for: a grid for yee has none."""
        if name in ADOPTED and not self.__dict__.get("_adopted", True):
            self._adopted = True
            self._adopt_system()
            return getattr(self, name)
        raise AttributeError(f"a scene has no {name!r}")

    def _adopt_system(self) -> None:
        pointer = lib.dvi_scene_system(self.scene)
        if pointer == ffi.NULL:
            self._adopted = False
            raise error(lib.DVI_UNSUPPORTED)
        nq, nv = lib.dvi_system_nq(pointer), lib.dvi_system_nv(pointer)
        self._adopt(pointer, [text(lib.dvi_scene_coordinate(self.scene, i)) for i in range(nq)],
                    [text(lib.dvi_scene_velocity(self.scene, i)) for i in range(nv)],
                    [text(lib.dvi_scene_momentum(self.scene, i)) for i in range(nv)])

    @property
    def source(self) -> str:
        """Return the text of the scene."""
        return self._made_of[1]

    @property
    def title(self) -> str | None:
        """Return the title, None without one."""
        return text(self._plan.title)

    @property
    def method(self) -> str | None:
        """Return the method that the scene names, None without one."""
        return text(self._plan.method)

    def start(self) -> tuple[Array, Array]:
        """Return q [nq] and p [nv] of the scene's start."""
        q, v, p = (ffi.new("double **") for _ in range(3))
        lib.dvi_scene_start(self.scene, q, v, p)
        return np.array(ffi.unpack(q[0], self.nq)), np.array(ffi.unpack(p[0], self.nv))

    def _start_of(self, q: ArrayLike | None, v: ArrayLike | None,
                  p: ArrayLike | None) -> tuple[Array, str, Array]:
        if q is None and v is None and p is None and self._is_planned:
            start = self.start()
            return start[0], "p", start[1]
        return super()._start_of(q, v, p)

    @property
    def parameters(self) -> dict[str, float]:
        """Return a dict of the parameters that are numbers."""
        found: dict[str, float] = {}
        i = 0
        while (parameter := lib.dvi_scene_parameter_at(self.scene, i)) != ffi.NULL:
            if parameter.settable:
                found[text(parameter.name)] = parameter.value
            i += 1
        return found

    @property
    def mesh(self) -> Mesh:
        """Return the mesh of a scene with a field."""
        return mesh_of(self)

    @property
    def field(self) -> Field:
        """Return the field of a scene with a mesh. Its unknowns are the coordinates."""
        return field_of(self)

    def march(self, method: str | None = None, h: float = 0.0, fraction: float = 0.0,
              threads: int = 1) -> March:
        """Return a march of the scene's field at its start, by leapfrog, yee, avi or tents.

        h, fraction  the step, or its fraction of the longest stable one. Default: the scene's
        """
        return March(self, method, h, fraction, threads)

    def _events(self) -> Iterator[tuple[str, dict[str, Any]]]:
        i = 0
        while (event := lib.dvi_scene_event_at(self.scene, i)) != ffi.NULL:
            yield text(event.name), {"name": event.name, "value": event.value,
                                     "user": event.user, "direction": event.direction,
                                     "terminal": event.terminal}
            i += 1

    def _method(self) -> str:
        if self.method is None:
            raise TypeError(f"{self!r} names no method; give one")
        return self.method

    def _refuse_march(self, method: str) -> None:
        """Raise `Unsupported` for a method that advances a field without a system."""
        if lib.dvi_scene_marches(self.scene, encoded(method, "the method")):
            raise Unsupported(f"{method!r} is a march of a field, which run does not record: "
                              f"scene.march({method!r}) makes it, march.advance(t) advances it, "
                              "and march[\"E\"] and march.observables show it")

    def run(self, method: str | None = None, h: float | None = None, t_end: float | None = None,
            q: ArrayLike | None = None, v: ArrayLike | None = None, p: ArrayLike | None = None,
            t: float = 0.0, every: int | None = None, times: ArrayLike | None = None,
            parts: Iterable[str] = ("q", "p"),
            events: Mapping[str, Callable[..., float]] | None = None) -> Run:
        """Run the scene as its file says, or by another method, step, end or start.

        q, v, p               another start at the time t, q [nq] with v or p [nv]
        every, times, parts   as of `dvi.recording.record`, which tells the errors, too
        events                beside those of the scene
        """
        plan, method = self._plan, self._method() if method is None else method
        self._refuse_march(method)
        if not self._is_planned and (h is None or t_end is None):
            raise TypeError("a Lagrangian has no step and no end; give h and t_end")
        integrator = Integrator(self, method).start(q, v=v, p=p, t=t)
        if every is None and times is None:
            every = plan.every
        return record(integrator, plan.h if h is None else h,
                      plan.t_end if t_end is None else t_end, every, times, parts, events,
                      list(self._events()))

    def __reduce__(self) -> Any:
        name, source, parameters = self._made_of
        return _parsed, (source, name, parameters, self._is_planned)

    def __repr__(self) -> str:
        return f"<Scene {pathlib.Path(self._made_of[0]).stem}>"

    def _repr_html_(self) -> str:
        """Return title, parameters, names and plan as tables, for notebooks."""
        plan, numbers = self._plan, ", ".join(f"{k} = {x:g}" for k, x in self.parameters.items())
        rows = [("parameters", numbers), ("method", self.method or "")]
        if self._is_planned:
            rows += [("step", f"{plan.h or plan.fraction:g}"), ("until", f"{plan.t_end:g}")]
        cells = "".join(f"<tr><th>{name}</th><td>{html.escape(said)}</td></tr>"
                        for name, said in rows if said)
        head = html.escape(f"{self!r} {self.title or ''}".strip())
        try:
            return f"<p>{head}</p><table>{cells}</table>{names_table(self)}"
        except Unsupported:  # a grid for yee has no coordinates
            return f"<p>{head}</p><table>{cells}</table>"


def _setting(value: Any) -> str:
    """Return a number as the library reads it, or complain."""
    try:
        return repr(float(value))
    except (TypeError, ValueError):
        raise TypeError(f"a parameter is a number, not {value!r}") from None


def _parsed(source: str, name: str, parameters: dict[str, float], is_planned: bool) -> Scene:
    made = Scene.parse(source, name, **parameters)
    made._is_planned = is_planned
    return made
