/* Saved states of grids, which are those of the whole grid. The section "yee" identifies the grid
 * and has its times, "yee-rows" row by row the fields, what was conducted, and the sums of
 * absorbing layers, "yee-waves" the lines of waves, "yee-sources" the impulses of the sources, and
 * "yee-charges" the charges of the start. Several processes put the rows together. Each has the
 * file, and takes its own from it. */
#include <math.h>
#include <string.h>

#include "core/hash.h"
#include "core/memory.h"
#include "core/status.h"
#include "field/yee/ranks.h"

enum { VERSION = 3, CHUNK = 1 << 14 };

typedef struct identity {
  uint64_t grid; /* hash of the axes and of what acts on the fields */
  double dt, t0, t;
  int64_t step, has_charge;
} identity;

static uint64_t hash_integer(uint64_t hash, int64_t number)
{
  return dvi__hash(hash, sizeof number, &number);
}

static uint64_t hash_numbers(uint64_t hash, size_t count, const double *x)
{
  return x != NULL ? dvi__hash(hash, count * sizeof *x, x) : hash;
}

static uint64_t hash_acts(uint64_t hash, const dvi__yee_acts *acts, size_t row)
{
  if (acts->count == 0) return hash;
  for (int64_t i = acts->row[row]; i < acts->row[row + 1]; i++) {
    hash = hash_integer(hash_integer(hash, acts->act[i].place), acts->act[i].from);
    hash = hash_numbers(hash, 2, acts->act[i].w);
  }
  return hash;
}

static uint64_t hash_beside(uint64_t hash, const double *array, size_t at, int count)
{
  return array != NULL ? hash_numbers(hash, (size_t)count, array + at) : hash;
}

/* Give the hash of what distinguishes the rows at (j, k), with their numbers. */
static uint64_t hash_row(const dvi__yee *y, int j, int k)
{
  uint64_t hash = hash_integer(hash_integer(DVI__HASH_START, j), k);
  const size_t row = dvi__yee_row(y, j, k);
  for (int c = 0; c < 6; c++) {
    const int is_edge = c < DVI__YEE_B, count = dvi__yee_places(y, c, 0);
    if (y->slot[c] < 0 || j >= dvi__yee_places(y, c, 1) || k >= dvi__yee_places(y, c, 2)) continue;
    const size_t at = dvi__yee_beside(y, c, (const int[]){0, j, k});
    if (!is_edge) hash = hash_beside(hash, y->mi, at, count);
    if (!is_edge) continue;
    hash = hash_beside(hash_beside(hash, y->ce, at, count), y->ca, at, count);
    for (int64_t i = 0; y->wall != NULL && i < dvi__yee_count_walls(y, c, j, k); i++)
      hash = hash_numbers(hash, 1, &y->wall[y->wall_first[at / y->width] + i].part);
  }
  return hash_acts(hash_acts(hash, &y->on_edges, row), &y->on_faces, row);
}

static uint64_t hash_axis(uint64_t hash, const dvi__yee_axis *a)
{
  const double phase[] = {a->cosine, a->sine};
  hash = hash_integer(hash, a->cells);
  hash = hash_numbers(hash, 2, phase);
  hash = hash_numbers(hash, (size_t)a->cells + 1, a->node);
  for (int e = 0; e < 2; e++) {
    const double numbers[] = {a->end[e].reflection, a->end[e].alpha, a->end[e].kappa,
                              a->layers[e].count};
    hash = hash_numbers(hash_integer(hash, (int64_t)a->end[e].kind), 4, numbers);
  }
  return hash;
}

/* Rows are hashed one by one and summed up, so that it is the same for all divisions. Called on all
 * processes. */
static uint64_t hash_grid(const dvi__yee *y)
{
  uint64_t sum = 0, hash = hash_integer(hash_integer(DVI__HASH_START, y->axes), y->degree);
  hash = hash_integer(hash_integer(hash, y->sources), y->beams);
  for (int l = 0; l < 3; l++) hash = hash_axis(hash, &y->axis[l]);
  for (int k = y->own[2][0]; k < y->own[2][1]; k++)
    for (int j = y->own[1][0]; j < y->own[1][1]; j++) sum += hash_row(y, j, k);
  return hash_integer(hash, (int64_t)dvi__yee_sum_modulo(y, sum));
}

/* ---- rows ---- */

/* What gives the pieces of the rows at (j, k). */
typedef int row_pieces(const dvi__yee *y, int j, int k, dvi__yee_piece *piece);

