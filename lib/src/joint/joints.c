/* Joints, made from points and axes of the assembled machine. */
#include <dvi/joint.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "joint/joint_make.h"
#include "num/finite.h"
#include "num/pattern.h"

struct dvi_joints {
  int count, row_count;
  dvi__joint *joint;
  dvi_holonomic constraint; /* all rows */
  const char **row_name;    /* [row_count] names of joints */
  char **name;              /* [count] */
  int *start, *coordinate;  /* gradients by columns */
  dvi__pattern qq;
};

/* ---- callbacks ---- */

static int joints_value(double t, const double *q, double *phi, void *user)
{
  const dvi_joints *joints = user;
  (void)t;
  for (int j = 0; j < joints->count; j++)
    for (int k = 0; k < joints->joint[j].row_count; k++)
      *phi++ = dvi__joint_row_value(&joints->joint[j], &joints->joint[j].row[k], q);
  return 0;
}

static int joints_gradient(double t, const double *q, double *phi_q, void *user)
{
  const dvi_joints *joints = user;
  (void)t;
  for (int j = 0; j < joints->count; j++) {
    const dvi__joint *joint = &joints->joint[j];
    for (int k = 0; k < joint->row_count; k++) {
      double gradient[DVI__JOINT_NUMBERS];
      dvi__joint_row_gradient(joint, &joint->row[k], q, gradient);
      for (int e = joint->start[k]; e < joint->start[k + 1]; e++)
        *phi_q++ = gradient[joint->local[e]];
    }
  }
  return 0;
}

static int joints_hessian(double t, const double *q, const double *w, double *phi_w_qq, void *user)
{
  const dvi_joints *joints = user;
  (void)t, (void)q;
  memset(phi_w_qq, 0, (size_t)dvi__pattern_entries(&joints->qq) * sizeof *phi_w_qq);
  for (int j = 0; j < joints->count; j++) {
    const dvi__joint *joint = &joints->joint[j];
    for (int k = 0; k < joint->row_count; k++, w++)
      for (int e = 0; e < joint->bend_count; e++)
        phi_w_qq[joint->in_qq[e]] += *w * joint->curvature[k * joint->bend_count + e];
  }
  return 0;
}

/* ---- patterns ---- */

static dvi_status refuse_memory_of_joints(void)
{
  return dvi__fail(DVI_NO_MEMORY, "joints: no memory");
}

static int first_place(const dvi__body *body)
{
  return body->turn >= 0 ? body->turn : body->place;
}

/* List the local numbers of both bodies in the order of their places in q. */
static int order_numbers(const dvi__joint *joint, int *local)
{
  const int second = first_place(&joint->body[0]) > first_place(&joint->body[1]);
  int count = 0;
  for (int k = 0; k < DVI__JOINT_NUMBERS; k++) {
    const int number = (k + (second ? DVI__BODY_NUMBERS : 0)) % DVI__JOINT_NUMBERS;
    if (dvi__joint_coordinate(joint, number) >= 0) local[count++] = number;
  }
  return count;
}

/* List the local numbers that enter each row of a joint. */
static void list_numbers(dvi__joint *joint)
{
  int local[DVI__JOINT_NUMBERS], entries = 0;
  const int count = order_numbers(joint, local);
  for (int k = 0; k < joint->row_count; k++) {
    int enters[DVI__JOINT_NUMBERS];
    dvi__joint_row_numbers(joint, &joint->row[k], enters);
    for (int i = 0; i < count; i++)
      if (enters[local[i]]) joint->local[entries++] = local[i];
    joint->start[k + 1] = entries;
  }
}

