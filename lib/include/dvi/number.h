/** Numbers as text, with a decimal point whatever the locale. */
#ifndef DVI_NUMBER_H
#define DVI_NUMBER_H
#include <stdarg.h>
#include <stddef.h>

/** Characters of a number's text at most, with its end. */
enum { DVI_NUMBER_SIZE = 32 };

#ifdef __cplusplus
extern "C" {
#endif

/** Read the decimal number that a text begins with: a sign, digits, a point, an exponent.
 *
 *  Blanks, hexadecimal numbers, "inf" and "nan" are none.
 *  @param[out] number  right to the last bit, infinite beyond 1.8e308; unchanged if there is none
 *  @return what follows the number; the text itself if there is none */
const char *dvi_number_read(const char *text, double *number);

/** Write a number with the fewest digits, from 15 on, that dvi_number_read reads as the same one.
 *
 *  @param[out] text  [DVI_NUMBER_SIZE] */
void dvi_number_write(double number, char *text);

/** As vsnprintf, with a decimal point in all numbers. */
int dvi_number_vprint(char *text, size_t size, const char *format, va_list arguments)
#if defined(__GNUC__)
    __attribute__((format(printf, 3, 0)))
#endif
    ;

#ifdef __cplusplus
}
#endif
#endif
