/* Rotations and unit quaternions.
 *
 * Sums and differences of R's entries are the products 4 q_i q_j. Those with the largest |q_k| have
 * lost no digits (Shepperd 1978). They are the quaternion but for their common length. */
#include "group/quaternion.h"

#include <dvi/group.h>
#include <math.h>

#include "core/status.h"
#include "group/vector.h"

/* A matrix this far from a rotation is still read as one. A long run or a file of ten digits leaves
 * such errors, and no larger ones. */
#define TOLERANCE 1e-8

void dvi_so3_from_quaternion(const double q[4], double R[9])
{
  const double largest = fmax(fmax(fabs(q[0]), fabs(q[1])), fmax(fabs(q[2]), fabs(q[3])));
  double unit[4] = {1, 0, 0, 0};
  for (int i = 0; largest > 0 && i < 4; i++) unit[i] = q[i] / largest;
  const double length = sqrt(unit[0] * unit[0] + dvi__dot(unit + 1, unit + 1));
  for (int i = 0; i < 4; i++) unit[i] /= length;
  dvi__rotation(unit, R);
}

/* row[j] = 4 q_k q_j for the k of the largest |q_k|. */
static void largest_row(const double R[9], double row[4])
{
  const double trace = R[0] + R[4] + R[8];
  const int i = R[4] > R[0] ? (R[8] > R[4] ? 2 : 1) : (R[8] > R[0] ? 2 : 0), j = (i + 1) % 3,
            k = (i + 2) % 3;
  if (trace >= R[4 * i]) {
    row[0] = 1 + trace;
    row[1] = R[7] - R[5];
    row[2] = R[2] - R[6];
    row[3] = R[3] - R[1];
  } else {
    row[0] = R[3 * k + j] - R[3 * j + k];
    row[1 + i] = 1 + (R[4 * i] - R[4 * j] - R[4 * k]);
    row[1 + j] = R[3 * i + j] + R[3 * j + i];
    row[1 + k] = R[3 * i + k] + R[3 * k + i];
  }
}

dvi_status dvi_so3_quaternion(const double R[9], double q[4])
{
  double row[4];
  const double distance = dvi_so3_distance(R);
  if (!(distance <= TOLERANCE))
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "rotation: the matrix is %.1e from the nearest rotation, %.0e is allowed; see "
                     "dvi_so3_project",
                     distance, TOLERANCE);
  largest_row(R, row);
  const double length = sqrt(row[0] * row[0] + dvi__dot(row + 1, row + 1)),
               sign = row[0] < 0 ? -length : length;
  for (int i = 0; i < 4; i++) q[i] = row[i] / sign;
  return DVI_OK;
}
