"""Fields on meshes, as arrays: points and cells, matrices, modes, and marches in time."""
from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from dvi._dvi import ffi, lib
from dvi._library import Array, Owned, array, numbers, text
from dvi.errors import Unsupported, check, error
from dvi.recording import interrupts

if TYPE_CHECKING:
    from dvi.scene import Scene

FORMS = {"A": lib.DVI_FORM_A, "E": lib.DVI_FORM_E, "B": lib.DVI_FORM_B}
PARTS = {"A": lib.DVI_RECORD_A, "E": lib.DVI_RECORD_E, "B": lib.DVI_RECORD_B}
OPERATORS = {"mass": lib.DVI_FIELD_MASS, "stiffness": lib.DVI_FIELD_STIFFNESS}


def _sparse(matrix: Any) -> Any:
    """Return a matrix of scipy with copies of the library's numbers."""
    from scipy import sparse
    entries = lib.dvi_matrix_entries(matrix)
    start, index = np.empty(matrix.rows + 1, np.int32), np.empty(entries, np.int32)
    value = np.empty(entries)
    arrays = ffi.new("dvi_matrix_arrays *", {"start": ffi.cast("void *", ffi.from_buffer(start)),
                                             "index": ffi.cast("void *", ffi.from_buffer(index)),
                                             "value": numbers(value)})
    check(lib.dvi_matrix_copy(matrix, arrays))
    return sparse.csr_matrix((value, index, start), shape=(matrix.rows, matrix.columns))


class Mesh:
    """The mesh of a scene.

    points  [vertices, space], without a copy
    """

    def __init__(self, pointer: Any, owner: Owned) -> None:
        self.pointer, self._owner = pointer, owner
        self.dimension: int = lib.dvi_mesh_dimension(pointer)
        points = ffi.cast("double *", lib.dvi_mesh_points(pointer))
        self.points = array(points, (self.count(0), lib.dvi_mesh_space(pointer)), owner)

    def count(self, k: int) -> int:
        """Return the number of k-cells."""
        return lib.dvi_mesh_count(self.pointer, k)

    def cells(self, k: int | None = None) -> np.ndarray:
        """Return the vertices of the k-cells [count, width], by default of the largest k."""
        k, width = self.dimension if k is None else k, ffi.new("int *")
        given = lib.dvi_mesh_vertices(self.pointer, k, width)
        if given == ffi.NULL:
            raise ValueError(f"a mesh of dimension {self.dimension} has no list of {k}-cells")
        count = self.count(k) * width[0]
        return np.frombuffer(ffi.buffer(given, 4 * count), np.int32).reshape(-1, width[0]).copy()

    def incidence(self, k: int) -> Any:
        """Return the incidence of (k+1)-cells and k-cells, a sparse matrix of scipy."""
        matrix = ffi.new("dvi_matrix *")
        check(lib.dvi_mesh_incidence(self.pointer, k, matrix))
        return _sparse(matrix)

    def part(self, name: str, k: int) -> np.ndarray:
        """Return the numbers of the k-cells of a named part."""
        count = ffi.new("int64_t *")
        cells = lib.dvi_mesh_part_cells(self.pointer, name.encode(), k, count)
        if cells == ffi.NULL:
            raise KeyError(f"the mesh has no part {name!r} of {k}-cells")
        return np.frombuffer(ffi.buffer(cells, 4 * count[0]), np.int32).copy()

    def __repr__(self) -> str:
        counts = ", ".join(f"{self.count(k)} {k}-cells" for k in range(self.dimension + 1))
        return f"<Mesh: {counts}>"


