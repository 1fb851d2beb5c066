#include "bench/machine.h"

#include <dvi/dvi.h>
#include <dvi/study.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A sanitizer has a malloc of its own, which the C library does not know. */
#if defined(__SANITIZE_ADDRESS__)
#define HAS_SANITIZER
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define HAS_SANITIZER
#endif
#endif

#if defined(HAS_SANITIZER)
size_t __sanitizer_get_current_allocated_bytes(void); /* not every package has its header */
#elif defined(__GLIBC__)
#include <malloc.h>
#if __GLIBC__ > 2 || __GLIBC_MINOR__ >= 33
#define HAS_MALLINFO2
#endif
#endif

/* Defined by the build, but not for a compiler that is called by hand. */
#ifndef DVI_BUILD_COMPILER
#define DVI_BUILD_COMPILER "unknown"
#endif
#ifndef DVI_BUILD_FLAGS
#define DVI_BUILD_FLAGS "flags unknown"
#endif

enum { LINE_SIZE = 256 };

/* Read the name of the processor. Linux on x86 has a line "model name : ..." for each core. Other
 * processors have no such line. */
static void read_processor(char *name)
{
  static const char key[] = "model name";
  char line[LINE_SIZE];
  (void)snprintf(name, LINE_SIZE, "unknown");
  FILE *file = fopen("/proc/cpuinfo", "r");
  if (file == NULL) return;
  while (fgets(line, sizeof line, file) != NULL) {
    const char *value = strchr(line, ':');
    if (strncmp(line, key, strlen(key)) != 0 || value == NULL) continue;
    value += 1 + strspn(value + 1, " \t");
    (void)snprintf(name, LINE_SIZE, "%.*s", (int)strcspn(value, "\n"), value);
    break;
  }
  (void)fclose(file);
}

void machine_print(FILE *stream)
{
  char name[LINE_SIZE];
  read_processor(name);
  (void)fprintf(stream, "processor: %s\n", name);
  (void)fprintf(stream, "compiler: %s, %s\n", DVI_BUILD_COMPILER, DVI_BUILD_FLAGS);
  (void)fprintf(stream, "libraries: dvi %s, SUNDIALS %s\n", dvi_version(), dvi_reference_version());
}

double machine_multiplications(void)
{
  enum { RUN = 10000000, SCALE = 10 };
  /* the compiler must not know the value, nor the use of the product */
  volatile double start = 1.0;
  const double factor = start + 1e-10;
  double product = start;
  const double began = dvi_study_clock();
  for (int i = 0; i < RUN; i++) product *= factor;
  const double spent = dvi_study_clock() - began;
  start = product;
  return SCALE * spent;
}

void machine_print_calibration(FILE *stream, const dvi_study_spread *seconds)
{
  (void)fprintf(
      stream,
      "calibration: 1e8 dependent multiplications in %.3f s (least %.3f, quartiles %.3f, %.3f)\n",
      seconds->median, seconds->least, seconds->lower, seconds->upper);
}

/* Use the processor's best instructions, because the loop serves as a yardstick. */
#if defined(__x86_64__) && defined(__gnu_linux__) && (!defined(__clang__) || __clang_major__ >= 14)
__attribute__((target_clones("arch=x86-64-v4", "avx2", "default")))
#endif
static void
add_multiple(size_t n, double a, const double *restrict x, double *restrict y)
{
  for (size_t i = 0; i < n; i++) y[i] += a * x[i];
}

double machine_axpy(int n)
{
  enum { LINE = 64, LEAST = 4 };
  static const double seconds = 0.05;
  const size_t count = (size_t)n, size = (count * sizeof(double) + LINE - 1) / LINE * LINE;
  double *x = aligned_alloc(LINE, size), *y = aligned_alloc(LINE, size), spent = 0.0;
  long passes = 0;
  for (size_t i = 0; x != NULL && y != NULL && i < count; i++) x[i] = y[i] = 1.0;
  for (const double began = dvi_study_clock();
       x != NULL && y != NULL && (passes < LEAST || spent < seconds); passes++) {
    add_multiple(count, 1e-9, x, y);
    spent = dvi_study_clock() - began;
  }
  free(x);
  free(y);
  return passes > 0 ? 24.0 * n * (double)passes / spent : (double)NAN;
}

double machine_heap(void)
{
#if defined(HAS_SANITIZER)
  return (double)__sanitizer_get_current_allocated_bytes();
#elif defined(HAS_MALLINFO2)
  const struct mallinfo2 heap = mallinfo2();
  return (double)heap.uordblks + (double)heap.hblkhd;
#else
  return (double)NAN;
#endif
}
