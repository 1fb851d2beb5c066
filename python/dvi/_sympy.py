"""Lagrangians of sympy, printed as scenes."""
from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any


def scene(lagrangian: Any, coordinates: Sequence[Any], time: Any,
          parameters: Mapping[str, float]) -> str:
    """Return the text of a scene with a Lagrangian of sympy, and a start of zeros."""
    import sympy
    from sympy.printing.str import StrPrinter
    time = time or coordinates[0].args[0]
    names = {x: x.func.__name__ for x in coordinates}

    class Printer(StrPrinter):
        """Print what scenes call otherwise than sympy."""

        def _print_Derivative(self, of: Any) -> str:
            if of.expr in names and of.variables == (time,):
                return names[of.expr] + "'"
            raise ValueError(f"a Lagrangian has no derivative {of}")

        def _print_AppliedUndef(self, of: Any) -> str:
            if of not in names:
                raise ValueError(f"{of} is no coordinate")
            return names[of]

        def _print_Pow(self, power: Any, rational: bool = False) -> str:
            base, exponent = power.as_base_exp()
            if exponent == sympy.S.Half:
                return f"sqrt({self._print(base)})"
            return f"({self._print(base)})^({self._print(exponent)})"

        def _print_Abs(self, of: Any) -> str:
            return f"abs({self._print(of.args[0])})"

        def _print_Float(self, number: Any) -> str:
            return repr(float(number))

        def _print_Symbol(self, symbol: Any) -> str:
            return "t" if symbol == time else symbol.name
    text = Printer().doprint(sympy.sympify(lagrangian))
    symbols = {symbol.name for symbol in sympy.sympify(lagrangian).free_symbols - {time}}
    missing = sorted(symbols - set(parameters))
    if missing:
        raise TypeError(f"the Lagrangian has symbols without a number: {', '.join(missing)}")
    unknown = set(parameters) - symbols
    if unknown:
        raise TypeError(f"the Lagrangian has no symbol {', '.join(sorted(unknown))}")
    lines = ["parameters:"] if parameters else []
    lines += [f"  {name}: {float(value)!r}" for name, value in parameters.items()]
    lines += ["coordinates:"] + [f"  {name}: scalar" for name in names.values()]
    lines += [f"lagrangian: {text}", "initial:"] + [f"  {name}: 0" for name in names.values()]
    return "\n".join(lines + ["step: 1", "until: 1", ""])
