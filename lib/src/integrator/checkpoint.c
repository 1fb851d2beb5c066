/* Checkpoints: everything that the next step depends on, in one file with checksums.
 *
 * Callbacks cannot be saved, but the system can be known again: by what it declares (hashes),
 * and by what they compute at the saved state (fingerprint.h), which other parameters would
 * change. So can the method: by its keys, of which all but the name of a file are hashed, and by
 * what no key spells, a tableau's coefficients or a program's own functions.
 *
 * Layout, in the machine's own byte order (a mark tells a foreign one): the header; the
 * specification, with zeros to a multiple of 8 bytes; then numbers: the state and the one before
 * it with their carries, the method's memory; the checksum of all that precedes it. The header
 * ends with one of its own, that of header and specification. */
#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/hash.h"
#include "core/memory.h"
#include "core/status.h"
#include "integrator/fingerprint.h"
#include "integrator/integrator_struct.h"
#include "integrator/whole_file.h"
#include "num/finite.h"

typedef struct header {
  char magic[8];
  uint32_t order_mark, version;
  uint64_t steps, fingerprint; /* the stepper's */
  dvi__declared declared;
  dvi__fingerprint system;
  int64_t n, memory_count, count;
  double t, t_carry, last_t, last_t_carry, last_h;
  int64_t pacing; /* of steps in another time: which one, and z, E0 and the monitor */
  double density, energy;
  char monitor[DVI__MONITOR_NAME];
  int64_t specification_size; /* with its zeros */
  uint64_t sum;
} header;

static const char magic[8] = {'d', 'v', 'i', 's', 't', 'a', 't', 'e'};
enum { ORDER_MARK = 0x01020304, VERSION = 5, STEPS_OF_TIME = 0, UNIT = 8 };

/* A file in memory; what `numbers` points to is where the integrator's numbers begin. */
typedef struct file {
  const char *path;
  unsigned char *bytes;
  size_t size;
  header head;
  const char *specification;
  const double *numbers;
} file;

static size_t padded(const char *specification)
{
  return (strlen(specification) / UNIT + 1) * UNIT;
}

static size_t numbers_size(const dvi_integrator *I)
{
  return (8 * (size_t)I->system->n + I->stepper.memory_count) * sizeof(double);
}

static int64_t pacing_of(const dvi_integrator *I)
{
  return I->pace != NULL ? 1 + (int64_t)I->pace->pacing : STEPS_OF_TIME;
}

/* ---- save ---- */

/* The sum itself is left out: it comes last. */
static uint64_t header_sum(const header *head, const char *specification)
{
  const uint64_t hash = dvi__hash(DVI__HASH_START, offsetof(header, sum), head);
  return dvi__hash(hash, (size_t)head->specification_size, specification);
}

static void fill_header(const dvi_integrator *I, header *head)
{
  const dvi__moment now = {I->now.t, I->last_h, I->now.q, I->now.p, I->last.q, I->last.p};
  *head = (header){.order_mark = ORDER_MARK,
                   .version = VERSION,
                   .steps = I->stepper.steps,
                   .fingerprint = I->stepper.fingerprint,
                   .declared = I->system->declared,
                   .n = I->system->n,
                   .memory_count = (int64_t)I->stepper.memory_count,
                   .count = I->counters.steps,
                   .t = I->now.t,
                   .t_carry = I->now.t_carry,
                   .last_t = I->last.t,
                   .last_t_carry = I->last.t_carry,
                   .last_h = I->last_h,
                   .pacing = pacing_of(I),
                   .density = I->now.density,
                   .energy = I->pace != NULL ? I->pace->energy : 0,
                   .specification_size = (int64_t)padded(I->stepper.specification)};
  memcpy(head->magic, magic, sizeof magic);
  if (I->pace != NULL) memcpy(head->monitor, I->pace->name, sizeof head->monitor);
  (void)dvi__fingerprint_take(I, &now, &head->system);
}

