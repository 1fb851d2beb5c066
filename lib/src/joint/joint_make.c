/* The rows of a joint, from the points and axes of the assembled machine. */
#include "joint/joint_make.h"

#include <math.h>

#include "core/status.h"
#include "num/finite.h"

/* A point or an axis of space in the frame of body k of the joint. The ground has constants. */
static dvi__affine fixed_in(const dvi__joint *joint, int k, const double *q, const double *given,
                            int is_direction)
{
  const dvi__body *body = &joint->body[k];
  dvi__affine made = {{0}, 1, {{.body = k, .is_direction = is_direction, .sign = 1}}};
  double from_body[3];
  if (body->turn < 0 && body->place < 0) {
    made = (dvi__affine){.constant = {given[0], given[1], given[2]}};
    return made;
  }
  for (int i = 0; i < 3; i++)
    from_body[i] = given[i] - (is_direction || body->place < 0 ? 0 : q[body->place + i]);
  for (int j = 0; j < 3; j++)
    for (int i = 0; i < 3 && body->turn >= 0; i++)
      made.part[0].r[j] += q[body->turn + 3 * i + j] * from_body[i];
  return made;
}

/* Compute plus - minus. */
static dvi__affine difference(const dvi__affine *plus, const dvi__affine *minus)
{
  dvi__affine made = *plus;
  for (int i = 0; i < 3; i++) made.constant[i] -= minus->constant[i];
  for (int k = 0; k < minus->count; k++) {
    made.part[made.count] = minus->part[k];
    made.part[made.count++].sign *= -1;
  }
  return made;
}

static void add_row(dvi__joint *joint, const dvi__affine *a, const dvi__affine *b, double value)
{
  joint->row[joint->row_count++] = (dvi__joint_row){*a, *b, value};
}

/* What the rows of one joint are made of. */
typedef struct assembly {
  const dvi_joint *given;
  const double *q;
  dvi__joint *joint;
  double frame[3][3]; /* the axis, and two orthogonal to it, in space */
} assembly;

static dvi__affine axis_of(const assembly *x, int body, const double *axis)
{
  return fixed_in(x->joint, body, x->q, axis, 1);
}

/* d = b - a. */
static dvi__affine displacement(const assembly *x)
{
  const double *to = x->given->kind == DVI_DISTANCE ? x->given->to : x->given->at;
  const dvi__affine b = fixed_in(x->joint, 1, x->q, to, 0),
                    a = fixed_in(x->joint, 0, x->q, x->given->at, 0);
  return difference(&b, &a);
}

static void add_point_rows(const assembly *x)
{
  const dvi__affine d = displacement(x);
  for (int i = 0; i < 3; i++) {
    dvi__affine e = {.count = 0};
    e.constant[i] = 1;
    add_row(x->joint, &d, &e, 0);
  }
}

/* Keep axis i of the first body orthogonal to axis j of the second. */
static void add_axis_row(const assembly *x, int i, int j)
{
  const dvi__affine first = axis_of(x, 0, x->frame[i]), second = axis_of(x, 1, x->frame[j]);
  add_row(x->joint, &first, &second, 0);
}

static void add_displacement_row(const assembly *x, int i)
{
  const dvi__affine d = displacement(x), axis = axis_of(x, 0, x->frame[i]);
  add_row(x->joint, &d, &axis, 0);
}

static void add_distance_row(const assembly *x)
{
  const dvi__affine d = displacement(x);
  double squared = 0;
  for (int i = 0; i < 3; i++) {
    const double length = x->given->to[i] - x->given->at[i];
    squared += 0.5 * length * length;
  }
  dvi__affine half = d;
  for (int i = 0; i < 3; i++) half.constant[i] *= 0.5;
  for (int k = 0; k < half.count; k++) half.part[k].sign *= 0.5;
  add_row(x->joint, &half, &d, squared);
}

static void add_turn_rows(const assembly *x)
{
  add_axis_row(x, 0, 1);
  add_axis_row(x, 0, 2);
  add_axis_row(x, 1, 2);
}

static void add_rows(const assembly *x)
{
  switch (x->given->kind) {
  case DVI_BALL: add_point_rows(x); break;
  case DVI_HINGE:
    add_point_rows(x);
    add_axis_row(x, 1, 0);
    add_axis_row(x, 2, 0);
    break;
  case DVI_UNIVERSAL: {
    const dvi__affine first = axis_of(x, 0, x->frame[0]),
                      second = axis_of(x, 1, x->given->second_axis);
    add_point_rows(x);
    add_row(x->joint, &first, &second, 0);
    break;
  }
  case DVI_SLIDER:
    add_displacement_row(x, 1);
    add_displacement_row(x, 2);
    add_turn_rows(x);
    break;
  case DVI_PLANAR:
    add_displacement_row(x, 0);
    add_axis_row(x, 1, 0);
    add_axis_row(x, 2, 0);
    break;
  case DVI_WELD:
    add_point_rows(x);
    add_turn_rows(x);
    break;
  case DVI_DISTANCE: add_distance_row(x); break;
  }
}

/* ---- what is given ---- */

static double length_of(const double *x)
{
  return sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
}

