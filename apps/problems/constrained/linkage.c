/* Uniform rods of mass m and length l in the plane, which pins join, in a tree or in a closed
 * chain,
 *
 *     L = sum_k m (x_k'^2 + y_k'^2)/2 + m l^2 a_k'^2/24 - m g y_k.
 *
 * Rod k has its centre at (x_k,y_k) and the angle a_k. It leads from (x_k,y_k) - l/2 (cos a_k, sin
 * a_k), its head, to its foot on the other side. In the tree rod 0 hangs by its head from the
 * origin, and rod k > 0 from the foot of rod (k - 1)/2. In the chain each head is pinned to the
 * foot of the rod before, that of rod 0 to that of the last one, and to the origin. Each pin is two
 * rows. */
#include <math.h>

#include "entry.h"

enum { HEAD = -1, FOOT = 1 };

/* Two ends that are one point. Without a second rod, `other` < 0, it is the origin. */
typedef struct linkage_pin {
  int rod, side, other, other_side;
} linkage_pin;

typedef struct linkage {
  double m, l, g, *mass;
  int rods, pins;
  linkage_pin *pin;
  int *angle_start, *angle_row; /* pattern of phi's Hessians: the angles on the diagonal */
  int *start, *row;             /* gradients by row */
} linkage;

static int linkage_weight(double t, const double *q, double *V, void *user)
{
  const linkage *own = user;
  (void)t;
  *V = 0;
  for (int k = 0; k < own->rods; k++) *V += own->m * own->g * q[3 * k + 1];
  return 0;
}

static int linkage_weight_gradient(double t, const double *q, double *V_q, void *user)
{
  const linkage *own = user;
  (void)t, (void)q;
  for (int k = 0; k < own->rods; k++) {
    V_q[3 * k] = V_q[3 * k + 2] = 0;
    V_q[3 * k + 1] = own->m * own->g;
  }
  return 0;
}

/* The weight is linear, and its pattern has no entries. */
static int linkage_no_hessian(double t, const double *q, double *V_qq, void *user)
{
  (void)t, (void)q, (void)V_qq, (void)user;
  return 0;
}

static double linkage_end(const linkage *own, const double *q, int rod, int side, int is_y)
{
  const double a = q[3 * rod + 2];
  return q[3 * rod + is_y] + side * own->l / 2 * (is_y ? sin(a) : cos(a));
}

static int linkage_phi(double t, const double *q, double *phi, void *user)
{
  const linkage *own = user;
  (void)t;
  for (int i = 0; i < 2 * own->pins; i++) {
    const linkage_pin *pin = &own->pin[i / 2];
    phi[i] = linkage_end(own, q, pin->rod, pin->side, i % 2);
    if (pin->other >= 0) phi[i] -= linkage_end(own, q, pin->other, pin->other_side, i % 2);
  }
  return 0;
}

/* Write the derivatives of an end by x or y, and by the angle. */
static double *linkage_slopes(const linkage *own, const double *q, int rod, double side, int is_y,
                              double sign, double *at)
{
  const double a = q[3 * rod + 2], arm = sign * side * own->l / 2;
  *at++ = sign;
  *at++ = is_y ? arm * cos(a) : -arm * sin(a);
  return at;
}

static int linkage_phi_gradient(double t, const double *q, double *phi_q, void *user)
{
  const linkage *own = user;
  (void)t;
  for (int i = 0; i < 2 * own->pins; i++) {
    const linkage_pin *pin = &own->pin[i / 2];
    phi_q = linkage_slopes(own, q, pin->rod, pin->side, i % 2, 1, phi_q);
    if (pin->other >= 0)
      phi_q = linkage_slopes(own, q, pin->other, pin->other_side, i % 2, -1, phi_q);
  }
  return 0;
}

static void linkage_bend(const linkage *own, const double *q, int rod, double arm, const double *w,
                         double *phi_w)
{
  const double a = q[3 * rod + 2];
  phi_w[rod] -= arm * own->l / 2 * (w[0] * cos(a) + w[1] * sin(a));
}

static int linkage_phi_hessian(double t, const double *q, const double *w, double *phi_w,
                               void *user)
{
  const linkage *own = user;
  (void)t;
  for (int k = 0; k < own->rods; k++) phi_w[k] = 0;
  for (int i = 0; i < own->pins; i++) {
    const linkage_pin *pin = &own->pin[i];
    linkage_bend(own, q, pin->rod, pin->side, w + 2 * i, phi_w);
    if (pin->other >= 0) linkage_bend(own, q, pin->other, -pin->other_side, w + 2 * i, phi_w);
  }
  return 0;
}

