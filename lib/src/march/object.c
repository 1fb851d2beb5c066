/* Marches of any kind (dvi/march.h): the checks that all kinds share, and their files. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "march/kind.h"
#include "march/parts.h"
#include "march/whole_file.h"

enum { PATH_NAME = 512 };

struct dvi_march {
  const dvi__march_kind *kind;
  void *self;
  int started;
};

dvi_status dvi__march_wrap(const dvi__march_kind *kind, void *self, dvi_march **march)
{
  dvi_march *m = DVI_NEW(dvi_march, 1);
  *march = m;
  if (m == NULL) {
    kind->destroy(self);
    return dvi__fail(DVI_NO_MEMORY, "march: no memory");
  }
  *m = (dvi_march){.kind = kind, .self = self};
  return DVI_OK;
}

double dvi__fit_step(double step, double span)
{
  return span > 0 ? span / ceil(span / step * (1 - 1e-12)) : step;
}

void dvi_march_destroy(dvi_march **march)
{
  if (march == NULL || *march == NULL) return;
  (*march)->kind->destroy((*march)->self);
  dvi__release(*march);
  *march = NULL;
}

static dvi_status check_started(const dvi_march *march)
{
  if (march == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "march: a march is needed");
  if (!march->started)
    return dvi__fail(DVI_BAD_STATE, "march: it has not been started; call dvi_march_start first");
  if (march->kind->is_lost == NULL || !march->kind->is_lost(march->self)) return DVI_OK;
  return dvi__fail(
      DVI_BAD_STATE,
      "march: its values are lost, because they have overflowed or its processes could "
      "not exchange them; start it again, or load a saved state");
}

dvi_status dvi__march_agree(const dvi_march *march, dvi_status status)
{
  return march->kind->agree != NULL ? march->kind->agree(march->self, status) : status;
}

/* ---- motion ---- */

static const char *const form_name[] = {"A", "E", "B"};

static dvi_status check_form(const dvi_march *march, dvi_march_form form, const double *values)
{
  if (values == NULL) return DVI_OK;
  const int64_t size = dvi_march_size(march, form == DVI_FORM_A ? DVI_FORM_E : form);
  for (int64_t i = 0; i < size; i++)
    if (!isfinite(values[i]))
      return dvi__fail(DVI_NOT_FINITE, "march: the start has %s = %g in cell %lld", form_name[form],
                       values[i], (long long)i);
  return DVI_OK;
}

static dvi_status check_state(const dvi_march *march, const dvi_march_state *state)
{
  if (state->size != sizeof *state)
    return dvi__fail(DVI_BAD_ARGUMENT, "march: set state.size to sizeof(dvi_march_state)");
  if (!isfinite(state->t))
    return dvi__fail(DVI_BAD_ARGUMENT, "march: the start is at t = %g", state->t);
  DVI_TRY(check_form(march, DVI_FORM_A, state->A));
  DVI_TRY(check_form(march, DVI_FORM_E, state->E));
  return check_form(march, DVI_FORM_B, state->B);
}

dvi_status dvi_march_start(dvi_march *march, const dvi_march_state *state)
{
  if (march == NULL || state == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "march: a march and a start are needed");
  DVI_TRY(dvi__march_agree(march, check_state(march, state)));
  DVI_TRY(march->kind->start(march->self, state));
  march->started = 1;
  return DVI_OK;
}

dvi_status dvi_march_advance(dvi_march *march, double t)
{
  DVI_TRY(check_started(march));
  const double now = dvi_march_time(march);
  if (!isfinite(t) || t < now)
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "march: it stands at t = %.17g and cannot advance to t = %.17g", now, t);
  return march->kind->advance(march->self, t);
}

double dvi_march_time(const dvi_march *march)
{
  return march != NULL && march->started ? march->kind->time(march->self) : (double)NAN;
}

/* ---- observations ---- */

int64_t dvi_march_size(const dvi_march *march, dvi_march_form form)
{
  if (march == NULL || form < DVI_FORM_A || form > DVI_FORM_B) return 0;
  return march->kind->size(march->self, form);
}

/* Nobody gets values of which some are not finite. */
static dvi_status check_values(const dvi_march *march, dvi_march_form form, int64_t count,
                               const int *cell, double *values)
{
  int64_t i = 0;
  while (i < count && isfinite(values[i])) i++;
  if (i == count) return DVI_OK;
  const double found = values[i];
  memset(values, 0, (size_t)count * sizeof *values);
  return dvi__fail(DVI_NOT_FINITE, "march: %s is %g in cell %lld at t = %g", form_name[form], found,
                   (long long)(cell != NULL ? cell[i] : i), dvi_march_time(march));
}

dvi_status dvi_march_sample(const dvi_march *march, dvi_march_form form, int64_t count,
                            const int *cell, double *values)
{
  DVI_TRY(check_started(march));
  const int64_t size = dvi_march_size(march, form);
  if (size == 0 || values == NULL || (cell != NULL && count < 0))
    return dvi__fail(DVI_BAD_ARGUMENT,
                     size == 0 ? "march: %s does not have such a form"
                               : "march: %s has no place for the values of a form",
                     march->kind->name);
  for (int64_t i = 0; i < count && cell != NULL; i++)
    if (cell[i] < 0 || cell[i] >= size)
      return dvi__fail(DVI_BAD_ARGUMENT, "march: cell %d is not from 0 to %lld", cell[i],
                       (long long)size - 1);
  if (cell == NULL) count = size;
  dvi_status status = march->kind->sample(march->self, form, count, cell, values);
  if (status == DVI_OK) status = check_values(march, form, count, cell, values);
  return cell == NULL ? dvi__march_agree(march, status) : status;
}

