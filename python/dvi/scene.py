"""Scenes: systems that a file describes by expressions (docs/scenes.md)."""
import pathlib

import numpy as np

from dvi._dvi import ffi, lib
from dvi._library import Owned, text
from dvi.errors import error
from dvi.field import Field, March, Mesh, field_of, mesh_of
from dvi.integrator import Integrator
from dvi.recording import record
from dvi.system import System


# What a scene has once its system is made.
ADOPTED = ("pointer", "nq", "nv", "coordinates", "velocities", "momenta", "invariants")


class Scene(System):
    """A scene, with a system, a start and the plan of a run.

    parameters  numbers in place of those of the file, as in Scene("cart.yaml", l=0.2)
    """

    def __init__(self, path, **parameters):
        path = str(path)
        with open(path, encoding="utf-8") as file:
            self._read(path, file.read(), parameters)

    @classmethod
    def parse(cls, source, name="scene.yaml", **parameters):
        """Make a scene of a text."""
        made = cls.__new__(cls)
        made._read(name, source, parameters)
        return made

    def _read(self, name, source, parameters):
        self._keep, self._failure = [], None
        self._made_of = (name, source, parameters)
        settings = [ffi.new("char[]", f"{key}={value!r}".encode())
                    for key, value in parameters.items()]
        listed = ffi.new("char *[]", settings)
        scene, message, code = ffi.new("dvi_scene **"), ffi.new("char[]", 4096), source.encode()
        status = lib.dvi_scene_parse(name.encode(), code, len(code), len(settings), listed, scene,
                                     message, 4096)
        if status != lib.DVI_OK:
            raise error(status, text(message))
        self.scene, self.owned = scene[0], Owned("scene", scene[0])
        self._plan = lib.dvi_scene_plan_of(self.scene)
        self._adopted = False

    def __getattr__(self, name):
        """Make the system when it is first asked for: a grid for yee has none."""
        if name in ADOPTED and not self.__dict__.get("_adopted", True):
            self._adopted = True
            self._adopt_system()
            return getattr(self, name)
        raise AttributeError(f"a scene has no {name!r}")

    def _adopt_system(self):
        pointer = lib.dvi_scene_system(self.scene)
        if pointer == ffi.NULL:
            self._adopted = False
            raise error(lib.DVI_UNSUPPORTED)
        nq, nv = lib.dvi_system_nq(pointer), lib.dvi_system_nv(pointer)
        self._adopt(pointer, [text(lib.dvi_scene_coordinate(self.scene, i)) for i in range(nq)],
                    [text(lib.dvi_scene_velocity(self.scene, i)) for i in range(nv)],
                    [text(lib.dvi_scene_momentum(self.scene, i)) for i in range(nv)])

    @property
    def source(self):
        """Return the text of the scene."""
        return self._made_of[1]

    def start(self):
        """Return q and p of the scene's start."""
        q, v, p = (ffi.new("double **") for _ in range(3))
        lib.dvi_scene_start(self.scene, q, v, p)
        return np.array(ffi.unpack(q[0], self.nq)), np.array(ffi.unpack(p[0], self.nv))

    @property
    def parameters(self):
        """Return a dict of the parameters that are numbers."""
        found, i = {}, 0
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

    def march(self, method=None, h=0.0, fraction=0.0, threads=1) -> March:
        """Return a march of the scene's field at its start, by leapfrog, yee, avi or tents."""
        return March(self, method, h, fraction, threads)

    def _events(self):
        i = 0
        while (event := lib.dvi_scene_event_at(self.scene, i)) != ffi.NULL:
            yield text(event.name), {"name": event.name, "value": event.value,
                                     "user": event.user, "direction": event.direction,
                                     "terminal": event.terminal}
            i += 1

    def run(self, method=None, h=None, t_end=None, q=None, v=None, p=None, **options):
        """Run the scene as its file says, or by another method, step, end or start."""
        plan = self._plan
        method = method or text(plan.method)
        integrator = Integrator(self, method).start(q, v=v, p=p)
        options.setdefault("every", plan.every or 1)
        return record(integrator, plan.h if h is None else h,
                      plan.t_end if t_end is None else t_end, events=list(self._events()),
                      **options)

    def __reduce__(self):
        name, source, parameters = self._made_of
        return _parsed, (source, name, parameters)

    def __repr__(self):
        return f"<Scene {pathlib.Path(self._made_of[0]).stem}>"


def _parsed(source, name, parameters):
    return Scene.parse(source, name, **parameters)
