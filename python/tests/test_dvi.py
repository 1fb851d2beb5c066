"""The package gives the library's numbers, and its sentences."""
import os
import pathlib
import pickle
import subprocess

import numpy as np
import pytest

import dvi

SCENES = pathlib.Path(__file__).resolve().parents[2] / "apps" / "scenes"
METHOD = "galerkin:degree=4"


@pytest.fixture
def kepler():
    return dvi.Scene(SCENES / "kepler.yaml", e=0.3)


def gravity():
    return dvi.System(2, potential=lambda t, q: -1 / np.hypot(*q),
                      gradient=lambda t, q: q / np.hypot(*q)**3)


def test_columns_have_names(kepler):
    run = kepler.run(METHOD, h=0.05, t_end=1)
    assert run.columns[:3] == ["t", "x", "y"]
    assert np.shares_memory(run["x"], run.q)
    assert run["energy"][0] == pytest.approx(-0.5, abs=1e-15)
    with pytest.raises(KeyError, match="there is no column 'z'; there are t, x, y"):
        run["z"]


def test_a_run_has_the_bits_of_its_steps(kepler):
    run = kepler.run(METHOD, h=0.0625, t_end=1, every=4)
    integrator = dvi.Integrator(kepler, METHOD).start()
    q = [integrator.q] + [integrator.q for _ in integrator.steps(0.0625, 16)]
    assert np.array_equal(run.q, np.array(q)[::4])


def test_rows_at_given_times(kepler):
    times = np.linspace(0, 1, 7)
    run = kepler.run(METHOD, h=0.0625, t_end=1, times=times)
    assert np.array_equal(run.t, times)
    assert np.allclose(run["energy"], -0.5, atol=1e-4)


def test_arrays_outlive_their_run(kepler):
    x = kepler.run(METHOD, h=0.05, t_end=1)["x"]
    kept = x.copy()
    for _ in range(4):
        kepler.run(METHOD, h=0.05, t_end=1)
    assert np.array_equal(x, kept)


def test_callbacks_of_python(kepler):
    own = gravity().run(METHOD, h=0.05, t_end=2, q=[0.7, 0], v=[0, np.sqrt(1.3 / 0.7)])
    assert np.allclose(own.q, kepler.run(METHOD, h=0.05, t_end=2).q, atol=1e-12)


def test_an_exception_of_a_callback_passes_through():
    def broken(t, q):
        raise ZeroDivisionError("in the callback")
    with pytest.raises(ZeroDivisionError, match="in the callback"):
        dvi.System(1, potential=broken).run("verlet", h=0.1, t_end=1, q=[0], v=[0])


def test_a_lagrangian_of_sympy_is_that_of_the_scene():
    sympy = pytest.importorskip("sympy")
    t, m, M, l, g = sympy.symbols("t m M l g")
    x, theta = sympy.Function("x")(t), sympy.Function("theta")(t)
    bob = sympy.Matrix([x + l * sympy.sin(theta), -l * sympy.cos(theta)])
    L = (M * x.diff(t)**2 + m * bob.diff(t).dot(bob.diff(t))) / 2 - m * g * bob[1]
    system = dvi.System.of_lagrangian(L, [x, theta], m=0.2, M=1, l=0.5, g=9.81)
    run = system.run("galerkin:degree=2", h=0.02, t_end=20, q=[0, 1], v=[0, 0])
    assert run["x"][-1] == pytest.approx(0.0019303282895615365, abs=1e-14)
    assert run["theta"][-1] == pytest.approx(0.95845943079021689, abs=1e-14)
    with pytest.raises(TypeError, match="symbols without a number: M"):
        dvi.System.of_lagrangian(L, [x, theta], m=0.2, l=0.5, g=9.81)


def test_masses():
    spring = dict(potential=lambda t, q: q @ q / 2, gradient=lambda t, q: q)
    start = dict(h=0.1, t_end=1, q=[1, 2], v=[0, 1])
    sparse = pytest.importorskip("scipy.sparse")
    runs = [dvi.System(2, mass=mass, **spring).run(METHOD, **start)
            for mass in (4.0, [4, 4], np.eye(2) * 4, sparse.eye(2) * 4)]
    for run in runs[1:]:
        assert np.allclose(run.q, runs[0].q, atol=1e-13)