class Field:
    """The field of a scene. Its unknowns are the values at k-cells that are not fixed."""

    def __init__(self, pointer: Any, mesh: Mesh, owner: Owned) -> None:
        self.pointer, self.mesh, self._owner = pointer, mesh, owner
        self.degree: int = lib.dvi_field_degree(pointer)
        count = ffi.new("int64_t *")
        cells = lib.dvi_field_unknowns(pointer, count)
        self.unknowns = np.frombuffer(ffi.buffer(cells, 4 * count[0]), np.int32).copy()

    def matrix(self, name: str) -> Any:
        """Return "mass" or "stiffness", a sparse matrix of scipy by unknowns."""
        matrix = ffi.new("dvi_matrix *")
        check(lib.dvi_field_matrix(self.pointer, OPERATORS[name], matrix))
        return _sparse(matrix)

    def lift(self, q: ArrayLike) -> np.ndarray:
        """Return the values at all k-cells [.., cells] of unknowns q [.., unknowns]."""
        q = np.ascontiguousarray(q, dtype=float)
        if q.shape[-1:] != (len(self.unknowns),):
            raise ValueError(f"q has the shape {q.shape}; (.., {len(self.unknowns)}) is needed")
        u = np.empty(q.shape[:-1] + (self.mesh.count(self.degree),))
        rows, lifted = q.reshape(-1, q.shape[-1]), u.reshape(-1, u.shape[-1])
        for row, to in zip(rows, lifted):
            check(lib.dvi_field_lift(self.pointer, numbers(row), numbers(to)))
        return u

    def modes(self, count: int = 6) -> tuple[np.ndarray, np.ndarray]:
        """Return angular frequencies [count], ascending, and modes [count, cells]."""
        eigenvalue, mode = np.empty(count), np.empty((count, self.mesh.count(self.degree)))
        options = ffi.new("dvi_modes_options *", {"size": ffi.sizeof("dvi_modes_options"),
                                                  "count": count})
        check(lib.dvi_field_modes(self.pointer, options, numbers(eigenvalue), numbers(mode),
                                  ffi.NULL))
        return np.sqrt(eigenvalue), mode

    def solve(self) -> np.ndarray:
        """Return the static state at all vertices."""
        u = np.zeros(self.mesh.count(self.degree))
        check(lib.dvi_field_solve(self.pointer, ffi.NULL, numbers(u), ffi.NULL))
        return u

    def __repr__(self) -> str:
        return f"<Field: {len(self.unknowns)} unknowns on {self.degree}-cells>"