static void pack(const dvi_integrator *I, unsigned char *bytes, size_t size)
{
  const size_t state = 4 * (size_t)I->system->n * sizeof(double);
  header head;
  fill_header(I, &head);
  unsigned char *at = bytes + sizeof head;
  memcpy(at, I->stepper.specification, strlen(I->stepper.specification));
  head.sum = header_sum(&head, (const char *)at);
  memcpy(bytes, &head, sizeof head);
  at += head.specification_size;
  memcpy(at, I->now.q, state);
  memcpy(at + state, I->last.q, state);
  memcpy(at + 2 * state, I->stepper.memory, I->stepper.memory_count * sizeof(double));
  const uint64_t sum = dvi__hash(DVI__HASH_START, size - sizeof sum, bytes);
  memcpy(bytes + size - sizeof sum, &sum, sizeof sum);
}

dvi_status dvi_integrator_save(const dvi_integrator *I, const char *path)
{
  if (I == NULL || path == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "checkpoint: an argument is NULL");
  if (!I->started) return dvi__fail(DVI_BAD_STATE, "checkpoint: the integrator has no state yet; call dvi_integrator_start first");
  const size_t size = sizeof(header) + padded(I->stepper.specification) + numbers_size(I) + sizeof(uint64_t);
  unsigned char *bytes = DVI_NEW(unsigned char, size);
  if (bytes == NULL) return dvi__fail(DVI_NO_MEMORY, "checkpoint: no memory for %zu bytes", size);
  pack(I, bytes, size);
  const dvi_status status = dvi__write_whole(path, bytes, size);
  dvi__release(bytes);
  return status == DVI_OK ? DVI_OK : dvi__fail_in(status, "checkpoint");
}

/* ---- restore: is it whole? ---- */

static dvi_status cut_short(const file *f)
{
  return dvi__fail(DVI_BAD_FILE, "checkpoint %s: cut short, %zu bytes", f->path, f->size);
}

static dvi_status damaged(const file *f)
{
  return dvi__fail(DVI_BAD_FILE, "checkpoint %s: damaged (its checksum is wrong)", f->path);
}

static dvi_status check_header(const file *f, size_t got)
{
  if (got >= sizeof magic && memcmp(f->head.magic, magic, sizeof magic) != 0)
    return dvi__fail(DVI_BAD_FILE, "%s is not a checkpoint", f->path);
  if (got < offsetof(header, steps)) return cut_short(f);
  if (f->head.order_mark != ORDER_MARK || f->head.version != VERSION)
    return dvi__fail(DVI_BAD_FILE, "checkpoint %s: written on another kind of machine or by another version", f->path);
  if (got < sizeof f->head) return cut_short(f);
  const int64_t size = f->head.specification_size;
  return size > 0 && size % UNIT == 0 && size <= DVI__SPECIFICATION_MOST + UNIT ? DVI_OK : damaged(f);
}

/* The header, then as much more as a file of this integrator with this specification may have,
 * and one byte, which shows a file that is too long. */
static dvi_status read_stream(const dvi_integrator *I, FILE *stream, file *f)
{
  f->size = fread(&f->head, 1, sizeof f->head, stream);
  if (ferror(stream)) return dvi__fail(DVI_IO_ERROR, "checkpoint: cannot read %s: %s", f->path, strerror(errno));
  DVI_TRY(check_header(f, f->size));
  const size_t rest = (size_t)f->head.specification_size + numbers_size(I) + sizeof(uint64_t) + 1;
  f->bytes = DVI_NEW(unsigned char, sizeof f->head + rest);
  if (f->bytes == NULL) return dvi__fail(DVI_NO_MEMORY, "checkpoint: no memory for %zu bytes", sizeof f->head + rest);
  memcpy(f->bytes, &f->head, sizeof f->head);
  f->size += fread(f->bytes + sizeof f->head, 1, rest, stream);
  return ferror(stream) ? dvi__fail(DVI_IO_ERROR, "checkpoint: cannot read %s: %s", f->path, strerror(errno)) : DVI_OK;
}