def test_hessians_of_python_have_patterns():
    sparse = pytest.importorskip("scipy.sparse")
    K = sparse.diags([[-1.0] * 3, [2.0] * 4, [-1.0] * 3], [-1, 0, 1], format="csc") * 100
    calls = []

    def hessian(t, q):
        calls.append(t)
        return K.data
    spring = dict(potential=lambda t, q: q @ (K @ q) / 2, gradient=lambda t, q: K @ q)
    start = dict(h=0.5, t_end=5, q=[1, 0, 0, 0], v=[0] * 4)
    method = "galerkin:degree=2,solver=newton"
    given = dvi.System(4, hessian=hessian, pattern=K, **spring).run(method, **start)
    dense = dvi.System(4, hessian=lambda t, q: K.toarray(), **spring).run(method, **start)
    assert calls
    assert np.allclose(given.q, dense.q, atol=1e-12)
    assert np.allclose(given.q, dvi.System(4, **spring).run(method, **start).q, atol=1e-8)


def test_forces_of_python_take_energy():
    system = dvi.System(1, potential=lambda t, q: q @ q / 2, gradient=lambda t, q: q,
                        forces=lambda t, q, v: -0.2 * v)
    run = system.run(METHOD, h=0.1, t_end=5, q=[1], v=[0])
    omega = np.sqrt(1 - 0.01)
    exact = np.exp(-0.1 * run.t) * (np.cos(omega * run.t) + 0.1 / omega * np.sin(omega * run.t))
    assert np.allclose(run["q1"], exact, atol=1e-6)


def test_addresses_of_c_callbacks():
    import ctypes
    kind = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_double, ctypes.POINTER(ctypes.c_double),
                            ctypes.POINTER(ctypes.c_double), ctypes.c_void_p)

    @kind
    def value(t, q, V, user):
        V[0] = q[0]**2 / 2
        return 0

    @kind
    def gradient(t, q, V_q, user):
        V_q[0] = q[0]
        return 0
    value_at, gradient_at = (ctypes.cast(f, ctypes.c_void_p).value for f in (value, gradient))
    run = dvi.System(1, value_at, gradient_at).run(METHOD, h=0.1, t_end=1, q=[1], v=[0])
    assert run["q1"][-1] == pytest.approx(np.cos(1), abs=1e-9)


def test_ensembles_have_the_bits_of_single_runs(kepler):
    v = np.array([[0.0] * 5, np.linspace(0.9, 1.1, 5)])
    ensemble = dvi.Ensemble(kepler, METHOD, 5).start(np.tile([[1.0], [0.0]], 5), v=v)
    t, q, p = ensemble.record(0.05, 20, every=5)
    assert t.shape == (5,) and q.shape == (5, 2, 5)
    single = dvi.Integrator(kepler, METHOD).start([1, 0], v=v[:, 3])
    for _ in single.steps(0.05, 20):
        pass
    assert np.array_equal(single.q, ensemble.q[:, 3])
    with pytest.raises(ValueError, match=r"\(2, 5\) is needed"):
        ensemble.start(np.zeros((5, 2)), v=v)


def test_a_pickled_integrator_goes_on_with_the_same_bits(kepler):
    integrator = dvi.Integrator(kepler, METHOD).start()
    for _ in integrator.steps(0.05, 7):
        pass
    copy = pickle.loads(pickle.dumps(integrator))
    copy.step(0.05)
    integrator.step(0.05)
    assert np.array_equal(copy.q, integrator.q) and copy.t == integrator.t


def test_events(tmp_path):
    text = (SCENES / "kepler.yaml").read_text() + "events: {crossing: {zero: y, direction: rising}}\n"
    scene = dvi.Scene.parse(text, e=0.3)
    run = scene.run(METHOD, h=0.05, t_end=13)
    assert [event.name for event in run.events] == ["crossing"] * len(run.events)
    assert all(abs(event.q[1]) < 1e-10 for event in run.events)


STRING = """
parameters: {N: 50}
mesh: {generator: interval, cells: N, size: 1}
field: wave
boundary: fixed
initial: {u: sin(pi*x)}
probes: {middle: {at: 0.5}}
method: verlet
step: {fraction: 0.5}
until: 1
"""


