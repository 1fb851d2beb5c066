/* Discrete Fourier transforms of real sequences of any length.
 *
 * Lengths that are products of 2, 3 and 5 go by Stockham's recursion with the factors 4, 2, 3 and
 * 5, and all other ones by Bluestein's chirp. A plan never changes, and threads may share it.
 * Sources: Cooley and Tukey 1965; Bluestein 1970. */
#ifndef DVI_NUM_FFT_FFT_H
#define DVI_NUM_FFT_FFT_H
#include <dvi/status.h>

typedef struct dvi__fft dvi__fft;

enum { DVI__FFT_MAX = 1 << 26 };

/* Make a plan for n points. DVI_BAD_SIZE for n outside 1 .. DVI__FFT_MAX, DVI_NO_MEMORY. */
dvi_status dvi__fft_create(int n, dvi__fft **plan);

/* Free a plan, and set the pointer to NULL. NULL in it is allowed. */
void dvi__fft_destroy(dvi__fft **plan);

/* Return the doubles of work that a transform needs. */
int dvi__fft_work(const dvi__fft *plan);

/* Give the sums c_k of x_j cos(2 pi j k/n) and s_k of x_j sin(2 pi j k/n) of real numbers x [n],
 * for k = 0 .. (n-1)/2, and c of k = n/2 too: [c_0, c_1, s_1, c_2, s_2, ..] [n], in place. An even
 * n costs half of a complex transform. */
void dvi__fft_analyse(const dvi__fft *plan, double *x, double *work);

/* The transposed sum x_j = c_0 + sum_k c_k cos(2 pi j k/n) + s_k sin(2 pi j k/n), in place. */
void dvi__fft_synthesise(const dvi__fft *plan, double *x, double *work);

/* Return the least length from n on that has no other factors than 2, 3 and 5, for n up to 2^30. */
int dvi__fft_length(int n);

#endif