static size_t size_of_rows(const dvi__yee *y, row_pieces *of)
{
  size_t numbers = 0;
  dvi__yee_piece piece[DVI__YEE_PIECES];
  for (int k = 0; k < y->axis[2].nodes; k++)
    for (int j = 0; j < y->axis[1].nodes; j++)
      for (int i = of(y, j, k, piece); i-- > 0;) numbers += piece[i].count;
  return numbers * sizeof(double);
}

/* Numbers that processes put together: the one that has a number adds its bits to the zeros of the
 * others, so that their sum as integers is exact, of -0 as well. */
typedef struct gathering {
  const dvi__yee *y;
  dvi__sections_writer *writer;
  int64_t *bits; /* [CHUNK] */
  size_t count;
} gathering;

static void end_chunk(gathering *g)
{
  dvi__yee_add_all(g->y, (int)g->count, g->bits);
  dvi__section_put(g->writer, g->bits, g->count * sizeof *g->bits);
  g->count = 0;
}

static void gather(gathering *g, const double *x, size_t count)
{
  for (size_t done = 0; done < count;) {
    const size_t free_ones = CHUNK - g->count, left = count - done,
                 next = left < free_ones ? left : free_ones;
    memset(g->bits + g->count, 0, next * sizeof *g->bits);
    if (x != NULL) memcpy(g->bits + g->count, x + done, next * sizeof *g->bits);
    done += next;
    g->count += next;
    if (g->count == CHUNK) end_chunk(g);
  }
}

static void put_rows(gathering *g, row_pieces *of)
{
  const dvi__yee *y = g->y;
  dvi__yee_piece piece[DVI__YEE_PIECES];
  for (int k = 0; k < y->axis[2].nodes; k++)
    for (int j = 0; j < y->axis[1].nodes; j++) {
      const int count = of(y, j, k, piece);
      for (int i = 0; i < count; i++)
        if (y->planes == NULL)
          dvi__section_put(g->writer, piece[i].x, piece[i].count * sizeof(double));
        else
          gather(g, piece[i].x, piece[i].count);
    }
  if (g->count > 0) end_chunk(g);
}

static void take_rows(const dvi__yee *y, row_pieces *of, const unsigned char *numbers)
{
  dvi__yee_piece piece[DVI__YEE_PIECES];
  for (int k = 0; k < y->axis[2].nodes; k++)
    for (int j = 0; j < y->axis[1].nodes; j++) {
      const int count = of(y, j, k, piece);
      for (int i = 0; i < count; i++) {
        const size_t size = piece[i].count * sizeof(double);
        if (piece[i].x != NULL) memcpy(piece[i].x, numbers, size);
        numbers += size;
      }
    }
}

/* ---- save ---- */

/* Put what all processes have alike. */
static void put_waves_and_sources(const dvi__yee *y, dvi__sections_writer *writer)
{
  dvi__section_open(writer, "yee-waves", VERSION);
  for (int i = 0; i < y->beams; i++) {
    size_t count;
    const double *line = dvi__yee_line_of(y, i, &count);
    dvi__section_put(writer, line, count * sizeof *line);
  }
  dvi__section_open(writer, "yee-sources", VERSION);
  for (int i = 0; i < y->sources; i++) {
    const double sums[2] = {y->source[i].impulse, y->source[i].compensation};
    dvi__section_put(writer, sums, sizeof sums);
  }
}

dvi_status dvi__yee_save(const void *self, dvi__sections_writer *writer)
{
  const dvi__yee *y = self;
  DVI_TRY(dvi__yee_check_ranks(y));
  const identity id = {hash_grid(y), y->dt, y->t0, y->t, y->step, y->charge != NULL};
  gathering g = {.y = y, .writer = writer};
  if (y->planes != NULL) g.bits = DVI_NEW(int64_t, CHUNK);
  DVI_TRY(dvi__yee_agree(y, g.bits != NULL || y->planes == NULL
                                ? DVI_OK
                                : dvi__fail(DVI_NO_MEMORY, "yee: no memory to save")));
  dvi__section_open(writer, "yee", VERSION);
  dvi__section_put(writer, &id, sizeof id);
  dvi__section_open(writer, "yee-rows", VERSION);
  put_rows(&g, dvi__yee_saved);
  put_waves_and_sources(y, writer);
  if (y->charge != NULL) {
    dvi__section_open(writer, "yee-charges", VERSION);
    put_rows(&g, dvi__yee_saved_charge);
  }
  dvi__release(g.bits);
  return dvi__yee_check_ranks(y);
}

/* ---- load ---- */

/* What a file has. */
typedef struct found {
  identity id;
  dvi__section rows, waves, sources, charges;
} found;

