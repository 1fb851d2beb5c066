"""Wrong arguments, threads, forks and signals raise exceptions, and never crash."""
import inspect
import os
import pickle
import random
import signal
import subprocess
import sys
import threading

import numpy as np
import pytest

import dvi
from test_dvi import METHOD, SCENES, STRING

JUNK = [None, True, -1, 0, 3, 2**70, 0.5, -0.1, 1e300, float("nan"), float("inf"), 1j, "", "x",
        "verlet", "galerkin:degree=0", "mass", "a\0b", "\ud800", b"x", [], [1], [1, 2], ["a"], (),
        {}, {"a": 1}, {1: 2}, np.zeros(0), np.zeros(2), np.full(2, np.nan), np.zeros((2, 3)),
        np.array(["s"]), np.array(1.0), object(), len, lambda *_: None, lambda *_: [1.0, 2.0],
        int, dvi.System, np.eye(2, dtype=int), "ida"]
COUNTS = ("members", "n", "levels", "rounds", "threads", "steps", "count", "constraint_count")
SMALL = [j for j in JUNK if not (isinstance(j, (int, float)) and not isinstance(j, bool) and j > 9)]


def spring(n=2, **more):
    return dvi.System(n, potential=lambda t, q: q @ q / 2, gradient=lambda t, q: q, **more)


def targets():
    """Return objects whose public methods are called, each with usual arguments of theirs."""
    scene = dvi.Scene(SCENES / "kepler.yaml")
    run = scene.run("verlet", h=0.1, t_end=1)
    waves = dvi.Scene.parse(STRING)
    q = np.ones((2, 2))
    return [scene, spring(), dvi.Integrator(scene, "verlet").start(), run, waves, waves.mesh,
            waves.field, waves.march("leapfrog"),
            dvi.Ensemble(scene, "verlet", 2).start(q, v=q), dvi]


USUAL = {"method": "verlet", "h": 0.1, "t_end": 0.5, "methods": ["verlet"], "steps": 2, "every": 1,
         "q": [1.0, 0.5], "v": [0.0, 1.0], "t": 0.5, "k": 0, "name": "mass", "count": 2,
         "source": STRING, "potential": lambda t, q: 0.0, "n": 2, "members": 2}


def arguments(call, chance):
    """Return arguments of a call, some of them junk."""
    given = {}
    for name, parameter in inspect.signature(call).parameters.items():
        if parameter.kind is parameter.VAR_KEYWORD or name in ("reference", "axes"):
            continue
        if name in COUNTS or name in ("t_end", "h", "t"):
            junk = chance.choice([USUAL.get(name, 1)] + SMALL)
        else:
            junk = chance.choice(JUNK)
        if chance.random() < 0.4:
            given[name] = junk
        elif name in USUAL:
            given[name] = USUAL[name]
    return given


def public_calls(of):
    """Return names and public methods of an object, or of the package."""
    names = dvi.__all__ if of is dvi else [name for name in dir(type(of)) if name[0] != "_"]
    if hasattr(of, "__getitem__"):
        names.append("__getitem__")
    kinds = () if of is dvi else [name for name in names
                                  if isinstance(getattr(type(of), name), property)]
    unused = ("plot", "read", "Event", "Field", "Mesh", "Run", "Rows", "March", "Path", *kinds)
    calls = [(name, getattr(of, name)) for name in names if name not in unused]
    return [(name, call) for name, call in calls
            if not (inspect.isclass(call) and issubclass(call, Exception))]


@pytest.mark.parametrize("seed", range(int(os.environ.get("DVI_SEEDS", "3"))))
def test_wrong_arguments_raise(seed):
    chance = random.Random(seed)
    for of in targets():
        for name, call in public_calls(of):
            try:
                made = call(**arguments(call, chance))
                if inspect.isgenerator(made):
                    next(made, None)
            except Exception as raised:
                assert str(raised), (name, raised)


def test_public_names_have_docstrings_and_types():
    for name in dvi.__all__:
        of = getattr(dvi, name)
        members = [(name, of)] + [(f"{name}.{key}", member) for key, member in vars(of).items()
                                  if inspect.isclass(of) and key[0] != "_" and
                                  (callable(member) or isinstance(member, (property, classmethod)))]
        for full, member in members:
            assert inspect.getdoc(member), f"{full} has no docstring"
            call = getattr(member, "fget", getattr(member, "__func__", member))
            if inspect.isfunction(call):
                typed = set(call.__annotations__) - {"return"}
                assert "return" in call.__annotations__, f"{full} has no type"
                assert set(inspect.signature(call).parameters) - typed <= {"self", "cls"}, full