/* ---- pins ---- */

static void linkage_list_tree(linkage *own)
{
  own->pin[own->pins++] = (linkage_pin){0, HEAD, -1, 0};
  for (int k = 1; k < own->rods; k++)
    own->pin[own->pins++] = (linkage_pin){(k - 1) / 2, FOOT, k, HEAD};
}

static void linkage_list_ring(linkage *own)
{
  own->pin[own->pins++] = (linkage_pin){0, HEAD, -1, 0};
  for (int k = 1; k < own->rods; k++) own->pin[own->pins++] = (linkage_pin){k - 1, FOOT, k, HEAD};
  own->pin[own->pins++] = (linkage_pin){0, HEAD, own->rods - 1, FOOT};
}

/* Rows of phi_q are those of the first rod, which comes first among the coordinates, too. */
static void linkage_list_patterns(linkage *own)
{
  int entries = 0, angles = 0;
  for (int i = 0; i < 2 * own->pins; i++) {
    const linkage_pin *pin = &own->pin[i / 2];
    for (int j = 0; j < 2; j++) {
      const int rod = j == 0 ? pin->rod : pin->other;
      if (rod < 0) continue;
      own->row[entries++] = 3 * rod + i % 2;
      own->row[entries++] = 3 * rod + 2;
    }
    own->start[i + 1] = entries;
  }
  for (int j = 0; j < 3 * own->rods; j++) {
    if (j % 3 == 2) own->angle_row[angles++] = j;
    own->angle_start[j + 1] = angles;
  }
}

static dvi_status linkage_join(problem *made, int is_ring, linkage *own)
{
  const size_t rods = (size_t)own->rods;
  own->mass = problem_allocate(made, 3 * rods, sizeof *own->mass);
  own->pin = problem_allocate(made, rods + 1, sizeof *own->pin);
  own->start = problem_allocate(made, 2 * rods + 3, sizeof *own->start);
  own->row = problem_allocate(made, 8 * rods + 8, sizeof *own->row);
  own->angle_start = problem_allocate(made, 3 * rods + 1, sizeof *own->angle_start);
  own->angle_row = problem_allocate(made, rods, sizeof *own->angle_row);
  if (!own->mass || !own->pin || !own->start || !own->row || !own->angle_start || !own->angle_row)
    return DVI_NO_MEMORY;
  if (is_ring)
    linkage_list_ring(own);
  else
    linkage_list_tree(own);
  linkage_list_patterns(own);
  for (int k = 0; k < own->rods; k++) {
    own->mass[3 * k] = own->mass[3 * k + 1] = own->m;
    own->mass[3 * k + 2] = own->m * own->l * own->l / 12;
  }
  return DVI_OK;
}

/* ---- starts ---- */

/* Place a rod by its head and its angle. */
static void linkage_place(const linkage *own, int rod, double x, double y, double a, double *q)
{
  q[3 * rod] = x + own->l / 2 * cos(a);
  q[3 * rod + 1] = y + own->l / 2 * sin(a);
  q[3 * rod + 2] = a;
}

/* The tree opens to the right at rest, less so from level to level. */
static void linkage_start_tree(const linkage *own, problem *made)
{
  linkage_place(own, 0, 0, 0, -1.25, made->q);
  for (int k = 1; k < own->rods; k++) {
    const int from = (k - 1) / 2;
    const double opening = 0.5 / (1 + ilogb(k + 1.0)), a = made->q[3 * from + 2];
    linkage_place(own, k, linkage_end(own, made->q, from, FOOT, 0),
                  linkage_end(own, made->q, from, FOOT, 1), a + (k % 2 ? -opening : opening),
                  made->q);
  }
}

/* Give the chord over l of an arc of rods whose directions turn evenly from -half to half. */
static double linkage_chord(int rods, double half)
{
  return sin(half) / sin(half / rods);
}

/* Find the arc with this chord by bisection. */
static double linkage_half(int rods, double chord)
{
  double least = 1e-3, most = 3.1;
  for (int k = 0; k < 60; k++) {
    const double half = 0.5 * (least + most);
    *(linkage_chord(rods, half) > chord ? &least : &most) = half;
  }
  return least;
}

