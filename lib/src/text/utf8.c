#include "text/utf8.h"

/* Give the number of bytes that a first byte announces, and the bits of the code in it. 0 if it is
 * no first byte. */
static size_t announced_bytes(unsigned char first, unsigned *bits)
{
  static const struct {
    unsigned char mask, mark;
  } kind[4] = {{0x80, 0x00}, {0xE0, 0xC0}, {0xF0, 0xE0}, {0xF8, 0xF0}};
  for (size_t k = 0; k < 4; k++) {
    if ((first & kind[k].mask) != kind[k].mark) continue;
    *bits = (unsigned)first & (0xFFU ^ kind[k].mask);
    return k + 1;
  }
  return 0;
}

size_t dvi__utf8(const char *text, size_t size, unsigned *code)
{
  /* smaller codes need fewer bytes */
  static const unsigned least[5] = {0, 0, 0x80, 0x800, 0x10000};
  unsigned value = 0;
  const size_t width = size == 0 ? 0 : announced_bytes((unsigned char)text[0], &value);
  if (width == 0 || width > size) return 0;
  for (size_t k = 1; k < width; k++) {
    const unsigned char byte = (unsigned char)text[k];
    if ((byte & 0xC0) != 0x80) return 0;
    value = value << 6 | (byte & 0x3FU);
  }
  if (value < least[width] || value > 0x10FFFF || (value >= 0xD800 && value < 0xE000)) return 0;
  *code = value;
  return width;
}

int dvi__utf8_printable(unsigned code)
{
  if (code < 0x20) return code == '\t' || code == '\n' || code == '\r';
  if (code >= 0x7F && code < 0xA0) return 0;
  if (code == 0x2028 || code == 0x2029) return 0;
  return code < 0xFFFE || code > 0xFFFF;
}

int dvi__is_blank(char c)
{
  return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}
