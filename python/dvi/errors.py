"""Exceptions with the library's sentences."""
from dvi._dvi import ffi, lib


class Error(Exception):
    """A call of the library failed. `status` is its name, such as "DVI_NOT_CONVERGED"."""

    status = "DVI_SOLVER_FAILED"


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


def error(status, sentence=None):
    """Return the exception of a status, with a sentence or that of the last failure."""
    name = ffi.string(lib.dvi_status_name(status)).decode()
    if name == "DVI_NO_MEMORY":
        return MemoryError(sentence or ffi.string(lib.dvi_last_error()).decode())
    made = KINDS.get(name, Error)(sentence or ffi.string(lib.dvi_last_error()).decode())
    made.status = name
    return made


def check(status):
    """Raise the exception of a status that is not DVI_OK."""
    if status != lib.DVI_OK:
        raise error(status)