def test_fields_are_arrays():
    scene = dvi.Scene.parse(STRING)
    mesh, field = scene.mesh, scene.field
    assert mesh.points.shape == (51, 1) and mesh.cells().shape == (50, 2)
    run = scene.run()
    u = field.lift(run.q)
    assert u.shape == (len(run), 51) and np.all(u[:, 0] == 0)
    assert np.array_equal(u[:, field.unknowns], run.q)
    assert run["middle"][-1] == pytest.approx(-1, abs=1e-3)
    omega, modes = field.modes(3)
    assert np.allclose(omega, np.pi * np.arange(1, 4), rtol=2e-3) and modes.shape == (3, 51)
    pytest.importorskip("scipy")
    mass, stiffness = field.matrix("mass"), field.matrix("stiffness")
    residual = stiffness @ modes[0, field.unknowns] - omega[0]**2 * (mass @ modes[0, field.unknowns])
    assert np.max(np.abs(residual)) < 1e-10
    with pytest.raises(dvi.Unsupported, match="has no mesh"):
        dvi.Scene(SCENES / "kepler.yaml").mesh


def test_marches_have_the_forms_of_maxwell():
    scene = dvi.Scene.parse("""
mesh: {generator: box, cells: [8, 8], size: [1, 1]}
field: maxwell
boundary: pec
initial: {E: [0, "sin(pi*x)"]}
step: {fraction: 0.5}
until: 1
""")
    march = scene.march("yee")
    first = march.observables["energy"]
    assert march.advance(0.5).t == 0.5
    assert march.observables["energy"] == pytest.approx(first, rel=0.02)
    assert march.vectors("E").shape == (64, 3)
    state = march.save()
    rows = march.record(t_end=1, every=0.1, forms=["E"])
    assert np.allclose(rows["t"], np.linspace(0.5, 1, 6)) and rows["t"][-1] == march.t == 1
    assert np.array_equal(rows["E"][-1], march["E"])
    assert rows["energy"][-1] == march.observables["energy"]
    last = march["E"]
    with pytest.raises(dvi.BadArgument, match="cut short"):
        march.restore(state[:-1])
    some = march.restore(state).record(t_end=1, times=[0.7, 1], forms={"E": [3, 7]})
    assert np.array_equal(some["E"][1], last[[3, 7]]) and some["E"].shape == (2, 2)
    with pytest.raises(dvi.BadArgument, match="t_end"):
        march.record(t_end=0.5)


def test_errors_have_the_librarys_sentences(kepler):
    with pytest.raises(dvi.BadArgument, match="unknown method .galerkn.; there are galerkin, verlet"):
        kepler.run("galerkn", h=0.05, t_end=1)
    with pytest.raises(dvi.BadArgument, match="leads away from t_end"):
        kepler.run(METHOD, h=-0.05, t_end=1)
    with pytest.raises(dvi.BadArgument, match="scene.yaml:2:"):
        dvi.Scene.parse("coordinates: {x: scalar}\nlagrangian: y\nstep: 1\nuntil: 1\n"
                        "initial: {x: 0}\n")
    with pytest.raises(dvi.Error) as failed:
        kepler.run("midpoint", h=2, t_end=100)
    assert failed.value.status in ("DVI_STEP_TOO_LARGE", "DVI_NOT_CONVERGED")
    assert len(failed.value.run) >= 1


def test_measured_orders(kepler):
    table = dvi.order(kepler, "galerkin:degree=2", h=0.1, t_end=2, levels=4)
    assert np.allclose(table["order"][1:], 4, atol=0.1)
    assert table.claimed == 4 and table.holds and abs(table.order - 4) < 0.1
    assert list(table["steps"]) == [20, 40, 80, 160] and np.all(table["energy_error"] > 0)
    assert "holds" in table._repr_html_() and "<th>energy_error</th>" in table._repr_html_()
    by_ida = dvi.order(kepler, "galerkin:degree=2", h=0.1, t_end=2, levels=4, reference="ida")
    assert np.allclose(by_ida["error"][:2], table["error"][:2] * 16 / 15, rtol=0.05)
    searched = dvi.order(kepler, "galerkin:degree=2", h=None, t_end=2, reference="ida")
    assert searched.holds and np.all(searched["error"] > searched.floor)
    with pytest.raises(dvi.BadArgument, match="a search for steps needs"):
        dvi.order(kepler, "verlet", h=None, t_end=2)
    with pytest.raises(dvi.BadArgument, match="ratio"):
        dvi.order(kepler, "verlet", h=0.1, t_end=2, ratio=1)
    with pytest.raises(dvi.BadArgument, match="levels"):
        dvi.order(kepler, "verlet", h=0.1, t_end=2, levels=100)
    with pytest.raises(ValueError, match="reference"):
        dvi.order(kepler, "verlet", h=0.1, t_end=2, reference="exact")


