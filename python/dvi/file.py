"""Files of HDF5 that the command has written (docs/command.md)."""
from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from dvi._library import Array


class Rows(Mapping[str, np.ndarray]):
    """The columns of a file.

    rows["x"]   a column by its name, an array
    array       all columns of numbers, an array [rows, columns]
    attributes  facts about the run: method, h, scene, command and others
    """

    def __init__(self, path: str | os.PathLike[str], array: Array, names: list[str],
                 text: dict[str, np.ndarray], attributes: dict[str, Any]) -> None:
        self.path, self.array, self.attributes = path, array, attributes
        self._columns: dict[str, np.ndarray] = {name: array[:, i] for i, name in enumerate(names)}
        self._columns.update(text)

    def __getitem__(self, name: str) -> np.ndarray:
        if name not in self._columns:
            raise KeyError(f"there is no column {name!r}; there are {', '.join(self)}")
        return self._columns[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __len__(self) -> int:
        return len(self._columns)

    def __repr__(self) -> str:
        return f"<Rows of {self.path}: {len(self.array)} of {', '.join(self)}>"


def read(path: str | os.PathLike[str]) -> Rows:
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