static dvi_status find_identity(const dvi__yee *y, uint64_t hash, const dvi__sections *sections,
                                identity *id)
{
  dvi__section section;
  DVI_TRY(dvi__section_find(sections, "yee", VERSION, sizeof *id, &section));
  memcpy(id, section.content, sizeof *id);
  if (id->grid == hash && id->dt == y->dt) return DVI_OK;
  return dvi__fail(DVI_BAD_FILE,
                   "%s: it was saved by another grid, or with another step: it has dt = %.17g, and "
                   "this march %.17g; make the march from the same terms",
                   sections->name, id->dt, y->dt);
}

static dvi_status find_charges(dvi__yee *y, const dvi__sections *sections, found *f)
{
  const size_t count = dvi__yee_count_nodes(y);
  if (!f->id.has_charge) return DVI_OK;
  DVI_TRY(dvi__section_find(sections, "yee-charges", VERSION,
                            size_of_rows(y, dvi__yee_saved_charge), &f->charges));
  if (y->charge == NULL) y->charge = DVI_NEW(double, count);
  return y->charge != NULL ? DVI_OK
                           : dvi__fail(DVI_NO_MEMORY, "yee: no memory for %zu charges", count);
}

/* Find all sections, and refuse files of another grid. */
static dvi_status find(dvi__yee *y, uint64_t hash, const dvi__sections *sections, found *f)
{
  size_t lines = 0;
  for (int i = 0; i < y->beams; i++) {
    size_t count;
    (void)dvi__yee_line_of(y, i, &count);
    lines += count * sizeof(double);
  }
  DVI_TRY(find_identity(y, hash, sections, &f->id));
  DVI_TRY(
      dvi__section_find(sections, "yee-rows", VERSION, size_of_rows(y, dvi__yee_saved), &f->rows));
  DVI_TRY(dvi__section_find(sections, "yee-waves", VERSION, lines, &f->waves));
  DVI_TRY(dvi__section_find(sections, "yee-sources", VERSION,
                            (size_t)y->sources * 2 * sizeof(double), &f->sources));
  return find_charges(y, sections, f);
}

/* Refuse sections of which the processes have different ones. Called on all of them. */
static dvi_status check_same(const dvi__yee *y, const dvi__sections *sections)
{
  if (y->planes == NULL) return DVI_OK;
  const uint64_t here = dvi__hash(DVI__HASH_START, sections->size, sections->bytes);
  const int is_same = dvi__yee_sum_modulo(y, here) == here * (uint64_t)dvi__yee_processes(y);
  return dvi__yee_agree(
      y, is_same ? DVI_OK
                 : dvi__fail(DVI_BAD_FILE, "%s is not the same on all processes", sections->name));
}

static void take_waves_and_sources(dvi__yee *y, const found *f)
{
  const unsigned char *lines = f->waves.content;
  for (int i = 0; i < y->beams; i++) {
    size_t count;
    double *line = dvi__yee_line_of(y, i, &count);
    memcpy(line, lines, count * sizeof *line);
    lines += count * sizeof *line;
  }
  for (int i = 0; i < y->sources; i++) {
    double sums[2];
    memcpy(sums, f->sources.content + (size_t)i * sizeof sums, sizeof sums);
    y->source[i].impulse = sums[0];
    y->source[i].compensation = sums[1];
  }
}

static void take(dvi__yee *y, const found *f)
{
  take_rows(y, dvi__yee_saved, f->rows.content);
  take_waves_and_sources(y, f);
  if (f->id.has_charge)
    take_rows(y, dvi__yee_saved_charge, f->charges.content);
  else if (y->charge != NULL)
    memset(y->charge, 0, dvi__yee_count_nodes(y) * sizeof(double));
  y->t0 = f->id.t0;
  y->t = f->id.t;
  y->step = f->id.step;
  y->moment->is_now = 0;
}

/* A march that has lost the other processes speaks with them again, and has lost them again if the
 * file is refused. */
dvi_status dvi__yee_load(void *self, const dvi__sections *sections)
{
  dvi__yee *y = self;
  found f = {.rows = {0}};
  const int lost = dvi__yee_begin_ranks(y), had_charge = y->charge != NULL;
  dvi_status status = find(y, hash_grid(y), sections, &f);
  const dvi_status agreed = dvi__yee_agree(y, status);
  if (status == DVI_OK) status = agreed;
  if (status == DVI_OK) status = check_same(y, sections);
  if (status != DVI_OK) {
    if (!had_charge) dvi__release(y->charge);
    if (!had_charge) y->charge = NULL;
    dvi__yee_lose_ranks(y, lost);
    return status;
  }
  take(y, &f);
  dvi__yee_wrap_values(y);
  return dvi__yee_check_ranks(y);
}
