#include "joint/joint_rows.h"

#include <string.h>

int dvi__joint_coordinate(const dvi__joint *joint, int local)
{
  const dvi__body *body = &joint->body[local / DVI__BODY_NUMBERS];
  const int i = local % DVI__BODY_NUMBERS;
  if (i < 9) return body->turn < 0 ? -1 : body->turn + i;
  return body->place < 0 ? -1 : body->place + i - 9;
}

/* Compute a vector at q. */
static void affine_value(const dvi__joint *joint, const dvi__affine *vector, const double *q,
                         double *value)
{
  memcpy(value, vector->constant, 3 * sizeof *value);
  for (int k = 0; k < vector->count; k++) {
    const dvi__affine_part *part = &vector->part[k];
    const dvi__body *body = &joint->body[part->body];
    const double *R = q + body->turn, *x = q + body->place, *r = part->r;
    for (int i = 0; i < 3; i++) {
      double sum = part->is_direction || body->place < 0 ? 0 : x[i];
      if (body->turn >= 0) sum += R[3 * i] * r[0] + R[3 * i + 1] * r[1] + R[3 * i + 2] * r[2];
      value[i] += part->sign * sum;
    }
  }
}

double dvi__joint_row_value(const dvi__joint *joint, const dvi__joint_row *row, const double *q)
{
  double a[3], b[3];
  affine_value(joint, &row->a, q, a);
  affine_value(joint, &row->b, q, b);
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] - row->value;
}

/* Write the derivatives of component i of a vector. The numbers of both bodies must be 0 before. */
static void affine_slopes(const dvi__joint *joint, const dvi__affine *vector, int i, double *slope)
{
  for (int k = 0; k < vector->count; k++) {
    const dvi__affine_part *part = &vector->part[k];
    const dvi__body *body = &joint->body[part->body];
    double *of = slope + DVI__BODY_NUMBERS * part->body;
    for (int j = 0; j < 3 && body->turn >= 0; j++) of[3 * i + j] += part->sign * part->r[j];
    if (!part->is_direction && body->place >= 0) of[9 + i] += part->sign;
  }
}

/* Tell whether component i of a vector may differ from 0. */
static int may_act(const dvi__affine *vector, int i)
{
  return vector->count > 0 || vector->constant[i] != 0;
}

void dvi__joint_row_numbers(const dvi__joint *joint, const dvi__joint_row *row, int *enters)
{
  memset(enters, 0, DVI__JOINT_NUMBERS * sizeof *enters);
  for (int i = 0; i < 3; i++) {
    double in_a[DVI__JOINT_NUMBERS] = {0}, in_b[DVI__JOINT_NUMBERS] = {0};
    if (may_act(&row->b, i)) affine_slopes(joint, &row->a, i, in_a);
    if (may_act(&row->a, i)) affine_slopes(joint, &row->b, i, in_b);
    for (int m = 0; m < DVI__JOINT_NUMBERS; m++) enters[m] |= in_a[m] != 0 || in_b[m] != 0;
  }
}

void dvi__joint_row_gradient(const dvi__joint *joint, const dvi__joint_row *row, const double *q,
                             double *gradient)
{
  double a[3], b[3];
  affine_value(joint, &row->a, q, a);
  affine_value(joint, &row->b, q, b);
  memset(gradient, 0, DVI__JOINT_NUMBERS * sizeof *gradient);
  for (int i = 0; i < 3; i++) {
    double in_a[DVI__JOINT_NUMBERS] = {0}, in_b[DVI__JOINT_NUMBERS] = {0};
    affine_slopes(joint, &row->a, i, in_a);
    affine_slopes(joint, &row->b, i, in_b);
    for (int m = 0; m < DVI__JOINT_NUMBERS; m++) gradient[m] += in_a[m] * b[i] + in_b[m] * a[i];
  }
}

void dvi__joint_row_hessian(const dvi__joint *joint, const dvi__joint_row *row,
                            double hessian[DVI__JOINT_NUMBERS][DVI__JOINT_NUMBERS])
{
  memset(hessian, 0, sizeof(double) * DVI__JOINT_NUMBERS * DVI__JOINT_NUMBERS);
  for (int i = 0; i < 3; i++) {
    double in_a[DVI__JOINT_NUMBERS] = {0}, in_b[DVI__JOINT_NUMBERS] = {0};
    affine_slopes(joint, &row->a, i, in_a);
    affine_slopes(joint, &row->b, i, in_b);
    for (int m = 0; m < DVI__JOINT_NUMBERS; m++)
      for (int n = 0; n < DVI__JOINT_NUMBERS; n++)
        hessian[m][n] += in_a[m] * in_b[n] + in_b[m] * in_a[n];
  }
}
