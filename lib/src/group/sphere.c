/* Exponential and logarithm along great circles of the unit circle and the unit sphere. */
#include <dvi/group.h>
#include <math.h>

#include "group/stumpff.h"
#include "group/vector.h"

#define PI 3.14159265358979323846

void dvi_u1_exp(double angle, double y[2])
{
  y[0] = cos(angle);
  y[1] = sin(angle);
}

double dvi_u1_log(const double y[2])
{
  return atan2(y[1] + 0.0, y[0]); /* -0 becomes 0, and (-1, -0) the angle pi */
}

/* Scale z = (cos|t| y + t sin|t| / |t|) to length 1. Otherwise the roundoff of a million steps
 * would add up in z. */
void dvi_s2_exp(const double y[3], const double t[3], double z[3])
{
  double c[4];
  dvi__stumpff_four(dvi__dot(t, t), c);
  for (int i = 0; i < 3; i++) z[i] = c[0] * y[i] + c[1] * t[i];
  const double length = sqrt(dvi__dot(z, z));
  for (int i = 0; i < 3; i++) z[i] /= length;
}

/* Compute t of length pi from y towards the axis of y's smallest component. */
static void half_turn(const double y[3], double t[3])
{
  int axis = 0;
  for (int i = 1; i < 3; i++)
    if (fabs(y[i]) < fabs(y[axis])) axis = i;
  const double scale = PI / sqrt(1 - y[axis] * y[axis]), height = y[axis];
  for (int i = 0; i < 3; i++) t[i] = scale * ((i == axis) - height * y[i]);
}

/* Take the normal y x z of the great circle from z - y or z + y. These differences lose no digits
 * where they are small. */
void dvi_s2_log(const double y[3], const double z[3], double t[3])
{
  const double cosine = dvi__dot(y, z), sign = cosine > 0 ? 1 : -1;
  const double between[3] = {z[0] - sign * y[0], z[1] - sign * y[1], z[2] - sign * y[2]};
  double normal[3], ahead[3];
  dvi__cross(y, between, normal);
  dvi__cross(normal, y, ahead);
  const double sine = sqrt(dvi__dot(normal, normal));
  if (sine == 0 && cosine < 0) {
    half_turn(y, t);
    return;
  }
  const double ratio = sine > 0 ? atan2(sine, cosine) / sine : 1;
  for (int i = 0; i < 3; i++) t[i] = ratio * ahead[i];
}
