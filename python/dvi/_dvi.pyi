"""The C part of the package, for checkers of types."""
from typing import Any

ffi: Any
lib: Any