static dvi_status read_file(const dvi_integrator *I, file *f)
{
  FILE *stream = fopen(f->path, "rb");
  if (stream == NULL) return dvi__fail(DVI_IO_ERROR, "checkpoint: cannot read %s: %s", f->path, strerror(errno));
  const dvi_status status = read_stream(I, stream, f);
  (void)fclose(stream);
  if (status != DVI_OK) return status;
  const size_t told = sizeof f->head + (size_t)f->head.specification_size;
  if (f->size < told) return cut_short(f);
  f->specification = (const char *)f->bytes + sizeof f->head;
  f->numbers = (const double *)(const void *)(f->bytes + told);
  return header_sum(&f->head, f->specification) == f->head.sum && f->bytes[told - 1] == 0 ? DVI_OK : damaged(f);
}

static dvi_status check_numbers(const dvi_integrator *I, const file *f)
{
  uint64_t sum;
  const size_t size = sizeof f->head + (size_t)f->head.specification_size + numbers_size(I) + sizeof sum;
  if (f->size != size)
    return dvi__fail(DVI_BAD_FILE, "checkpoint %s: cut short or too long, %zu bytes instead of %zu", f->path, f->size, size);
  memcpy(&sum, f->bytes + size - sizeof sum, sizeof sum);
  const int whole = sum == dvi__hash(DVI__HASH_START, size - sizeof sum, f->bytes);
  return whole && isfinite(f->head.t) && dvi__first_not_finite(8 * (size_t)I->system->n, f->numbers) < 0 ? DVI_OK : damaged(f);
}

/* ---- restore: is it of this method and this system? ---- */

/* Whether "key=value" or a name is one of what determines the steps. */
static int matters(const dvi__method *method, const char *piece)
{
  const size_t length = strcspn(piece, "=:,");
  for (int k = 0; k < dvi__key_count(method); k++) {
    const dvi__key *key = &method->keys[k];
    if (strlen(key->name) == length && strncmp(key->name, piece, length) == 0)
      return key->least != DVI__SAID && key->least != DVI__FILE;
  }
  return 1;
}

/* The first of those in which two specifications differ. */
static void find_difference(const dvi__method *method, const char *at[2], int length[2])
{
  for (;;) {
    length[0] = (int)strcspn(at[0], ":,");
    length[1] = (int)strcspn(at[1], ":,");
    const int same = length[0] == length[1] && memcmp(at[0], at[1], (size_t)length[0]) == 0;
    if ((!same && matters(method, at[1])) || at[0][length[0]] == 0 || at[1][length[1]] == 0) return;
    at[0] += length[0] + 1, at[1] += length[1] + 1;
  }
}

static dvi_status check_method(const dvi_integrator *I, const file *f)
{
  if (f->head.steps != I->stepper.steps) {
    const char *here = I->stepper.specification, *at[2] = {f->specification, here};
    int length[2];
    find_difference(I->stepper.method, at, length);
    return dvi__fail(DVI_BAD_FILE, "checkpoint %s: %.*s there, %.*s here: written by %s, not by %s", f->path, length[0], at[0],
                     length[1], at[1], f->specification, here);
  }
  if (f->head.fingerprint == I->stepper.fingerprint) return DVI_OK;
  return dvi__fail(DVI_BAD_FILE, "checkpoint %s: written with other %s, by %s", f->path, I->stepper.fingerprinted,
                   f->specification);
}

static const char *name_of(int64_t pacing)
{
  return pacing == STEPS_OF_TIME ? "of time" : pacing == 1 + DVI__TRANSFORM ? "in another time, by " : "controlled by ";
}

static dvi_status check_time(const dvi_integrator *I, const file *f)
{
  const char *monitor = I->pace != NULL ? I->pace->name : "";
  if (f->head.pacing == pacing_of(I) && strncmp(f->head.monitor, monitor, sizeof f->head.monitor) == 0) return DVI_OK;
  return dvi__fail(DVI_BAD_FILE, "checkpoint %s: of steps %s%.*s, not of steps %s%s", f->path, name_of(f->head.pacing),
                   (int)sizeof f->head.monitor, f->head.monitor, name_of(pacing_of(I)), monitor);
}