def test_measured_work(kepler):
    tables = dvi.work(kepler, ["verlet", "galerkin:degree=2"], [0.1, 0.05], t_end=2, rounds=2)
    verlet, galerkin = tables.values()
    assert list(verlet["steps"]) == [20, 40] and set(verlet["status"]) == {"DVI_OK"}
    assert verlet["error"][0] / verlet["error"][1] == pytest.approx(4, rel=0.1)
    assert np.all(galerkin["error"] < verlet["error"]) and np.all(galerkin["evaluations"] > 0)
    assert np.all(verlet["lower"] <= verlet["seconds"]) and np.all(verlet["lower"] > 0)
    assert "<td>DVI_OK</td>" in verlet._repr_html_()
    with pytest.raises(dvi.BadArgument, match="one of end"):
        dvi.work(kepler, ["verlet"], [0.1], t_end=2, reference=None)


def test_sweeps_have_the_bits_of_runs_and_of_the_command(kepler, tmp_path):
    grid = {"e": dvi.values(0.1, 0.7, 3)}
    table = dvi.sweep(kepler, grid, h=0.0625, t_end=1, method=METHOD, threads=2, extremes=True)
    assert list(table["e"]) == list(grid["e"]) and set(table["status"]) == {"DVI_OK"}
    for row in table:
        run = dvi.Scene(SCENES / "kepler.yaml", e=row["e"]).run(METHOD, h=0.0625, t_end=1)
        assert all(row[name] == run[name][-1] for name in ("t", "x", "p_y", "energy"))
        assert row["least_y"] == run["y"].min() and row["most_y"] == run["y"].max()
        assert row["energy_error"] == np.abs(run["energy"] - run["energy"][0]).max()
    path = tmp_path / "sweep.csv"
    subprocess.run([os.environ["DVI_COMMAND"], "sweep", SCENES / "kepler.yaml", "--method", METHOD,
                    "--set", "e=0.1:0.7:3", "--h", "0.0625", "--t-end", "1", "--out", path],
                   check=True)
    said = np.genfromtxt(path, delimiter=",", names=True, dtype=None, encoding="utf-8")
    for name in said.dtype.names:
        assert np.array_equal(said[name], table[name]), name
    part = dvi.sweep(kepler, grid, h=0.0625, t_end=1, method=METHOD, part=(1, 2), extremes=True)
    assert part.tobytes() == table[1::2].tobytes()


def test_sweeps_over_starts_of_a_function():
    system = gravity()

    def make(speed, x):
        if speed > 2:
            raise dvi.BadArgument("too fast")
        return dvi.Integrator(system, "verlet").start([x, 0], v=[0, speed])
    table = dvi.sweep(make, {"speed": [1, 3], "x": [1, 1.5]}, h=0.01, t_end=0.5)
    assert list(table["x"]) == [1, 1.5, 1, 1.5] and list(table["steps"]) == [50, 50, 0, 0]
    assert np.isnan(table["q1"][2]) and table.sentences == {2: "too fast", 3: "too fast"}
    assert "<th>energy_error</th>" in table._repr_html_()
    with pytest.raises(ZeroDivisionError):
        dvi.sweep(lambda x: 1 / x, {"x": [0]}, h=0.1, t_end=1)
    with pytest.raises(ValueError, match="same coordinates"):
        dvi.sweep(lambda n: dvi.Integrator(dvi.System(int(n), potential=lambda t, q: q[0]),
                                           "verlet").start(np.ones(int(n)), v=np.ones(int(n))),
                  {"n": [1, 2]}, h=0.1, t_end=1)
    with pytest.raises(dvi.BadArgument, match="part 3"):
        dvi.sweep(make, {"speed": [1], "x": [1]}, h=0.1, t_end=1, part=(3, 2))
    with pytest.raises(dvi.BadArgument, match="from 2"):
        dvi.values(0, 1, 1)


