/* Text, numbers and arrays of emitted files, and the beginning of these files. */
#include "scene/emit/emit.h"

#include <dvi/number.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene/emit/emit_parts.h"
#include "text/heap.h"

enum { TEXT_MAX = 500, A_LINE = 16 };

/* An array that has been written. */
struct dvi__emitted_array {
  const void *address;
};

static void write_text(dvi__emitter *out, const char *text, size_t size)
{
  if (out->failed == DVI_OK && out->write(text, size, out->user) != 0) out->failed = DVI_IO_ERROR;
}

void dvi__emit(dvi__emitter *out, const char *format, ...)
{
  char text[TEXT_MAX + 1];
  va_list arguments;
  va_start(arguments, format);
  const int length = dvi_number_vprint(text, sizeof text, format, arguments);
  va_end(arguments);
  if (length > 0) write_text(out, text, length < TEXT_MAX ? (size_t)length : TEXT_MAX);
}

/* Write the fewest digits that give the same number. A point or an exponent makes it a double. */
void dvi__emit_number(dvi__emitter *out, double value)
{
  char text[DVI_NUMBER_SIZE];
  if (!isfinite(value)) {
    dvi__emit(out, "%s", isnan(value) ? "NAN" : value > 0 ? "INFINITY" : "-INFINITY");
    return;
  }
  dvi_number_write(value, text);
  dvi__emit(out, "%s%s", text, strpbrk(text, ".e") == NULL ? ".0" : "");
}

/* Return the number of an array that was written before, or -1. */
static int find_array(const dvi__emitter *out, const void *address)
{
  for (int i = 0; i < out->array_count; i++)
    if (out->array[i].address == address) return i;
  return -1;
}

/* Return a number for a new array. */
static int new_array(dvi__emitter *out, const void *address)
{
  struct dvi__emitted_array *array = dvi__heap_grow(out->array, (size_t)out->array_count,
                                                    sizeof *array);
  if (array == NULL) {
    out->failed = DVI_NO_MEMORY;
    return 0;
  }
  out->array = array;
  array[out->array_count].address = address;
  return out->array_count++;
}

static int emit_new_list(dvi__emitter *out, const void *key, int count, const int *value)
{
  const int number = new_array(out, key);
  dvi__emit(out, "static const int dvi_list_%d[] = {", number);
  for (int i = 0; i < count; i++)
    dvi__emit(out, "%s%d", i == 0 ? "" : i % A_LINE == 0 ? ",\n  " : ", ", value[i]);
  dvi__emit(out, count == 0 ? "0};\n" : "};\n");
  return number;
}

int dvi__emit_ints_of(dvi__emitter *out, const void *key, int count, const int *value)
{
  const int known = key != NULL ? find_array(out, key) : -1;
  return known >= 0 ? known : emit_new_list(out, key, count, value);
}

int dvi__emit_ints(dvi__emitter *out, int count, const int *value)
{
  const int known = find_array(out, value);
  return known >= 0 ? known : emit_new_list(out, value, count, value);
}

int dvi__emit_lists(dvi__emitter *out, int count, const int *list)
{
  const int number = new_array(out, NULL);
  dvi__emit(out, "static const int *const dvi_lists_%d[] = {", number);
  for (int i = 0; i < count; i++)
    dvi__emit(out, "%sdvi_list_%d", i == 0 ? "" : i % A_LINE == 0 ? ",\n  " : ", ", list[i]);
  dvi__emit(out, "};\n");
  return number;
}

int dvi__emit_doubles(dvi__emitter *out, int count, const double *value)
{
  const int known = find_array(out, value);
  if (known >= 0) return known;
  const int number = new_array(out, value);
  dvi__emit(out, "static const double dvi_row_%d[] = {", number);
  for (int i = 0; i < count; i++) {
    dvi__emit(out, "%s", i == 0 ? "" : i % A_LINE == 0 ? ",\n  " : ", ");
    dvi__emit_number(out, value[i]);
  }
  dvi__emit(out, count == 0 ? "0};\n" : "};\n");
  return number;
}

dvi_status dvi__emit_end(dvi__emitter *out)
{
  dvi__heap_free(out->array);
  out->array = NULL;
  out->array_count = 0;
  return out->failed;
}