def test_nothing_is_ignored():
    with pytest.raises(TypeError, match="mass belongs to a potential"):
        dvi.System(1, lagrangian=lambda t, q, v: 0.0, mass=2)
    with pytest.raises(ValueError, match="2 coordinates have 1 names"):
        spring(names=["x"])
    pytest.importorskip("scipy")
    with pytest.raises(ValueError, match=r"mass has the shape \(2, 2\); \(3, 3\) is needed"):
        spring(3, mass=np.eye(2))
    with pytest.raises(ValueError, match=r"pattern has the shape \(3, 3\)"):
        spring(pattern=np.eye(3))
    start = {"q": [1, 0], "v": [0, 0], "h": 0.1, "t_end": 1}
    with pytest.raises(TypeError, match="both are given"):
        spring().run("verlet", times=[0.5], every=2, **start)
    with pytest.raises(ValueError, match=r"times has the shape \(2, 2\)"):
        spring().run("verlet", times=np.zeros((2, 2)), **start)
    with pytest.raises(ValueError, match="there is no part 'Q'"):
        spring().run("verlet", parts=["Q"], **start)
    with pytest.raises(ValueError, match="has a NUL"):
        spring().run("verlet\0", **start)
    members = dvi.Ensemble(spring(), "verlet", 2).start(np.ones((2, 2)), v=np.ones((2, 2)))
    with pytest.raises(ValueError, match="no multiple of every = 3"):
        members.record(0.1, 10, every=3)
    sympy = pytest.importorskip("sympy")
    t, m = sympy.symbols("t m")
    x = sympy.Function("x")(t)
    with pytest.raises(TypeError, match="has no symbol k"):
        dvi.System.of_lagrangian(m * x.diff(t)**2, [x], m=1, k=2)
    with pytest.raises(TypeError, match="needs q"):
        dvi.System.of_lagrangian(m * x.diff(t)**2, [x], m=1).run("verlet", 0.1, 1)


def test_arrays_of_callbacks_are_copies():
    kept = []

    def gradient(t, q):
        kept.append(q)
        return q
    start = {"q": [1], "v": [0], "h": 0.1, "t_end": 1}
    run = dvi.System(1, lambda t, q: q @ q / 2, gradient).run("verlet", **start)
    assert kept[-1] == run["q1"][-1] and kept[0] == 1

    def broken(t, q):
        q[:] = 0
    with pytest.raises(ValueError, match="read-only"):
        dvi.System(1, lambda t, q: 0.0, broken).run("verlet", **start)


def late(t, q):
    if t > 0.5:
        raise ZeroDivisionError("late")
    return q


def test_an_exception_has_the_rows_before_it():
    with pytest.raises(ZeroDivisionError) as failed:
        dvi.System(1, lambda t, q: 0.0, late).run("verlet", h=0.1, t_end=1, q=[1], v=[1])
    assert len(failed.value.run) == 6 and failed.value.run.end == "failed"


def test_events_constraints_and_invariants_of_python():
    def down(t, q, v):
        return q[0]
    down.terminal = True
    pendulum = dvi.System(names=["x", "y"], potential=lambda t, q: q[1],
                          gradient=lambda t, q: [0.0, 1.0],
                          constraints=lambda t, q: q @ q - 1, jacobian=lambda t, q: 2 * q,
                          invariants={"L": lambda t, q, p: q[0] * p[1] - q[1] * p[0]})
    run = pendulum.run("galerkin:degree=2", h=0.05, t_end=10, q=[1, 0], v=[0, 0],
                       events={"down": down}, parts=["q", "p", "constraint", "reactions"])
    assert run.end == "event" and [event.name for event in run.events] == ["down"]
    assert run.t[-1] == pytest.approx(1.8540746773, abs=1e-5)  # K(1/2) of elliptic integrals
    assert np.max(np.abs(run["constraint"])) < 1e-12 and run.reactions.shape == (len(run), 1)
    assert abs(run["L"][-1]) == pytest.approx(np.sqrt(2), abs=1e-5)
    with pytest.raises(ValueError, match=r"jacobian gave the shape \(2, 2\); \(1, 2\) is needed"):
        dvi.System(2, lambda t, q: 0.0, constraints=lambda t, q: q[0], jacobian=lambda t, q: [q, q]
                   ).run("galerkin:degree=2", 0.1, 1, q=[0, 0], v=[0, 1])


def value(t, q):
    return q @ q / 2


def test_runs_and_systems_are_pickled():
    run = dvi.System(1, value).run("verlet", h=0.1, t_end=1, q=[1], v=[0])
    copy = pickle.loads(pickle.dumps(run))
    assert copy.columns == run.columns == list(run) and len(copy) == len(run)
    assert all(np.array_equal(copy[name], column) for name, column in dict(run).items())
    assert copy._repr_html_() == run._repr_html_() and "x" not in copy and "q1" in copy
    integrator = dvi.Integrator(dvi.System(1, value), "verlet").start([1], v=[0])
    other = pickle.loads(pickle.dumps(integrator))
    other.step(0.1)
    integrator.step(0.1)
    assert other.q == integrator.q


