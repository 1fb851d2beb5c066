#include "field/step/saved.h"

#include <math.h>
#include <string.h>

#include "core/hash.h"
#include "core/memory.h"
#include "core/status.h"
#include "field/mesh/share.h"
#include "march/parts.h"

/* ---- pieces ---- */

static int64_t size_of(const dvi_mesh *mesh, const dvi__piece *piece)
{
  return piece->degree < 0 || piece->count == 0 ? piece->count
                                                : dvi__whole_count(mesh, piece->degree);
}

/* Numbers of a piece in a section. */
static int64_t held_of(const dvi_mesh *mesh, const dvi__piece *piece, const dvi__parts *parts)
{
  const int64_t size = size_of(mesh, piece);
  return parts != NULL && piece->degree >= 0 && size > 0 ? 1 : size;
}

int64_t dvi__pieces_size(const dvi_mesh *mesh, int pieces, const dvi__piece *piece,
                         const dvi__parts *parts)
{
  int64_t sum = 0;
  for (int i = 0; i < pieces; i++) sum += held_of(mesh, piece + i, parts);
  return sum;
}

/* ---- parts ---- */

static int is_in_parts(const dvi__piece *piece, const dvi__parts *parts)
{
  return parts != NULL && piece->degree >= 0 && piece->count > 0;
}

static dvi__part_rows part_rows(const dvi_mesh *mesh, int array, const dvi__piece *piece)
{
  const dvi__share *s = mesh->share;
  return (dvi__part_rows){.array = array,
                          .total = size_of(mesh, piece),
                          .listed = piece->count,
                          .number = s != NULL ? s->number[piece->degree] : NULL,
                          .owner = s != NULL ? s->owner[piece->degree] : NULL};
}

/* Give a hash of a form of the whole mesh, which does not depend on the division. */
static dvi_status hash_form(const dvi_mesh *mesh, const dvi__piece *piece, uint64_t *hash)
{
  uint64_t sum = 0;
  for (int64_t c = 0; c < piece->count; c++) {
    if (!dvi__owns(mesh, piece->degree, c)) continue;
    int64_t row[2] = {dvi__whole_number(mesh, piece->degree, c)};
    memcpy(row + 1, piece->value + c, sizeof *row);
    sum += dvi__hash(DVI__HASH_START, sizeof row, row);
  }
  DVI_TRY(dvi__sum_modulo(mesh, &sum));
  *hash = sum;
  return DVI_OK;
}

static dvi_status put_part(const dvi_mesh *mesh, int array, const dvi__piece *piece,
                           dvi__sections_writer *writer)
{
  const dvi__part_rows rows = part_rows(mesh, array, piece);
  uint64_t hash = 0;
  DVI_TRY(hash_form(mesh, piece, &hash));
  dvi__section_put(writer, &hash, sizeof hash);
  return writer->parts->put(writer->parts->of, &rows, piece->value);
}

static dvi_status take_part(const dvi_mesh *mesh, int array, const dvi__piece *piece,
                            const dvi__sections *sections, const unsigned char *numbers)
{
  const dvi__part_rows rows = part_rows(mesh, array, piece);
  uint64_t hash = 0;
  DVI_TRY(sections->parts->take(sections->parts->of, &rows, piece->value));
  DVI_TRY(hash_form(mesh, piece, &hash));
  if (memcmp(&hash, numbers, sizeof hash) == 0) return DVI_OK;
  return dvi__fail(DVI_BAD_FILE, "%s: damaged (the checksum of an array is wrong)", sections->name);
}

/* Take all pieces to `room`, those that are no parts, too. */
static dvi_status take_parts(const dvi_mesh *mesh, int pieces, const dvi__piece *piece,
                             const dvi__sections *sections, const unsigned char *numbers,
                             double *room)
{
  for (int i = 0; i < pieces; i++) {
    const dvi__piece here = {piece[i].degree, piece[i].count, room};
    if (is_in_parts(piece + i, sections->parts))
      DVI_TRY(take_part(mesh, i, &here, sections, numbers));
    else
      memcpy(room, numbers, (size_t)here.count * sizeof *room);
    room += here.count;
    numbers += (size_t)held_of(mesh, piece + i, sections->parts) * sizeof *room;
  }
  return DVI_OK;
}

/* Replace all pieces or none. */
static dvi_status replace(const dvi_mesh *mesh, int pieces, const dvi__piece *piece,
                          const dvi__sections *sections, const unsigned char *numbers)
{
  int64_t count = 0;
  for (int i = 0; i < pieces; i++) count += piece[i].count;
  double *room = DVI_NEW(double, count);
  dvi_status status = dvi__agree(
      mesh, room != NULL ? DVI_OK : dvi__fail(DVI_NO_MEMORY, "march: no memory to load"));
  if (status == DVI_OK && room != NULL)
    status = take_parts(mesh, pieces, piece, sections, numbers, room);
  if (status == DVI_OK && room != NULL)
    for (int64_t i = 0, at = 0; i < pieces; at += piece[i++].count)
      memcpy(piece[i].value, room + at, (size_t)piece[i].count * sizeof *room);
  dvi__release(room);
  return status;
}