/* The beginning of every file. Results must not depend on the machine, hence no contraction of
 * products and sums. Loops with roots become vectors only if roots leave errno alone, and with gcc
 * 12 at -O2 only if they are asked to. Clang must not take several vectors at once, which is more
 * than the few points there are. DVI_LANES may be defined, as nothing, for a program that is
 * compiled sooner and runs on one instruction set. */
static const char *const beginning[] = {
    "#include <dvi/sines.h>\n"
    "#include <float.h>\n"
    "#include <math.h>\n"
    "#include <stddef.h>\n"
    "#include <stdint.h>\n"
    "#include <string.h>\n"
    "\n"
    "#if defined(__clang__)\n"
    "#pragma STDC FP_CONTRACT OFF\n"
    "#pragma clang diagnostic ignored \"-Wpass-failed\"\n"
    "#define DVI_INDEPENDENT _Pragma(\"clang loop vectorize(assume_safety) interleave(disable)\")\n"
    "#elif defined(__GNUC__)\n"
    "#pragma GCC optimize(\"fp-contract=off\", \"no-math-errno\")\n"
    "#if defined(__OPTIMIZE__)\n"
    "#pragma GCC optimize(\"tree-vectorize\", \"vect-cost-model=dynamic\")\n"
    "#endif\n"
    "#define DVI_INDEPENDENT _Pragma(\"GCC ivdep\")\n"
    "#else\n"
    "#define DVI_INDEPENDENT\n"
    "#endif\n",
    "#if defined(__GNUC__)\n"
    "#define DVI_INLINE static inline __attribute__((always_inline, unused))\n"
    "#define DVI_SELDOM __attribute__((cold, noinline))\n"
    "#else\n"
    "#define DVI_SELDOM\n"
    "#define DVI_INLINE static inline\n"
    "#endif\n"
    "#if defined(DVI_LANES)\n"
    "#elif defined(__x86_64__) && defined(__gnu_linux__) && (!defined(__clang__) || "
    "__clang_major__ >= 14) && "
    "!defined(__SANITIZE_THREAD__)\n"
    "#define DVI_LANES __attribute__((target_clones(\"arch=x86-64-v4\", \"avx2\", \"default\")))\n"
    "#else\n"
    "#define DVI_LANES\n"
    "#endif\n\n",
    "/* x^(-1/2), right to two ulp: a first guess by halving the exponent's bits (Lomont 2003), "
    "then the series of (1 - e)^(-1/2), "
    "e = 1 - x y^2, twice.\n"
    " * Numbers near the ends of the range, and those that have no root, want a careful caller. "
    "*/\n"
    "DVI_INLINE double dvi_inverse_root(const int careful, double x, int64_t *unusual)\n"
    "{\n"
    "  uint64_t bits;\n"
    "  double y;\n"
    "  memcpy(&bits, &x, sizeof bits);\n"
    "  bits = UINT64_C(0x5fe6eb50c7b537a9) - (bits >> 1);\n"
    "  memcpy(&y, &bits, sizeof y);\n",
    "  double e = 1.0 - x * (y * y);\n"
    "  y += y * (e * (0.5 + e * (0.375 + e * 0.3125)));\n"
    "  e = 1.0 - x * (y * y);\n"
    "  y += y * (e * (0.5 + e * (0.375 + e * 0.3125)));\n"
    "  if (careful) return x >= DBL_MIN && x <= 1e300 ? y : 1.0 / sqrt(x);\n"
    "  *unusual |= (x >= DBL_MIN ? 0 : 1) | (x <= 1e300 ? 0 : 1);\n"
    "  return y;\n"
    "}\n\n",
    "/* The sum of all elements' numbers, by halves. */\n"
    "DVI_INLINE void dvi_fold(int elements, const int points, const double *row, double *sum)\n"
    "{\n"
    "  int left = (elements + 1) / 2, others = (elements - left) * points;\n"
    "  for (int k = 0; k < left * points; k++) sum[k] = k < others ? row[k] + row[left * points + "
    "k] : row[k];\n"
    "  for (; left > 1; left = (left + 1) / 2) {\n"
    "    const int half = (left + 1) / 2;\n"
    "    others = (left - half) * points;\n"
    "    DVI_INDEPENDENT\n"
    "    for (int k = 0; k < others; k++) sum[k] += sum[half * points + k];\n"
    "  }\n"
    "}\n\n"};

void dvi__emit_begin(dvi__emitter *out)
{
  for (size_t i = 0; i < sizeof beginning / sizeof *beginning; i++)
    write_text(out, beginning[i], strlen(beginning[i]));
}
