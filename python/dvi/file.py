"""Files of HDF5 that the command has written (docs/command.md)."""
from collections.abc import Mapping


class Rows(Mapping):
    """The columns of a file.

    rows["x"]   a column by its name, an array
    array       all columns of numbers, an array [rows, columns]
    attributes  facts about the run: method, h, scene, command and others
    """

    def __init__(self, path, array, names, text, attributes):
        self.path, self.array, self.attributes = path, array, attributes
        self._columns = {name: array[:, i] for i, name in enumerate(names)}
        self._columns.update(text)

    def __getitem__(self, name):
        if name not in self._columns:
            raise KeyError(f"there is no column {name!r}; there are {', '.join(self)}")
        return self._columns[name]

    def __iter__(self):
        return iter(self._columns)

    def __len__(self):
        return len(self._columns)

    def __repr__(self):
        return f"<Rows of {self.path}: {len(self.array)} of {', '.join(self)}>"


def read(path):
    """Read the `Rows` of a file that dvi run or dvi sweep has written.

    The run may still go on, or have been killed: then these are the rows up to its last flush.
    """
    import h5py
    try:
        file = h5py.File(path, "r")
    except OSError:
        file = h5py.File(path, "r", swmr=True)
    with file:
        if not str(file.attrs.get("layout", "")).startswith(("dvi rows", "dvi table")):
            raise ValueError(f"{path} has no rows of dvi")
        rows = file["rows"]
        text = {name: texts.asstr()[:] for name, texts in file.get("text", {}).items()}
        return Rows(path, rows[:], list(rows.attrs["columns"]), text, dict(file.attrs))