static dvi_status check_declared(const dvi_integrator *I, const file *f)
{
  if (f->head.n != I->system->n)
    return dvi__fail(DVI_BAD_FILE, "checkpoint %s: %" PRId64 " coordinates, not %d", f->path, f->head.n, I->system->n);
  const char *difference = dvi__declared_difference(&f->head.declared, &I->system->declared);
  if (difference == NULL) return DVI_OK;
  return dvi__fail(DVI_BAD_FILE, "checkpoint %s: of a system that declares other %s", f->path, difference);
}

/* A monitor may depend on the energy of the start. */
static dvi_status take_fingerprint(const dvi_integrator *I, const file *f, dvi__fingerprint *here)
{
  const size_t n = (size_t)I->system->n;
  const double *now = f->numbers, *last = now + 4 * n, before = I->pace != NULL ? I->pace->energy : 0;
  const dvi__moment at = {f->head.t, f->head.last_h, now, now + n, last, last + n};
  if (I->pace != NULL) dvi__pace_set_energy(I->pace, f->head.energy);
  const dvi_status status = dvi__fingerprint_take(I, &at, here);
  if (I->pace != NULL) dvi__pace_set_energy(I->pace, before);
  return status;
}

static dvi_status check_system(const dvi_integrator *I, const file *f)
{
  dvi__fingerprint here;
  const dvi_status taken = take_fingerprint(I, f, &here);
  if (taken != DVI_OK && !isnan(f->head.system.lagrangian.value))
    return dvi__fail_in(DVI_BAD_FILE, "checkpoint %s: of another system or other parameters; at its state this one fails", f->path);
  const dvi_status status = dvi__fingerprint_compare(&f->head.system, &here);
  return status == DVI_OK ? DVI_OK : dvi__fail_in(status, "checkpoint %s", f->path);
}

static dvi_status check_space(const dvi_integrator *I, const file *f)
{
  const dvi__method *method = I->stepper.method;
  if (method->recognizes == NULL || method->recognizes(&I->stepper, f->numbers + 8 * (size_t)I->system->n)) return DVI_OK;
  return dvi__fail(DVI_BAD_FILE, "checkpoint %s: of another function space of the same name", f->path);
}

/* What the header tells is compared first: of another method or system the numbers are of
 * another count, too. */
static dvi_status check(const dvi_integrator *I, const file *f)
{
  DVI_TRY(check_method(I, f));
  DVI_TRY(check_declared(I, f));
  DVI_TRY(check_time(I, f));
  DVI_TRY(check_numbers(I, f));
  DVI_TRY(check_system(I, f));
  return check_space(I, f);
}

/* ---- restore ---- */

static void unpack(dvi_integrator *I, const file *f)
{
  const header *head = &f->head;
  const size_t count = 4 * (size_t)I->system->n, state = count * sizeof(double);
  I->now.t = head->t;
  I->now.t_carry = head->t_carry;
  I->last.t = head->last_t;
  I->last.t_carry = head->last_t_carry;
  I->last_h = head->last_h;
  I->now.density = head->density;
  I->now.side = 0;
  if (I->pace != NULL) dvi__pace_set_energy(I->pace, head->energy);
  I->counters.steps = (long)head->count;
  memcpy(I->now.q, f->numbers, state);
  memcpy(I->last.q, f->numbers + count, state);
  memcpy(I->stepper.memory, f->numbers + 2 * count, I->stepper.memory_count * sizeof(double));
  I->started = 1;
}

dvi_status dvi_integrator_restore(dvi_integrator *I, const char *path)
{
  if (I == NULL || path == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "checkpoint: an argument is NULL");
  file f = {.path = path};
  dvi_status status = read_file(I, &f);
  if (status == DVI_OK) status = check(I, &f);
  if (status == DVI_OK) unpack(I, &f);
  dvi__release(f.bytes);
  return status;
}
