/* The rotation of a quaternion, from which exponential and Cayley's map are made. */
#ifndef DVI_GROUP_QUATERNION_H
#define DVI_GROUP_QUATERNION_H

/* A product q_i q_j as a head without error and a tail. */
typedef struct dvi__product {
  double head, tail;
} dvi__product;

/* Compute R = I + 2 (q_0 hat(u) + hat(u)^2) / |q|^2, u = (q_1, q_2, q_3), for q of length 1 but for
 * roundoff. Each entry is rounded once.
 *
 * q is split into tails and heads, which are multiples of 2^-25 whose products add up without
 * error. Then |q|^2 - 1 is known to 1e-23, and the tails are corrected to length 1. Otherwise the
 * roundoff of q would be in R^T R - I four times as large, and biased. */
static inline void dvi__rotation(const double q[4], double R[9])
{
  const double shift = 0x1.8p27;
  double head[4], tail[4], squares = -1, rest = 0;
  for (int i = 0; i < 4; i++) {
    head[i] = (q[i] + shift) - shift;
    tail[i] = q[i] - head[i];
    squares += head[i] * head[i];
    rest += tail[i] * (q[i] + head[i]);
  }
  const double half_excess = 0.5 * (squares + rest);
  dvi__product p[4][4];
  for (int i = 0; i < 4; i++) tail[i] -= half_excess * q[i];
  for (int i = 0; i < 4; i++)
    for (int j = i; j < 4; j++)
      p[i][j] = (dvi__product){head[i] * head[j], tail[i] * q[j] + head[i] * tail[j]};
  for (int i = 0; i < 3; i++) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const dvi__product side = j < k ? p[1 + j][1 + k] : p[1 + k][1 + j], turn = p[0][1 + i],
                       *a = &p[1 + j][1 + j], *b = &p[1 + k][1 + k];
    R[4 * i] = (1 - 2 * (a->head + b->head)) - 2 * (a->tail + b->tail);
    R[3 * j + k] = 2 * ((side.head - turn.head) + (side.tail - turn.tail));
    R[3 * k + j] = 2 * ((side.head + turn.head) + (side.tail + turn.tail));
  }
}

#endif
