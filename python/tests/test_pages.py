"""The Python on the pages runs, and the notebooks run from their first cell to the last."""
import json
import os
import pathlib
import re

import pytest

pytest.importorskip("sympy")
matplotlib = pytest.importorskip("matplotlib")
matplotlib.use("Agg")

TOP = pathlib.Path(__file__).resolve().parents[2]
NOTEBOOKS = sorted((TOP / "python" / "notebooks").glob("*.ipynb"))


def scenes_of(text, folder):
    """Write the scenes that begin with a comment of their name."""
    for scene in re.findall(r"```yaml\n(# ([\w-]+\.yaml): .*?)```", text, re.S):
        (folder / scene[1]).write_text(scene[0])


@pytest.mark.parametrize("page", ["README.md", "docs/tutorial.md", "docs/python.md"])
def test_the_python_of_a_page_runs(page, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    command = pathlib.Path(os.environ["DVI_COMMAND"])
    monkeypatch.setenv("PATH", f"{command.parent}:{os.environ['PATH']}")
    if page == "docs/python.md":
        pytest.importorskip("h5py")
        if not command.with_name("dvi_hdf5.so").exists():
            pytest.skip("the command was built without libhdf5")
    for source in ("README.md", "docs/tutorial.md", page):
        scenes_of((TOP / source).read_text(), tmp_path)
    blocks = re.findall(r"```python\n(.*?)```", (TOP / page).read_text(), re.S)
    assert blocks
    names = {"__name__": page}
    for block in blocks:
        exec(compile(block, page, "exec"), names)


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_runs(path, monkeypatch):
    monkeypatch.chdir(path.parent)
    names = {"__name__": path.stem}
    for cell in json.loads(path.read_text())["cells"]:
        if cell["cell_type"] == "code":
            exec(compile("".join(cell["source"]), path.name, "exec"), names)
    matplotlib.pyplot.close("all")