static dvi_status make_gradients(dvi_joints *joints)
{
  size_t entries = 0;
  int at = 0, row = 0;
  for (int j = 0; j < joints->count; j++) {
    dvi__joint *joint = &joints->joint[j];
    list_numbers(joint);
    entries += (size_t)joint->start[joint->row_count];
    joints->row_count += joint->row_count;
  }
  joints->start = DVI_NEW(int, (size_t)joints->row_count + 1);
  joints->coordinate = DVI_NEW(int, entries);
  joints->row_name = DVI_NEW(const char *, joints->row_count);
  if (!joints->start || !joints->coordinate || !joints->row_name) return refuse_memory_of_joints();
  for (int j = 0; j < joints->count; j++) {
    const dvi__joint *joint = &joints->joint[j];
    for (int k = 0; k < joint->row_count; k++, row++) {
      joints->row_name[row] = joints->name[j];
      for (int e = joint->start[k]; e < joint->start[k + 1]; e++)
        joints->coordinate[at++] = dvi__joint_coordinate(joint, joint->local[e]);
      joints->start[row + 1] = at;
    }
  }
  return DVI_OK;
}

typedef double bend[DVI__JOINT_NUMBERS][DVI__JOINT_NUMBERS];

/* List the entries of a joint's Hessians, and their numbers in each row, which are constant. */
static dvi_status list_bends(dvi__joint *joint)
{
  bend of[DVI__JOINT_ROWS];
  int most = 0;
  for (int k = 0; k < joint->row_count; k++) dvi__joint_row_hessian(joint, &joint->row[k], of[k]);
  for (int m = 0; m < DVI__JOINT_NUMBERS * DVI__JOINT_NUMBERS; m++) {
    int meets = 0;
    for (int k = 0; k < joint->row_count; k++)
      meets |= of[k][m / DVI__JOINT_NUMBERS][m % DVI__JOINT_NUMBERS] != 0;
    most += meets;
    if (meets) joint->bend[joint->bend_count++] = m;
  }
  joint->in_qq = DVI_NEW(int, (size_t)most + 1);
  joint->curvature = DVI_NEW(double, (size_t)joint->row_count *(size_t)most + 1);
  if (joint->in_qq == NULL || joint->curvature == NULL) return refuse_memory_of_joints();
  for (int k = 0; k < joint->row_count; k++)
    for (int e = 0; e < most; e++)
      joint->curvature[k * most + e] =
          of[k][joint->bend[e] / DVI__JOINT_NUMBERS][joint->bend[e] % DVI__JOINT_NUMBERS];
  return DVI_OK;
}

/* Places (column, row) of entries in ascending order. */
static int compare_places(const void *a, const void *b)
{
  const int *x = a, *y = b;
  if (x[0] != y[0]) return x[0] < y[0] ? -1 : 1;
  return (x[1] > y[1]) - (x[1] < y[1]);
}

static void place_of_bend(const dvi__joint *joint, int e, int *place)
{
  place[0] = dvi__joint_coordinate(joint, joint->bend[e] % DVI__JOINT_NUMBERS);
  place[1] = dvi__joint_coordinate(joint, joint->bend[e] / DVI__JOINT_NUMBERS);
}

/* Compress sorted places, of which some are equal, to a pattern. */
static void compress_places(const int (*place)[2], size_t count, int nq, dvi__pattern *qq)
{
  int entries = 0, next = 0;
  for (size_t k = 0; k < count; k++) {
    if (k > 0 && compare_places(place[k - 1], place[k]) == 0) continue;
    while (next <= place[k][0]) qq->start[next++] = entries;
    qq->row[entries++] = place[k][1];
  }
  while (next <= nq) qq->start[next++] = entries;
}

