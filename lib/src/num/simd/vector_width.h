/* Vectors of WIDTH numbers, for the files that include num/simd/width.h. Included once for each
 * width, before the functions on them.
 *
 * GCC and clang lower a vector that the target lacks to smaller ones, lane by lane, with the same
 * operations. Vectors are passed by pointers, because as arguments they would have another calling
 * convention on every target. */

typedef double NAME(vector) __attribute__((vector_size(WIDTH * sizeof(double))));
typedef int64_t NAME(mask) __attribute__((vector_size(WIDTH * sizeof(double))));

INLINE void NAME(load)(const double *x, NAME(vector) * loaded)
{
  memcpy(loaded, x, sizeof *loaded);
}

/* Store the first `count` lanes, none if it is not positive. Fewer than WIDTH are stored in pieces
 * of known size, because a call of memcpy costs more than all of them. */
INLINE void NAME(store)(double *out, const NAME(vector) * x, int count)
{
  if (count >= WIDTH) {
    memcpy(out, x, sizeof *x);
    return;
  }
  const double *from = (const double *)x;
  for (int piece = WIDTH / 2; piece > 0 && count > 0; piece /= 2)
    if (count & piece) {
      memcpy(out, from, (size_t)piece * sizeof(double));
      out += piece;
      from += piece;
    }
}

/* Replace largest by max(largest, |x|), lane by lane. Magnitudes are ordered as their bits are,
 * with NaN above all numbers, so that NaN stays. */
INLINE void NAME(larger)(NAME(vector) * largest, const NAME(vector) * x)
{
  const NAME(mask) magnitude = (NAME(mask)) * x & INT64_MAX,
                   take = (NAME(mask))(magnitude > (NAME(mask)) * largest);
  *largest = (NAME(vector))((take & magnitude) | (~take & (NAME(mask)) * largest));
}

/* Give the largest lane of magnitudes, NaN if one is. */
INLINE double NAME(largest_of)(const NAME(vector) * x)
{
  uint64_t bits[WIDTH];
  double largest;
  memcpy(bits, x, sizeof bits);
  for (int half = WIDTH / 2; half > 0; half /= 2)
    for (int i = 0; i < half; i++) bits[i] = bits[i] > bits[i + half] ? bits[i] : bits[i + half];
  memcpy(&largest, bits, sizeof largest);
  return largest;
}