def test_an_exception_in_a_run_ends_a_sweep():
    def potential(t, q):
        raise KeyError("in a run")
    broken = dvi.System(1, potential=potential, gradient=lambda t, q: q)
    with pytest.raises(KeyError, match="in a run"):
        dvi.sweep(lambda x: dvi.Integrator(broken, "verlet").start([x], v=[0]), {"x": [1, 2]},
                  h=0.1, t_end=1)


def test_sweeps_end_runs_at_events_of_scenes():
    ball = dvi.Scene.parse("""
parameters: {x0: 1}
coordinates: {x: scalar}
lagrangian: x'^2/2 - 9.81*x
initial: {x: x0}
events: {ground: {zero: x, stop: yes}}
method: verlet
step: 0.01
until: 9
""")
    table = dvi.sweep(ball, {"x0": [1, 2]})
    assert list(table["status"]) == ["event ground"] * 2
    assert np.allclose(table["t"], np.sqrt(2 * table["x0"] / 9.81))


def test_paths_between_ends(kepler):
    run = kepler.run(METHOD, h=0.0625, t_end=1)
    path = dvi.path(kepler, METHOD, 16, 1.0, q0=run.q[0], q1=run.q[-1], guess=(run.t, run.q))
    assert path.q.shape == (17, 2) and np.allclose(path.q, run.q, atol=1e-12)
    assert np.allclose(path.p, run.p, atol=1e-11) and path.negative == 0
    forward = dvi.path(kepler, METHOD, 16, 1.0, q0=run.q[0], p0=run.p[0])
    assert np.allclose(forward.q, run.q, atol=1e-11) and forward.negative == -1
    closed = dvi.path(dvi.System(1, potential=lambda t, q: q[0]**2 / 4 + np.cos(t) * q[0]),
                      "midpoint", 40, 2 * np.pi)
    assert closed.q[0] == pytest.approx(closed.q[-1])
    with pytest.raises(TypeError, match="q0 and q1"):
        dvi.path(kepler, METHOD, 16, 1.0, q0=run.q[0])
    with pytest.raises(ValueError, match="guess"):
        dvi.path(kepler, METHOD, 16, 1.0, q0=run.q[0], q1=run.q[-1], guess=(run.t, run.p[:3]))


def test_files_of_the_command(kepler, tmp_path):
    pytest.importorskip("h5py")
    path, command = tmp_path / "run.h5", os.environ["DVI_COMMAND"]
    made = subprocess.run([command, "run", SCENES / "kepler.yaml", "--set", "e=0.3", "--method",
                           METHOD, "--h", "0.0625", "--t-end", "1", "--out", path],
                          stderr=subprocess.PIPE, text=True)
    if "no module" in made.stderr:
        pytest.skip(made.stderr)
    rows = dvi.read(path)
    run = kepler.run(METHOD, h=0.0625, t_end=1)
    assert list(rows)[:3] == ["t", "x", "y"] and rows.array.shape == (17, len(rows))
    assert all(np.array_equal(rows[name], run[name]) for name in ("t", "x", "p_y", "energy"))
    assert rows.attributes["method"] == METHOD and "lagrangian" in rows.attributes["scene"]
    with pytest.raises(KeyError, match="there is no column 'z'; there are t, x, y"):
        rows["z"]
    table = tmp_path / "table.h5"
    subprocess.run([command, "sweep", "kepler", "--method", METHOD, "--set", "e=0,0.5", "--h", "0.1",
                    "--t-end", "1", "--out", table], check=True)
    assert list(dvi.read(table)["status"]) == ["DVI_OK", "DVI_OK"]
    assert list(dvi.read(table)["e"]) == [0, 0.5]


def test_a_run_that_ends_before_its_first_row_has_its_events(kepler):
    hit = lambda t, q, v: q[1] - 0.1  # noqa: E731
    hit.terminal = True
    run = kepler.run("verlet", h=0.01, t_end=5, times=[4.0], events={"hit": hit})
    assert len(run) == 0 and [event.name for event in run.events] == ["hit"] and "0 rows" in repr(run)


def test_recorded_arrays_cannot_be_changed(kepler):
    run = kepler.run("verlet", h=0.01, t_end=0.1)
    with pytest.raises(ValueError):
        run.q[0, 0] = 1
