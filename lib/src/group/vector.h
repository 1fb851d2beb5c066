/* Vectors of three numbers. */
#ifndef DVI_GROUP_VECTOR_H
#define DVI_GROUP_VECTOR_H

static inline double dvi__dot(const double a[3], const double b[3])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Compute product = a x b, which may be neither a nor b. */
static inline void dvi__cross(const double a[3], const double b[3], double product[3])
{
  product[0] = a[1] * b[2] - a[2] * b[1];
  product[1] = a[2] * b[0] - a[0] * b[2];
  product[2] = a[0] * b[1] - a[1] * b[0];
}

/* Compute sum = v + a w x v + b w x (w x v). Every operator here that commutes with the rotations
 * about w has this form. sum may overwrite v. */
static inline void dvi__about(const double w[3], double a, double b, const double v[3],
                              double sum[3])
{
  double once[3], inner[3], turned[3];
  dvi__cross(w, v, once);
  for (int i = 0; i < 3; i++) inner[i] = a * v[i] + b * once[i];
  dvi__cross(w, inner, turned);
  for (int i = 0; i < 3; i++) sum[i] = v[i] + turned[i];
}

#endif
