"""What the modules share of the C library."""
import numpy as np

from dvi._dvi import ffi, lib


def version():
    """Return the version of the linked library."""
    return text(lib.dvi_version())


def text(pointer):
    """Return a string of C, None for NULL."""
    return None if pointer == ffi.NULL else ffi.string(pointer).decode()


def numbers(array):
    """Return the pointer to a contiguous array of doubles."""
    return ffi.cast("double *", ffi.from_buffer(array))


def vector(given, size, name):
    """Return a new vector of `size` finite or other numbers, or complain with its name."""
    made = np.array(given, dtype=float, ndmin=1, order="C")
    if made.shape != (size,):
        raise ValueError(f"{name} has the shape {made.shape}; {size} numbers are needed")
    return made


class Owned:
    """An object of the library, destroyed when neither it nor an object made of it is in use.

    The collector of cycles finalises objects in any order, so users are counted here.
    """

    def __init__(self, kind, pointer, of=None):
        self.kind, self.pointer, self.of = kind, pointer, of
        self.users = 1
        if of is not None:
            of.users += 1

    def release(self):
        """End one use."""
        self.users -= 1
        if self.users > 0:
            return
        getattr(lib, f"dvi_{self.kind}_destroy")(ffi.new(f"dvi_{self.kind} **", self.pointer))
        if self.of is not None:
            self.of.release()

    __del__ = release


def array(pointer, shape, owner):
    """Return an array on memory of the library, which keeps the owner of the memory alive."""
    count = int(np.prod(shape))
    if count == 0:
        return np.empty(shape)
    held = ffi.gc(pointer, lambda _: owner)
    return np.frombuffer(ffi.buffer(held, count * 8), dtype=float).reshape(shape)
