"""What the modules share of the C library."""
from __future__ import annotations

import os
import threading
import weakref
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from dvi._dvi import ffi, lib

Array = NDArray[np.float64]


def version() -> str:
    """Return the version of the linked library."""
    return ffi.string(lib.dvi_version()).decode()


def text(pointer: Any) -> Any:
    """Return a string of C, None for NULL."""
    return None if pointer == ffi.NULL else ffi.string(pointer).decode()


def encoded(given: Any, name: str) -> bytes:
    """Return a text for C, or complain with its name. C would end it at a NUL."""
    if not isinstance(given, str):
        raise TypeError(f"{name} is a text, not {given!r}")
    if "\0" in given:
        raise ValueError(f"{name} has a NUL: {given!r}")
    return given.encode()


def numbers(array: np.ndarray) -> Any:
    """Return the pointer to a contiguous array of doubles."""
    return ffi.cast("double *", ffi.from_buffer(array))


def vector(given: ArrayLike, size: int, name: str) -> Array:
    """Return a new vector of `size` finite or other numbers, or complain with its name."""
    made = np.array(given, dtype=float, ndmin=1, order="C")
    if made.shape != (size,):
        raise ValueError(f"{name} has the shape {made.shape}; {size} numbers are needed")
    return made


class Owned:
    """An object of the library, destroyed when neither it nor an object made of it is in use.

    The collector of cycles finalises objects in any order, so users are counted here. A lock keeps
    a second thread away, and a callback from the object that calls it. After a fork the child has
    no threads of the object: then the lock stays closed there, and nothing is destroyed.
    """

    live: weakref.WeakSet[Owned] = weakref.WeakSet()

    def __init__(self, kind: str, pointer: Any, of: Owned | None = None, threads: int = 1) -> None:
        self.kind, self.pointer, self.of, self.threads = kind, pointer, of, threads
        self.users, self.forked, self.lock = 1, False, threading.Lock()
        if of is not None:
            of.users += 1
        Owned.live.add(self)

    def busy(self) -> RuntimeError:
        """Return the exception of an object whose lock is closed."""
        if self.forked:
            return RuntimeError(f"the {self.kind} has threads or a step of the process before the "
                                "fork; make another one here")
        return RuntimeError(f"the {self.kind} is at work, in another thread or in the callback "
                            "that it calls; make one for each thread")

    def __enter__(self) -> None:
        if not self.lock.acquire(False):
            raise self.busy()

    def __exit__(self, *_: object) -> None:
        self.lock.release()

    def release(self) -> None:
        """End one use."""
        self.users -= 1
        if self.users > 0:
            return
        if not self.forked:
            getattr(lib, f"dvi_{self.kind}_destroy")(ffi.new(f"dvi_{self.kind} **", self.pointer))
        if self.of is not None:
            self.of.release()

    __del__ = release


def _after_fork() -> None:
    """Close what has threads, in the child, which has none of them."""
    for owned in list(Owned.live):
        owned.forked = True
        if owned.threads > 1:
            owned.lock.acquire(False)


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_after_fork)


def array(pointer: Any, shape: tuple[int, ...], owner: Owned) -> Array:
    """Return an array on memory of the library, which keeps the owner of the memory alive."""
    count = int(np.prod(shape))
    if count == 0:
        return np.empty(shape)
    held = ffi.gc(pointer, lambda _: owner)
    return np.frombuffer(ffi.buffer(held, count * 8), dtype=float).reshape(shape)
