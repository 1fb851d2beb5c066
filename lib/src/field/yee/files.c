/* Saved states of grids. The section "yee" identifies the grid and has its times, "yee-fields" the
 * fields, "yee-worn" what was conducted, "yee-layers" the sums of absorbing layers, "yee-waves" the
 * lines of waves, "yee-sources" the impulses of the sources, and "yee-charges" the charges of the
 * start. */
#include <math.h>
#include <string.h>

#include "core/hash.h"
#include "core/memory.h"
#include "core/status.h"
#include "field/yee/ranks.h"

enum { VERSION = 2 };

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

static uint64_t hash_acts(uint64_t hash, const dvi__yee *y, const dvi__yee_acts *acts)
{
  if (acts->count == 0) return hash;
  hash = dvi__hash(hash, (y->rows[0] * y->rows[1] + 1) * sizeof *acts->row, acts->row);
  for (int64_t i = 0; i < acts->count; i++) {
    hash = hash_integer(hash_integer(hash, acts->act[i].place), acts->act[i].from);
    hash = hash_numbers(hash, 2, acts->act[i].w);
  }
  return hash;
}

static uint64_t hash_walls(uint64_t hash, const dvi__yee *y)
{
  const size_t rows = y->rows[0] * y->rows[1] * (size_t)y->edges_slots;
  for (int64_t i = 0; y->wall != NULL && i < y->wall_first[rows]; i++)
    hash = hash_numbers(hash, 1, &y->wall[i].part);
  return hash;
}

static uint64_t hash_grid(const dvi__yee *y)
{
  const size_t places = y->rows[0] * y->rows[1] * y->width;
  uint64_t hash = hash_integer(hash_integer(DVI__HASH_START, y->axes), y->degree);
  hash = hash_integer(hash_integer(hash, y->sources), y->beams);
  for (int l = 0; l < 3; l++) {
    const dvi__yee_axis *a = &y->axis[l];
    const double phase[] = {a->cosine, a->sine};
    hash = hash_integer(hash, a->cells);
    hash = hash_numbers(hash, 2, phase);
    hash = hash_numbers(hash, (size_t)a->cells + 1, a->node);
    for (int e = 0; e < 2; e++) {
      const double numbers[] = {a->end[e].reflection, a->end[e].alpha, a->end[e].kappa,
                                a->layers[e].count};
      hash = hash_numbers(hash_integer(hash, (int64_t)a->end[e].kind), 4, numbers);
    }
  }
  if (y->divided >= 0) hash = dvi__hash(hash, sizeof y->own, y->own);
  hash = hash_numbers(hash, places * (size_t)y->edges_slots, y->ce);
  hash = hash_numbers(hash, places * (size_t)y->edges_slots, y->ca);
  hash = hash_numbers(hash, places * (size_t)(y->components - y->edges_slots), y->mi);
  hash = hash_walls(hash, y);
  return hash_acts(hash_acts(hash, y, &y->on_edges), y, &y->on_faces);
}

/* ---- arrays of the state ---- */

/* An array that belongs to the state. */
typedef struct part {
  const char *section;
  double *x;
  size_t count;
} part;

/* Count the arrays. */
static int count_parts(const dvi__yee *y)
{
  int count = y->copies + (y->worn != NULL) + y->beams;
  for (int l = 0; l < 3; l++)
    count += (y->axis[l].layers[0].count > 0) + (y->axis[l].layers[1].count > 0);
  return count;
}

/* Give the array with a number. Those of one section follow each other. */
static part part_of(const dvi__yee *y, int number)
{
  const size_t places = y->rows[0] * y->rows[1] * y->width;
  part wave = {.section = "yee-waves"};
  if (number < y->copies) return (part){"yee-fields", y->state[number], y->size};
  number -= y->copies;
  if (y->worn != NULL && number-- == 0)
    return (part){"yee-worn", y->worn, places * (size_t)y->edges_slots};
  for (int l = 0; l < 6; l++) {
    const dvi__yee_layers *layers = &y->axis[l / 2].layers[l % 2];
    if (layers->count > 0 && number-- == 0)
      return (part){"yee-layers", layers->psi, (size_t)y->copies * layers->psi_count};
  }
  wave.x = dvi__yee_line_of(y, number, &wave.count);
  return wave;
}

/* ---- save ---- */

