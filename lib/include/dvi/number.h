/** Numbers as text, with a decimal point whatever the locale. */
#ifndef DVI_NUMBER_H
#define DVI_NUMBER_H
#include <stdarg.h>
#include <stddef.h>

/** Most characters of a number's text, with the 0 at its end. */
enum { DVI_NUMBER_SIZE = 32 };

#ifdef __cplusplus
extern "C" {
#endif

/** Read the decimal number that a text begins with: a sign, digits, a point, an exponent.
 *
 *  Leading blanks, hexadecimal numbers, "inf" and "nan" are refused.
 *  @param[out] number  right to the last bit, infinite beyond 1.8e308. Unchanged if there is none
 *  @return the text behind the number. The text itself if there is no number */
const char *dvi_number_read(const char *text, double *number);

/** Write a number with the fewest digits, from 15 on, that dvi_number_read reads as the same
 *  number.
 *
 *  @param[out] text  [DVI_NUMBER_SIZE] */
void dvi_number_write(double number, char *text);

/** Print as vsnprintf does, with a decimal point in all numbers. */
int dvi_number_vprint(char *text, size_t size, const char *format, va_list arguments)
#if defined(__GNUC__)
    __attribute__((format(printf, 3, 0)))
#endif
    ;

#ifdef __cplusplus
}
#endif
#endif
