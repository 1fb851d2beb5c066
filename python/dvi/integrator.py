"""Single steps."""
import numpy as np

from dvi._dvi import ffi, lib
from dvi._library import Owned, numbers, text, vector
from dvi.errors import check
from dvi.recording import record


class Integrator:
    """A method with a state, of a system or a scene.

        integrator = dvi.Integrator(system, "galerkin:degree=4").start([1, 0], v=[0, 1])
        for _ in integrator.steps(0.05, 100): print(integrator.t, integrator.q)
    """

    def __init__(self, system, method):
        made = ffi.new("dvi_integrator **")
        check(lib.dvi_integrator_create(system.pointer, method.encode(), made))
        self._owned = Owned("integrator", made[0], system.owned)
        self.pointer, self.system = made[0], system

    def _check(self, status):
        self.system.raise_failure()
        check(status)

    def start(self, q=None, v=None, p=None, t=0.0):
        """Put the integrator at time t in q with v or p. A scene has a start of its own."""
        system = self.system
        if q is None:
            q, p = system.start()
        if (v is None) == (p is None):
            raise TypeError("a start needs q with either v or p")
        q = vector(q, system.nq, "q")
        if p is not None:
            p = vector(p, system.nv, "p")
            self._check(lib.dvi_integrator_start(self.pointer, t, numbers(q), numbers(p)))
        else:
            v = vector(v, system.nv, "v")
            self._check(lib.dvi_integrator_start_velocity(self.pointer, t, numbers(q),
                                                          numbers(v)))
        return self

    def step(self, h):
        """Take one step. After a failure the state is that before the step."""
        status = lib.dvi_integrator_step(self.pointer, h)
        if status != lib.DVI_OK:
            self._check(status)

    def steps(self, h, count=None):
        """Take steps without end, or `count`, and yield the integrator after each."""
        taken = 0
        while count is None or taken < count:
            self.step(h)
            taken += 1
            yield self

    def run(self, h, t_end, **options):
        """Run to t_end, and return the arrays of the run (`dvi.recording.record`)."""
        return record(self, h, t_end, **options)

    def at(self, t):
        """Return q and v of the last step's path at t."""
        q, v = np.empty(self.system.nq), np.empty(self.system.nv)
        self._check(lib.dvi_integrator_interpolate(self.pointer, t, numbers(q), numbers(v)))
        return q, v

    @property
    def t(self):
        """Return the time."""
        return lib.dvi_integrator_time(self.pointer)

    @property
    def q(self):
        """Return the coordinates, a new array."""
        return self._copy(lib.dvi_integrator_q(self.pointer), self.system.nq)

    @property
    def p(self):
        """Return the momenta, a new array."""
        return self._copy(lib.dvi_integrator_p(self.pointer), self.system.nv)

    @staticmethod
    def _copy(pointer, count):
        return np.frombuffer(ffi.buffer(pointer, 8 * count), dtype=float).copy()

    @property
    def invariants(self):
        """Return a dict of the invariants' values. The first is the energy."""
        value = np.empty(len(self.system.invariants))
        self._check(lib.dvi_integrator_invariants(self.pointer, numbers(value)))
        return dict(zip(self.system.invariants, value.tolist()))

    @property
    def method(self):
        """Return the full specification of the method."""
        return text(lib.dvi_integrator_method(self.pointer))

    @property
    def order(self):
        """Return the order of the method."""
        return lib.dvi_integrator_order(self.pointer)

    def explain(self):
        """Return which kernel, solver and sparsity the integrator chose, and why."""
        size = lib.dvi_integrator_explain(self.pointer, ffi.NULL, 0) + 1
        room = ffi.new("char[]", size)
        lib.dvi_integrator_explain(self.pointer, room, size)
        return text(room)

    def save(self):
        """Return the state as bytes. A restored run goes on with the same bits."""
        size = ffi.new("size_t *")
        lib.dvi_integrator_save_memory(self.pointer, ffi.NULL, 0, size)
        room = ffi.new("char[]", size[0])
        self._check(lib.dvi_integrator_save_memory(self.pointer, room, size[0], size))
        return bytes(ffi.buffer(room, size[0]))

    def restore(self, state):
        """Go on from a state that `save` returned."""
        self._check(lib.dvi_integrator_restore_memory(self.pointer, state, len(state)))
        return self

    def __reduce__(self):
        return _restored, (self.system, self.method, self.save())

    def __repr__(self):
        return f"<Integrator {self.method} at t = {self.t:g}>"


def _restored(system, method, state):
    return Integrator(system, method).restore(state)