/* ---- whole numbers ---- */

typedef struct form {
  const dvi_mesh *mesh;
  const dvi__piece *piece;
} form;

static void fill_value(const void *of, int64_t i, int64_t *word)
{
  const form *f = of;
  if (dvi__owns(f->mesh, f->piece->degree, i)) memcpy(word, f->piece->value + i, sizeof *word);
}

static void put_values(void *to, int64_t count, const int64_t *word)
{
  dvi__section_put(to, word, (size_t)count * sizeof *word);
}

/* Put a form together. */
static dvi_status put_form(const dvi_mesh *mesh, const dvi__piece *piece, int64_t *room,
                           dvi__sections_writer *writer)
{
  const form f = {mesh, piece};
  const dvi__whole_rows rows = {.total = size_of(mesh, piece),
                                .listed = piece->count,
                                .number = mesh->share->number[piece->degree],
                                .width = 1,
                                .fill = fill_value,
                                .of = &f};
  return dvi__gather_rows(mesh, &rows, room, put_values, writer);
}

dvi_status dvi__pieces_put(const dvi_mesh *mesh, int pieces, const dvi__piece *piece,
                           dvi__sections_writer *writer)
{
  int64_t *room = mesh->share != NULL ? DVI_NEW(int64_t, dvi__whole_room(1)) : NULL;
  dvi_status status = dvi__agree(mesh, room != NULL || mesh->share == NULL
                                           ? DVI_OK
                                           : dvi__fail(DVI_NO_MEMORY, "march: no memory to save"));
  for (int i = 0; i < pieces && status == DVI_OK; i++) {
    if (is_in_parts(piece + i, writer->parts))
      status = put_part(mesh, i, piece + i, writer);
    else if (room != NULL && piece[i].degree >= 0)
      status = put_form(mesh, piece + i, room, writer);
    else
      dvi__section_put(writer, piece[i].value, (size_t)piece[i].count * sizeof(double));
  }
  dvi__release(room);
  return status;
}

dvi_status dvi__pieces_take(const dvi_mesh *mesh, int pieces, const dvi__piece *piece,
                            const dvi__sections *sections, const unsigned char *numbers)
{
  if (sections->parts != NULL) return replace(mesh, pieces, piece, sections, numbers);
  for (int i = 0; i < pieces; i++) {
    const int k = piece[i].degree;
    for (int64_t c = 0; c < piece[i].count; c++) {
      const int64_t at = k >= 0 ? dvi__whole_number(mesh, k, c) : c;
      memcpy(piece[i].value + c, numbers + (size_t)at * sizeof(double), sizeof(double));
    }
    numbers += (size_t)size_of(mesh, piece + i) * sizeof(double);
  }
  return DVI_OK;
}

/* ---- hashes ---- */

static uint64_t hash_entries(const dvi__csr *A, int64_t row, uint64_t hash)
{
  for (int64_t e = A->start[row]; e < A->start[row + 1]; e++)
    if (A->value[e] != 0) hash = dvi__hash(hash, sizeof *A->value, A->value + e);
  return hash;
}

/* Give a hash of an unknown, with its cell's number in the whole mesh. */
static uint64_t hash_unknown(const dvi_field *f, int64_t i)
{
  const int64_t number = dvi__whole_number(f->mesh, f->degree, f->unknown[i]);
  uint64_t hash = dvi__hash(DVI__HASH_START, sizeof number, &number);
  hash = hash_entries(&f->mass, i, hash);
  hash = hash_entries(&f->stiffness, i, hash);
  if (f->damping.rows > 0) hash = hash_entries(&f->damping, i, hash);
  for (int c = 0; c < f->currents; c++) {
    const dvi__current *J = f->current + c;
    const int64_t k = dvi__current_entry(J, i);
    if (k == J->count || J->unknown[k] != i) continue;
    hash = dvi__hash(hash, sizeof c, &c);
    hash = dvi__hash(hash, sizeof *J->weight, J->weight + k);
  }
  return hash;
}

/* The halves do not overflow. */
dvi_status dvi__sum_modulo(const dvi_mesh *mesh, uint64_t *number)
{
  int64_t half[2] = {(int64_t)(*number & UINT32_MAX), (int64_t)(*number >> 32)};
  DVI_TRY(dvi__count_all(mesh, 2, half));
  *number = (uint64_t)half[0] + ((uint64_t)half[1] << 32);
  return DVI_OK;
}

