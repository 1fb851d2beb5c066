/* Quadratures of triangles and tetrahedra.
 *
 * Their points are orbits of the symmetries of the simplex. Degrees 1 and 2 have closed forms. That
 * of degree 4 in triangles has (8 - sqrt(10) +- sqrt(38 - 44 sqrt(2/5)))/18 and the weights
 * (620 +- sqrt(213125 - 53320 sqrt(10)))/3720. Sources: Strang and Fix 1973, table 4.1; Walkington
 * 2000, for the 14 points of degree 5 in tetrahedra. */
#include "field/space/simplex_rule.h"

#include <stddef.h>

/* Orbits: one coordinate is `1 - n a` and the others are a, and in tetrahedra two are a and two are
 * 1/2 - a. */
#define TRIANGLE(a)                         \
  {1 - 2 * (a), a, a}, {a, 1 - 2 * (a), a}, \
  {                                         \
    a, a, 1 - 2 * (a)                       \
  }
#define TETRAHEDRON(a)                                                    \
  {1 - 3 * (a), a, a, a}, {a, 1 - 3 * (a), a, a}, {a, a, 1 - 3 * (a), a}, \
  {                                                                       \
    a, a, a, 1 - 3 * (a)                                                  \
  }
#define PAIRS(a)                                                                            \
  {a, a, 0.5 - (a), 0.5 - (a)}, {a, 0.5 - (a), a, 0.5 - (a)}, {a, 0.5 - (a), 0.5 - (a), a}, \
      {0.5 - (a), a, a, 0.5 - (a)}, {0.5 - (a), a, 0.5 - (a), a},                           \
  {                                                                                         \
    0.5 - (a), 0.5 - (a), a, a                                                              \
  }
#define THREE(w) w, w, w
#define FOUR(w) w, w, w, w

static const dvi__simplex_rule rules[] = {
    {2, 1, 1, {{1.0 / 3, 1.0 / 3, 1.0 / 3}}, {1}},
    {2, 3, 2, {TRIANGLE(1.0 / 6)}, {THREE(1.0 / 3)}},
    {2,
     6,
     4,
     {TRIANGLE(0.44594849091596488632), TRIANGLE(0.091576213509770743460)},
     {THREE(0.22338158967801146570), THREE(0.10995174365532186764)}},
    {3, 1, 1, {{0.25, 0.25, 0.25, 0.25}}, {1}},
    {3, 4, 2, {TETRAHEDRON(0.13819660112501051518)}, {FOUR(0.25)}},
    {3,
     14,
     5,
     {TETRAHEDRON(0.31088591926330060980), TETRAHEDRON(0.092735250310891226402),
      PAIRS(0.045503704125649649492)},
     {FOUR(0.11268792571801585080), FOUR(0.073493043116361949544), THREE(0.042546020777081466438),
      THREE(0.042546020777081466438)}},
};

const dvi__simplex_rule *dvi__simplex_rule_of(int n, int degree, int points)
{
  for (size_t i = 0; i < sizeof rules / sizeof *rules; i++)
    if (rules[i].n == n && (points > 0 ? rules[i].points == points : rules[i].degree >= 2 * degree))
      return &rules[i];
  return NULL;
}
