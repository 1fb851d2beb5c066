"""Lagrangians of sympy, printed as scenes."""


def scene(lagrangian, coordinates, time, parameters):
    """Return the text of a scene with a Lagrangian of sympy, and a start of zeros."""
    import sympy
    from sympy.printing.str import StrPrinter
    time = time or coordinates[0].args[0]
    names = {x: x.func.__name__ for x in coordinates}

    class Printer(StrPrinter):
        """Print what scenes call otherwise than sympy."""

        def _print_Derivative(self, of):
            if of.expr in names and of.variables == (time,):
                return names[of.expr] + "'"
            raise ValueError(f"a Lagrangian has no derivative {of}")

        def _print_AppliedUndef(self, of):
            if of not in names:
                raise ValueError(f"{of} is no coordinate")
            return names[of]

        def _print_Pow(self, power, rational=False):
            base, exponent = power.as_base_exp()
            if exponent == sympy.S.Half:
                return f"sqrt({self._print(base)})"
            return f"({self._print(base)})^({self._print(exponent)})"

        def _print_Abs(self, of):
            return f"abs({self._print(of.args[0])})"

        def _print_Float(self, number):
            return repr(float(number))

        def _print_Symbol(self, symbol):
            return "t" if symbol == time else symbol.name
    text = Printer().doprint(sympy.sympify(lagrangian))
    symbols = {symbol.name for symbol in sympy.sympify(lagrangian).free_symbols - {time}}
    missing = symbols - set(parameters)
    if missing:
        raise TypeError(f"the Lagrangian has symbols without a number: {', '.join(sorted(missing))}")
    lines = ["parameters:"] if parameters else []
    lines += [f"  {name}: {float(value)!r}" for name, value in parameters.items()]
    lines += ["coordinates:"] + [f"  {name}: scalar" for name in names.values()]
    lines += [f"lagrangian: {text}", "initial:"] + [f"  {name}: 0" for name in names.values()]
    return "\n".join(lines + ["step: 1", "until: 1", ""])