const char *dvi_march_observable(const dvi_march *march, int i)
{
  if (march == NULL || i < 0 || i >= march->kind->observables(march->self)) return NULL;
  return march->kind->observable(march->self, i);
}

dvi_status dvi_march_observe(const dvi_march *march, int i, double *value)
{
  DVI_TRY(check_started(march));
  if (value == NULL || dvi_march_observable(march, i) == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "march: there is no observable %d, or no place for it", i);
  double found;
  DVI_TRY(march->kind->observe(march->self, i, &found));
  if (!isfinite(found))
    return dvi__fail(DVI_NOT_FINITE, "march: %s is %g at t = %g", dvi_march_observable(march, i),
                     found, dvi_march_time(march));
  *value = found;
  return DVI_OK;
}

void dvi_march_facts_of(const dvi_march *march, dvi_march_facts *facts)
{
  if (facts == NULL) return;
  *facts = (dvi_march_facts){.method = ""};
  if (march == NULL) return;
  march->kind->facts(march->self, facts);
  facts->method = march->kind->name;
}

/* ---- states in files and in memory ---- */

/* Put the state together, on processes that do not keep it for the others alone. The caller
 * releases the bytes, after a failure, too. */
static dvi_status pack(const dvi_march *march, int keeps, const dvi__parts *parts,
                       dvi__sections_writer *writer)
{
  *writer = (dvi__sections_writer){.bytes = NULL};
  if (keeps) dvi__sections_start(writer, 1 << 12);
  writer->parts = parts;
  DVI_TRY(march->kind->save(march->self, writer));
  return keeps ? dvi__sections_finish(writer) : DVI_OK;
}

static dvi_status write(const dvi_march *march, const char *path)
{
  dvi__sections_writer writer;
  const int writes = march->kind->writes == NULL || march->kind->writes(march->self);
  dvi_status status = pack(march, writes, NULL, &writer);
  if (status == DVI_OK && writes) status = dvi__write_whole(path, writer.bytes, writer.size);
  dvi__release(writer.bytes);
  return status;
}

dvi_status dvi_march_save(const dvi_march *march, const char *path)
{
  DVI_TRY(check_started(march));
  if (path == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "march: a file's name is needed");
  return dvi__march_agree(march, write(march, path));
}

dvi_status dvi_march_save_memory(const dvi_march *march, void *bytes, size_t capacity, size_t *size)
{
  dvi__sections_writer writer;
  DVI_TRY(check_started(march));
  if (size == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "march: a place for the size is needed");
  const dvi_status status = dvi__march_agree(march, pack(march, 1, NULL, &writer));
  const size_t needed = writer.size;
  if (status == DVI_OK) *size = needed;
  if (status == DVI_OK && bytes != NULL && needed <= capacity) memcpy(bytes, writer.bytes, needed);
  dvi__release(writer.bytes);
  if (status != DVI_OK || bytes == NULL || needed <= capacity) return status;
  return dvi__fail(DVI_BAD_SIZE, "march: %zu bytes of room for its state; %zu are needed", capacity,
                   needed);
}

/* Take the state of sections whose reading has this status. */
static dvi_status take_state(dvi_march *march, dvi__sections *sections, dvi_status status)
{
  status = dvi__march_agree(march, status);
  if (status == DVI_OK) status = march->kind->load(march->self, sections);
  dvi__sections_clear(sections);
  if (status == DVI_OK) march->started = 1;
  return status;
}

dvi_status dvi_march_load(dvi_march *march, const char *path)
{
  char name[PATH_NAME];
  dvi__sections sections = {.name = name};
  if (march == NULL || path == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "march: a march and a file's name are needed");
  (void)snprintf(name, sizeof name, "checkpoint %s", path);
  const dvi_status status = dvi__sections_read(path, &sections);
  return take_state(march, &sections, status);
}

/* Read a copy, which is aligned as numbers must be. */
dvi_status dvi_march_load_memory(dvi_march *march, const void *bytes, size_t size)
{
  dvi__sections sections = {.name = NULL};
  if (march == NULL || bytes == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "march: a march and the bytes of its state are needed");
  sections.own = dvi__duplicate(bytes, size, 1);
  const dvi_status status =
      sections.own != NULL
          ? dvi__sections_check(&sections, "checkpoint in memory", sections.own, size)
          : dvi__fail(DVI_NO_MEMORY, "march: no memory for a state of %zu bytes", size);
  return take_state(march, &sections, status);
}

/* ---- states in parts ---- */

static dvi_status check_parts(const dvi_march *march)
{
  if (march == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "march: a march is needed");
  if (march->kind->has_parts) return DVI_OK;
  return dvi__fail(DVI_UNSUPPORTED, "march: a state of %s is not written in parts",
                   march->kind->name);
}

dvi_status dvi__march_put_parts(const dvi_march *march, const dvi__parts *parts,
                                unsigned char **bytes, size_t *size)
{
  dvi__sections_writer writer;
  *bytes = NULL;
  DVI_TRY(check_started(march));
  DVI_TRY(check_parts(march));
  const dvi_status status = dvi__march_agree(march, pack(march, 1, parts, &writer));
  if (status == DVI_OK) {
    *bytes = writer.bytes;
    *size = writer.size;
  } else {
    dvi__release(writer.bytes);
  }
  return status;
}

dvi_status dvi__march_take_parts(dvi_march *march, const char *name, const dvi__parts *parts,
                                 unsigned char *bytes, size_t size, dvi_status status)
{
  dvi__sections sections = {.name = name, .own = bytes, .parts = parts};
  const dvi_status checked = check_parts(march);
  if (checked != DVI_OK) {
    dvi__release(bytes);
    return checked;
  }
  if (status == DVI_OK) status = dvi__sections_check(&sections, name, bytes, size);
  return take_state(march, &sections, status);
}
