/* Prints the version of the linked library. Fails if it is not the version of the headers, or if
 * the library does not work. */
#include <dvi/dvi.h>
#include <stdio.h>

int main(void)
{
  char expected[32];
  (void)snprintf(expected, sizeof expected, "%d.%d.%d", DVI_VERSION_MAJOR, DVI_VERSION_MINOR,
                 DVI_VERSION_PATCH);
  (void)printf("%s\n", dvi_version());
  for (const char *a = expected, *b = dvi_version();; a++, b++) {
    if (*a != *b) return 1;
    if (*a == '\0') break;
  }
  double node[2], weight[2];
  return dvi_quadrature(DVI_GAUSS, 2, node, weight) == DVI_OK && dvi_method_count() > 0 ? 0 : 1;
}
