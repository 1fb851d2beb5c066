/* The loops of rescaled.c for vectors of WIDTH numbers, after vector_width.h. rescaled.c includes
 * this header once for each width. */

/* Multiply a row by a matrix, in two sums that do not wait for each other. */
INLINE void NAME(times_matrix)(const int stages, int lanes, const double *matrix, const double *row,
                               NAME(vector) * product)
{
  NAME(vector) column, even = {0}, odd = {0};
  for (int j = 0; j < stages; j++) {
    NAME(load)(matrix + (size_t)j * (size_t)lanes, &column);
    if (j % 2 == 0)
      even += column * row[j];
    else
      odd += column * row[j];
  }
  *product = even + odd;
}

INLINE void NAME(find_forces)(const dvi__rescaled_sums *s, const int stages)
{
  for (int b = 0; b < s->lanes; b += WIDTH) {
    NAME(vector) weight, g, energy = {0}, V, V_q, g_q, P;
    for (size_t i = 0; i < (size_t)s->n; i++) {
      NAME(load)(s->P + i * (size_t)s->lanes + (size_t)b, &P);
      energy += s->inverse_mass[i] * (P * P);
    }
    NAME(load)(s->weight + b, &weight);
    NAME(load)(s->g + b, &g);
    NAME(load)(s->V + b, &V);
    energy = 0.5 * energy + V;
    for (size_t i = 0; i < (size_t)s->n; i++) {
      NAME(load)(s->V_q + i * (size_t)stages + (size_t)b, &V_q);
      NAME(load)(s->g_q + i * (size_t)stages + (size_t)b, &g_q);
      const NAME(vector) f = -weight * (g * V_q + energy * g_q);
      NAME(store)(s->f + i * (size_t)stages + (size_t)b, &f, stages - b);
    }
  }
}

INLINE void NAME(find_momenta)(const dvi__rescaled_sums *s, const int stages)
{
  for (size_t i = 0; i < (size_t)s->n; i++)
    for (int b = 0; b < s->lanes; b += WIDTH) {
      NAME(vector) P;
      NAME(times_matrix)(stages, s->lanes, s->momentum + b, s->f + i * (size_t)stages, &P);
      P = s->p0[i] + P;
      NAME(store)(s->P + i * (size_t)s->lanes + (size_t)b, &P, WIDTH);
    }
}

/* In the first sweep next is Z. */
INLINE void NAME(find_rates)(const dvi__rescaled_sums *s, const int stages, int sweep)
{
  for (int b = 0; b < s->lanes; b += WIDTH) {
    NAME(vector) weight, rate, g_q, next, Z, P;
    NAME(load)(s->g + b, &rate);
    for (size_t i = 0; i < (size_t)s->n && sweep > 0; i++) {
      NAME(load)(s->g_q + i * (size_t)stages + (size_t)b, &g_q);
      NAME(load)(s->next + i * (size_t)s->lanes + (size_t)b, &next);
      NAME(load)(s->Z + i * (size_t)s->lanes + (size_t)b, &Z);
      rate += g_q * (next - Z);
    }
    NAME(load)(s->weight + b, &weight);
    rate *= weight;
    NAME(store)(s->rate + b, &rate, WIDTH);
    for (size_t i = 0; i < (size_t)s->n; i++) {
      NAME(load)(s->P + i * (size_t)s->lanes + (size_t)b, &P);
      const NAME(vector) u = rate * (s->inverse_mass[i] * P);
      NAME(store)(s->u + i * (size_t)stages + (size_t)b, &u, stages - b);
    }
  }
}

INLINE void NAME(find_places)(const dvi__rescaled_sums *s, const int stages)
{
  for (size_t i = 0; i < (size_t)s->n; i++)
    for (int b = 0; b < s->lanes; b += WIDTH) {
      NAME(vector) next;
      NAME(times_matrix)(stages, s->lanes, s->place + b, s->u + i * (size_t)stages, &next);
      NAME(store)(s->next + i * (size_t)s->lanes + (size_t)b, &next, WIDTH);
    }
}

/* Move the stages to the new offsets. Gives the largest change and offset. */
INLINE void NAME(move)(const dvi__rescaled_sums *s, const int stages, double *change,
                       double *largest)
{
  NAME(vector) moved_most = {0}, most = {0};
  for (size_t i = 0; i < (size_t)s->n; i++)
    for (int b = 0; b < s->lanes; b += WIDTH) {
      NAME(vector) next, Z;
      NAME(load)(s->next + i * (size_t)s->lanes + (size_t)b, &next);
      NAME(load)(s->Z + i * (size_t)s->lanes + (size_t)b, &Z);
      const NAME(vector) moved = next - Z, Q = s->origin[i] + next;
      NAME(larger)(&moved_most, &moved);
      NAME(larger)(&most, &next);
      NAME(store)(s->Z + i * (size_t)s->lanes + (size_t)b, &next, WIDTH);
      NAME(store)(s->Q + i * (size_t)stages + (size_t)b, &Q, stages - b);
    }
  *change = NAME(largest_of)(&moved_most);
  *largest = NAME(largest_of)(&most);
}

INLINE void NAME(rescaled_iterate)(dvi__rescaled_sums *s, const int stages)
{
  const dvi__rescaled_sums own = *s; /* a copy, which nothing else writes */
  for (int sweep = 0; sweep < own.sweeps; sweep++) {
    NAME(find_forces)(&own, stages);
    NAME(find_momenta)(&own, stages);
    NAME(find_rates)(&own, stages, sweep);
    NAME(find_places)(&own, stages);
  }
  NAME(move)(&own, stages, &s->change, &s->largest);
}

INLINE void NAME(rescaled_begin)(const dvi__rescaled_sums *s, const int stages)
{
  double change, largest;
  NAME(find_momenta)(s, stages);
  NAME(find_places)(s, stages);
  NAME(move)(s, stages, &change, &largest);
}
