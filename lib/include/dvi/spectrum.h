/** Frequencies and decay rates from series of samples.
 *
 *  A series y_p(t), of a probe p of a field or of a coordinate, is a sum of spectral lines,
 *
 *      y_p(t) = sum_k A_pk exp(-gamma_k t) cos(omega_k t + phi_pk),
 *
 *  whose omega and gamma all probes share. A Fourier transform of duration T resolves frequencies
 *  to 2 pi/T. The matrix pencil of Hua and Sarkar finds them, without noise, to roundoff, and with
 *  noise as precisely as the noise allows (docs/fields/spectra.md). */
#ifndef DVI_SPECTRUM_H
#define DVI_SPECTRUM_H
#include <dvi/status.h>
#include <stddef.h>
#include <stdint.h>

/** Options of a spectrum. Zero means the default. */
typedef struct dvi_spectrum_options {
  size_t size; /**< sizeof(dvi_spectrum_options) */
  /** the band of angular frequencies that are asked for, both ends included. Default: 0, and the
   *  highest that samples can tell, pi/interval */
  double lowest, highest;
  /** what is noise: singular values below the series' root of mean square, and amplitudes below the
   *  largest one, times this number. Where noise reaches higher, the smallest singular values
   *  tell it. Default: 1e-10 */
  double tolerance;
} dvi_spectrum_options;

/** A spectral line. */
typedef struct dvi_spectral_line {
  double frequency; /**< omega, an angular frequency. 0 for a real exponential */
  double decay;     /**< gamma, of the amplitude. Negative where it grows */
  double quality;   /**< Q = omega/(2 gamma). Infinite without decay */
  double amplitude; /**< at the first sample, the largest of all probes */
  /** standard error of omega, and of gamma: of a fit of all lines, whose noise is what they leave
   *  of the series, and at least roundoff */
  double error;
} dvi_spectral_line;

/** What a spectrum took, and what it left. */
typedef struct dvi_spectrum_report {
  int lines;        /**< all that were found in the band */
  double residual;  /**< root of the mean square of what the lines leave, beside the series' own */
  int parts;        /**< of the band, each solved by itself */
  int64_t samples;  /**< of each part, after its filter */
  int exponentials; /**< the most of a part. Two make a line */
  int room;         /**< how many of them a part can tell apart */
} dvi_spectrum_report;

#ifdef __cplusplus
extern "C" {
#endif

/** Find the spectral lines of a band in one or several series of equally spaced samples.
 *
 *  Lines are told apart if their distance is not much below 2 pi/T, or far below it without noise.
 *  There must be fewer than samples/5 of them in one series, or samples/4 in two, because the rest
 *  tells the noise. Of samples that are denser than the fastest line needs, only as many count as
 *  it needs. More than 1023 samples are filtered and decimated to about 512 for each part of the
 *  band, so that the cost grows with the number of samples and with the band's width. The filter
 *  takes in a twelfth of the series. Lines that decay within so short a time are lost.
 *
 *  Series of one call share a unit, because noise has one size in all of them.
 *
 *  @param      samples    of each series, 6 at least
 *  @param      probes     number of series, 1 at least
 *  @param      series     [probes*samples], probe by probe
 *  @param      interval   between samples, positive
 *  @param      options    NULL for the defaults
 *  @param      most       room of the arrays. Of more lines the strongest are given
 *  @param[out] count      of the lines that are given, 0 if there is none in the band
 *  @param[out] line       [most], ascending in omega
 *  @param[out] amplitude  [most*probes] A_pk at [k*probes + p], at the first sample. May be NULL
 *  @param[out] phase      [most*probes] phi_pk in (-pi, pi]. May be NULL
 *  @param[out] report     may be NULL
 *  @retval DVI_BAD_SIZE      there are too few samples, or no room for lines
 *  @retval DVI_BAD_ARGUMENT  all series are constant, an argument is missing, or an option is out
 *                            of range
 *  @retval DVI_NOT_FINITE    a sample is not finite. dvi_last_error() names it
 *  @retval DVI_SOLVER_FAILED LAPACK found no singular values or no eigenvalues
 *  @retval DVI_NO_MEMORY     there is no memory
 *
 *  Hua and Sarkar 1990, with a step of Gauss and Newton's method after it (Golub and Pereyra 1973);
 *  long series by bands, after Mandelshtam and Taylor 1997. */
dvi_status dvi_spectrum(int64_t samples, int probes, const double *series, double interval,
                        const dvi_spectrum_options *options, int most, int *count,
                        dvi_spectral_line *line, double *amplitude, double *phase,
                        dvi_spectrum_report *report);

#ifdef __cplusplus
}
#endif
#endif
