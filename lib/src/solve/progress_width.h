/* The verdict of progress.c for vectors of WIDTH problems, after vector_width.h; it includes this once for each width.
 *
 * There is no branch: which of many iterations end with this correction nobody could predict. */

INLINE void NAME(keep_smaller)(NAME(vector) * x, const NAME(vector) * other)
{
  const NAME(mask) take = (NAME(mask))(*x < *other);
  *x = (NAME(vector))((take & (NAME(mask)) * x) | (~take & (NAME(mask)) * other));
}

/* What is left of the iteration's error in a correction, by the contraction from `before` to `last`; without one, all of it. */
INLINE void NAME(expected)(const NAME(vector) * correction, const NAME(vector) * last, const NAME(vector) * before,
                           NAME(vector) * left)
{
  const NAME(vector) one = (NAME(vector)){0} + 1.0;
  const NAME(mask) known = (NAME(mask))(*before != 0.0);
  NAME(vector) shrunk = *last / *before;
  NAME(keep_smaller)(&shrunk, &one);
  shrunk = *last * shrunk;
  NAME(keep_smaller)(&shrunk, correction);
  *left = (NAME(vector))((known & (NAME(mask))shrunk) | (~known & (NAME(mask)) * correction));
}

/* Every comparison with NaN is false. */
INLINE void NAME(judge)(const NAME(vector) * correction, const NAME(vector) * last, const NAME(vector) * before,
                        const NAME(vector) * unknown, const NAME(vector) * size, const dvi__pace *pace, NAME(mask) * verdict)
{
  const NAME(mask) finite = (NAME(mask))(*correction <= DBL_MAX), second = (NAME(mask))(*last != 0.0);
  NAME(vector) own, next;
  NAME(expected)(correction, last, before, &own);
  NAME(expected)(correction, correction, last, &next);
  const NAME(mask) still = (NAME(mask))(*correction <= rounding * *unknown) & (NAME(mask))(own <= settled * *unknown);
  const NAME(mask) ahead = (NAME(mask))(*correction <= near * *unknown) & (NAME(mask))(next <= unseen * *unknown) & second;
  const NAME(mask) noise = (NAME(mask))(*correction >= pace->stagnant * *last) &
                           (NAME(mask))(*correction <= pace->noise * (*unknown + *size)) & second;
  const NAME(mask) slow = (NAME(mask))(*correction > pace->slowest * *last) & second;
  const NAME(mask) converged = finite & (still | (pace->ahead ? ahead : (NAME(mask)){0}) | noise);
  *verdict = (converged & DVI__CONVERGED) | (~converged & (slow | ~finite) & DVI__STALLED);
}

INLINE int NAME(judge_from)(int count, const double *correction, const double *unknown, const dvi__pace *pace,
                            const dvi__trails *trails, int64_t *verdicts, int k)
{
  for (; k + WIDTH <= count; k += WIDTH) {
    NAME(vector) now, last, before, whole, size;
    NAME(mask) verdict;
    NAME(load)(correction + k, &now);
    NAME(load)(trails->last + k, &last);
    NAME(load)(trails->before + k, &before);
    NAME(load)(unknown + k, &whole);
    NAME(load)(trails->size + k, &size);
    NAME(judge)(&now, &last, &before, &whole, &size, pace, &verdict);
    memcpy(verdicts + k, &verdict, sizeof verdict);
    memcpy(trails->before + k, &last, sizeof last);
    memcpy(trails->last + k, &now, sizeof now);
  }
  return k;
}