dvi_status dvi__yee_save(const void *self, dvi__sections_writer *writer)
{
  const dvi__yee *y = self;
  const identity id = {hash_grid(y), y->dt, y->t0, y->t, y->step, y->charge != NULL};
  const char *section = "";
  dvi__section_open(writer, "yee", VERSION);
  dvi__section_put(writer, &id, sizeof id);
  for (int i = 0; i < count_parts(y); i++) {
    const part next = part_of(y, i);
    if (strcmp(next.section, section) != 0) dvi__section_open(writer, next.section, VERSION);
    dvi__section_put(writer, next.x, next.count * sizeof(double));
    section = next.section;
  }
  dvi__section_open(writer, "yee-sources", VERSION);
  for (int i = 0; i < y->sources; i++) {
    const double sums[2] = {y->source[i].impulse, y->source[i].compensation};
    dvi__section_put(writer, sums, sizeof sums);
  }
  if (y->charge == NULL) return DVI_OK;
  dvi__section_open(writer, "yee-charges", VERSION);
  dvi__section_put(writer, y->charge, dvi__yee_count_nodes(y) * sizeof(double));
  return DVI_OK;
}

/* ---- load ---- */

static dvi_status find_identity(const dvi__yee *y, const dvi__sections *sections, identity *id)
{
  dvi__section found;
  DVI_TRY(dvi__section_find(sections, "yee", VERSION, sizeof *id, &found));
  memcpy(id, found.content, sizeof *id);
  if (id->grid == hash_grid(y) && id->dt == y->dt) return DVI_OK;
  return dvi__fail(DVI_BAD_FILE,
                   "%s: it was saved by another grid, or with another step: it has dt = %.17g, and "
                   "this march %.17g; make the march from the same terms",
                   sections->name, id->dt, y->dt);
}

/* Go through the sections of all arrays. DVI_BAD_FILE if one is missing or has another size. With
 * `takes`, copy them to the state. */
static dvi_status go_through_parts(const dvi__yee *y, const dvi__sections *sections, int takes)
{
  const int count = count_parts(y);
  for (int i = 0; i < count;) {
    const char *section = part_of(y, i).section;
    size_t size = 0;
    dvi__section found;
    int next = i;
    for (; next < count && strcmp(part_of(y, next).section, section) == 0; next++)
      size += part_of(y, next).count * sizeof(double);
    DVI_TRY(dvi__section_find(sections, section, VERSION, size, &found));
    for (const unsigned char *at = found.content; i < next; i++) {
      const part own = part_of(y, i);
      if (takes) memcpy(own.x, at, own.count * sizeof(double));
      at += own.count * sizeof(double);
    }
  }
  return DVI_OK;
}

static dvi_status find_charges(dvi__yee *y, const dvi__sections *sections, const identity *id,
                               dvi__section *charges)
{
  const size_t count = dvi__yee_count_nodes(y);
  if (!id->has_charge) return DVI_OK;
  DVI_TRY(dvi__section_find(sections, "yee-charges", VERSION, count * sizeof(double), charges));
  if (y->charge == NULL) y->charge = DVI_NEW(double, count);
  return y->charge != NULL ? DVI_OK
                           : dvi__fail(DVI_NO_MEMORY, "yee: no memory for %zu charges", count);
}

static void take_sources(dvi__yee *y, const dvi__section *sources)
{
  for (int i = 0; i < y->sources; i++) {
    double sums[2];
    memcpy(sums, sources->content + (size_t)i * sizeof sums, sizeof sums);
    y->source[i].impulse = sums[0];
    y->source[i].compensation = sums[1];
  }
}

dvi_status dvi__yee_load(void *self, const dvi__sections *sections)
{
  dvi__yee *y = self;
  identity id;
  dvi__section sources, charges = {0};
  DVI_TRY(find_identity(y, sections, &id));
  DVI_TRY(go_through_parts(y, sections, 0));
  DVI_TRY(dvi__section_find(sections, "yee-sources", VERSION,
                            (size_t)y->sources * 2 * sizeof(double), &sources));
  DVI_TRY(find_charges(y, sections, &id, &charges));
  DVI_TRY(go_through_parts(y, sections, 1));
  take_sources(y, &sources);
  if (charges.content != NULL)
    memcpy(y->charge, charges.content, charges.size);
  else if (y->charge != NULL)
    memset(y->charge, 0, dvi__yee_count_nodes(y) * sizeof(double));
  y->t0 = id.t0;
  y->t = id.t;
  y->step = id.step;
  y->moment->is_now = 0;
  dvi__yee_begin_ranks(y);
  return DVI_OK;
}
