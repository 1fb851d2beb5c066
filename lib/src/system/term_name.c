/* The terms of a system in words. */
#include "system/term_name.h"

#include "system/system.h"

const char *dvi__term_name(unsigned terms)
{
  switch (terms & (0 - terms)) {
  case DVI__CONSTANT_MASS: return "a constant mass";
  case DVI__LAGRANGIAN: return "a general Lagrangian";
  case DVI__ONE_FORM: return "a one-form";
  case DVI__FACTORS:
    return "bodies, rotations, directions or angles, factors of its configuration space";
  case DVI__CONSTRAINED_HAMILTONIAN: return "a Hamiltonian with constraints";
  case DVI__ROTATIONS: return "rotations";
  case DVI__DIRECTIONS: return "directions (S^2)";
  case DVI__HAMILTONIAN: return "a Hamiltonian without constraints";
  case DVI__FORCE: return "forces without a potential";
  case DVI__FRICTION: return "forces without a potential that depend on the velocity";
  case DVI__HOLONOMIC: return "holonomic constraints phi(t,q) = 0";
  case DVI__VECTOR_POTENTIAL: return "a vector potential A(t,q).v";
  case DVI__NONHOLONOMIC: return "nonholonomic constraints A v + a = 0";
  case DVI__CONTACT: return "contacts phi(t,q) >= 0";
  case DVI__DAMPING: return "damping, uniform friction -gamma p";
  case DVI__RUBBING: return "contacts with friction";
  case DVI__NOISE: return "noise";
  case DVI__FAST: return "a fast potential (one that is declared `fast`)";
  default: return "potentials";
  }
}
