"""Run notebooks, and write what their cells print and draw into them.

    python3 fill.py [NOTEBOOK.ipynb ...]    default: all in this folder
"""
import ast
import base64
import contextlib
import io
import json
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  the backend is chosen first


def run(source, names):
    """Run a cell. Returns its last expression, as a notebook shows it."""
    tree = ast.parse(source)
    last = tree.body.pop() if tree.body and isinstance(tree.body[-1], ast.Expr) else None
    exec(compile(tree, "cell", "exec"), names)
    return eval(compile(ast.Expression(last.value), "cell", "eval"), names) if last else None


def outputs(source, names):
    """Return the outputs of a cell as a notebook keeps them."""
    printed, made = io.StringIO(), []
    with contextlib.redirect_stdout(printed):
        shown = run(source, names)
    if printed.getvalue():
        made.append({"output_type": "stream", "name": "stdout",
                     "text": printed.getvalue().splitlines(keepends=True)})
    if plt.get_fignums():
        picture = io.BytesIO()
        plt.gcf().savefig(picture, dpi=55, metadata={"Software": None})
        plt.close("all")
        made.append({"output_type": "display_data", "metadata": {},
                     "data": {"image/png": base64.b64encode(picture.getvalue()).decode()}})
    elif shown is not None:
        data = {"text/plain": repr(shown).splitlines(keepends=True)}
        if hasattr(shown, "_repr_html_"):
            data["text/html"] = shown._repr_html_().splitlines(keepends=True)
        made.append({"output_type": "execute_result", "execution_count": None, "metadata": {},
                     "data": data})
    return made


def fill(path):
    """Fill in a notebook."""
    notebook, names = json.loads(path.read_text()), {"__name__": path.stem}
    for cell in notebook["cells"]:
        if cell["cell_type"] == "code":
            cell["outputs"] = outputs("".join(cell["source"]), names)
    path.write_text(json.dumps(notebook, indent=1, ensure_ascii=False) + "\n")


if __name__ == "__main__":
    here = pathlib.Path(__file__).resolve().parent
    for given in sys.argv[1:] or sorted(here.glob("*.ipynb")):
        fill(pathlib.Path(given))