/* Make an orthonormal frame whose first axis is along x. */
static void make_frame(const double *x, double frame[3][3])
{
  const double length = length_of(x);
  double *u = frame[0], *v = frame[1], *w = frame[2];
  int least = 0;
  for (int i = 0; i < 3; i++) u[i] = x[i] / length;
  for (int i = 1; i < 3; i++)
    if (fabs(u[i]) < fabs(u[least])) least = i;
  for (int i = 0; i < 3; i++) v[i] = (i == least) - u[least] * u[i];
  const double across = length_of(v);
  for (int i = 0; i < 3; i++) v[i] /= across;
  for (int i = 0; i < 3; i++)
    w[i] = u[(i + 1) % 3] * v[(i + 2) % 3] - u[(i + 2) % 3] * v[(i + 1) % 3];
}

int dvi__factor_numbers(const dvi_factor *factor)
{
  switch (factor->kind) {
  case DVI_SO3: return 9;
  case DVI_SE3: return 12;
  case DVI_S2: return 3;
  case DVI_U1: return 2;
  default: return factor->size;
  }
}

/* Find the numbers of a body. `turns` says that the joint needs axes. */
static dvi_status find_body(const char *name, const dvi_factor *factors, int count, int index,
                            int turns, dvi__body *body)
{
  *body = (dvi__body){-1, -1};
  if (index == DVI_GROUND) return DVI_OK;
  if (index < 0 || index >= count)
    return dvi__fail(DVI_BAD_ARGUMENT, "joint '%s': there is no body %d among %d factors", name,
                     index, count);
  int at = 0;
  for (int f = 0; f < index; f++) at += dvi__factor_numbers(&factors[f]);
  const dvi_factor *factor = &factors[index];
  const int is_point = factor->kind == DVI_RN && factor->size == 3;
  if (factor->kind == DVI_SO3 || factor->kind == DVI_SE3)
    *body = (dvi__body){at, factor->kind == DVI_SE3 ? at + 9 : -1};
  else if (is_point && !turns)
    body->place = at;
  else
    return dvi__fail(DVI_BAD_ARGUMENT, "joint '%s': factor %d is %s", name, index,
                     is_point ? "a point, which has no axes; points take balls and distances"
                              : "neither a rigid motion, nor a rotation, nor a point of R^3");
  return DVI_OK;
}

static dvi_status check_axes(const char *name, const dvi_joint *given)
{
  if (given->kind == DVI_BALL || given->kind == DVI_DISTANCE || given->kind == DVI_WELD)
    return DVI_OK;
  const double *u = given->axis, *w = given->second_axis;
  if (!(length_of(u) > 0) || (given->kind == DVI_UNIVERSAL && !(length_of(w) > 0)))
    return dvi__fail(DVI_BAD_ARGUMENT, "joint '%s': an axis of length 0", name);
  const double along = u[0] * w[0] + u[1] * w[1] + u[2] * w[2];
  if (given->kind == DVI_UNIVERSAL && !(fabs(along) <= 1e-12 * length_of(u) * length_of(w)))
    return dvi__fail(DVI_BAD_ARGUMENT, "joint '%s': its two axes are not orthogonal", name);
  return DVI_OK;
}

static dvi_status check_joint(const char *name, const dvi_joint *given)
{
  const double *const numbers[] = {given->at, given->to, given->axis, given->second_axis};
  if ((int)given->kind < DVI_BALL || (int)given->kind > DVI_DISTANCE)
    return dvi__fail(DVI_BAD_ARGUMENT, "joint '%s' is of no known kind (%d)", name,
                     (int)given->kind);
  for (int k = 0; k < 4; k++)
    if (dvi__first_not_finite(3, numbers[k]) >= 0)
      return dvi__fail(DVI_NOT_FINITE, "joint '%s': a point or an axis is not finite", name);
  if (given->body[0] == DVI_GROUND && given->body[1] == DVI_GROUND)
    return dvi__fail(DVI_BAD_ARGUMENT, "joint '%s' joins the ground to itself", name);
  if (given->body[0] == given->body[1])
    return dvi__fail(DVI_BAD_ARGUMENT, "joint '%s' joins body %d to itself", name, given->body[0]);
  double way = 0;
  for (int i = 0; i < 3; i++) way = fmax(way, fabs(given->to[i] - given->at[i]));
  if (given->kind == DVI_DISTANCE && way == 0)
    return dvi__fail(DVI_BAD_ARGUMENT, "joint '%s': a distance of 0; a ball joins two points",
                     name);
  return check_axes(name, given);
}

static int needs_axes(dvi_joint_kind kind)
{
  return kind != DVI_BALL && kind != DVI_DISTANCE;
}

dvi_status dvi__joint_make(const dvi_factor *factors, int count, const char *name,
                           const dvi_joint *given, const double *q, dvi__joint *joint)
{
  assembly x = {given, q, joint, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  DVI_TRY(check_joint(name, given));
  for (int k = 0; k < 2; k++)
    DVI_TRY(
        find_body(name, factors, count, given->body[k], needs_axes(given->kind), &joint->body[k]));
  if (needs_axes(given->kind) && given->kind != DVI_WELD) make_frame(given->axis, x.frame);
  add_rows(&x);
  return DVI_OK;
}