static dvi_status make_hessians(dvi_joints *joints, int nq)
{
  size_t count = 0, at = 0;
  for (int j = 0; j < joints->count; j++) {
    DVI_TRY(list_bends(&joints->joint[j]));
    count += (size_t)joints->joint[j].bend_count;
  }
  int(*place)[2] = dvi__allocate(count + 1, sizeof *place);
  joints->qq = (dvi__pattern){nq, nq, DVI_NEW(int, (size_t)nq + 1), DVI_NEW(int, count + 1)};
  const int possible = place != NULL && joints->qq.start != NULL && joints->qq.row != NULL;
  for (int j = 0; possible && j < joints->count; j++)
    for (int e = 0; e < joints->joint[j].bend_count; e++)
      place_of_bend(&joints->joint[j], e, place[at++]);
  if (possible) {
    qsort(place, count, sizeof *place, compare_places);
    compress_places((const int(*)[2])place, count, nq, &joints->qq);
  }
  for (int j = 0; possible && j < joints->count; j++)
    for (int e = 0; e < joints->joint[j].bend_count; e++) {
      int of[2];
      place_of_bend(&joints->joint[j], e, of);
      joints->joint[j].in_qq[e] = dvi__pattern_find(&joints->qq, of[1], of[0]);
    }
  dvi__release(place);
  return possible ? DVI_OK : refuse_memory_of_joints();
}

/* ---- all joints ---- */

static const char *name_of(const dvi_joint *joint)
{
  return joint->name != NULL ? joint->name : "joint";
}

static dvi_status make_all(const dvi_factor *factors, int factor_count, const dvi_joint *given,
                           const double *q, dvi_joints *made)
{
  int nq = 0;
  for (int f = 0; f < factor_count; f++) nq += dvi__factor_numbers(&factors[f]);
  if (dvi__first_not_finite((size_t)nq, q) >= 0)
    return dvi__fail(DVI_NOT_FINITE, "joints: the coordinates of the machine are not finite");
  for (int j = 0; j < made->count; j++) {
    const char *name = name_of(&given[j]);
    DVI_TRY(dvi__joint_make(factors, factor_count, name, &given[j], q, &made->joint[j]));
    made->name[j] = dvi__duplicate(name, strlen(name) + 1, 1);
    if (made->name[j] == NULL) return refuse_memory_of_joints();
  }
  DVI_TRY(make_gradients(made));
  DVI_TRY(make_hessians(made, nq));
  made->constraint = (dvi_holonomic){.name = "joints",
                                     .count = made->row_count,
                                     .value = joints_value,
                                     .gradient = joints_gradient,
                                     .hessian = joints_hessian,
                                     .gradients = {made->start, made->coordinate},
                                     .qq = {made->qq.start, made->qq.row},
                                     .row_names = made->row_name,
                                     .user = made};
  return DVI_OK;
}

dvi_status dvi_joints_create(const dvi_factor *factors, int factor_count, const dvi_joint *joints,
                             int joint_count, const double *q, dvi_joints **made)
{
  if (made == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "joints: no place for the result");
  *made = NULL;
  if (factors == NULL || joints == NULL || q == NULL || factor_count < 1 || joint_count < 1)
    return dvi__fail(DVI_BAD_ARGUMENT, "joints: factors, joints and coordinates are needed");
  dvi_joints *x = *made = DVI_NEW(dvi_joints, 1);
  if (x == NULL) return refuse_memory_of_joints();
  x->count = joint_count;
  x->joint = DVI_NEW(dvi__joint, joint_count);
  x->name = DVI_NEW(char *, joint_count);
  const dvi_status status = x->joint != NULL && x->name != NULL
                                ? make_all(factors, factor_count, joints, q, x)
                                : refuse_memory_of_joints();
  if (status != DVI_OK) dvi_joints_destroy(made);
  return status;
}

const dvi_holonomic *dvi_joints_constraints(const dvi_joints *joints)
{
  return joints != NULL ? &joints->constraint : NULL;
}

void dvi_joints_destroy(dvi_joints **joints)
{
  if (joints == NULL || *joints == NULL) return;
  dvi_joints *x = *joints;
  for (int j = 0; j < x->count && x->joint != NULL && x->name != NULL; j++) {
    dvi__release(x->joint[j].in_qq);
    dvi__release(x->joint[j].curvature);
    dvi__release(x->name[j]);
  }
  dvi__pattern_clear(&x->qq);
  dvi__release(x->joint);
  dvi__release(x->name);
  dvi__release(x->row_name);
  dvi__release(x->start);
  dvi__release(x->coordinate);
  dvi__release(x);
  *joints = NULL;
}
