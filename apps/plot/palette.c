#include "plot/palette.h"

#include <math.h>

enum { COLOURS = 25 };

void palette_set(FILE *script, double least, double most)
{
  if (!(most > least)) {
    (void)fputs("set palette defined (0 '#a8b4c0', 1 '#f4f6f8')\nset cbrange [*:*]\n", script);
  } else if (least < 0 && most > 0) {
    const double size = fmax(-least, most);
    (void)fputs("set palette defined (-1 '#2166ac', -0.5 '#92c5de', 0 '#f7f7f7', 0.5 '#f4a582', "
                "1 '#b2182b')\n",
                script);
    (void)fprintf(script, "set cbrange [%.9g:%.9g]\n", -size, size);
  } else {
    (void)fputs("set palette defined (0 '#440154', 1 '#3b528b', 2 '#21918c', 3 '#5ec962', "
                "4 '#fde725')\n",
                script);
    (void)fprintf(script, "set cbrange [%.9g:%.9g]\nset format cb '%%g'\n", least, most);
  }
  (void)fprintf(script, "set colorbox\nset palette maxcolors %d\n", COLOURS);
}