class March:
    """A field of a scene that advances by a method of its own: leapfrog, yee, avi, tents."""

    def __init__(self, scene: Scene, method: str | None = None, h: float = 0.0,
                 fraction: float = 0.0, threads: int = 1) -> None:
        options = ffi.new("dvi_march_options *", {"size": ffi.sizeof("dvi_march_options"),
                                                  "step": h, "fraction": fraction,
                                                  "threads": threads})
        name = ffi.NULL if method is None else ffi.new("char[]", method.encode())
        options.method = name
        made = ffi.new("dvi_march **")
        check(lib.dvi_scene_march_create(scene.scene, options, made))
        self._owned = Owned("march", made[0], scene.owned, threads)
        self.pointer, self.scene = made[0], scene

    @property
    def t(self) -> float:
        """Return the time."""
        return lib.dvi_march_time(self.pointer)

    def advance(self, t: float) -> March:
        """Let all happen that happens up to the time t."""
        check(lib.dvi_march_advance(self.pointer, t))
        return self

    def __getitem__(self, form: str) -> np.ndarray:
        """Return the form "A", "E" or "B" on its cells, a new array."""
        values = np.empty(lib.dvi_march_size(self.pointer, FORMS[form]))
        check(lib.dvi_march_sample(self.pointer, FORMS[form], 0, ffi.NULL, numbers(values)))
        return values

    def vectors(self, form: str) -> np.ndarray:
        """Return E or B as vectors in the cells of the mesh [cells, 3]."""
        mesh = self.scene.mesh
        values = np.empty((mesh.count(mesh.dimension), 3))
        check(lib.dvi_scene_vectors(self.scene.scene, self.pointer, FORMS[form], numbers(values)))
        return values

    @property
    def observables(self) -> dict[str, float]:
        """Return what can be observed at the march's time: the energy, probes and so on."""
        found, value, i = {}, ffi.new("double *"), 0
        while (name := lib.dvi_march_observable(self.pointer, i)) != ffi.NULL:
            check(lib.dvi_march_observe(self.pointer, i, value))
            found[text(name)] = value[0]
            i += 1
        return found

    def record(self, t_end: float, every: float = 0.0, times: ArrayLike | None = None,
               forms: Iterable[str] | dict[str, Any] = ()) -> dict[str, Array]:
        """Advance to t_end, and return arrays by name: "t", forms and observables.

        every  time between two rows. times  the times of the rows in place of that
        forms  some of A, E and B [rows, cells], or a dict of a form's chosen cells (None for all)
        """
        options = ffi.new("dvi_march_record_options *", {
            "size": ffi.sizeof("dvi_march_record_options"), "t_end": t_end, "every": every,
            "parts": lib.DVI_RECORD_OBSERVABLES})
        if times is not None:
            times = np.ascontiguousarray(times, dtype=float)
            options.times, options.time_count = numbers(times), len(times)
        kept = []
        for form, cells in (forms if isinstance(forms, dict) else dict.fromkeys(forms)).items():
            options.parts |= PARTS[form]
            if cells is not None:
                kept.append(ffi.new("int[]", [int(cell) for cell in cells]))
                options.cell[FORMS[form]] = kept[-1]
                options.cell_count[FORMS[form]] = len(cells)
        made, interrupted = ffi.new("dvi_recording **"), ffi.new("int *", interrupts())
        status = lib.interruptible_march(self.pointer, options, made, interrupted)
        failure = error(status) if status != lib.DVI_OK else None
        rows = self._rows(made[0]) if made[0] != ffi.NULL else None
        if interrupted[0]:
            raise KeyboardInterrupt
        if failure is not None:
            failure.run = rows  # what was recorded before the failure
            raise failure
        return rows

    def _rows(self, recording: Any) -> dict[str, Array]:
        """Return the arrays of a recording, without copies."""
        owner, count = Owned("recording", recording), lib.dvi_recording_rows(recording)
        found, width, i = {}, ffi.new("int *"), 0
        for name, part in [("t", lib.DVI_RECORD_T), *PARTS.items(),
                           (None, lib.DVI_RECORD_OBSERVABLES)]:
            pointer = lib.dvi_recording_part(recording, part, width)
            if pointer != ffi.NULL:
                found[name] = array(ffi.cast("double *", pointer), (count, width[0]), owner)
        found["t"], observed = found["t"][:, 0], found.pop(None)
        while (name := lib.dvi_march_observable(self.pointer, i)) != ffi.NULL:
            found[text(name)] = observed[:, i]
            i += 1
        return found

    def save(self) -> bytes:
        """Return the state as bytes. A restored march goes on with the same bits."""
        size = ffi.new("size_t *")
        check(lib.dvi_march_save_memory(self.pointer, ffi.NULL, 0, size))
        room = ffi.new("char[]", size[0])
        check(lib.dvi_march_save_memory(self.pointer, room, size[0], size))
        return bytes(ffi.buffer(room, size[0]))

    def restore(self, state: bytes) -> March:
        """Go on from a state that `save` returned."""
        check(lib.dvi_march_load_memory(self.pointer, state, len(state)))
        return self

    def __repr__(self) -> str:
        return f"<March at t = {self.t:g}>"


def mesh_of(scene: Scene) -> Mesh:
    """Return the mesh of a scene."""
    pointer = lib.dvi_scene_mesh(scene.scene)
    if pointer == ffi.NULL:
        raise Unsupported(f"{scene!r} has no mesh")
    return Mesh(pointer, scene.owned)


def field_of(scene: Scene) -> Field:
    """Return the field of a scene."""
    pointer = lib.dvi_scene_field(scene.scene)
    if pointer == ffi.NULL:
        raise Unsupported(f"{scene!r} has no field on a mesh")
    return Field(pointer, mesh_of(scene), scene.owned)