def test_html_and_axes():
    scene = dvi.Scene(SCENES / "kepler.yaml", e=0.3)
    run = scene.run("verlet", h=0.1, t_end=1)
    for shown in (scene, spring(), run):
        said = shown._repr_html_()
        assert said.startswith("<p>") and said.count("<table>") == said.count("</table>") > 0
        assert "<Run" not in said and "<Scene" not in said
    assert "<th>parameters</th><td>e = 0.3</td>" in scene._repr_html_()
    figure = pytest.importorskip("matplotlib.figure")
    axes = figure.Figure().add_subplot()
    assert run.plot("x", "y", axes=axes) is axes
    assert (axes.get_xlabel(), axes.get_ylabel(), len(axes.lines)) == ("t", "x, y", 2)
    axes = run.plot("y", against="x", axes=figure.Figure().add_subplot())
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("x", "y")


def test_one_integrator_serves_one_thread():
    integrator = dvi.Integrator(dvi.Scene(SCENES / "kepler.yaml"), METHOD).start()
    failures, taken = [], []

    def steps():
        try:
            for _ in integrator.steps(1e-3, 3000):
                taken.append(1)
        except RuntimeError as failure:
            failures.append(failure)
    threads = [threading.Thread(target=steps) for _ in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert integrator.t == pytest.approx(len(taken) * 1e-3)
    assert all("at work" in str(failure) for failure in failures)

    def gradient(t, q):
        own.step(0.1)
    own = dvi.Integrator(dvi.System(1, lambda t, q: 0.0, gradient), "verlet")
    with pytest.raises(RuntimeError, match="in the callback"):
        own.start([0], v=[1]).step(0.1)


@pytest.mark.skipif(not hasattr(os, "fork"), reason="there is no fork")
def test_children_of_forks():
    scene, q = dvi.Scene(SCENES / "kepler.yaml", e=0.3), np.ones((2, 64))
    shared = dvi.Ensemble(scene, "verlet", 64, threads=2).start(q, v=q)
    integrator = dvi.Integrator(scene, "verlet").start()
    child = os.fork()
    if child == 0:
        signal.alarm(10)
        integrator.step(0.1)
        try:
            shared.advance(0.1, 1)
        except RuntimeError as failure:
            del shared
            dvi.Ensemble(scene, "verlet", 64, threads=2).start(q, v=q).advance(0.1, 1)
            os._exit(5 if "before the fork" in str(failure) else 6)
        os._exit(7)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 5
    shared.advance(0.1, 1)


def test_ctrl_c_ends_a_run_with_its_rows():
    source = f"""
import dvi, os, signal, threading
scene = dvi.Scene({str(SCENES / "kepler.yaml")!r})
threading.Timer(0.2, os.kill, (os.getpid(), signal.SIGINT)).start()
try:
    scene.run("galerkin:degree=4", h=1e-4, t_end=1e9, every=100000)
except KeyboardInterrupt as stopped:
    assert stopped.run.end == "cancelled" and len(stopped.run) >= 1
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
    print("rows")
"""
    said = subprocess.run([sys.executable, "-X", "faulthandler", "-c", source], text=True,
                          capture_output=True, timeout=60)
    assert said.stdout == "rows\n", said.stderr


@pytest.mark.parametrize("scene", ["kepler.yaml", "constrained/slider-crank.yaml", "field.yaml"])
def test_numbers_are_those_of_the_command(scene, tmp_path):
    command, folder = os.environ["DVI_COMMAND"], SCENES
    if scene == "field.yaml":
        folder = SCENES.parent / "templates"
    said = subprocess.run([command, "run", folder / scene, "--t-end", "0.5"], text=True,
                          capture_output=True, check=True).stdout.splitlines()
    lines = [line for line in said if line and line[0] != "#"]
    columns = np.array([[float(x) for x in line.split(",")] for line in lines[1:]]).T
    run, compared = dvi.Scene(folder / scene).run(t_end=0.5), 0
    for name, column in zip(lines[0].split(","), columns):
        if name in run:
            assert np.array_equal(run[name], column), name
            compared += 1
    assert compared >= 3


def test_marches_name_their_way():
    block = dvi.Scene(SCENES / "solids" / "bouncing-block.yaml")
    with pytest.raises(dvi.Unsupported, match=r"scene.march\('avi'\) makes it"):
        block.run()
    assert block.march().advance(0.1).observables["energy"] > 0
    shaken = dvi.Scene(SCENES / "solids" / "shaken-bar.yaml").run(t_end=0.01)
    assert shaken.end == "complete" and np.all(np.isfinite(shaken["energy"]))