/* The chain hangs at rest as two arcs, down and up again, so that all of it is pulled. A polygon
 * would be pressed like an arch, and buckle. */
static void linkage_start_ring(const linkage *own, problem *made)
{
  const int down = own->rods / 2, up = own->rods - down;
  const double first = 0.5, last = linkage_half(up, linkage_chord(down, first)),
               quarter = 1.57079632679489661923;
  double x = 0, y = 0;
  for (int k = 0; k < own->rods; k++) {
    const double turn = k < down ? first * ((2 * k + 1.0) / down - 1)
                                 : last * ((2 * (k - down) + 1.0) / up - 1);
    linkage_place(own, k, x, y, (k < down ? -quarter : quarter) + turn, made->q);
    x = linkage_end(own, made->q, k, FOOT, 0);
    y = linkage_end(own, made->q, k, FOOT, 1);
  }
}

static dvi_status linkage_make(const double *setting, problem *made)
{
  const int is_ring = setting[0] > 0, rods = (int)setting[1];
  dvi_status status = problem_room(made, 3 * rods, sizeof(linkage));
  if (status != DVI_OK) return status;
  linkage *own = made->parameters;
  *own = (linkage){.m = setting[2], .l = setting[3], .g = setting[4], .rods = rods};
  status = linkage_join(made, is_ring, own);
  if (status != DVI_OK) return status;
  (is_ring ? linkage_start_ring : linkage_start_tree)(own, made);
  for (int i = 0; i < 3 * rods; i++) problem_label(made, i, "%c_%d", "xya"[i % 3], i / 3);

  int *none = problem_allocate(made, 3 * (size_t)rods + 1, sizeof *none);
  if (none == NULL) return DVI_NO_MEMORY;
  const dvi_potential weight = {.name = "weight",
                                .value = linkage_weight,
                                .gradient = linkage_weight_gradient,
                                .hessian = linkage_no_hessian,
                                .qq = {none, none},
                                .user = own};
  const dvi_holonomic pins = {.name = "pins",
                              .count = 2 * own->pins,
                              .value = linkage_phi,
                              .gradient = linkage_phi_gradient,
                              .hessian = linkage_phi_hessian,
                              .gradients = {own->start, own->row},
                              .qq = {own->angle_start, own->angle_row},
                              .user = own};
  return problem_system(made, &(dvi_system_terms){.dimension = 3 * rods,
                                                  .mass.diagonal = own->mass,
                                                  .potentials = &weight,
                                                  .potential_count = 1,
                                                  .holonomics = &pins,
                                                  .holonomic_count = 1,
                                                  .autonomous = 1});
}

static const char *const forms[] = {"tree", "ring", NULL};

static const problem_parameter parameters[] = {
    {.name = "form",
     .choice = forms,
     .most = 1,
     .whole = 1,
     .help = "tree or ring: each rod carries two, or the rods are a closed chain"},
    {.name = "links",
     .value = 3,
     .least = 3,
     .most = 1e6,
     .whole = 1,
     .help = "the number of rods, a whole number from 3 to 1e6"},
    PROBLEM_MASS(1),
    {.name = "l", .value = 1, .least = 1e-3, .most = 1e3, .help = "the length of a rod"},
    {.name = "g", .value = 1, .least = 0, .most = 1e50, .help = "gravity, 0 or more"},
    {.name = NULL},
};

/* Quadruple-precision results, recomputed by tests/reference/test_digits. */
static const double digits_q[] = {-0.11339089140023288, -0.4869727977489714, -1.7995684224789308,
                                  -0.27278328331207075, -1.4718249603552149, -1.6629296187493485,
                                  -0.47420908668219164, -1.4084334886478211, -2.0884638359693972};
static const double digits_p[] = {
    -0.09701438851590348, 0.022589656020452833, -0.016601609810026327,
    -0.31526272296532465, 0.056380707036425018, -0.020291720326045915,
    -0.16911272709649941, 0.030990398710818951, 0.0047788155374279264};

const problem_entry problem_entry_linkage = {
    .name = "linkage",
    .summary = "rods and pins, a tree or a closed chain, of any number",
    .parameters = parameters,
    .make = linkage_make,
    .h = 0.02,
    .t_end = 20.0,
    .order_h = 0.1,
    .order_t_end = 3.0,
    .digits_q = digits_q,
    .digits_p = digits_p,
};
