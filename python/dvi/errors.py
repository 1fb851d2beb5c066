"""Exceptions with the library's sentences."""
from __future__ import annotations

from typing import TYPE_CHECKING

from dvi._dvi import ffi, lib

if TYPE_CHECKING:
    from dvi.recording import Run


class Error(Exception):
    """A call of the library failed.

    status  the name of its status, such as "DVI_NOT_CONVERGED"
    run     the `Run` before the failure, if the call was to return one and there are rows
    """

    status: str = "DVI_SOLVER_FAILED"
    run: Run | None = None


class NotConverged(Error):
    """The equations of a step could not be solved."""


class StepTooLarge(Error):
    """A step is beyond where its solution goes."""


class NotFinite(Error):
    """NaN or Inf came where a finite number is needed."""


class CallbackFailed(Error):
    """A callback failed, or asked for a smaller step."""


class BadArgument(Error, ValueError):
    """An argument, a count or an option is out of range."""


class Unsupported(Error):
    """The method cannot use what the system declares."""


KINDS = {
    "DVI_NOT_CONVERGED": NotConverged,
    "DVI_STEP_TOO_LARGE": StepTooLarge,
    "DVI_NOT_FINITE": NotFinite,
    "DVI_CALLBACK_RETRY": CallbackFailed,
    "DVI_CALLBACK_FAILED": CallbackFailed,
    "DVI_BAD_ARGUMENT": BadArgument,
    "DVI_BAD_SIZE": BadArgument,
    "DVI_BAD_OPTION": BadArgument,
    "DVI_BAD_FILE": BadArgument,
    "DVI_UNSUPPORTED": Unsupported,
}


def error(status: int, sentence: str | None = None) -> Exception:
    """Return the exception of a status, with a sentence or that of the last failure."""
    name = ffi.string(lib.dvi_status_name(status)).decode()
    if name == "DVI_NO_MEMORY":
        return MemoryError(sentence or ffi.string(lib.dvi_last_error()).decode())
    made = KINDS.get(name, Error)(sentence or ffi.string(lib.dvi_last_error()).decode())
    made.status = name
    return made


def check(status: int) -> None:
    """Raise the exception of a status that is not DVI_OK."""
    if status != lib.DVI_OK:
        raise error(status)
