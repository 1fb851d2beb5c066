#include "plot/space_map.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "plot/gnuplot.h"
#include "plot/palette.h"

enum { HEIGHT = 400 };

typedef struct map_drawing {
  const space_map *map;
  const char *title, *axis;
} map_drawing;

bool space_map_start(space_map *map, double from, double to)
{
  *map = (space_map){.width = SPACE_MAP_WIDTH, .stride = 1, .from = from, .to = to};
  map->time = calloc(SPACE_MAP_ROWS, sizeof *map->time);
  map->value = calloc((size_t)SPACE_MAP_ROWS * SPACE_MAP_WIDTH, sizeof *map->value);
  if (map->time != NULL && map->value != NULL) return true;
  complain("out of memory");
  space_map_clear(map);
  return false;
}

void space_map_clear(space_map *map)
{
  free(map->time);
  free(map->value);
  *map = (space_map){0};
}

static double *row_of(const space_map *map, int row)
{
  return map->value + (size_t)row * (size_t)map->width;
}

/* Keep every second row. */
static void thin(space_map *map)
{
  map->rows /= 2;
  map->stride *= 2;
  for (int i = 1; i < map->rows; i++) {
    map->time[i] = map->time[2 * i];
    memcpy(row_of(map, i), row_of(map, 2 * i), (size_t)map->width * sizeof(double));
  }
}

double *space_map_row(space_map *map, double t)
{
  if (map->rows == SPACE_MAP_ROWS) thin(map);
  if (map->seen++ % map->stride != 0) return NULL;
  map->time[map->rows] = t;
  return row_of(map, map->rows++);
}

static void set_colours(FILE *script, const space_map *map)
{
  double least = HUGE_VAL, most = -HUGE_VAL;
  for (size_t i = 0; i < (size_t)map->rows * (size_t)map->width; i++) {
    if (!isfinite(map->value[i])) continue;
    least = fmin(least, map->value[i]);
    most = fmax(most, map->value[i]);
  }
  palette_set(script, least, most);
}

static int nearest_row(const space_map *map, double t)
{
  int near = 0;
  for (int i = 1; i < map->rows; i++)
    if (fabs(map->time[i] - t) <= fabs(map->time[near] - t)) near = i;
  return near;
}

/* Write the rows at equal times, each that of the nearest time. gnuplot warns of NaN in texts, and
 * so they follow the command as bytes. */
static void write_rows(FILE *script, const space_map *map, double first, double step)
{
  for (int j = 0; j < HEIGHT; j++)
    (void)fwrite(row_of(map, nearest_row(map, first + j * step)), sizeof(double),
                 (size_t)map->width, script);
}

static void write_script(FILE *script, const void *drawing)
{
  const map_drawing *d = drawing;
  const space_map *map = d->map;
  const double start = map->time[0], end = map->time[map->rows - 1], first = fmin(start, end),
               dx = (map->to - map->from) / (map->width - 1), dt = fabs(end - start) / (HEIGHT - 1);
  (void)fputs("set terminal svg size 760,560 enhanced background rgb 'white' font "
              "'Helvetica,13'\nset border lc rgb '#404040'\nunset key\n",
              script);
  gnuplot_setting(script, "title", d->title);
  gnuplot_setting(script, "xlabel", d->axis);
  gnuplot_setting(script, "ylabel", "t");
  (void)fprintf(script, "set xrange [%.9g:%.9g]\nset yrange [%.9g:%.9g]\n", map->from, map->to,
                first, fmax(start, end));
  set_colours(script, map);
  (void)fprintf(script,
                "plot '-' binary array=(%d,%d) origin=(%.9g,%.9g) dx=%.9g dy=%.9g "
                "format='%%double' notitle with image\n",
                map->width, HEIGHT, map->from, first, dx, dt);
  write_rows(script, map, first, dt);
}

bool space_map_draw(const space_map *map, const char *path, const char *title, const char *axis)
{
  if (map->rows >= 2 && map->time[map->rows - 1] != map->time[0])
    return gnuplot_draw(path, write_script, &(map_drawing){map, title, axis});
  complain("no map in '%s': it needs rows at two times at least", path);
  return false;
}
