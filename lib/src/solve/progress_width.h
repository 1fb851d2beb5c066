/* The tests of progress.c for vectors of WIDTH problems, after vector_width.h. progress.c includes
 * this file once for each width.
 *
 * There is no branch, because nobody could predict which of many iterations end with this
 * correction. */

/* A dvi__history of each problem. */
typedef struct NAME(history) {
  NAME(vector) last, ratio, contraction, own;
} NAME(history);

/* Choose where ? yes : no, lane by lane. */
INLINE void NAME(choose)(const NAME(mask) * where, const NAME(vector) * yes,
                         const NAME(vector) * no, NAME(vector) * chosen)
{
  *chosen = (NAME(vector))((*where & (NAME(mask)) * yes) | (~*where & (NAME(mask)) * no));
}

INLINE void NAME(larger_of)(const NAME(vector) * x, const NAME(vector) * y, NAME(vector) * larger)
{
  const NAME(mask) above = (NAME(mask))(*x > *y);
  NAME(choose)(&above, x, y, larger);
}

/* Update the history by one correction. Gives the contraction to be expected, 1 if not known. */
INLINE void NAME(update_history)(const NAME(vector) * correction, const NAME(vector) * noise,
                                 const dvi__criteria *criteria, NAME(history) * t,
                                 NAME(vector) * expected)
{
  const NAME(vector) one = (NAME(vector)){0} + 1.0,
                     most = (NAME(vector)){0} +
                            (criteria->slowest < dvi__hardly ? criteria->slowest : dvi__hardly);
  const NAME(mask) first = (NAME(mask))(t->last == 0.0), measured = (NAME(mask))(t->last > *noise),
                   loud = (NAME(mask))(*correction > *noise);
  const NAME(vector) quotient = *correction / t->last;
  NAME(vector) shrinking, contraction, own, larger;
  const NAME(mask) grows = (NAME(mask))(quotient > most);
  NAME(choose)(&grows, &most, &quotient, &shrinking);
  NAME(choose)(&first, &one, &shrinking, &shrinking);
  NAME(larger_of)(&shrinking, &t->ratio, &larger);
  NAME(choose)(&measured, criteria->steady ? &larger : &shrinking, &t->contraction, &contraction);
  NAME(choose)(&measured, &shrinking, &t->ratio, &t->ratio);
  const NAME(mask) blind = (NAME(mask))(contraction == 0.0);
  NAME(choose)(&blind, &shrinking, &contraction, expected);
  own = contraction * t->own;
  NAME(larger_of)(correction, &own, &larger);
  const NAME(mask) none = {0}, fresh = first | blind | (criteria->steady ? none : loud);
  NAME(choose)(&loud, &larger, &own, &own);
  NAME(choose)(&fresh, correction, &own, &t->own);
  t->contraction = contraction;
}

/* Every comparison with NaN is false. */
INLINE void NAME(test)(const NAME(vector) * correction, const NAME(vector) * unknown,
                       const NAME(vector) * size, const dvi__criteria *criteria, NAME(history) * t,
                       NAME(mask) * verdict)
{
  const NAME(vector) last = t->last, feared = t->own, noise = criteria->noise * (*unknown + *size);
  const NAME(mask) finite = (NAME(mask))(*correction <= DBL_MAX),
                   quiet = (NAME(mask))(*correction <= noise);
  const NAME(mask) loud_before = (NAME(mask))(last > noise), second = (NAME(mask))(last != 0.0);
  NAME(vector) expected;
  NAME(update_history)(correction, &noise, criteria, t, &expected);
  t->last = *correction;
  const NAME(vector) shows = criteria->ahead ? expected * t->own : t->own;
  const NAME(mask)
      still = quiet &
              (NAME(mask))(shows <= (criteria->ahead ? dvi__unseen : dvi__settled) * *unknown);
  const NAME(mask) stagnant = second & quiet & ~loud_before & (NAME(mask))(t->contraction == 0.0) &
                              (NAME(mask))(*correction >= criteria->stagnant * last);
  const NAME(mask) slow = loud_before & (NAME(mask))(*correction > criteria->slowest * feared);
  const NAME(mask) converged = finite & (still | stagnant);
  *verdict = (converged & DVI__CONVERGED) | (~converged & (slow | ~finite) & DVI__STALLED);
}

INLINE int NAME(test_from)(int count, const double *correction, const double *unknown,
                           const dvi__criteria *criteria, const dvi__histories *histories,
                           int64_t *verdicts, int k)
{
  for (; k + WIDTH <= count; k += WIDTH) {
    NAME(vector) now, whole, size;
    NAME(history) t;
    NAME(mask) verdict;
    NAME(load)(correction + k, &now);
    NAME(load)(unknown + k, &whole);
    NAME(load)(histories->size + k, &size);
    NAME(load)(histories->last + k, &t.last);
    NAME(load)(histories->ratio + k, &t.ratio);
    NAME(load)(histories->contraction + k, &t.contraction);
    NAME(load)(histories->own + k, &t.own);
    NAME(test)(&now, &whole, &size, criteria, &t, &verdict);
    memcpy(verdicts + k, &verdict, sizeof verdict);
    memcpy(histories->last + k, &t.last, sizeof now);
    memcpy(histories->ratio + k, &t.ratio, sizeof now);
    memcpy(histories->contraction + k, &t.contraction, sizeof now);
    memcpy(histories->own + k, &t.own, sizeof now);
  }
  return k;
}
