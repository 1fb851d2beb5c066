/* The loops of lanes.c for vectors of WIDTH numbers, after vector_width.h. Each function takes a
 * copy of its arguments, because the compiler cannot know that no store changes them. */

INLINE void NAME(difference)(const double *p1, const double *p0, size_t i, NAME(vector) * d)
{
  NAME(vector) before;
  NAME(load)(p1 + i, d);
  NAME(load)(p0 + i, &before);
  *d -= before;
}

/* Give up p1 - down p0 with factors that are numbers. */
INLINE void NAME(weighted)(const double *p1, const double *p0, double up, double down, size_t i,
                           NAME(vector) * d)
{
  NAME(vector) before;
  NAME(load)(p1 + i, d);
  NAME(load)(p0 + i, &before);
  *d = up * *d - down * before;
}

/* Give it with factors that are arrays. */
INLINE void NAME(weighted_at)(const double *p1, const double *p0, const double *up,
                              const double *down, size_t i, NAME(vector) * d)
{
  NAME(vector) before, u, v;
  NAME(load)(p1 + i, d);
  NAME(load)(p0 + i, &before);
  NAME(load)(up + i, &u);
  NAME(load)(down + i, &v);
  *d = u * *d - v * before;
}

INLINE void NAME(faces)(const dvi__yee_faces_row *whole)
{
  const dvi__yee_faces_row l = *whole;
  for (size_t i = 0; i < l.count; i += WIDTH) {
    NAME(vector) b, p, q;
    __builtin_prefetch((const void *)(l.soon + i * sizeof(double)));
    NAME(load)(l.b + i, &b);
    NAME(difference)(l.p1, l.p0, i, &p);
    NAME(difference)(l.q1, l.q0, i, &q);
    b -= l.dt * (p - q);
    NAME(store)(l.b + i, &b, WIDTH);
  }
}

INLINE void NAME(edges)(const dvi__yee_edges_row *whole, const dvi__yee_metric metric,
                        const dvi__yee_matter matter)
{
  const dvi__yee_edges_row l = *whole;
  for (size_t i = 0; i < l.count; i += WIDTH) {
    NAME(vector) e, p, q, factor;
    __builtin_prefetch((const void *)(l.soon + i * sizeof(double)));
    NAME(load)(l.e + i, &e);
    if (metric == DVI__YEE_EQUAL) {
      NAME(difference)(l.p1, l.p0, i, &p);
      NAME(difference)(l.q1, l.q0, i, &q);
      p = l.p_up * p - l.q_up * q;
    } else {
      if (metric == DVI__YEE_P_ALONG)
        NAME(weighted_at)(l.p1, l.p0, l.up, l.down, i, &p);
      else
        NAME(weighted)(l.p1, l.p0, l.p_up, l.p_down, i, &p);
      if (metric == DVI__YEE_Q_ALONG)
        NAME(weighted_at)(l.q1, l.q0, l.up, l.down, i, &q);
      else
        NAME(weighted)(l.q1, l.q0, l.q_up, l.q_down, i, &q);
      p -= q;
    }
    if (matter != DVI__YEE_VACUUM) {
      NAME(load)(l.ce + i, &factor);
      p *= factor;
    }
    if (matter == DVI__YEE_LOSSY) {
      NAME(load)(l.ca + i, &factor);
      e *= factor;
    }
    e += p;
    NAME(store)(l.e + i, &e, WIDTH);
  }
}

/* Add sign ce d to f. ce may be NULL. */
INLINE void NAME(add_signed)(double sign, const double *ce, size_t i, const NAME(vector) * d,
                             double *f)
{
  NAME(vector) sum, term = sign * *d, factor;
  if (ce != NULL) {
    NAME(load)(ce + i, &factor);
    term *= factor;
  }
  NAME(load)(f + i, &sum);
  sum += term;
  NAME(store)(f + i, &sum, WIDTH);
}

INLINE void NAME(layers)(const dvi__yee_layers_row *whole)
{
  const dvi__yee_layers_row l = *whole;
  for (size_t i = 0; i < l.count; i += WIDTH) {
    NAME(vector) d, psi;
    __builtin_prefetch((const void *)((uintptr_t)(l.psi + i) + l.soon));
    NAME(weighted)(l.p1, l.p0, l.up, l.down, i, &d);
    NAME(load)(l.psi + i, &psi);
    psi = l.b * psi + l.a * d;
    NAME(store)(l.psi + i, &psi, WIDTH);
    d = psi + l.r * d;
    NAME(add_signed)(l.sign, l.ce, i, &d, l.f);
  }
}

INLINE void NAME(layers_end)(const dvi__yee_layers_end *l)
{
  const size_t count = l->count;
  for (size_t i = 0; i < count; i += WIDTH) {
    NAME(vector) a, b, r;
    NAME(load)(l->b + i, &b);
    NAME(load)(l->a + i, &a);
    NAME(load)(l->r + i, &r);
    for (int c = 0; c < 2; c++) {
      NAME(vector) d, psi;
      double *own = l->psi + (size_t)c * count + i;
      __builtin_prefetch((const void *)((uintptr_t)own + 4 * count * sizeof(double)));
      if (l->of[c].f == NULL) continue;
      NAME(weighted_at)(l->of[c].p1, l->of[c].p0, l->up, l->down, i, &d);
      NAME(load)(own, &psi);
      psi = b * psi + a * d;
      NAME(store)(own, &psi, WIDTH);
      d = psi + r * d;
      NAME(add_signed)(l->of[c].sign, l->of[c].ce, i, &d, l->of[c].f);
    }
  }
}

INLINE void NAME(product)(size_t count, const double *mi, const double *b, double *h)
{
  for (size_t i = 0; i < count; i += WIDTH) {
    NAME(vector) m, x;
    NAME(load)(mi + i, &m);
    NAME(load)(b + i, &x);
    x *= m;
    NAME(store)(h + i, &x, WIDTH);
  }
}
