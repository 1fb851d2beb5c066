/* Sums of kernels as C functions. */
#include "scene/emit/emit_parts.h"
#include "text/heap.h"

/* A C file has neither controls nor variable parameters. The block of inputs is left out. */
const char *const dvi__block_name[DVI__INPUTS] = {"t", "q", "v", "w"};
/* Sums have arrays of all blocks and pairs. Those of inputs are never wanted, and have no name. */
static const char *const value_name[] = {"f"},
                         *const gradient_name[DVI__BLOCKS] = {"f_t", "f_q", "f_v", "f_w"},
                         *const second_name[DVI__PAIRS] = {"f_qq", "f_qv", "f_vv", "f_qw",
                                                           "f_vw", "f_tq", "f_tv", "f_vq",
                                                           "f_wq", "f_wv", "f_tw"};

int *dvi__name_rows(const dvi__part *part, int *next)
{
  const dvi__program *program = &part->program;
  int *name = dvi__heap_take((size_t)program->row_count + (size_t)program->input_count + 1,
                             sizeof *name);
  for (int i = 0; i < program->input_count && name != NULL; i++)
    name[program->row_count + i] = (*next)++;
  return name;
}

/* ---- parameters ---- */

/* Write blocks and arrays, with something in front of each. */
static void emit_names(dvi__emitter *out, const dvi__emitted_sum *own, const char *before)
{
  for (int b = 0; b < DVI__INPUTS; b++) dvi__emit(out, "%s%s", before, dvi__block_name[b]);
  for (int a = 0; a < own->sum->array_count; a++)
    if (own->sum->wanted[a]) dvi__emit(out, "%s%s", before, own->array[a]);
}

void dvi__emit_parameters(dvi__emitter *out, const dvi__emitted_sum *own)
{
  dvi__emit(out, ",\n    ");
  for (int b = 0; b < DVI__INPUTS; b++)
    dvi__emit(out, "const double *restrict %s, ", dvi__block_name[b]);
  for (int a = 0, more = 0; a < own->sum->array_count; a++)
    if (own->sum->wanted[a])
      dvi__emit(out, "%sdouble *restrict %s", more++ > 0 ? ", " : "", own->array[a]);
}

void dvi__emit_arguments(dvi__emitter *out, const dvi__emitted_sum *own)
{
  emit_names(out, own, ", ");
}

void dvi__emit_mentions(dvi__emitter *out, const dvi__emitted_sum *own)
{
  emit_names(out, own, ", (void)");
  dvi__emit(out, ";\n");
}

void dvi__emit_shifts(dvi__emitter *out, const dvi__emitted_sum *own, const dvi__part *part)
{
  unsigned blocks = 0, arrays = 0;
  for (int i = 0; i < part->variable_count; i++) blocks |= 1U << part->block[i];
  for (int i = 0; i < part->target_count; i++) arrays |= 1U << part->target[i].array;
  for (int b = 0; b < DVI__INPUTS; b++)
    if ((blocks >> b & 1U) != 0) dvi__emit(out, "  %s += k;\n", dvi__block_name[b]);
  for (int a = 0; arrays >> a != 0; a++)
    if ((arrays >> a & 1U) != 0) dvi__emit(out, "  %s += k;\n", own->array[a]);
}

void dvi__emit_zeros(dvi__emitter *out, const dvi__emitted_sum *own, int array)
{
  dvi__emit(out, "  memset(%s, 0, sizeof *%s * (size_t)n * %d);\n", own->array[array],
            own->array[array], own->sum->size[array]);
}

/* ---- functions ---- */

static int has_one_element(const dvi__function_sum *sum)
{
  for (int k = 0; k < sum->part_count; k++)
    if (sum->part[k].kernel->elements > 1) return 0;
  return 1;
}

static int has_inverse_roots(const dvi__function_sum *sum)
{
  for (int k = 0; k < sum->part_count; k++)
    if (dvi__program_has_inverse_roots(&sum->part[k].program)) return 1;
  return 0;
}

static void emit_function_head(dvi__emitter *out, const dvi__emitted_sum *own, const char *kind,
                               const char *ending)
{
  dvi__emit(out, "%sstatic void %s%s(int count", kind, own->name, ending);
  dvi__emit_parameters(out, own);
  dvi__emit(out, ")\n{\n");
}

static void emit_function_call(dvi__emitter *out, const dvi__emitted_sum *own, const char *function)
{
  dvi__emit(out, "%s%s", own->name, function);
  dvi__emit_arguments(out, own);
  dvi__emit(out, ")");
}

static dvi_status emit_sum(dvi__emitter *out, const dvi__emitted_sum *own)
{
  const int may_be_unusual = has_inverse_roots(own->sum);
  const dvi_status status = has_one_element(own->sum) ? dvi__emit_expressions(out, own)
                                                      : dvi__emit_elements(out, own);
  if (status != DVI_OK) return status;
  if (may_be_unusual) {
    emit_function_head(out, own, "DVI_SELDOM ", "_careful");
    dvi__emit(out, "  ");
    emit_function_call(out, own, "_at(1, count");
    dvi__emit(out, ";\n}\n");
  }
  emit_function_head(out, own, own->points > 1 ? "DVI_LANES " : "", "");
  dvi__emit(out, may_be_unusual ? "  if (" : "  ");
  emit_function_call(out, own, "_at(0, count");
  if (may_be_unusual) {
    dvi__emit(out, ") ");
    emit_function_call(out, own, "_careful(count");
  }
  dvi__emit(out, ";\n}\n\n");
  return out->failed;
}

/* Write a kind of result, deriving the sum if need be. `names` are those of its arrays. */
static dvi_status emit_derived(dvi__emitter *out, dvi__function *function, dvi__derived derived,
                               const char *wanted, const dvi__emitted_sum *named)
{
  dvi__emitted_sum own = *named;
  const dvi_status status = dvi__function_prepare(function, derived == DVI__VALUE,
                                                  derived == DVI__GRADIENT ? wanted : NULL,
                                                  derived == DVI__SECOND ? wanted : NULL);
  if (status != DVI_OK) return status;
  own.sum = dvi__function_sum_of(function, derived, wanted);
  return emit_sum(out, &own);
}

dvi_status dvi__emit_value(dvi__emitter *out, dvi__function *function, const char *name)
{
  const dvi__emitted_sum own = {.name = name, .array = value_name, .points = 1};
  return emit_derived(out, function, DVI__VALUE, &(const char){1}, &own);
}

dvi_status dvi__emit_gradient(dvi__emitter *out, dvi__function *function, const char *blocks,
                              int lanes, const char *name)
{
  const dvi__emitted_sum own = {.name = name, .array = gradient_name, .points = lanes ? 8 : 1};
  return emit_derived(out, function, DVI__GRADIENT, blocks, &own);
}

dvi_status dvi__emit_second(dvi__emitter *out, dvi__function *function, const char *pairs,
                            int lanes, const char *name)
{
  const dvi__emitted_sum own = {.name = name, .array = second_name, .points = lanes ? 4 : 1};
  return emit_derived(out, function, DVI__SECOND, pairs, &own);
}