dvi_status dvi__field_hash(const dvi_field *field, uint64_t *hash)
{
  const dvi_field *f = field;
  const int64_t head[] = {f->degree, dvi__whole_count(f->mesh, f->degree),
                          dvi__whole_count(f->mesh, f->degree + 1), f->whole_unknowns, f->currents};
  uint64_t sum = 0;
  for (int64_t i = 0; i < f->unknowns; i++)
    if (dvi__owns(f->mesh, f->degree, f->unknown[i])) sum += hash_unknown(f, i);
  DVI_TRY(dvi__sum_modulo(f->mesh, &sum));
  *hash = dvi__hash(dvi__hash(DVI__HASH_START, sizeof head, head), sizeof sum, &sum);
  return DVI_OK;
}

dvi_status dvi__check_same(const dvi_mesh *mesh, const char *name, size_t size,
                           const unsigned char *content)
{
  if (mesh->share == NULL) return DVI_OK;
  const uint64_t here = dvi__hash(DVI__HASH_START, size, content);
  uint64_t all = here;
  DVI_TRY(dvi__sum_modulo(mesh, &all));
  return dvi__agree(
      mesh, all == here * (uint64_t)mesh->share->ranks.count
                ? DVI_OK
                : dvi__fail(DVI_BAD_FILE, "march: %s is not the same on all processes", name));
}

/* ---- marches of equal steps ---- */

/* What is written is read again. */
static dvi_status check_pieces(const dvi__saved_march *march)
{
  for (int i = 0; i < march->pieces; i++)
    for (int64_t c = 0; c < march->piece[i].count; c++)
      if (!isfinite(march->piece[i].value[c]))
        return dvi__fail(DVI_NOT_FINITE, "march: its state has the number %g at t = %g",
                         march->piece[i].value[c], march->at->t);
  return DVI_OK;
}

dvi_status dvi__saved_march_put(const dvi__saved_march *march, dvi__sections_writer *writer)
{
  DVI_TRY(dvi__agree(march->mesh, check_pieces(march)));
  dvi__section_open(writer, march->method, march->version);
  dvi__section_put(writer, march->at, sizeof *march->at);
  dvi__section_open(writer, "forms", 1);
  return dvi__pieces_put(march->mesh, march->pieces, march->piece, writer);
}

/* Refuse the state of an integrator, whose solver leaves other roundings. */
static dvi_status refuse_integrator(const dvi__saved_march *march, const dvi__sections *sections)
{
  if (dvi__sections_have(sections, march->method) || !dvi__sections_have(sections, "method"))
    return DVI_OK;
  return dvi__fail(
      DVI_BAD_FILE,
      "march: %s is the state of an integrator, and of no march. One process writes it "
      "with an implicit method, and one goes on from it: leave mpirun out",
      sections->name);
}

static dvi_status check_field(const dvi__saved_march *march, const char *name,
                              const dvi__march_place *at)
{
  if (at->dt != march->at->dt)
    return dvi__fail(DVI_BAD_FILE,
                     "march: %s is of another field, or of another step: it has dt = %.17g, and "
                     "this march %.17g",
                     name, at->dt, march->at->dt);
  if (at->hash == march->at->hash) return DVI_OK;
  return dvi__fail(DVI_BAD_FILE,
                   "march: %s is of another field: its mesh, materials or conditions are not those "
                   "of this march",
                   name);
}

/* Find what was saved, and refuse what another march has saved. */
static dvi_status find_saved(const dvi__saved_march *march, const dvi__sections *sections,
                             dvi__march_place *at, dvi__section *forms)
{
  dvi__section found;
  const size_t numbers = (size_t)dvi__pieces_size(march->mesh, march->pieces, march->piece,
                                                  sections->parts);
  DVI_TRY(refuse_integrator(march, sections));
  DVI_TRY(dvi__section_find(sections, march->method, march->version, sizeof *at, &found));
  memcpy(at, found.content, sizeof *at);
  DVI_TRY(check_field(march, sections->name, at));
  return dvi__section_find(sections, "forms", 1, numbers * sizeof(double), forms);
}

dvi_status dvi__saved_march_take(const dvi__saved_march *march, const dvi__sections *sections)
{
  dvi__section forms = {0};
  dvi__march_place at;
  const dvi_status found = dvi__agree(march->mesh, find_saved(march, sections, &at, &forms));
  if (found != DVI_OK || forms.content == NULL) return found;
  DVI_TRY(dvi__check_same(march->mesh, sections->name, sections->size, sections->bytes));
  DVI_TRY(dvi__pieces_take(march->mesh, march->pieces, march->piece, sections, forms.content));
  *march->at = at;
  return DVI_OK;
}
